#!/bin/bash
# What goes wrong on a bus is dropped, counted, published, and gone when it is over.
. tests/system/daemon_lib.bash

make_digs
speed=4
config tcp "$modbus" "time_scale: $speed"
log tcp
# All in free air, before the dig (which begins at 6.9 s) and after it (13.8 s): the dig itself must come
# out as if nothing had been.
start "$work/rig.err" "$BIN/digrig" serve "$work/simpleA.csv" --machine "$machine" --start-delay 2 --speed "$speed" \
    --modbus-tcp "127.0.0.1:$port" --fault not-available@0.5:1 --fault out-of-range@2:1 \
    --fault missing@3.5:1.5 --fault frozen@15:3
rig=$started
wait_for 5 grep -q serving "$work/rig.err"
start "$work/daemon.log" "$BIN/digsightd" -c "$work/tcp.yaml"
daemon=$started
ends "$rig"
daemon_ends tcp
check "values that are not available are counted" within "$(last health "$f" $h_not_available)" 100 1e6
check "values out of range are counted" within "$(last health "$f" $h_out_of_range)" 100 1e6
check "a counter that stands still is counted" within "$(last health "$f" $h_frozen)" 10 1e6
check "ticks without a fresh sample are counted" within "$(last health "$f" $h_missing)" 50 1e6
check "the state is published as it changes" \
    eval '[ "$(grep -c "^health waiting_for_bus" "$f")" -ge 3 ]'
check "no estimate is made of what was dropped" \
    eval '[ "$(grep -c ^estimate "$f")" -lt "$(last samples "$f" 2)" ]'
check "the daemon recovers and identifies the gravel" identified "$f"
check "a person is told" grep -q "dropped so far: [1-9]" "$work/daemon.log"
finish
