#!/bin/sh
# Digs with our engine what LIGGGHTS has dug beside this folder: six beds each, for tests/offline_dem/test_ensemble.c.
# A minute and a half of one core a bed and two digs, two minutes of a card (ENGINE=cuda JOBS=15) for all but the rock, which
# the kernel dug.
# usage, from the root of the sources: BIN=build/bin [JOBS=1] [ENGINE=kernel] tests/data/liggghts_more/ours/make.sh
set -eu
here=$(dirname "$0")
bin=${BIN:-build/bin}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

scene() { # NAME BED: the rig with this under bed:
    sed "s/^name: rig$/name: rig_$1/" config/scenes/rig.yaml > "$work/$1.yaml"
    printf 'bed:\n  %s\n' "$2" >> "$work/$1.yaml"
}
make_table() { # SCENE GRID TABLE [ENGINE]
    "$bin/digtable" generate "$1" "$here/$2.yaml" -o "$here/$3.sqlite" -j "${JOBS:-1}" --engine "${4:-${ENGINE:-kernel}}"
}
# Where they were put in LIGGGHTS: ../../liggghts_digs/make.sh.
scene slope 'surface_m: [[0, 0.0723513], [0.31, 0.115919]]'
scene rock 'obstacles: [{shape: sphere, diameter_m: 0.03, centre_m: [0.1138, 0, 0.085], movable: false}]'
make_table config/scenes/rig.yaml gravels gravels
make_table "$work/slope.yaml" base slope
make_table "$work/rock.yaml" base rock kernel
# Last, since it fails: of the stronger cohesion some beds are refused, whose heap stands in the bucket's way.
make_table config/scenes/rig.yaml effects effects
