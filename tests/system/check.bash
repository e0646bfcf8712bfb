# What every system test shares. Sourced from the repository's root; BIN is where the programs are. Gives $work, a folder
# that goes away, and counts what is checked. `finish` at the end.
set -u
BIN=${BIN:-build/bin}
passed=0 failed=0 skipped=0
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

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

# What this machine does not let a test do, aloud.
skip_check() { # SENTENCE WHY
    skipped=$((skipped + 1))
    echo "SKIP: $1: $2"
}

finish() { # with what the programs said, if anything failed
    if [ "$failed" != 0 ]; then
        for f in "$work"/*.log "$work"/*.err; do
            [ -f "$f" ] && { echo "--- $f"; tail -n 30 "$f"; }
        done
    fi
    echo "$passed passed, $failed failed$([ "$skipped" = 0 ] || echo ", $skipped skipped")"
    [ "$failed" = 0 ]
    exit
}

heavier() { # KG FILE: a machine whose bucket weighs so much more than $machine says
    awk -v more="$1" '/^[a-z]/ { part = $1 }
        part == "bucket:" && $1 == "mass_kg:" { $0 = "  mass_kg: " $2 + more } { print }' "$machine" >"$2"
}

is() { # VALUE WANTED
    [ "$1" = "$2" ] || { echo "      \"$1\" instead of \"$2\""; return 1; }
}

# Exit status 2, a message that holds every word, and no output file.
refuses() { # WORDS… -- COMMAND…
    local words=() word
    while [ "$1" != -- ]; do words+=("$1"); shift; done
    shift
    "$@" >"$work/out" 2>"$work/err"
    local rc=$?
    [ "$rc" = 2 ] || { echo "      exit status $rc of: $*"; return 1; }
    for word in "${words[@]}"; do
        grep -qF -- "$word" "$work/err" || { echo "      no \"$word\" in: $(cat "$work/err")"; return 1; }
    done
    [ ! -e "$work/never" ]
}

is_json() { # standard input: one JSON value and nothing else
    cat >"$work/json" && is "$(sqlite3 :memory: "SELECT json_valid(CAST(readfile('$work/json') AS TEXT))")" 1
}

within() { # VALUE LOW HIGH
    awk -v v="$1" -v low="$2" -v high="$3" 'BEGIN { exit !(v != "" && v >= low && v <= high) }'
}
