#!/bin/bash
# What goes wrong on a CAN bus while a machine digs: nothing wrong is published as good, every loss is
# counted, and one dig later all is as if nothing had been. One dig a fault; the frames carry a counter
# and a checksum, as those of a bus have to that is to be believed whatever happens to it.
# User Mode Linux has one slow processor, which rig, daemons and loggers share: a try takes minutes, and where the
# rig is late by a few of its ticks the others were as well.
export DIG_TRIES=1
. tests/system/daemon_lib.bash
LATE_LIMIT_ms=30

if [ "${1-}" != inside ]; then
    make_digs
    # shellcheck disable=SC2086 # options: -r for a busy machine
    DIG_DATA=$work tools/vcan/with-vcan ${DIG_VCAN_OPTIONS-} -t 280 "$0" inside
    status=$?
    if [ "$status" = 125 ] && [ -z "${DIG_NO_SKIP-}" ]; then
        echo "0 passed, 0 failed, 1 skipped (User Mode Linux does not start here)"
        exit 0
    fi
    exit "$status"
fi
cp "$DIG_DATA"/* "$work"
speed=4
series 13
config can "{kind: can, can: {interface: vcan0, dbc: $PWD/tests/data/sealed/zx200_sealed.dbc, map: $PWD/tests/data/sealed/signals.yaml}}" \
    "time_scale: $speed"
at() { # SECONDS COMMAND…: runs it when the rig has come to that time of its motion
    sleep "$(awk -v s="$1" -v speed="$speed" 'BEGIN { print s / speed }')"
    "${@:2}"
}
clock() { # steps the wall clock by an hour, forth in dig 11 and back after it
    at "$(awk -v c="${contacts[10]}" 'BEGIN { print c + 3 }')" date -s "+1 hour"
    at 12 date -s "-1 hour"
}
controller() { # what a CAN controller says of its bus in dig 12: three error frames, then bus off
    local i
    at "$(awk -v c="${contacts[11]}" 'BEGIN { print c + 3 }')" true
    for i in 1 2 3; do cansend vcan0 20000008#0000000000000000; done
    cansend vcan0 20000040#0000000000000000
}

log can
start "$work/can.log" "$BIN/digsightd" -c "$work/can.yaml"
daemon=$started
wait_for 5 grep -q "waiting for bus" "$work/can.log"
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
# Digs 8 to 10 have frozen values and identify nothing; whether they count as digs is left open. The
# three after them - the clock is set, the controller errs, nothing is wrong - identify the gravel.
digs_told=$(last health "$f" $h_digs)
for back in 2 1 0; do
    check_timed "the dig $((13 - back)) after the frozen ones identifies it" [ "$(judged dig 6 $((digs_told - back)))" = 1 ]
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
check "error frames are counted" [ "$(last health "$f" $h_error_frames)" = 4 ]
check "bus off is counted, and said" eval '[ "$(last health "$f" $h_bus_offs)" = 1 ] && grep -q "vcan0: bus off" "$work/can.log"'
check "and is over when frames come" grep -q '^health running .*"can vcan0" ""' "$f"
check_timed "no sample was lost on the way" [ "$(last health "$f" $h_lost)" = 0 ]
finish
