#!/bin/bash
# How well curves between the depths and attacks a table was dug at are met: one gravel of the rig, a cross
# of depths .8, 1, 1.2 and attacks -5, 0, 5 deg, four beds each, against digs between them in other beds; and
# how depth and attack are told by a machine that dug so. About 25 minutes of one core; goes on where it was
# broken off. OUT keeps the digs.
set -eu
BIN=${BIN:-build/bin}
OUT=${OUT:-build/approach_study}
machine=config/machines/zx200_trench.yaml
scene=config/scenes/rig.yaml
mkdir -p "$OUT"

cat >"$OUT/grid.yaml" <<'GRID'
points:
  - {friction: 0.5, rolling: 0.5, density_kgpm3: 2500, packings: 4}
depth: [0.8, 1, 1.2]
attack_deg: [-5, 0, 5]
trajectories: [simpleA]
GRID
"$BIN/digtable" generate $scene "$OUT/grid.yaml" -o "$OUT/rig.sqlite" -j 1
# The same without what is not plain.
sed '/^depth:/d; /^attack_deg:/d' "$OUT/grid.yaml" >"$OUT/plain.yaml"
"$BIN/digtable" generate $scene "$OUT/plain.yaml" -o "$OUT/plain.sqlite" -j 1

dig() { # DEPTH ATTACK SEED
    [ -e "$OUT/$1_$2_$3.csv" ] || "$BIN/digtable" dig $scene --trajectory simpleA --friction .5 --rolling .5 \
        --density 2500 --depth "$1" --attack-deg "$2" --seed "$3" -o "$OUT/$1_$2_$3.csv" 2>/dev/null
}
number() { # PATTERN: what stands behind it in an identification
    sed -nE "s/.*$1 (-?[0-9.]+).*/\1/p"
}
printf '%-16s %8s %8s   %s\n' "depth attack bed" "as dug" "plain" "told by the machine"
for ways in "0.9 0" "1.1 0" "1 2.5" "1.2 0"; do
    for seed in 901 902; do
        read -r depth attack <<<"$ways"
        dig "$depth" "$attack" $seed
        csv=$OUT/${depth}_${attack}_$seed.csv
        "$BIN/digrig" record "$csv" --machine $machine -o "$OUT/run.csv" 2>/dev/null
        "$BIN/digloop" identify "$OUT/rig.sqlite" "$csv" --moment-alone >"$OUT/as_dug.txt"
        "$BIN/digloop" identify "$OUT/plain.sqlite" "$csv" --moment-alone >"$OUT/plain.txt" 2>&1 || true
        "$BIN/digloop" identify "$OUT/rig.sqlite" "$OUT/run.csv" --machine $machine --moment-alone >"$OUT/run.txt"
        plain=$(number '^  distance' <"$OUT/plain.txt")
        printf '%5s %6s %3s %8s %8s   depth %s, attack %s deg\n' "$depth" "$attack" $seed \
            "$(number '^  distance' <"$OUT/as_dug.txt")" "${plain:-off}" \
            "$(number 'at depth' <"$OUT/run.txt")" "$(number 'attack' <"$OUT/run.txt")"
    done
done
