#!/bin/sh
# scripts/check_layers.sh [BUILD]: fails where a source includes a header it must not, where headers
# include each other in a circle, or sources call each other in one (told by the objects in BUILD).
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

# The rooms of a folder, from the ground up: a room may include those before it. What stands in the
# folder itself is its roof.
rooms='
estimator     wrench track approach effects match predict
offline_dem   law shapes kernel world dig sweep device reference cuda
closed_loop   numeric recordings model machine search accuracy verdict design report
firmware_host threads bus config tick matching publish
'

# A foreign library is included only where it is wrapped: one file, or one folder (by its prefix).
owners='
nlopt.h      estimator/match/fit_nlopt.c
modbus       firmware_host/bus/input_modbus.c firmware_host/bus/modbus_tcp. tools/rig/
linux/can    firmware_host/bus/input_can.c firmware_host/bus/can_message. tools/rig/
lcm/         firmware_host/publish/output_lcm.c files/lcm_log.c
curses.h     tools/digwatch/terminal.c
cyaml/       files/ firmware_host/config/
yaml.h       files/ firmware_host/config/
sqlite3.h    tables/
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
find $folders -name '*.[ch]' | sort | xargs awk -v may="$may_include" -v rooms="$rooms" -v owners="$owners" -v edges="$edges" '
    function folder_of(path) { return path ~ /^tools\/rig\// ? "tools/rig" : substr(path, 1, index(path "/", "/") - 1) }
    function room_of(path, a, n) { n = split(path, a, "/"); return n > 2 && (a[1] "/" a[2]) in room ? room[a[1] "/" a[2]] : 99 }
    function say(text) { print FILENAME ": " text; bad = 1 }
    BEGIN {
        n = split(may, line, "\n")
        for (i = 1; i <= n; i++) { m = split(line[i], a, " "); for (k = 2; k <= m; k++) allowed[a[1] " " a[k]] = 1 }
        n = split(rooms, line, "\n")
        for (i = 1; i <= n; i++) { m = split(line[i], a, " "); for (k = 2; k <= m; k++) room[a[1] "/" a[k]] = k }
        foreign = split(owners, owner, "\n")
    }
    /^#include "/ {
        split($0, quoted, "\"")
        header = quoted[2]
        # The rig has levers of its own, by virtual work: the estimator is judged by it.
        if (!((folder_of(FILENAME) " " folder_of(header)) in allowed) || (FILENAME ~ /^tools\/rig\// && header == "core/linkage.h"))
            say("must not include \"" header "\"")
        if (folder_of(header) == folder_of(FILENAME) && room_of(header) > room_of(FILENAME))
            say("\"" header "\" stands above it")
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
    END { exit bad }' || bad=1
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
