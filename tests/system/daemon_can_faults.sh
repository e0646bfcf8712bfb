#!/bin/bash
# What goes wrong on a CAN bus while a machine digs: nothing wrong is published as good, every loss is
# counted, and one dig later all is as if nothing had been. One dig a fault; the frames carry a counter
# and a checksum, as those of a bus have to that is to be believed whatever happens to it.
. tests/system/daemon_lib.bash

if [ "${1-}" != inside ]; then
    make_digs
    # shellcheck disable=SC2086 # options: -r for a busy machine
    DIG_DATA=$work tools/vcan/with-vcan ${DIG_VCAN_OPTIONS-} -t "$(longer 400)" "$0" inside
    status=$?
    if [ "$status" = 125 ] && [ -z "${DIG_NO_SKIP-}" ]; then
        echo "0 passed, 0 failed, 1 skipped (User Mode Linux does not start here)"
        exit 0
    fi
    exit "$status"
fi
cp "$DIG_DATA"/* "$work"
speed=$(slowed 4)
series 14
config can "{kind: can, can: {interface: vcan0, dbc: $PWD/tests/data/sealed/zx200_sealed.dbc, map: $PWD/tests/data/sealed/signals.yaml}}" \
    "time_scale: $speed"
at() { # SECONDS COMMAND…: runs it when the rig has come to that time of its motion
    sleep "$(awk -v s="$1" -v speed="$speed" 'BEGIN { print s / speed }')"
    "${@:2}"
}
deep_in() { # DIG: a time at which the bucket is deep in it
    awk -v c="${contacts[$1 - 1]}" 'BEGIN { print c + 3 }'
}
off_s=2 # seconds of the machine, that the bus is gone
bus_off() { # in dig 11 the controller leaves the bus, its interface goes down, and both come back
    at "$(deep_in 11)" cansend vcan0 20000040#0000000000000000
    ip link set vcan0 down
    at $off_s ip link set vcan0 up
    at 6 cansend vcan0 20000100#0000000000000000
}
step() { # SECONDS: sets the wall clock so much on, and says by how much it went
    local before=$EPOCHSECONDS
    date -s "@$((before + $1))" >/dev/null
    echo "step $((EPOCHSECONDS - before))"
}
clock() { # steps the wall clock by an hour, forth in dig 12 and back in the air after it
    at "$(deep_in 12)" step 3600
    at 12 step -3600
}
controller() { # what a CAN controller says of its bus in dig 13: three error frames, then bus off
    local i
    at "$(deep_in 13)" true
    for i in 1 2 3; do cansend vcan0 20000008#0000000000000000; done
    cansend vcan0 20000040#0000000000000000
}

log can
start "$work/can.log" "$BIN/digsightd" -c "$work/can.yaml"
daemon=$started
wait_for 5 grep -q "waiting for bus" "$work/can.log"
bus_off >"$work/off.log" 2>&1 &
clock >"$work/clock.log" 2>&1 &
controller >"$work/controller.log" 2>&1 &
serve_series can --can vcan0 --can-sealed \
    --fault "$(fault drop=0.01 1)" --fault "$(fault drop=0.1 2)" --fault "$(fault drop=0.5 3)" \
    --fault "$(fault duplicate=0.2 4)" --fault "$(fault reorder=0.2 5)" --fault "$(fault corrupt=0.2 6)" \
    --fault "$(fault delay=0.1 7)" --fault "$(fault frozen 8)" --fault "$(fault stuck-pressures 9)" \
    --fault "$(fault stuck-angles 10)"
stop "$daemon"
check "the daemon ends with exit status 0" [ "$status" = 0 ]
read_log can
f=$work/can.txt
judge can 10

n=0
for what in "1 % of its frames lost" "10 % lost" "50 % lost" "20 % doubled" "20 % out of order" "20 % damaged" \
    "frames held back by 0.1 s"; do
    n=$((n + 1))
    check_timed "a dig with $what identifies the gravel" [ "$(judged dig 6 $n)" = 1 ]
done
# Digs 8 to 10 have frozen values and dig 11 a hole; whether they count as digs is left open. The three
# after them - the clock is set, the controller errs, nothing is wrong - identify the gravel.
digs_told=$(last health "$f" $h_digs)
for back in 2 1 0; do
    check_timed "the dig $((14 - back)), after those, identifies it" [ "$(judged dig 6 $((digs_told - back)))" = 1 ]
done
check_timed "what came twice or late is counted" within "$(last health "$f" $h_repeated)" \
    $((($(rig can_doubled) + $(rig can_overtaken)) * 60 / 100)) 1e6
check_timed "what was damaged is counted" \
    within "$(last health "$f" $h_checksum)" $(($(rig can_damaged) * 60 / 100)) "$(rig can_damaged)"
# What is damaged or comes late counts as missed too, by the counter of the next.
check_timed "what did not come is counted" within "$(last health "$f" $h_missed)" $(($(rig can_dropped) * 85 / 100)) \
    $((($(rig can_dropped) + $(rig can_damaged) + $(rig can_overtaken)) * 115 / 100 + 20))
check_timed "frozen frames are counted" within "$(last health "$f" $h_repeated)" 500 1e6
check_timed "values that stand while the front moves are counted" within "$(last health "$f" $h_stuck)" 100 1e6
# The controller's word that it is back may come before the daemon has opened the interface again.
check "error frames are counted" within "$(last health "$f" $h_error_frames)" 5 6
check "bus off is counted, and said" \
    eval '[ "$(last health "$f" $h_bus_offs)" = 2 ] && [ "$(grep -c "vcan0: bus off" "$work/can.log")" = 2 ]'
check "and is over when frames come" grep -q '^health running .*"can vcan0" ""' "$f"
check "an interface that goes down in a dig is said, and opened again" \
    eval 'grep -q "can vcan0: .*Network is down" "$work/can.log" && [ "$(last health "$f" $h_reconnects)" = 1 ]'
check_timed "the rig could not send meanwhile" within "$(rig can_lost)" $((off_s * 250)) 1e6
# Five milliseconds a tick; the daemon looks again a quarter of a second after the first failure.
check_timed "and the ticks without a sample are counted" \
    within "$(last health "$f" $h_missing)" "$(awk -v s="$off_s" -v speed="$speed" 'BEGIN { print 200 * 0.8 * s / speed }')" 1e6
check_timed "no estimate is published of the time without frames" awk -v least="$off_s" '
    $1 == "estimate" { if ($2 - before > gap) gap = $2 - before; before = $2 } END { exit !(gap >= 0.9 * least) }' "$f"
if [ "$(awk '$1 == "step" { n += ($2 * $2 > 3590 ^ 2) } END { print n }' "$work/clock.log")" = 2 ]; then
    # Were a stamp of it taken for the machine's time, an hour or a step back would be among them.
    check "an hour more or less on the wall clock is no time of the machine" \
        awk '$1 == "estimate" { if (n++ && ($2 <= before || $2 - before > 30)) bad++; before = $2 } END { exit !(n > 100 && !bad) }' "$f"
else
    skip_check "the wall clock is set" "it cannot be set here: $(tr '\n' ' ' <"$work/clock.log")"
fi
check_timed "no sample was lost on the way" [ "$(last health "$f" $h_lost)" = 0 ]
finish
