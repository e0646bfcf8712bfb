#!/bin/sh
# Computes the digs of tests/data/blind: a minute of one core a bed and two digs, 68 beds. Goes on where it was stopped.
# usage, from the root of the sources: BIN=build/bin tests/blind/pool/make.sh
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

"$bin/digtable" generate config/scenes/rig.yaml "$here/plain.yaml" -o "$out/plain.sqlite" -j 1
"$bin/digtable" generate config/scenes/rig.yaml "$here/effects.yaml" -o "$out/effects.sqlite" -j 1
"$bin/digtable" generate config/scenes/rig.yaml "$here/effects_2.yaml" -o "$out/effects.sqlite" -j 1
"$bin/digtable" generate config/scenes/rig.yaml "$here/effects_3.yaml" -o "$out/effects.sqlite" -j 1
for name in trench bouncy smooth_walls berm; do
    "$bin/digtable" generate "$work/$name.yaml" "$here/outside.yaml" -o "$out/$name.sqlite" -j 1
done
