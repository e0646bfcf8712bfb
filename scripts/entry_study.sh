#!/bin/bash
# Which entries of tables/reference_rig.sqlite change, and by how much, with another stiffness or time step (docs/numerics/dem.md,
# "Stiff" and "A step that heats")? Digs the same gravels anew and compares them, a line an entry. What lies in OUT is
# not dug again.
#   BIN=build/bin OUT=build/entry_study [ENGINE=kernel] [JOBS=1] scripts/entry_study.sh [stiff] [step]
#   stiff   the paper's 1.5e8 Pa for 5e6, seven gravels, three beds: five minutes of an H100 (ENGINE=cuda JOBS=15), eight hours of a core
#   step    the derived time step for the reference's, the three light gravels, five beds: one minute, or an hour and a half
set -euo pipefail
bin=${BIN:-build/bin} out=${OUT:-build/entry_study} engine=${ENGINE:-kernel} jobs=${JOBS:-1} table=tables/reference_rig.sqlite
mkdir -p "$out"

grid() { # PACKINGS DENSITY:FRICTION:ROLLING...
    local packings=$1 gravel
    shift
    echo "points:"
    for gravel; do
        IFS=: read -r density friction rolling <<<"$gravel"
        echo "  - {friction: $friction, rolling: $rolling, density_kgpm3: $density, packings: $packings}"
    done
    echo "trajectories: [simpleA, actual, simpleB]"
}

study() { # NAME SCENE
    "$bin/digtable" generate "$2" "$out/$1.yaml" -o "$out/$1.sqlite" -j "$jobs" --engine "$engine"
    awk -v files=1 -v entries=1 -v first="$table" -v second="$1" -f scripts/compare_runs.awk \
        <("$bin/digtable" export "$table" --runs) <("$bin/digtable" export "$out/$1.sqlite" --runs)
}

stiff() {
    grid 3 2500:.5:.5 2500:.9:.9 2500:.3:.3 4000:.5:.5 2500:.9:.3 2500:.3:.9 1500:.5:.5 >"$out/stiff.yaml"
    study stiff config/scenes/paper_rolling.yaml
}

step() {
    grid 5 1500:.5:.5 1500:.9:.9 1500:.3:.3 >"$out/step.yaml"
    sed -e 's/^time_step_s: .*/time_step_s: 0/; /^may_tremble/d' config/scenes/rig.yaml >"$out/rig_step.yaml"
    study step "$out/rig_step.yaml"
}

[ $# -gt 0 ] || set -- stiff step
for part; do "$part"; done
