#!/bin/bash
# How right a machine is, which does not know where the ground lies: the simple digs of LIGGGHTS in the open, true depth 1,
# as a machine would record them. A line a dig: the depth told, how far off the actual dig of that bed is predicted, the
# noise floor, by what the gravel was identified, and whether it was told to be outside; or what refused it.
# AIR_PACE=3 moves the bucket so much more briskly before and after a dig.
#   BIN=build/bin scripts/machine_depths.sh [TABLE.sqlite [SCENE.yaml [FOLDER...]]]
set -eu
bin=${BIN:-build/bin} table=${1:-tables/product.sqlite} scene=${2:-config/scenes/product.yaml}
machine=config/machines/zx200_trench.yaml
[ $# -le 2 ] && set -- - - tests/data/liggghts_product tests/data/liggghts_product/smooth
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

one() { sed -nE "s/.*\"$1\": ([a-z0-9.e+-]+).*/\1/p" "$2" | head -n 1; }

printf '%-40s %6s %6s %6s  %s\n' dig depth error floor identified
for simple in "${@/%//*__simpleA.csv}"; do
    # shellcheck disable=SC2086 # a pattern
    for dig in $simple; do
        name=$(basename "${dig%__simpleA.csv}")
        "$bin/digrig" record "$dig" --machine "$machine" --scene "$scene" -o "$work/machine.csv" -q \
            --air-pace "${AIR_PACE:-1}"
        if ! "$bin/digloop" identify "$table" "$work/machine.csv" --machine "$machine" --trajectory simpleA \
            --json >"$work/id.json" 2>"$work/why"; then
            printf '%-40s %6s %6s %6s  refused: %s\n' "$name" - - - "$(sed -nE 's/.*(digs in it: [^;]*), expected.*/\1/p' "$work/why")"
            continue
        fi
        "$bin/digloop" predict "$table" --identified "$work/id.json" --trajectory actual \
            --measured "${dig%simpleA.csv}actual.csv" --json >"$work/next.json" 2>/dev/null
        printf '%-40s %6.3f %6.3f %6.3f  %s%s\n' "$name" "$(one depth "$work/id.json")" "$(one error "$work/next.json")" \
            "$(one noise_floor "$work/next.json")" \
            "$([ "$(one forces "$work/id.json")" = true ] && echo moment and forces || echo moment alone)" \
            "$([ "$(one outside "$work/id.json")" = true ] && echo ', outside' || true)"
    done
done
