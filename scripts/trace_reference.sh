#!/bin/bash
# What `digloop trace` says of digs of another code in plain gravel: every LIGGGHTS gravel of
# tests/data/reference as a campaign, its first simple dig to identify, its last real dig held out
# where it has three beds or more. One line a campaign; the right verdict is none.
#   BIN=build/bin scripts/trace_reference.sh [TABLE.sqlite]
set -eu
bin=${BIN:-build/bin} table=${1:-tables/rig.sqlite}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
here=$(pwd)

field() { sed -nE "s/.*\"$1\": ($2).*/\1/p" "$work/trace.json" | head -n 1; }

printf '%-22s %5s  %-14s %9s %9s %6s %6s\n' gravel digs verdict p residual error floor
for first in tests/data/reference/*0__simpleA.csv; do
    gravel=$(basename "${first%__simpleA.csv}")
    beds=("$gravel")
    for other in tests/data/reference/"$gravel"_seed*__simpleA.csv; do
        [ -e "$other" ] && beds+=("$(basename "${other%__simpleA.csv}")")
    done
    {
        echo "scene: rig"
        echo "recordings:"
        role=identify
        for i in "${!beds[@]}"; do
            held=fit
            [ "${#beds[@]}" -ge 3 ] && [ "$i" = $((${#beds[@]} - 1)) ] && held=holdout
            echo "  - {file: $here/tests/data/reference/${beds[$i]}__simpleA.csv, trajectory: simpleA, role: $role}"
            echo "  - {file: $here/tests/data/reference/${beds[$i]}__actual.csv, trajectory: actual, role: $held}"
            role=fit
        done
    } >"$work/campaign.yaml"
    "$bin/digloop" trace "$table" "$work" --json "$work/trace.json" 2>"$work/err" || { cat "$work/err"; exit 1; }
    printf '%-22s %5d  %-14s %9s %9s %6.3f %6.3f\n' "$gravel" $((2 * ${#beds[@]})) "$(field verdict '\[[^]]*\]')" \
        "$(field p_complete '[0-9.e+-]+')" "$(field soil '[0-9.e+-]+')" \
        "$(field holdout '[0-9.e+-]+' | grep . || echo nan)" "$(field noise_floor '[0-9.e+-]+')"
done
