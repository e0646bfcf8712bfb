#!/bin/bash
# What a CAN bus carries that is no measurement, while a machine digs: frames and values that stand still, error frames,
# bus off. Nothing wrong is published as good, every loss is counted, and one dig later all
# is as if nothing had been. One dig a fault.
. tests/system/daemon_lib.bash
in_uml "$@"
speed=4
series 5
config can "$sealed_can" "time_scale: $speed"
# What a CAN controller says of its bus in dig 4: three error frames, then bus off.
trouble() {
    local i
    till 4 3
    for i in 1 2 3; do cansend vcan0 20000008#0000000000000000; done
    cansend vcan0 20000040#0000000000000000
}

daemon_begins can
start_series can --can vcan0 --can-sealed --fault "$(fault frozen 1)" --fault "$(fault stuck-pressures 2)" \
    --fault "$(fault stuck-angles 3)"
trouble >"$work/trouble.log" 2>&1
ends "$rig"
daemon_ends can
judge can 3

# Digs 1 to 3 have frozen values and identify nothing; whether they count as digs is left open. The
# two after them - the controller errs, nothing is wrong - identify the gravel.
digs_told=$(last health "$f" $h_digs)
for back in 1 0; do
    check "the dig $((5 - back)) after the frozen ones identifies it" [ "$(judged dig 6 $((digs_told - back)))" = 1 ]
done
check "frozen frames are counted" within "$(last health "$f" $h_repeated)" 500 1e6
check "values that stand while the front moves are counted" within "$(last health "$f" $h_stuck)" 100 1e6
check "error frames are counted" [ "$(last health "$f" $h_error_frames)" = 4 ]
check "bus off is counted, and said" eval '[ "$(last health "$f" $h_bus_offs)" = 1 ] && grep -q "vcan0: bus off" "$work/can.log"'
check "and is over when frames come" grep -q '^health running .*"can vcan0" ""' "$f"
check "no sample was lost on the way" [ "$(last health "$f" $h_lost)" = 0 ]
finish
