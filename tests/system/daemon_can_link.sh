#!/bin/bash
# A CAN interface that goes down in the middle of a dig and is back before its end, and a wall clock that is set in the
# middle of others, an hour forth and two back: nothing wrong is published as good, the dig with the hole is not matched
# as a whole one, the one after it identifies the gravel, and what did not come is counted.
. tests/system/daemon_lib.bash
in_uml "$@"
speed=4
series 5
config can "$sealed_can" "time_scale: $speed"
set_clock() { # CHANGE: says how far the wall clock went beside the other one, in seconds
    local wall up
    wall=$(date +%s)
    up=$(cut -d. -f1 /proc/uptime)
    date -s "$1" >/dev/null && echo $(($(date +%s) - wall - $(cut -d. -f1 /proc/uptime) + up))
}
trouble() { # a dig takes some 12 s
    till 2 4
    ip link set vcan0 down
    pass 1
    ip link set vcan0 up
    till 4 4
    set_clock "+1 hour"
    till 5 4
    set_clock "-2 hours"
}

daemon_begins can
start_series can --can vcan0 --can-sealed
trouble >"$work/trouble.log" 2>&1
ends "$rig"
daemon_ends can
judge can

lost=$(rig can_lost)
check "the link was down for a part of a dig" within "$lost" 500 6000
check "the link that went down is said" grep -q "can vcan0: .*Network is down" "$work/can.log"
check "and that it is back" [ "$(grep -c "running (can vcan0)" "$work/can.log")" -ge 2 ]
check "the source was opened again, and that is counted" [ "$(last health "$f" $h_reconnects)" -ge 1 ]
# A sample every 5 ms of the machine's 4 s at least, at four times real time: a thousand beats of a millisecond.
check "the ticks without a sample are counted" within "$(last health "$f" $h_missing)" 500 1e6
whole() { # DIG: matches of that dig that are of all of it
    awk -v dig="$1" '$1 == "match" && $2 && $4 == dig && !$NF { n++ } END { print n + 0 }' "$f"
}
check "the dig before identifies the gravel" [ "$(judged dig 6 1)" = 1 ]
check "five digs are counted" [ "$(last health "$f" $h_digs)" = 5 ]
check "the one with the hole is matched as no whole one" [ "$(whole 2)" = 0 ]
check "and how it ended is not told" within "$(last endings "$f" 4)" 1 1
check "the next one identifies it" [ "$(judged dig 6 3) $([ "$(whole 3)" -ge 1 ] && echo 1)" = "1 1" ]
check "the wall clock went an hour forth and two back" \
    eval 'within "$(sed -n 1p "$work/trouble.log")" 3598 3602 && within "$(sed -n 2p "$work/trouble.log")" -7202 -7198'
check "the dig in which it went forth identifies the gravel" [ "$(judged dig 6 4)" = 1 ]
check "and the one in which it went back" [ "$(judged dig 6 5)" = 1 ]
check "what is known does not grow old by it" eval '! grep -q "too old" "$work/can.log"'
check "no sample was lost on the way" [ "$(last health "$f" $h_lost)" = 0 ]
finish
