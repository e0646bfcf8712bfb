#!/bin/sh
# Digs with a bucket smoother than the gravel, and as rough, computed with LIGGGHTS: some ten minutes of one core a line.
# What is here already is left; -n: only say what is missing.
#   tests/data/liggghts_bucket/make.sh [-n]
set -eu
here=$(cd "$(dirname "$0")" && pwd)
for gravel in mu0.6_mur0.4_rho2500_bucket0.15 mu0.5_mur0.5_rho2500_bucket0.3 mu0.6_mur0.4_rho2500; do
    for seed in 1 2 3; do
        for trajectory in simpleA actual; do
            [ ! -e "$here/${gravel}_seed${seed}__$trajectory.csv" ] || continue
            echo "$gravel seed $seed $trajectory"
            [ "${1:-}" = -n ] || OUT="$here" "$here/../liggghts_digs/make.sh" "$gravel" "$seed" "$trajectory"
        done
    done
done
