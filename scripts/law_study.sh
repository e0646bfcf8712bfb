#!/bin/bash
# What `digloop trace` says of gravel that other contact laws dug than the table's: .5/.5/2500 in the rig's scene, one bed
# a law, a simple and a real dig (docs/accuracy.md, "Traces of another code's digs"). Seven minutes of one core.
#   BIN=build/bin scripts/law_study.sh FOLDER     digs that are there are not dug again
set -euo pipefail
bin=${BIN:-build/bin} folder=${1:?expected a folder for the digs} scene=config/scenes/rig.yaml
derived='s/^time_step_s: .*/time_step_s: 0/; /^may_tremble/d' # each law at the step that is right for it

study() { # NAME SED LAWS
    local to=$folder/$1
    mkdir -p "$to"
    { sed "$derived; $2" "$scene" && echo "$3"; } >"$to/scene.yaml"
    for trajectory in simpleA actual; do
        [ -e "$to/$trajectory.csv" ] || "$bin/digtable" dig "$to/scene.yaml" --trajectory $trajectory --friction .5 \
            --rolling .5 --density 2500 -q -o "$to/$trajectory.csv"
    done
    printf 'scene: rig\nrecordings:\n  - {file: simpleA.csv, trajectory: simpleA, role: identify}\n  - {file: actual.csv, trajectory: actual, role: fit}\n' \
        >"$to/campaign.yaml"
    echo "== $1"
    "$bin/digloop" trace tables/reference_rig.sqlite "$to" --json "$to/trace.json" 2>/dev/null
    sed -nE '/^ "(verdict|material)"/{s/"material": //; s/[]["{}]//g; s/,$//; p}' "$to/trace.json"
}

study plain '' ''
study hertz '' 'laws: {normal: hertz}'
study restitution 's/restitution: 0.2/restitution: 0.5/' ''
study cdt '' 'laws: {rolling: cdt}'
study hertz_cdt '' 'laws: {normal: hertz, rolling: cdt}'
