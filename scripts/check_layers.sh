#!/bin/bash
# scripts/check_layers.sh [BUILD]: fails where a source includes a header it must not, where headers
# include each other in a circle, or sources call each other in one (told by the objects in BUILD).
# The picture of this is docs/architecture.md.
set -euo pipefail

# Each folder may include its own headers and those of the folders named here, and nothing else.
may_include() {
    case $1 in
    core)          echo "core" ;;
    files)         echo "core files build messages" ;;
    estimator)     echo "core estimator" ;;
    tables)        echo "core tables" ;;
    offline_dem)   echo "core tables offline_dem" ;;
    closed_loop)   echo "core tables estimator closed_loop" ;;
    firmware_host) echo "core files tables estimator firmware_host messages" ;;
    tools/rig)     echo "core files tools/rig" ;;
    tools)         echo "core files tables estimator offline_dem closed_loop firmware_host tools" ;;
    esac
}

# The rooms of a folder, from the ground up: a room may include those before it. What stands in the
# folder itself is its roof.
rooms_of() {
    case $1 in
    estimator)     echo "wrench track approach effects match predict" ;;
    offline_dem)   echo "law shapes kernel world dig sweep device reference cuda" ;;
    closed_loop)   echo "numeric recordings model machine search accuracy verdict design report" ;;
    firmware_host) echo "threads bus config tick matching publish" ;;
    esac
}

# A foreign library is included only where it is wrapped: one file, or one folder.
owner_of() {
    case $1 in
    nlopt.h)      echo "estimator/match/fit_nlopt.c" ;;
    modbus*.h | modbus/*) echo "firmware_host/bus/input_modbus.c tools/rig/*" ;;
    linux/can*)   echo "firmware_host/bus/input_can.c firmware_host/bus/can_message.* tools/rig/*" ;;
    lcm/*)        echo "firmware_host/publish/output_lcm.c files/lcm_log.c" ;;
    cyaml/* | yaml.h) echo "files/* firmware_host/config/*" ;;
    sqlite3.h)    echo "tables/*" ;;
    ode/*)        echo "offline_dem/*" ;;
    *)            echo "*" ;;
    esac
}

folder_of() {
    case $1 in
    tools/rig/*) echo "tools/rig" ;;
    *)           echo "${1%%/*}" ;;
    esac
}

room_of() { # PATH: the room's number from 1; 99: the roof
    local folder=${1%%/*} rest=${1#*/} n=1 room
    for room in $(rooms_of "$folder"); do
        [ "${rest%%/*}" = "$room" ] && { echo $n; return; }
        n=$((n + 1))
    done
    echo 99
}

is_owner() { # FILE PATTERN…
    local file=$1 pattern
    shift
    for pattern in "$@"; do
        # shellcheck disable=SC2254 # the pattern is meant as one
        case $file in $pattern) return 0 ;; esac
    done
    return 1
}

bad=0
say() {
    echo "$*"
    bad=1
}

set -f
edges=$(mktemp)
trap 'rm -f "$edges"' EXIT
while read -r file kind header; do
    if [ "$kind" = library ]; then
        owners=$(owner_of "$header")
        # shellcheck disable=SC2086 # a list of patterns
        [ "$owners" = "*" ] || is_owner "$file" $owners || say "$file: <$header> belongs in $owners only"
        continue
    fi
    case $file:$header in
    # The rig has levers of its own, by virtual work: the estimator is judged by it.
    tools/rig/*:core/linkage.h) say "$file: must not include \"$header\"" ;;
    esac
    case " $(may_include "$(folder_of "$file")") " in
    *" $(folder_of "$header") "*) ;;
    *) say "$file: must not include \"$header\"" ;;
    esac
    if [ "${file%%/*}" = "${header%%/*}" ] && [ "$(room_of "$header")" -gt "$(room_of "$file")" ]; then
        say "$file: \"$header\" stands above it"
    fi
    case $file in
    *.h) echo "$file $header" >>"$edges" ;;
    esac
done < <(find core files estimator tables offline_dem closed_loop firmware_host tools -name '*.[ch]' -print0 | sort -z |
    xargs -0 awk '/^#include "/ { split($0, a, "\""); print FILENAME, "ours", a[2] }
                  /^#include </ { split($0, a, "[<>]"); print FILENAME, "library", a[2] }')

in_a_circle() { # WHAT: says each circle of the pairs in $edges
    local circle
    circle=$({ tsort "$edges" 2>&1 >/dev/null || true; } | sed -n '/^tsort: [^ ]*$/s/^tsort: //p')
    [ -z "$circle" ] || say "$1 in a circle:" $circle
}
in_a_circle "headers include each other"

if [ -n "${1:-}" ]; then
    objects=$(find core files estimator tables offline_dem closed_loop firmware_host tools -name '*.c' | sed "s#^#$1/#; s#c\$#o#")
    present=()
    for object in $objects; do [ ! -e "$object" ] || present+=("$object"); done
    # nm -A: FILE:ADDRESS KIND NAME, FILE: U NAME
    nm -A "${present[@]}" | awk -v build="$1/" '
        $NF == "main" { next }
        { file = $1; sub(/:.*/, "", file); sub(build, "", file); sub(/o$/, "c", file) }
        $(NF - 1) ~ /^[TDBRVW]$/ { home[$NF] = file }
        $(NF - 1) == "U" { uses[file "\t" $NF] = 1 }
        END { for (u in uses) { split(u, a, "\t"); if (a[2] in home && home[a[2]] != a[1]) print a[1], home[a[2]] } }' |
        sort -u >"$edges"
    in_a_circle "sources call each other"
fi
exit $bad
