#!/bin/bash
# Runs every tests/bench/*.sh, one after the other: lines of `name ratio unit detail` on stdout.
#   BUILD=build BENCH_QUICK=1 scripts/bench.sh [NAME...]
set -u
cd "$(dirname "$0")/.." || exit 1
failed=0
for bench in tests/bench/*.sh; do
    name=$(basename "$bench" .sh)
    [ $# -eq 0 ] || [[ " $* " == *" $name "* ]] || continue
    BUILD=${BUILD:-build} "$bench" || { echo "$name: failed" >&2; failed=1; }
done
exit $failed
