#!/bin/bash
# scripts/bed_scatter.sh [FOLDER]: how far two beds of one gravel are apart that LIGGGHTS dug alike: each pair of packings
# in tests/data/reference, a line each, then the least and the most.
set -eu
data=${1:-tests/data/reference}
for one in "$data"/*.csv; do
    gravel=$(basename "$one" .csv) path=${one##*__}
    gravel=${gravel%__*}
    for other in "$data/${gravel%_seed*}"__"$path" "$data/${gravel%_seed*}"_seed*__"$path"; do
        [ -e "$other" ] && [[ $one < $other ]] || continue
        echo "$(basename "$one" .csv) $(basename "$other" .csv) $(awk -f scripts/between.awk "$one" "$other")"
    done
done | sort -k3 -n | awk '{ print; if (NR == 1) least = $3; most = $3 }
    END { printf "two beds: %.0f to %.0f %%, %d pairs\n", 100 * least, 100 * most, NR }'
