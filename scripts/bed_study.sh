#!/bin/sh
# How wide and deep must a bed be before the bucket stops feeling it, and how does the spread over
# packings fall with more grains across the bucket? Varies SCENE one thing at a time, digs one
# trajectory in PACKINGS beds each and prints a table: time mean of the moment, its standard error
# over packings, and the spread of one dig (both relative to the mean). Hours at the finest grains.
#   BIN=build/bin OUT=build/bed_study scripts/bed_study.sh [SCENE.yaml]
set -eu
BIN=${BIN:-build/bin}
OUT=${OUT:-build/bed_study}
SCENE=${1:-config/scenes/rig.yaml}
PACKINGS=${PACKINGS:-3}
TRAJECTORY=${TRAJECTORY:-simpleA}
WIDTHS=${WIDTHS:-"0.085 0.12 0.175 0.21 0.28"} # of the box, m
DEPTHS=${DEPTHS:-"0 0.02 0.04"}                # more gravel below the rig's floor, m
ACROSS=${ACROSS:-"7 9.33 14 20"}               # grains across the bucket of 0.07 m
mkdir -p "$OUT"

# One variant: NAME, then sed commands that make it of the scene.
study() {
    name=$1
    shift
    sed "$@" "$SCENE" >"$OUT/$name.yaml"
    seed=1
    while [ "$seed" -le "$PACKINGS" ]; do
        "$BIN/digtable" dig "$OUT/$name.yaml" --trajectory "$TRAJECTORY" --friction .5 \
            --rolling .5 --density 2500 --seed "$seed" -o "$OUT/$name.$seed.csv"
        seed=$((seed + 1))
    done
    awk -F, -v name="$name" '
        /^#/ { next }
        /^[a-z]/ { for (i = 1; i <= NF; i++) if ($i == "My_Nm") my = i; file++; next }
        { sum[file] += $my; n[file]++ }
        END {
            for (f = 1; f <= file; f++) { m = sum[f] / n[f]; s += m; q += m * m }
            mean = s / file
            spread = file > 1 ? sqrt((q - file * mean * mean) / (file - 1)) : 0
            printf "%-16s %8.4f N m  +- %.3f  spread %.3f\n", name, mean,
                spread / sqrt(file) / mean, spread / mean
        }' "$OUT/$name".[0-9]*.csv
}

for w in $WIDTHS; do
    half=$(awk -v w="$w" 'BEGIN { print w / 2 }')
    study "walls_$w" -e "s/^  y: .*/  y: [-$half, $half]/"
done
for w in $WIDTHS; do
    half=$(awk -v w="$w" 'BEGIN { print w / 2 }')
    # Grains must not meet their own images: the narrowest do not fit.
    awk -v w="$w" 'BEGIN { exit !(w > 0.07 + 4 * 0.0075) }' &&
        study "periodic_$w" -e "s/^  y: .*/  y: [-$half, $half]/" \
            -e '$a bed: {periodic_y: true}'
done
for d in $DEPTHS; do
    study "deeper_$d" -e "s/^  z: .*/  z: [-$d, 0.085]/"
done
for n in $ACROSS; do
    diameter=$(awk -v n="$n" 'BEGIN { print 0.07 / n }')
    study "across_$n" -e "s/^  diameter_m: .*/  diameter_m: $diameter/" \
        -e 's/^time_step_s: .*/time_step_s: 0/'
done
