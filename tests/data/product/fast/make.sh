#!/bin/sh
# Digs along the trajectories of the product scene at three times their pace, in gravel .6/.45/2300, one bed: a CSV each here, where
# they lack. BIN is where digtable is; some minutes of one core.
#   BIN=build/bin tests/data/product/fast/make.sh
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 - "$here/../../../../config/scenes/product.yaml" >"$work/fast.yaml" <<'END'
import re
import sys

with open(sys.argv[1], encoding="utf-8") as scene:
    text = scene.read()
text = re.sub(r"(duration_s: )([-0-9.e]+)", lambda m: m[1] + repr(float(m[2]) / 3), text)
print(re.sub(r"((?:vx_mps|vz_mps|omega_degps): )([-0-9.e]+)", lambda m: m[1] + repr(float(m[2]) * 3), text))
END
for trajectory in simpleA simpleB actual; do
    [ -e "$here/$trajectory.csv" ] ||
        "${BIN:-build/bin}/digtable" dig "$work/fast.yaml" --trajectory $trajectory --friction .6 --rolling .45 --density 2300 --seed 41 \
            --threads 1 -q -o "$here/$trajectory.csv"
done
