#!/bin/sh
# Digs whose drag leaves the trajectory of the product scene, in gravel .6/.45/2300, one bed each: up by 3.2 mm/s, 4 degrees, a quarter of
# the depth at its end; down by half as much. A CSV each here, where they lack. BIN is where digtable is; ten minutes of one core.
#   BIN=build/bin tests/data/product/off_path/make.sh
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for way in up:0.0032 down:-0.0016; do
    python3 - "$here/../../../../config/scenes/product.yaml" "${way#*:}" >"$work/${way%:*}.yaml" <<'END'
import re
import sys

with open(sys.argv[1], encoding="utf-8") as scene:
    text = scene.read()
for phase in ("drag", "pulling"):
    text = re.sub(rf"(name: {phase}\b.*?vz_mps: )([-0-9.e]+)", lambda m: m[1] + repr(float(m[2]) + float(sys.argv[2])), text, flags=re.S)
print(text)
END
    for dug in simpleA:43 actual:44; do
        [ -e "$here/${way%:*}_${dug%:*}.csv" ] ||
            "${BIN:-build/bin}/digtable" dig "$work/${way%:*}.yaml" --trajectory ${dug%:*} --friction .6 --rolling .45 --density 2300 \
                --seed ${dug#*:} --threads 1 -q -o "$here/${way%:*}_${dug%:*}.csv"
    done
done
