#!/bin/bash
# Makes tests/data/formats/daemon.lcm anew, once a type of messages/*.lcm has grown: the first messages of
# each channel of a daemon that replays a dig, on a table that was dug in several ways. From the
# repository's root, after `make all build/tests/system/daemon_data build/tests/system/log_cut`:
#   scripts/example_log.sh [OUT.lcm]
# What was read is named as it was given, so that no path of this machine comes into the log.
. tests/system/daemon_lib.bash

out=${1:-tests/data/formats/daemon.lcm}
make_digs
"$helpers/daemon_data" "$scene" "$work" ways >"$work/ways.log" 2>&1
"$BIN/digrig" record "$work/deep.csv" --machine "$machine" -o "$work/run.csv" 2>"$work/rig.err"
config run "{kind: replay, replay: {file: run.csv, speed: 5}}"
sed -i 's/table.sqlite/ways.sqlite/' "$work/run.yaml"
log run
daemon=$(realpath "$BIN/digsightd")
check "the daemon replays the dig" eval '(cd "$work" && "$daemon" -c run.yaml 2>daemon.log)'
sleep 0.3
stop "$logger" INT
check "its log is cut down to $out" "$helpers/log_cut" "$work/run.lcm" "$out"
check "no path of this machine is in it" eval '! grep -aqF "$work" "$out" && ! grep -aqF "$PWD" "$out"'
finish
