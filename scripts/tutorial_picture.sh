#!/bin/bash
# scripts/tutorial_picture.sh OUT.svg: the tutorial's working dig, predicted from its simple one. Computes the tutorial's table.
#   BIN=build/bin scripts/tutorial_picture.sh docs/pictures/tutorial.svg
set -euo pipefail
to=${1:?usage: tutorial_picture.sh OUT.svg}
BIN=$(realpath "${BIN:-build/bin}")
export BIN PATH=$BIN:$PATH
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp docs/tutorial/* "$work"
(cd "$work" && sh prepare.sh)
scripts/picture.sh "$to" "$work/yard.sqlite" "$work/ground/simple1.csv" "$work/ground/working1.csv" working \
    'dug by the simulator'
