#!/bin/sh
# Digs in the product scene with a steel bucket, computed with LIGGGHTS: three beds of four gravels, some twenty-five minutes of
# one core a bed. What is here already is left; -n: only say what is missing.
#   tests/data/liggghts_product/make.sh [-n]
set -eu
here=$(cd "$(dirname "$0")" && pwd)
for seed in 1 2 3; do
    for gravel in mu0.6_mur0.4_rho2200_bucket0.4 mu0.4_mur0.6_rho3000_bucket0.4 \
        smooth/mu0.5_mur0.6_rho2600_bucket0.2 smooth/mu0.6_mur0.4_rho2200_bucket0.2; do
        case $gravel in *rho2600*) young=5e6 ;; *) young= ;; esac # the scene's is 5.2e6
        for trajectory in simpleA actual; do
            [ ! -e "$here/${gravel}_seed${seed}__$trajectory.csv" ] || continue
            echo "$gravel seed $seed $trajectory"
            [ "${1:-}" = -n ] ||
                YOUNG_PA=$young SCENE=product OUT="$(dirname "$here/$gravel")" "$here/../liggghts_digs/make.sh" "${gravel#*/}" $seed "$trajectory"
        done
    done
done
for kind in obstacle cohesion_all; do # one bed each
    gravel=${kind}_mu0.6_mur0.5_rho2300_bucket0.4
    for trajectory in simpleA actual; do
        [ ! -e "$here/effects/${gravel}_seed1__$trajectory.csv" ] || continue
        echo "effects/$gravel seed 1 $trajectory"
        [ "${1:-}" = -n ] || SCENE=product OUT="$here/effects" "$here/../liggghts_digs/make.sh" $gravel 1 $trajectory
    done
done
fine=mu0.6_mur0.4_rho2200_bucket0.4 # an hour
if [ ! -e "$here/fine/${fine}_seed1__simpleA.csv" ]; then
    echo "fine/$fine seed 1 simpleA"
    [ "${1:-}" = -n ] || ACROSS=14 SCENE=product OUT="$here/fine" "$here/../liggghts_digs/make.sh" $fine 1 simpleA
fi
