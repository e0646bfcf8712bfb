#!/bin/bash
# What goes wrong with the frames on a CAN bus while a machine digs: nothing wrong is published as good, every loss is
# counted. One dig a fault; the frames carry a counter and a checksum, as those of a bus have to that is to be believed
# whatever happens to it.
. tests/system/daemon_lib.bash
in_uml "$@"
speed=4
series 7
config can "$sealed_can" "time_scale: $speed"

daemon_begins can
serve_series can --can vcan0 --can-sealed \
    --fault "$(fault drop=0.01 1)" --fault "$(fault drop=0.1 2)" --fault "$(fault drop=0.5 3)" \
    --fault "$(fault duplicate=0.2 4)" --fault "$(fault reorder=0.2 5)" --fault "$(fault corrupt=0.2 6)" \
    --fault "$(fault delay=0.1 7)"
daemon_ends can
judge can

n=0
for what in "1 % of its frames lost" "10 % lost" "50 % lost" "20 % doubled" "20 % out of order" "20 % damaged" \
    "frames held back by 0.1 s"; do
    n=$((n + 1))
    check "a dig with $what identifies the gravel" [ "$(judged dig 6 $n)" = 1 ]
done
check "what came twice or late is counted" within "$(last health "$f" $h_repeated)" \
    $((($(rig can_doubled) + $(rig can_overtaken)) * 60 / 100)) 1e6
check "what was damaged is counted" \
    within "$(last health "$f" $h_checksum)" $(($(rig can_damaged) * 60 / 100)) "$(rig can_damaged)"
# What is damaged or comes late counts as missed too, by the counter of the next.
check "what did not come is counted" within "$(last health "$f" $h_missed)" $(($(rig can_dropped) * 85 / 100)) \
    $((($(rig can_dropped) + $(rig can_damaged) + $(rig can_overtaken)) * 115 / 100 + 20))
check "no sample was lost on the way" [ "$(last health "$f" $h_lost)" = 0 ]
finish
