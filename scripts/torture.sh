#!/bin/bash
# Runs torture scripts one after the other and ends with a table of what they counted:
#   BIN=build/bin TORTURE_S=30 scripts/torture.sh tests/torture/NAME.sh…
set -u
log=$(mktemp) said=$(mktemp)
trap 'rm -f "$log" "$said"' EXIT
export TORTURE_S=${TORTURE_S:-30} DIG_TRIES=1
failed=0
for script in "$@"; do
    echo "== $script"
    began=$SECONDS
    echo "script $(basename "$script" .sh)" >>"$log"
    # What hangs has failed; preparations and a slow machine have half an hour. So has what was not run at all.
    : >"$said"
    timeout -k 10 $((3 * TORTURE_S + 1800)) "$script" 2>&1 </dev/null | tee "$said"
    [ "${PIPESTATUS[0]}" = 0 ] && ! grep ": line [0-9]*: .*: command not found" "$said" || { failed=$((failed + 1)); echo "FAILED: $script"; }
    cat "$said" >>"$log"
    echo "seconds $((SECONDS - began))" >>"$log"
done
echo
echo "| script | count | of what |"
echo "|---|---|---|"
awk '$1 == "script" { name = $2 } $1 == "count" { count = $2; $1 = $2 = ""; sub(/^ +/, ""); print "| `" name "` | " count " | " $0 " |" }' "$log"
echo "$(($# - failed)) passed, $failed failed"
[ $failed = 0 ]
