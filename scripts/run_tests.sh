#!/bin/bash
# Runs test programs and system test scripts, shows what failed, counts every single test, and says how long each took
# and how much of a processor:
#   scripts/run_tests.sh [-j N] PROGRAM|SCRIPT…
# A program's own closing lines are read: cmocka's "[  PASSED  ] N test(s)", or "N passed, M failed[, K
# skipped]". Exits 1 when anything failed, crashed, ran past its limit, or closed without such a line.
set -u
jobs=1
[ "${1-}" = -j ] && { jobs=$2; shift 2; }
limit_s=${DIG_TEST_LIMIT_S:-1800}
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT

run_one() { # INDEX PROGRAM
    local log=$out/$1.log rc=0 passed failed skipped TIMEFORMAT='%1R %1U %1S'
    { time timeout -k 5 "$limit_s" "$2" >"$log" 2>&1 </dev/null; } 2>"$out/$1.time" || rc=$?
    passed=$(sed -nE 's/^\[  PASSED  \] ([0-9]+) test.*/\1/p; s/^(.*: )?([0-9]+) passed, ([0-9]+) failed.*/\2/p' "$log" | tail -n 1)
    failed=$(sed -nE 's/^\[  FAILED  \] ([0-9]+) test.*/\1/p; s/^(.*: )?([0-9]+) passed, ([0-9]+) failed.*/\3/p' "$log" | tail -n 1)
    skipped=$(sed -nE 's/^\[  SKIPPED \] ([0-9]+) test.*/\1/p; s/.* failed, ([0-9]+) skipped.*/\1/p' "$log" | tail -n 1)
    [ -n "$passed$failed" ] || { rc=${rc/#0/1}; echo "$2 closed without a count (exit $rc)" >>"$log"; }
    if [ "$rc" != 0 ] && [ "${failed:-0}" = 0 ]; then failed=1; fi
    echo "${passed:-0} ${failed:-0} ${skipped:-0}" >"$out/$1.count"
    local word=ok
    [ "${failed:-0}" = 0 ] || word=FAILED
    printf '  %-6s %-44s %3d passed %s%s\n' "$word" "$2" "${passed:-0}" \
        "$(tail -n 1 "$out/$1.time" | tr , . | LC_ALL=C awk '{ printf "%5.1f s, %5.1f s of a processor", $1, $2 + $3 }')" \
        "$([ "${skipped:-0}" = 0 ] || echo ", $skipped SKIPPED")"
    # The checks that failed first: what follows them may be longer than what is shown.
    [ "$word" = ok ] || { grep '^FAIL' "$log"; tail -n 60 "$log"; } | sed 's/^/      | /'
    grep -h '^SKIP' "$log" | sed 's/^/      /'
}

index=0
for program in "$@"; do
    index=$((index + 1))
    while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n; done
    run_one "$index" "$program" &
done
wait

total=$(cat "$out"/*.count 2>/dev/null | awk '{ p += $1; f += $2; s += $3 } END { printf "%d passed, %d failed, %d skipped", p, f, s }')
echo "$total"
case $total in *" 0 failed,"*) exit 0 ;; esac
exit 1
