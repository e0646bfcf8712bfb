#!/bin/bash
# An LCM network that goes away while the bucket digs: the daemon digs on, counts what it could not send,
# and publishes the match of the next dig. In a network namespace of its own, whose route is taken away.
if [ -z "${DIG_IN_NAMESPACE-}" ]; then
    if unshare -Urn true 2>/dev/null; then
        DIG_IN_NAMESPACE=1 exec unshare -Urn "$0" "$@"
    fi
    echo "SKIP: no network namespace can be made here"
    echo "0 passed, 0 failed, 1 skipped"
    [ -z "${DIG_NO_SKIP-}" ]
    exit
fi
. tests/system/daemon_lib.bash

make_digs
speed=4
series 3
config tcp "$modbus" "$(paced)"
route() { # add|del
    ip route "$1" 239.255.76.67 dev lo
}
at() { # SECONDS COMMAND…: runs it when the rig has moved on by so much
    pass "$(awk -v s="$1" -v speed="$speed" 'BEGIN { print s / speed }')"
    "${@:2}"
}
off_s=8 # seconds of the machine, from deep in the first dig: to its end and beyond

start "$work/rig.err" "$BIN/digrig" serve "${digs[@]}" --machine "$machine" --speed "$speed" --modbus-tcp "127.0.0.1:$port" \
    --start-delay 3
rig=$started
wait_for 30 grep -q "serving Modbus" "$work/rig.err"
log tcp
start "$work/daemon.log" "$BIN/digsightd" -c "$work/tcp.yaml"
daemon=$started
pass 2.9 # and a tenth for the log to begin
at "$(awk -v c="${contacts[0]}" 'BEGIN { print c + 3 }')" route del
at $off_s route add
check "a network that goes away in a dig is said" grep -q "LCM .*: sending failed; joining again" "$work/daemon.log"
check "so it is when it comes back" wait_for 20 eval '[ "$(grep -c "publishing on" "$work/daemon.log")" = 2 ]'
ends "$rig"
daemon_ends tcp
judge tcp
# 400 polls a second of the clock; joining again takes up to a second and a half after the network is back.
unsent=$(last health "$f" $h_unsent)
check "what could not be sent is counted" within "$unsent" \
    "$(awk -v s="$off_s" -v speed="$speed" 'BEGIN { print 400 * 0.6 * s / speed }')" \
    "$(awk -v s="$off_s" -v speed="$speed" 'BEGIN { print 400 * (s / speed + 3) }')"
check "it was heard nothing of meanwhile" awk -v least="$off_s" '
    $1 == "estimate" { if (n++ && $2 - before > gap) gap = $2 - before; before = $2 } END { exit !(gap >= 0.8 * least) }' "$f"
check "nothing else was lost" [ "$(last health "$f" $h_lost)" = 0 ]
check "no tick waited for the network" within "$(last health "$f" $h_missing)" 0 250
check "all three digs are told" [ "$(last health "$f" $h_digs)" = 3 ]
check "the gravel is identified by the digs after it" identified "$f"
finish
