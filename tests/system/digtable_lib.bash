# What the system tests of digtable share. Source it from the repository's root.
BIN=${BIN:-build/bin}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
scene=tests/data/formats/scene.yaml # a coarse tub: a dig takes a fraction of a second
passed=0 failed=0

# check DESCRIPTION COMMAND…: the command succeeds.
check() {
    local what=$1
    shift
    if "$@" >"$work/check.log" 2>&1; then
        passed=$((passed + 1))
        echo "ok: $what"
    else
        failed=$((failed + 1))
        echo "FAILED: $what"
        sed 's/^/    /' "$work/check.log" "$work/err" 2>/dev/null | tail -n 12
    fi
}

# digtable ARGUMENTS…: its exit code in $code, its words in $work/out and $work/err.
digtable() {
    code=0
    "$BIN/digtable" "$@" >"$work/out" 2>"$work/err" </dev/null || code=$?
}

is() { [ "$1" = "$2" ] || { echo "\"$1\" instead of \"$2\""; return 1; }; }

finish() {
    echo "$passed passed, $failed failed"
    [ "$failed" = 0 ]
    exit
}
