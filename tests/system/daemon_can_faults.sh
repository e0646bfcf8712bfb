#!/bin/bash
# What goes wrong on a CAN bus while a machine digs: frames that are lost, doubled, damaged or late, values that stand
# still or are none, error frames, an interface that goes down, a wall clock that is set. Nothing wrong is published as
# good, every loss is counted, and the next dig identifies the gravel. The frames carry a counter and a checksum, as those
# of a bus have to that is to be believed whatever happens to it.
. tests/system/daemon_lib.bash
in_uml "$@"
speed=4
series 9
config can "$sealed_can" "$(paced)"
trouble() {
    # In the middle of dig 2, and back before its end.
    till 2 4
    ip link set vcan0 down
    pass 1
    ip link set vcan0 up
    till 3 4
    "$simclock" set 3600
    till 4 4
    "$simclock" set -7200
    # What a CAN controller says of its bus.
    till 5 3
    for i in 1 2 3; do cansend vcan0 20000008#0000000000000000; done
    cansend vcan0 20000040#0000000000000000
}

daemon_begins can
# The first three in free air, before the first dig, which begins at 6.9 s.
start_series can --can vcan0 --can-sealed \
    --fault not-available@0.5:1 --fault out-of-range@2:1 --fault missing@3.5:1.5 \
    --fault "$(fault drop=0.1 1)" --fault "$(fault duplicate=0.2 1)" --fault "$(fault reorder=0.2 1)" \
    --fault "$(fault drop=0.5 3)" --fault "$(fault corrupt=0.2 4)" --fault "$(fault delay=0.1 5)" \
    --fault "$(fault frozen 6)" --fault "$(fault stuck-pressures 7)" --fault "$(fault stuck-angles 8)"
trouble >"$work/trouble.log" 2>&1
ends "$rig"
daemon_ends can
judge can 8

n=0
for what in "10 % of its frames lost, 20 % doubled and 20 % out of order" "" "50 % lost, behind one with a hole" "20 % damaged" \
    "frames held back by 0.1 s"; do
    n=$((n + 1))
    [ -z "$what" ] || check "a dig with $what identifies the gravel" [ "$(judged dig 6 $n)" = 1 ]
done
check "what came twice or late is counted" within "$(last health "$f" $h_repeated)" \
    $((($(rig can_doubled) + $(rig can_overtaken)) * 60 / 100)) 1e6
check "what was damaged is counted" \
    within "$(last health "$f" $h_checksum)" $(($(rig can_damaged) * 60 / 100)) "$(rig can_damaged)"
# What is damaged or comes late counts as missed too, by the counter of the next.
check "what did not come is counted" within "$(last health "$f" $h_missed)" $(($(rig can_dropped) * 85 / 100)) \
    $((($(rig can_dropped) + $(rig can_damaged) + $(rig can_overtaken)) * 115 / 100 + 20))
check "values that are not available are counted" within "$(last health "$f" $h_not_available)" 100 1e6
check "values out of range are counted" within "$(last health "$f" $h_out_of_range)" 100 1e6
check "frozen frames are counted" within "$(last health "$f" $h_repeated)" 500 1e6
check "an alive counter that stands still is counted" within "$(last health "$f" $h_frozen)" 10 1e6
check "values that stand while the front moves are counted" within "$(last health "$f" $h_stuck)" 100 1e6
check "the dig after the frozen ones identifies the gravel" [ "$(judged dig 6 "$(last health "$f" $h_digs)")" = 1 ]

check "error frames are counted" [ "$(last health "$f" $h_error_frames)" = 4 ]
check "bus off is counted, and said" eval '[ "$(last health "$f" $h_bus_offs)" = 1 ] && grep -q "vcan0: bus off" "$work/can.log"'
check "and is over when frames come" grep -q '^health running .*"can vcan0" ""' "$f"

check "the link was down for a part of a dig" within "$(rig can_lost)" 500 6000
check "the link that went down is said" grep -q "can vcan0: .*Network is down" "$work/can.log"
check "and that it is back" [ "$(grep -c "running (can vcan0)" "$work/can.log")" -ge 2 ]
check "the source was opened again, and that is counted" [ "$(last health "$f" $h_reconnects)" -ge 1 ]
# A beat is 4 ms. Each wait for the bus, in beats: its beginning, values that are none twice, missing, the link.
waits=$(awk '$1 == "health" && $2 != was { if (was ~ /waiting/) printf "%d ", $10 - from; was = $2; from = $10 }' "$f")
check "the beats without a frame are counted" within "$(echo "$waits" | cut -d " " -f 4)" 50 94
check "so are those without a link" within "$(echo "$waits" | cut -d " " -f 5)" 200 1000
whole() { # DIG: matches of that dig that are of all of it
    awk -v dig="$1" '$1 == "match" && $2 && $4 == dig && !$NF { n++ } END { print n + 0 }' "$f"
}
check "the dig with the hole is matched as no whole one" [ "$(whole 2)" = 0 ]
check "and how it ended is not told" [ "$(last endings "$f" 4)" = 1 ]
check "the one after it is matched as one" [ "$(whole 3)" -ge 1 ]

awk '$1 == "utc" { if (n++) print $2 - was; was = $2 }' "$f" >"$work/utc"
check "the wall clock went an hour forth and two back" \
    [ "$(awk '$1 > 3500 || $1 < -1 { printf "%.0f ", $1 / 3600 }' "$work/utc")" = "1 -2 " ]
check "what is known does not grow old by it" eval '! grep -q "too old" "$work/can.log"'
check "no sample was lost on the way" [ "$(last health "$f" $h_lost)" = 0 ]
finish
