#!/bin/bash
# The engine on a graphics card beside the kernel on one core: wall time of the same dig, pouring included, one after
# the other. Without a card, or its library (make cuda), it says so and measures nothing.
#   BUILD=build tests/bench/card.sh       some minutes; BENCH_QUICK=1: the rig alone
set -eu
build=${BUILD:-build}
export DIG_CUDA_LIBRARY=${DIG_CUDA_LIBRARY:-$build/libdig_cuda.so}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

seconds_of() { # SCENE TRAJECTORY ENGINE
    local TIMEFORMAT=%R
    { time "$build/bin/digtable" dig "config/scenes/$1.yaml" --trajectory "$2" --friction .5 --rolling .5 --density 2500 \
        --engine "$3" -o "$work/$3.csv" >"$work/log" 2>&1; } 2>"$work/time" || { tail -n 3 "$work/log" >&2; return 1; }
    cat "$work/time"
}

if ! command -v nvidia-smi >/dev/null || [ ! -e "$DIG_CUDA_LIBRARY" ]; then
    echo "card: SKIP, no graphics card or no $DIG_CUDA_LIBRARY" >&2
    exit 0
fi
for dig in rig:simpleA rig:actual product:simpleA; do
    scene=${dig%:*} trajectory=${dig#*:}
    [ -z "${BENCH_QUICK:-}" ] || [ "$scene" = rig ] || continue
    card=$(seconds_of "$scene" "$trajectory" cuda)
    kernel=$(seconds_of "$scene" "$trajectory" kernel)
    awk -v name="card_${scene}_$trajectory" -v a="$card" -v b="$kernel" 'BEGIN {
        printf "%s %.2f ratio wall time of a dig: the card %.1f s, the kernel on one core %.1f s\n", name, b / a, a, b }'
done
