#!/bin/bash
# How right a table is on digs of another code: every LIGGGHTS gravel of tests/data/reference is
# identified from its simpleA dig, its actual dig is predicted and compared. One line a case.
#   BIN=build/bin scripts/evaluate.sh [TABLE.sqlite]
set -eu
bin=${BIN:-build/bin} table=${1:-tables/rig.sqlite}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

field() { # KEY AXIS: a number of one of the identity's gravels
    sed -nE "s/.*\"$1\": \{.*\"$2\": ([0-9.e+-]+).*/\1/p" "$work/id.json"
}
one() { sed -nE "s/.*\"$1\": ([a-z0-9.e+-]+).*/\1/p" "$2" | head -n 1; }

printf '%-30s %22s %22s %6s %6s\n' "true gravel (packing)" identified nearest error floor
for simple in tests/data/reference/*__simpleA.csv; do
    case=${simple%__simpleA.csv}
    "$bin/digloop" identify "$table" "$simple" --json >"$work/id.json"
    "$bin/digloop" predict "$table" --identified "$work/id.json" --trajectory actual \
        --measured "${case}__actual.csv" --json >"$work/next.json"
    printf '%-30s %6.2f %6.2f %7.0f %8.1f %6.1f %6.0f %6.3f %6.3f %s\n' "$(basename "$case")" \
        "$(field gravel friction)" "$(field gravel rolling)" "$(field gravel density_kgpm3)" \
        "$(field nearest friction)" "$(field nearest rolling)" "$(field nearest density_kgpm3)" \
        "$(one error "$work/next.json")" "$(one noise_floor "$work/next.json")" \
        "$([ "$(one outside "$work/id.json")" = true ] && echo outside || true)" | tee -a "$work/all"
done
sort -k8 -n "$work/all" | awk '{ e[NR] = $8; f[NR] = $9 } END {
    median = NR % 2 ? e[(NR + 1) / 2] : (e[NR / 2] + e[NR / 2 + 1]) / 2
    for (i = 1; i <= NR; i++) sum += f[i]
    printf "median error %.3f, mean noise floor %.3f over %d digs\n", median, sum / NR, NR }'
