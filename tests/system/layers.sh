#!/bin/bash
# scripts/check_layers.sh on a copy of the headers and sources: each rule, broken once, is named.
. tests/system/check.bash

mkdir "$work/tree"
cp -a scripts core files estimator tables offline_dem closed_loop firmware_host tools "$work/tree"

layers() { (cd "$work/tree" && sh scripts/check_layers.sh) >"$work/err" 2>&1; }

broken() { # FILE INCLUDE WORDS: with this line at its beginning the file is refused, in these words
    cp -p "$work/tree/$1" "$work/kept"
    sed -i "1i #include $2" "$work/tree/$1"
    ! layers && grep -qF "$1: $3" "$work/err"
    local status=$?
    mv "$work/kept" "$work/tree/$1"
    return $status
}
listed() { # FROM TO WORDS: with the list of rooms changed so, it is refused
    cp -p "$work/tree/scripts/check_layers.sh" "$work/kept"
    sed -i "s#$1#$2#" "$work/tree/scripts/check_layers.sh"
    ! layers && grep -qF "$3" "$work/err"
    local status=$?
    mv "$work/kept" "$work/tree/scripts/check_layers.sh"
    return $status
}
unlisted() { # a room that the list lacks
    mkdir "$work/tree/estimator/attic"
    echo >"$work/tree/estimator/attic/old.h"
    ! layers && grep -qF "estimator/attic/old.h: stands in no room" "$work/err"
    local status=$?
    rm -r "$work/tree/estimator/attic"
    return $status
}

check "the tree keeps the rules" layers
check "a folder includes no folder above it" broken core/scene.c '"files/scene_yaml.h"' 'must not include "files/scene_yaml.h"'
check "a room includes no room above it" broken estimator/wrench/wrench.c '"estimator/match/match.h"' '"estimator/match/match.h" stands above it'
check "a header private to its room is not included by another folder" \
    broken firmware_host/daemon.c '"estimator/match/gaussian.h"' '"estimator/match/gaussian.h" is private'
check "nor by another room of its folder" \
    broken firmware_host/daemon.c '"firmware_host/matching/table_in_use.h"' '"firmware_host/matching/table_in_use.h" is private'
check "a header for the rooms above is not included by another folder" \
    broken tools/digloop/campaign.c '"estimator/track/path.h"' '"estimator/track/path.h" is private'
check "a program's parts are its own" broken tools/digloop/scene.c '"tools/digwatch/grid.h"' '"tools/digwatch/grid.h" is private'
check "a library is included where it is wrapped" broken tables/put.c '<nlopt.h>' '<nlopt.h> belongs in'
check "the list names no header that nobody outside includes" \
    listed '^files/text  *whole' '& recordings' 'files/text/recordings.h: no other folders include it'
check "every room is listed" unlisted

finish
