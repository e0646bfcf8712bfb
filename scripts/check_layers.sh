#!/bin/sh
# scripts/check_layers.sh [BUILD]: fails where a source includes a header it must not, be it of a folder or room
# above it or private to another room; where headers include each other in a circle, or sources call each other in
# one (told by the objects in BUILD); and where a header is listed as public that no one outside its room includes.
# The picture of this is docs/architecture.md.
set -eu

# Each folder may include its own headers and those of the folders named here, and nothing else.
may_include='
core          core
files         core files build messages
estimator     core estimator
tables        core tables
offline_dem   core tables offline_dem
closed_loop   core tables estimator closed_loop
firmware_host core files tables estimator firmware_host messages
tools/rig     core files tools/rig
tools         core files tables estimator offline_dem closed_loop firmware_host tools
'

# The rooms from the ground up: a room may include those of its folder before it. What stands in the folder itself
# is its roof. Behind each the headers that other folders may include, and after | those that only the rooms above
# may. All other headers are private to their room; a program's parts in tools/NAME are private to tools/NAME.c.
rooms='
core                   approach bed bed_plan chance command_line contact curve did_you_mean effect entry_set error
                       geometry gravel_match ground linkage log_normal machine markup model name observation outline part process
                       recording regular room sample scene sha256 shell similar sort status streams table_step text units vec2
files/text             whole | csv
files/yaml             yaml | yaml_schema
files/lcm              health_text lcm_datagram lcm_log lcm_message matched_gravel predicted_curve
files                  bed_csv campaign_yaml curves_csv grid_yaml identity_json job_plan machine_yaml model_json
                       recording_csv scene_yaml
estimator              estimator
estimator/wrench       balance correction cylinder dynamics rates statics wrench | sensed soil_wrench
estimator/track        frame inertia phase recorded_dig route settings track window steady | abort_detection ending estimate
                       motion
estimator/approach     approach_error approach_fit approach_route approach_slots approached approaches
                       approach_response interpolate live_recording observe_dig | laid
estimator/effects      effect template
estimator/match        depth match pool rubbed | entry_scatter
estimator/predict      forecast peak_energy | predict prediction
tables/schema          | canonical_scene schema seal
tables                 derive export listed load merge queue scene store
offline_dem/law        | both law law_general period rigid wall
offline_dem/shapes     | bucket_surface clump plate_contacts rock_surface tool
offline_dem/kernel     | cell_grid clump_body contacts crew grains kernel neighbour
offline_dem/world      | bodies device grain_types obstacles ode_scene offloaded world
offline_dem/dig        checked_pour dig input_checks variant
offline_dem/sweep      sweep
offline_dem/device     engine_cuda | device_carry device_grain device_surfaces
offline_dem/reference  engine_ode
offline_dem/cuda
closed_loop/numeric    | dense levenberg
closed_loop/recordings measured observe | features lateness reading_noise regressors path_depth
closed_loop/machine_digs observe_machine recording_faults | machine_dig
closed_loop/model      | approach_change candidate response_surface scatter soil soil_fit
closed_loop/fit        | batch hypothesis posterior steps
closed_loop/air        | machine_air
closed_loop/machine    machine_side | machine_fit machine_noise
closed_loop/check      machine_check
closed_loop/search     | cross_validation search search_work unlisted
closed_loop/accuracy   score | effect_size judge
closed_loop/verdict    trace | residuals
closed_loop/design     design
closed_loop/report     design_report html machine_check_report plot report trace_report
firmware_host/threads  | handoff log_limit notify rt
firmware_host/bus      | frame_watch input reading register_plan signal_map stuck
firmware_host/config   load_model | config load
firmware_host/tick     | loop
firmware_host/matching | fit
firmware_host/publish  | publish
firmware_host
tools/rig/motion
tools/rig/bus
'

# A foreign library is included only where it is wrapped: one file, or one folder (by its prefix).
owners='
nlopt.h      estimator/match/fit_nlopt.c
modbus       firmware_host/bus/input_modbus.c firmware_host/bus/modbus_tcp. tools/rig/
linux/can    firmware_host/bus/input_can.c firmware_host/bus/can_message. tools/rig/
lcm/         firmware_host/publish/output_lcm.c files/lcm/lcm_log.c
curses.h     tools/digwatch/terminal.c
yaml.h       files/yaml/
sqlite3.h    tables/
nettle/      core/sha256.h
ode/         offline_dem/
'

folders="core files estimator tables offline_dem closed_loop firmware_host tools"
edges=$(mktemp)
trap 'rm -f "$edges"' EXIT
bad=0

in_a_circle() { # WHAT: says each circle of the pairs in $edges
    circle=$({ tsort "$edges" 2>&1 >/dev/null || true; } | sed -n '/^tsort: [^ ]*$/s/^tsort: //p' | tr '\n' ' ')
    [ -z "$circle" ] || { echo "$1 in a circle: $circle"; bad=1; }
}

# shellcheck disable=SC2086 # a list of folders
find $folders -name '*.[ch]' -o -name '*.cu' | sort | xargs awk -v may="$may_include" -v rooms="$rooms" -v owners="$owners" -v edges="$edges" '
    function folder_of(path) { return path ~ /^tools\/rig\// ? "tools/rig" : substr(path, 1, index(path "/", "/") - 1) }
    function place_of(path) { sub(/\/[^\/]*$/, "", path); return path }
    function floor_of(place) { return place ~ /\// && place in floor ? floor[place] : 999 }
    function program_of(path, a) { split(path, a, "/"); sub(/\.c$/, "", a[2]); return a[2] }
    function say(text) { print FILENAME ": " text; bad = 1 }
    BEGIN {
        n = split(may, line, "\n")
        for (i = 1; i <= n; i++) { m = split(line[i], a, " "); for (k = 2; k <= m; k++) allowed[a[1] " " a[k]] = 1 }
        n = split(rooms, line, "\n")
        for (i = 1; i <= n; i++) {
            m = split(line[i], a, " ")
            if (line[i] ~ /^[a-z]/) { place = a[1]; floor[place] = i; offer = "other folders"; a[1] = "" }
            for (k = 1; k <= m; k++)
                if (a[k] == "|") offer = "rooms above"
                else if (a[k] != "") offered[place "/" a[k] ".h"] = offer
        }
        foreign = split(owners, owner, "\n")
    }
    FNR == 1 && FILENAME !~ /^tools\// && !(place_of(FILENAME) in floor) { say("stands in no room of the list") }
    /^#include "/ {
        split($0, quoted, "\"")
        header = quoted[2]
        # The rig has levers of its own, by virtual work: the estimator is judged by it.
        if (!((folder_of(FILENAME) " " folder_of(header)) in allowed) || (FILENAME ~ /^tools\/rig\// && header == "core/linkage.h"))
            say("must not include \"" header "\"")
        same_folder = folder_of(header) == folder_of(FILENAME)
        place = place_of(header)
        if (same_folder && floor_of(place) > floor_of(place_of(FILENAME)))
            say("\"" header "\" stands above it")
        if (header ~ /^tools\// ? program_of(header) != program_of(FILENAME) : place in floor && place != place_of(FILENAME)) {
            if (!(header in offered) || (offered[header] == "rooms above" && !same_folder))
                say("\"" header "\" is private")
            used[header, same_folder ? "rooms above" : "other folders"] = 1
        }
        if (FILENAME ~ /\.h$/) print FILENAME, header > edges
    }
    /^#include </ {
        split($0, quoted, /[<>]/)
        for (i = 1; i <= foreign; i++) {
            m = split(owner[i], a, " ")
            if (m == 0 || index(quoted[2], a[1]) != 1) continue
            mine = 0
            for (k = 2; k <= m; k++) mine = mine || index(FILENAME, a[k]) == 1
            if (!mine) say("<" quoted[2] "> belongs in" substr(owner[i], length(a[1]) + 1) " only")
        }
    }
    END {
        for (header in offered) if (!((header, offered[header]) in used)) { print header ": no " offered[header] " include it"; bad = 1 }
        exit bad
    }' || bad=1
in_a_circle "headers include each other"

if [ -n "${1:-}" ]; then
    # shellcheck disable=SC2086 # a list of folders
    # nm -A: FILE:ADDRESS KIND NAME, or FILE: U NAME
    find $folders -name '*.c' | sed "s#^#$1/#; s#c\$#o#" | xargs ls 2>/dev/null | xargs nm -A | awk -v build="$1/" '
        $NF == "main" { next }
        { file = $1; sub(/:.*/, "", file); sub(build, "", file); sub(/o$/, "c", file) }
        $(NF - 1) ~ /^[TDBRVW]$/ { home[$NF] = file }
        $(NF - 1) == "U" { uses[file "\t" $NF] = 1 }
        END { for (u in uses) { split(u, a, "\t"); if (a[2] in home && home[a[2]] != a[1]) print a[1], home[a[2]] } }' |
        sort -u >"$edges"
    in_a_circle "sources call each other"
fi
exit $bad
