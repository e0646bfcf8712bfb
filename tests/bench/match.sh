#!/bin/bash
# The matcher on 10^5 curves of 3 channels x 256 points, grown from tables/reference_rig.sqlite: the nearest entry
# beside a look at all entries, and the refinement, against 10 and 50 ms. Processor time of one thread. Lines
# `name ratio unit detail`; BENCH_QUICK=1: 10 digs instead of 40. 0.9 GB of memory.
#   BUILD=build tests/bench/match.sh
set -eu
BUILD=${BUILD:-build}
digs=40
[ -z "${BENCH_QUICK-}" ] || digs=10
make --no-print-directory -s BUILD="$BUILD" "$BUILD/tests/bench/match" >&2

"$BUILD/tests/bench/match" tables/reference_rig.sqlite 47 "$digs" | awk '
    { entries = $2; n[$1] = $3; ms[$1] = $4; worst[$1] = $5 }
    END {
        printf "match-nearest %.0f x-a-look-at-all median %s ms, a look at all %s; the same entry and distance in %d of %d digs, %d curves\n",
            ms["all"] / ms["nearest"], ms["nearest"], ms["all"], n["nearest"], n["nearest"], entries
        printf "match-nearest-limit %.2f x-of-10ms median %s ms, worst %s\n", ms["nearest"] / 10, ms["nearest"], worst["nearest"]
        for (k = 1; k <= split("weighed_moment weighed_forces", kinds); k++) {
            kind = kinds[k]
            sub("_", "-", kind)
            printf "match-%s %.2f x-of-10ms median %s ms, worst %s\n", kind, ms[kinds[k]] / 10, ms[kinds[k]], worst[kinds[k]]
        }
        for (k = 1; k <= split("moment forces", kinds); k++)
            printf "match-refined-%s %.2f x-of-50ms median %s ms, worst %s\n", kinds[k], ms[kinds[k]] / 50, ms[kinds[k]], worst[kinds[k]]
    }'
