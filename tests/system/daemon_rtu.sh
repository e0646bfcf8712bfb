#!/bin/bash
# Modbus RTU over a pair of pseudo terminals.
. tests/system/daemon_lib.bash

make_digs
sed 's/^function: 4/function: 3/' config/signals/modbus_default.yaml >"$work/holding.yaml"
config rtu "{kind: modbus-rtu, modbus: {device: $work/controller, baud: 115200, parity: none, poll_Hz: 200, map: holding.yaml}}" \
    "time_scale: 4"
start "$work/socat.log" socat "pty,raw,echo=0,link=$work/controller" "pty,raw,echo=0,link=$work/rig"
wait_for 5 test -e "$work/rig" -a -e "$work/controller"
log rtu
start "$work/daemon.log" "$BIN/digsightd" -c "$work/rtu.yaml"
daemon=$started
"$BIN/digrig" serve "$work/simpleA.csv" --machine "$machine" --modbus-rtu "$work/rig:115200" --speed 4 --start-delay 6 \
    --json >"$work/rig.json" 2>"$work/rig.err"
check "the rig served to its end" [ $? = 0 ]
stop "$daemon"
check "SIGTERM ends the daemon with exit status 0" [ "$status" = 0 ]
read_log rtu
check "the gravel is identified over RTU" identified "$work/rtu.txt"
check "holding registers are read with function 3 when the map says so" \
    grep -q '"modbus_served": {"3": [0-9]*}' "$work/rig.json"
finish
