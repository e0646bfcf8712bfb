#!/bin/sh
# Digs of config/scenes by YADE (Debian package yade), a third DEM code: dig.py beside this file, which says the laws.
#   tests/data/yade/make.sh SCENE GRAVEL SEED [TRAJECTORY...]
#       SCENE is rig, product or small (small.yaml, along scratch, seconds). GRAVEL is muF_murR_rhoD, or muF_murR_rhoD_bucketB
#       with a bucket of its own friction and rolling friction, or either after obstacle_ (a fixed sphere of 30 mm) or slope_up_
#       (8 deg). Without a trajectory, simpleA and actual. One bed is poured, and dug anew along each:
#       SCENE/GRAVEL_seedN__TRAJECTORY.csv. What is there stays. Hours: see README.md.
#   tests/data/yade/make.sh check               a grain on a plate, two grains that meet
# OUT=FOLDER in place of this one. DAMPING and STEPS: see dig.py.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$here/../../..
yade() { command yade -n -x -j1 "$here/dig.py" "$@"; }
if [ "$1" = check ]; then
    yade check "$root/config/scenes/rig.yaml" -
    exit
fi
scene=$1 gravel=$2 seed=$3
shift 3
file=$root/config/scenes/$scene.yaml
[ -e "$file" ] || file=$here/$scene.yaml
out=${OUT:-$here}/$scene
numbers=mu${gravel#*mu}
FRICTION=${numbers#mu} FRICTION=${FRICTION%%_*}
ROLLING=${numbers#*_mur} ROLLING=${ROLLING%%_*}
DENSITY=${numbers#*_rho} DENSITY=${DENSITY%%_*}
SEED=$seed
export FRICTION ROLLING DENSITY SEED
case $numbers in *_bucket*) export BUCKET="${numbers#*_bucket}" ;; esac
case $gravel in
mu*) ;;
obstacle_mu*) export ROCK_M=.015 ;;
slope_up_mu*) export SLOPE_DEG=8 ;;
*) echo "gravel: $gravel, expected muF_murR_rhoD, with _bucketB, obstacle_ or slope_up_" >&2; exit 2 ;;
esac

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"
bed=$work/${gravel}_seed$seed
for trajectory in ${*:-simpleA actual}; do
    [ ! -e "$out/${gravel}_seed${seed}__$trajectory.csv" ] || continue
    [ -e "$bed" ] || yade bed "$file" "$bed"
    yade "$trajectory" "$file" "$bed"
    mv "${bed}__$trajectory.csv" "$out/"
done
