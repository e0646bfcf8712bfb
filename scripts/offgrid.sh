#!/bin/bash
# How right a table is on gravels off its grid: every plain dig of LIGGGHTS in tests/data/liggghts_more, none of
# which is of any table, is identified from its simpleA dig, and its actual dig predicted. Beside the error stand
# what the best entry of the table would have had in hindsight, and what the other packings of the gravel
# have as a prediction. Last line: the medians, and whether the error's is at most 1.25 of the one or 1.1 of the other.
#   BIN=build/bin scripts/offgrid.sh [TABLE.sqlite]
set -eu
bin=${BIN:-build/bin} table=${1:-tables/reference_rig.sqlite} data=tests/data/liggghts_more
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

error_of() { # IDENTITY ACTUAL
    "$bin/digloop" predict "$table" --identified "$1" --trajectory actual --measured "$2" --json |
        sed -nE 's/.*"error": ([0-9.e+-]+).*/\1/p' | head -n 1
}

# An identity that is sure of one gravel.
sure_of() { # FRICTION ROLLING DENSITY
    awk -v gravel="{\"friction\": $1, \"rolling\": $2, \"density_kgpm3\": $3}" '
        { gsub(/\{"friction": [^}]*\}/, gravel) }
        /"samples"/ { sub(/\[.*/, "[" gravel "]}"); print; exit }
        { print }' "$work/id.json"
}

printf '%-30s %6s %8s %8s\n' gravel error hindsight packings
for simple in "$data"/mu*__simpleA.csv; do
    case=${simple%__simpleA.csv}
    "$bin/digloop" identify "$table" "$simple" --json >"$work/id.json"
    error=$(error_of "$work/id.json" "${case}__actual.csv")
    best=$("$bin/digtable" list "$table" | awk '$1 ~ /^[0-9]+$/ { print $2, $3, $4 }' |
        while read -r friction rolling density; do
            sure_of "$friction" "$rolling" "$density" >"$work/sure.json"
            error_of "$work/sure.json" "${case}__actual.csv"
        done | sort -g | head -n 1)
    others=$(for other in "${case%_seed*}"_seed*__actual.csv; do
        [ "$other" = "${case}__actual.csv" ] || awk -f scripts/between.awk "$other" "${case}__actual.csv"
    done | awk '{ s += $1 } END { if (NR) printf "%.3f", s / NR; else print "-" }')
    printf '%-30s %6.3f %8.3f %8s\n' "$(basename "$case")" "$error" "$best" "$others" | tee -a "$work/lines"
done
median() { sort -g | awk '{ v[NR] = $1 } END { print NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'; }
error=$(awk '{ print $2 }' "$work/lines" | median)
best=$(awk '{ print $3 }' "$work/lines" | median)
others=$(awk '$4 != "-" { print $4 }' "$work/lines" | median)
echo "$error $best $others" | awk '{ a = 1.25 * $2; b = 1.1 * $3; most = a > b ? a : b
    printf "median error %.3f, best entry in hindsight %.3f, other packings %.3f: %s %.3f\n", $1, $2, $3,
        ($1 <= most ? "at most" : "MORE than"), most }'
