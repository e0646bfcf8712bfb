#!/bin/bash
# What does a table of coarse grains tell of finer gravel? Digs config/scenes/product.yaml with smaller grains, identifies
# each gravel from its simpleA dig by tables/product.sqlite, predicts its actual dig and compares. One line a dig: grains
# across the bucket, mean moments, the gravel found, error and noise floor (docs/numerics/dem.md, "Fine gravel").
#   BIN=build/bin OUT=build/fine_study [TABLE=tables/product.sqlite] scripts/fine_study.sh [ACROSS...]
# ACROSS: 10 14 20. What lies in OUT is not dug again, so it may be stopped and started. On two cores the two gravels
# take 3 and 15 minutes for 10 and 14.
set -euo pipefail
bin=${BIN:-build/bin} out=${OUT:-build/fine_study} table=${TABLE:-tables/product.sqlite} scene=config/scenes/product.yaml
mkdir -p "$out"

number() { sed -nE "s/.*\"$1\": ([0-9.e+-]+).*/\1/p" "$2" | head -n 1; }
axis() { sed -nE "s/.*\"gravel\": \{.*\"$1\": ([0-9.e+-]+).*/\1/p" "$2"; }
mean() { awk -F, '/^t_s/ { for (i = 1; i <= NF; i++) if ($i == "My_Nm") c = i; next } { s += $c; n++ } END { print s / n }' "$1"; }

printf '%-12s %6s %8s %8s %9s %9s  %-18s %6s %6s\n' gravel across grains seed simpleA/Nm actual/Nm identified error floor
for gravel in ".6 .4" ".4 .6"; do
    read -r friction rolling <<<"$gravel"
    for across in "${@:-10 14 20}"; do
        for n in $across; do
            name=$out/mu${friction}_mur${rolling}_across$n
            diameter=$(awk -v n="$n" 'BEGIN { print .07 / n }')
            sed "s/^  diameter_m: .*/  diameter_m: $diameter/" "$scene" >"$out/across$n.yaml"
            for trajectory in simpleA actual; do
                [ -e "$name.$trajectory.csv" ] || "$bin/digtable" dig "$out/across$n.yaml" --trajectory $trajectory \
                    --friction "$friction" --rolling "$rolling" --density 2500 --seed 101 \
                    -o "$name.$trajectory.csv" 2>"$name.log" || { cat "$name.log" >&2; exit 1; }
                [ ! -s "$name.log" ] || grep -oE '[0-9]+ grains' "$name.log" | cut -d ' ' -f 1 >"$name.grains"
            done
            "$bin/digloop" identify "$table" "$name.simpleA.csv" --json >"$name.json"
            "$bin/digloop" predict "$table" --identified "$name.json" --trajectory actual --measured "$name.actual.csv" \
                --json >"$name.next.json"
            printf '%-12s %6s %8s %8s %9.3f %9.3f  %-18s %6.3f %6.3f\n' "$friction/$rolling" "$n" "$(cat "$name.grains")" 101 \
                "$(mean "$name.simpleA.csv")" "$(mean "$name.actual.csv")" \
                "$(printf '%.2f/%.2f/%.0f' "$(axis friction "$name.json")" "$(axis rolling "$name.json")" "$(axis density_kgpm3 "$name.json")")" \
                "$(number error "$name.next.json")" "$(number noise_floor "$name.next.json")"
        done
    done
done
