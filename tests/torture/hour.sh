#!/bin/bash
# A daemon on a Modbus machine that digs and is switched off and on again, beside garbage on its LCM network, for
# $TORTURE_S seconds: its memory stays what it was after the first dig. An hour is TORTURE_S=3600.
. tests/system/daemon_lib.bash
. tests/torture/torture.bash

make_digs
speed=2
series 10 # 2 minutes at this speed
config tcp "{kind: modbus-tcp, modbus: {address: \"127.0.0.1:$port\", poll_Hz: 400, map: $PWD/config/signals/modbus_default.yaml}}" \
    "time_scale: $speed"
group=${lcm#udpm://} group=${group%%:*}
lcm_port=${lcm##*:} lcm_port=${lcm_port%%\?*}
start "$work/flood.out" "$BIN/../tests/torture/lcm_flood" "$group" "$lcm_port" $((TORTURE_S + 5)) $RANDOM 200
flood=$started
start "$work/tcp.log" "$BIN/digsightd" -c "$work/tcp.yaml"
daemon=$started
identified_digs() { grep -c "digsightd: dig .*friction 0\.[45]" "$work/tcp.log"; }

rounds=0 before_kB='' most_kB=0
while going; do
    start_series tcp --modbus-tcp "127.0.0.1:$port"
    rounds=$((rounds + 1))
    while kill -0 "$rig" 2>/dev/null && going; do
        sleep 1
        if [ -z "$before_kB" ] && [ "$(identified_digs)" -ge 1 ]; then
            before_kB=$(memory_kB "$daemon") most_kB=$before_kB
        fi
        now_kB=$(memory_kB "$daemon")
        [ -z "$before_kB" ] || [ "$now_kB" -le "$most_kB" ] || most_kB=$now_kB
    done
done
after_kB=$(memory_kB "$daemon")
stop "$rig" KILL
stop "$daemon"
check "the daemon lives, and ends with exit status 0" [ "$status" = 0 ]
wait "$flood"
told "$(identified_digs)" "digs identified in $rounds rounds of a machine on Modbus, in $TORTURE_S s"
told "$(cat "$work/flood.out")" "datagrams of garbage beside it"
told "$before_kB" "kB of memory after the first dig, $after_kB at the end, $most_kB at most"
check "nearly every dig identifies the gravel" within "$(identified_digs)" $((TORTURE_S * speed / 24 * 9 / 10 - 1)) 1e9
check "its memory is flat" eval '[ -n "$before_kB" ] && [ $((most_kB - before_kB)) -le 256 ]'
finish
