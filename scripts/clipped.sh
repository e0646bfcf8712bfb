#!/bin/bash
# How far recordings whose pressures are whole are from those refused as clipped, and those cut off from being taken for whole:
# every dig of LIGGGHTS, on every machine that can make it.
set -eu
bin=${BIN:-build/bin}
margin=$bin/../tests/system/clip_margin
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
seed=0
for machine in config/machines/{mini_2t8,zx120,zx200,zx200_trench}.yaml; do
    for dig in tests/data/reference/*.csv tests/data/liggghts_more/*.csv; do
        seed=$((seed + 1))
        "$bin/digrig" record "$dig" --machine "$machine" --seed "$seed" "$@" -o "$work/r.csv" 2>/dev/null || continue
        "$margin" "$machine" "$work/r.csv" | sed "s|^[^ ]*|$(basename "$machine" .yaml) $(basename "$dig")|"
    done
done >"$work/all"
awk '{ n[$4]++; refused[$4] += $5; if (!($4 in least) || $6 < least[$4]) least[$4] = $6; if ($4 == "0.5" && $6 < 0 && (most == "" || $6 > most)) most = $6 }
     END { printf "whole: %d of %d chambers refused, log10 of the chance %.2f or more\n", refused["1.0"], n["1.0"], least["1.0"]
           printf "cut off at nine tenths: %d of %d refused\n", refused["0.9"], n["0.9"]
           printf "cut off at half: %d of %d refused, log10 of the chance %.2f or less where noise is seen\n", refused["0.5"], n["0.5"], most }' "$work/all"
