#!/bin/bash
# What `digloop trace` says of digs of another code: every gravel of a folder as a campaign, of each bed its simpleA and its
# actual, or its simpleB where it has no actual. The first simple dig identifies, the last real dig is held out where it has
# three beds or more. A line a campaign, intervals of 90 %; bed: how far off the other beds' real digs would be, in the mean,
# as the prediction of the one held out. The right verdict of plain gravel, and so of tests/data/reference, is none.
#   BIN=build/bin scripts/trace_reference.sh [TABLE.sqlite [FOLDER]]
set -eu
bin=${BIN:-build/bin} table=${1:-tables/reference_rig.sqlite} data=${2:-tests/data/reference}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
here=$(realpath "$data")
scene=$("$bin/digtable" list "$table" --json | sed -nE 's/.*"name": "([^"]*)".*/\1/p' | head -n 1)

whole() { tr -d '\n' <"$work/trace.json"; }
field() { whole | grep -oE "\"$1\": $2" | head -n 1 | sed -E 's/^"[^"]*": //'; }
interval() { # TEXT: value (low-high) of the first object in it that has them
    grep -oE '\{"value": [^}]*' <<<"$1" | head -n 1 | tr -d '{,' | awk '{ printf "%.3g (%.3g-%.3g)", $2, $4, $6 }'
}
other_beds() { # of the beds, the last against each before it
    local measured=${beds[-1]}__actual.csv
    [ "${#beds[@]}" -ge 3 ] || { echo nan; return; }
    for other in "${beds[@]:0:${#beds[@]}-1}"; do awk -f scripts/between.awk "${other}__actual.csv" "$measured"; done |
        awk '{ s += $1 } END { print s / NR }'
}
holdout() { field "error_$1" '\{"holdout": [^,]*' | sed -E 's/.* //; s/null/nan/'; }

printf '%-32s %4s  %-19s %-18s %-16s %-16s %-17s %8s %6s %6s %6s %6s\n' gravel digs verdict magnitude friction rolling \
    kg/m3 residual before after bed floor
for gravel in $(cd "$here" && printf '%s\n' *rho*__simpleA.csv | sed -E 's/(_seed[0-9]+)?__simpleA.csv//' | sort -u); do
    beds=()
    for simple in "$here/$gravel"{,_seed*}__simpleA.csv; do
        bed=${simple%__simpleA.csv}
        if [ -e "${bed}__actual.csv" ] || [ -e "${bed}__simpleB.csv" ]; then beds+=("$bed"); fi
    done
    [ "${#beds[@]}" -gt 0 ] || continue
    {
        echo "scene: $scene"
        echo "recordings:"
        role=identify
        for i in "${!beds[@]}"; do
            held=fit
            [ "${#beds[@]}" -ge 3 ] && [ "$i" = $((${#beds[@]} - 1)) ] && held=holdout
            echo "  - {file: ${beds[$i]}__simpleA.csv, trajectory: simpleA, role: $role}"
            other=actual
            [ -e "${beds[$i]}__actual.csv" ] || other=simpleB
            echo "  - {file: ${beds[$i]}__$other.csv, trajectory: $other, role: $held}"
            role=fit
        done
    } >"$work/campaign.yaml"
    "$bin/digloop" trace "$table" "$work" --json "$work/trace.json" 2>"$work/err" || { cat "$work/err"; exit 1; }
    printf '%-32s %4d  %-19s %-18s %-16s %-16s %-17s %8.3g %6.3f %6.3f %6.3f %6.3f\n' "$gravel" $((2 * ${#beds[@]})) \
        "$(field verdict '\[[^]]*\]')" "$(interval "$(whole | sed 's/"material": .*//; s/.*"effects": //')")" \
        "$(interval "$(field friction '.*')")" "$(interval "$(field rolling '.*')")" \
        "$(interval "$(field density_kgpm3 '.*')")" "$(field soil '[0-9.e+-]+')" "$(holdout before)" \
        "$(holdout after)" "$(other_beds)" "$(field noise_floor '[0-9.e+-]+')"
done
