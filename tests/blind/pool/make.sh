#!/bin/sh
# Computes the digs of tests/data/blind: a minute and a half of one core a bed and three digs, 176 beds. Goes on where it was stopped.
# usage, from the root of the sources: BIN=build/bin [JOBS=1] [ENGINE=kernel] tests/blind/pool/make.sh [judge | product]
#   judge: what the judging split alone draws from, which a graphics card can dig whole (ENGINE=cuda)
#   product: the digs of tests/data/product, in the open: 134 of one to two minutes each, beside other work
set -eu
here=$(dirname "$0")
out=tests/data/blind
bin=${BIN:-build/bin}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"

# The rig with something put in: NAME and what is to stand under bed:, or a change of the scene.
scene() {
    sed "s/^name: rig$/name: rig_$1/" config/scenes/rig.yaml
}
{ scene bouncy | sed 's/restitution: 0.2/restitution: 0.8/'; } > "$work/bouncy.yaml"
{ scene trench; printf 'bed:\n  surface_m: [[0, 0.085], [0.15, 0.085], [0.165, 0.06], [0.2, 0.06], [0.215, 0.085], [0.31, 0.085]]\n'; } > "$work/trench.yaml"
{ scene smooth_walls; printf 'bed:\n  pairs:\n    - {between: [gravel, walls], friction: 0.02, rolling: 0, restitution: 0.2}\n'; } > "$work/smooth_walls.yaml"

{ scene berm; printf 'bed:\n  surface_m: [[0, 0.085], [0.12, 0.085], [0.15, 0.11], [0.18, 0.11], [0.21, 0.085], [0.31, 0.085]]\n'; } > "$work/berm.yaml"

# Layers to develop with, over the gravel of outside.yaml; below, those to judge with.
{ scene coarse; printf 'bed:\n  materials:\n    - {name: coarse, friction: 0.8, rolling: 0.5, density_kgpm3: 3200, restitution: 0.2}\n  layers:\n    - {material: coarse, z_m: [0, 0.053]}\n'; } > "$work/coarse.yaml"
{ scene gritty; printf 'bed:\n  materials:\n    - {name: gritty, friction: 0.6, rolling: 0.7, density_kgpm3: 2800, restitution: 0.2}\n  layers:\n    - {material: gritty, z_m: [0, 0.045]}\n'; } > "$work/gritty.yaml"
{ scene sandy; printf 'bed:\n  materials:\n    - {name: sandy, friction: 0.35, rolling: 0.35, density_kgpm3: 1600, restitution: 0.2}\n  layers:\n    - {material: sandy, z_m: [0, 0.057]}\n'; } > "$work/sandy.yaml"
{ scene firm; printf 'bed:\n  materials:\n    - {name: firm, friction: 0.7, rolling: 0.8, density_kgpm3: 3400, restitution: 0.2}\n  layers:\n    - {material: firm, z_m: [0, 0.05]}\n'; } > "$work/firm.yaml"
{ scene weak; printf 'bed:\n  materials:\n    - {name: weak, friction: 0.35, rolling: 0.4, density_kgpm3: 1700, restitution: 0.2}\n  layers:\n    - {material: weak, z_m: [0, 0.055]}\n'; } > "$work/weak.yaml"
{ scene stony; printf 'bed:\n  materials:\n    - {name: stony, friction: 0.6, rolling: 0.9, density_kgpm3: 2900, restitution: 0.2}\n  layers:\n    - {material: stony, z_m: [0, 0.048]}\n'; } > "$work/stony.yaml"
{ scene silty; printf 'bed:\n  materials:\n    - {name: silty, friction: 0.45, rolling: 0.3, density_kgpm3: 2000, restitution: 0.2}\n  layers:\n    - {material: silty, z_m: [0, 0.06]}\n'; } > "$work/silty.yaml"

make_table() { # SCENE GRID TABLE
    "$bin/digtable" generate "$1" "$2" -o "$3" -j "${JOBS:-1}" --engine "${ENGINE:-kernel}"
}
if [ "${1:-}" = product ]; then
    mkdir -p tests/data/product/blind tests/data/product/spread
    for table in effects=blind/effects plain=blind/plain spread_develop=spread/develop spread_judge=spread/judge depths=depths; do
        ENGINE=${ENGINE:-single} make_table config/scenes/product.yaml "$here/product/${table%=*}.yaml" "tests/data/product/${table#*=}.sqlite"
    done
    exit
fi
mkdir -p "$out/judge"
if [ "${1:-}" != judge ]; then
    for grid in plain:plain effects:effects effects_2:effects effects_3:effects; do
        make_table config/scenes/rig.yaml "$here/${grid%:*}.yaml" "$out/${grid#*:}.sqlite"
    done
    for name in trench bouncy smooth_walls berm; do
        make_table "$work/$name.yaml" "$here/outside.yaml" "$out/$name.sqlite"
    done
    for name in coarse=0.053 gritty=0.045 sandy=-0.057; do # the layer's top, below 0 of a looser one
        make_table "$work/${name%=*}.yaml" "$here/outside.yaml" "$out/layering-$name.sqlite"
    done
fi
for grid in plain:plain effects:effects effects_2:effects effects_3:effects; do
    make_table config/scenes/rig.yaml "$here/judge/${grid%:*}.yaml" "$out/judge/${grid#*:}.sqlite"
done
for name in firm=0.05 weak=-0.055 stony=0.048 silty=-0.06; do
    make_table "$work/${name%=*}.yaml" "$here/judge/${name%=*}.yaml" "$out/judge/layering-$name.sqlite"
done
