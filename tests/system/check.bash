# How a system test counts what it checks. Source it from the repository's root; at the end:
#   echo "$passed passed, $failed failed"
passed=0 failed=0

check() { # SENTENCE COMMAND…: the command must succeed; the last words it left in $work/err are shown if not
    if "${@:2}"; then
        passed=$((passed + 1))
        echo "ok    $1"
    else
        failed=$((failed + 1))
        echo "FAIL  $1"
        tail -n 5 "$work"/err 2>/dev/null
    fi
}

within() { # VALUE LOW HIGH
    awk -v v="$1" -v low="$2" -v high="$3" 'BEGIN { exit !(v != "" && v >= low && v <= high) }'
}
