#!/bin/bash
# Modbus RTU over a pair of pseudo terminals: a dig on a line that damages a tenth of the answers, and one
# on a good line.
. tests/system/daemon_lib.bash

make_digs
speed=4
series 2
sed 's/^function: 4/function: 3/' config/signals/modbus_default.yaml >"$work/holding.yaml"
config rtu "{kind: modbus-rtu, modbus: {device: $work/controller, baud: 115200, parity: none, poll_Hz: 200, map: holding.yaml}}" \
    "$(paced)"
# Bytes on a terminal are counted until they are read.
export DIG_SIMCLOCK_TERMINALS=1
start "$work/socat.log" socat "pty,raw,echo=0,link=$work/controller" "pty,raw,echo=0,link=$work/rig"
until [ -e "$work/rig" ] && [ -e "$work/controller" ]; do sleep 0.05; done
daemon_begins rtu
serve_series rtu --modbus-rtu "$work/rig:115200" --start-delay 2 --fault "$(fault corrupt=0.1 1)"
daemon_ends rtu
judge rtu
check "the gravel is identified over RTU" identified "$f"
check "by the dig on the good line" [ "$(judged dig 6 "$(last health "$f" $h_digs)")" = 1 ]
# The three bytes take the answer's place; what is left of it is no answer either, and the next one is doubted.
check "damaged answers are counted" eval '[ "$(rig modbus_damaged)" -ge 5 ] && within \
    $(($(last health "$f" $h_malformed) + $(last health "$f" $h_timeouts))) "$(rig modbus_damaged)" $(($(rig modbus_damaged) * 4 + 10))'
check "holding registers are read with function 3 when the map says so" \
    grep -q '"modbus_served": {"3": [0-9]*}' "$work/rtu.json"
finish
