#!/bin/bash
# How deep a machine takes digs to be whose depth is known: the simple digs of LIGGGHTS in the open, true depth 1, as a machine
# would record them. There the surface is where the first grain is met. A line a dig: depth, by what the gravel was
# identified, and whether it was told to be outside; or what refused it.
#   BIN=build/bin scripts/machine_depths.sh [TABLE.sqlite [SCENE.yaml [FOLDER...]]]
set -eu
bin=${BIN:-build/bin} table=${1:-tables/product.sqlite} scene=${2:-config/scenes/product.yaml}
machine=config/machines/zx200_trench.yaml
[ $# -le 2 ] && set -- - - tests/data/liggghts_product tests/data/liggghts_product/smooth
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

printf '%-40s %6s  %s\n' dig depth identified
for simple in "${@/%//*__simpleA.csv}"; do
    # shellcheck disable=SC2086 # a pattern
    for dig in $simple; do
        "$bin/digrig" record "$dig" --machine "$machine" --scene "$scene" -o "$work/machine.csv" -q
        "$bin/digloop" identify "$table" "$work/machine.csv" --machine "$machine" --trajectory simpleA >"$work/said" 2>&1 || true
        depth=$(sed -nE 's/.*at depth ([0-9.]+),.*/\1/p' "$work/said")
        how=$(sed -nE 's/.*\(simpleA\): ([^;]*).*/\1/p' "$work/said")
        outside=$(grep -o OUTSIDE "$work/said" || true)
        printf '%-40s %6s  %s\n' "$(basename "${dig%__simpleA.csv}")" "${depth:--}" \
            "${how:-refused: no dig along a trajectory of the table}${outside:+, outside}"
    done
done
