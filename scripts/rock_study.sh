#!/bin/bash
# What `digloop trace` says of a rock that does not lie where the table's does: 30 mm thick, in gravel .5/.4/2300 in the rig's
# scene, one bed a place, a simple and a real dig (docs/accuracy.md, "Traces of another code's digs"). Four minutes of one core.
#   BIN=build/bin scripts/rock_study.sh FOLDER     digs that are there are not dug again
set -euo pipefail
bin=${BIN:-build/bin} folder=${1:?expected a folder for the digs} scene=config/scenes/rig.yaml

study() { # NAME X_M Z_M: the rock's centre; the table's lies at x = .114, z = .085
    local to=$folder/$1
    mkdir -p "$to"
    { cat "$scene" && echo "bed: {obstacles: [{shape: sphere, centre_m: [$2, 0, $3], diameter_m: 0.03}]}"; } >"$to/scene.yaml"
    for trajectory in simpleA actual; do
        [ -e "$to/$trajectory.csv" ] || "$bin/digtable" dig "$to/scene.yaml" --trajectory $trajectory --friction .5 \
            --rolling .4 --density 2300 --seed 901 -q -o "$to/$trajectory.csv"
    done
    printf 'scene: rig\nrecordings:\n  - {file: simpleA.csv, trajectory: simpleA, role: identify}\n  - {file: actual.csv, trajectory: actual, role: fit}\n' \
        >"$to/campaign.yaml"
    echo "== $1"
    "$bin/digloop" trace tables/reference_rig.sqlite "$to" 2>/dev/null | sed -n '/^Missing\|^No\|ahead_m\|gravel:/p'
}

study further .139 .085
study nearer .09 .085
study deeper .139 .07
