#!/bin/bash
# A daemon that is stopped (SIGSTOP) for up to four seconds again and again while a machine digs on Modbus: it goes on,
# tells the ticks that were late, and publishes nothing wrong.
. tests/system/daemon_lib.bash
. tests/torture/torture.bash

make_digs
speed=4
series $((2 + TORTURE_S / 8))
config tcp "{kind: modbus-tcp, modbus: {address: \"127.0.0.1:$port\", poll_Hz: 400, map: $PWD/config/signals/modbus_default.yaml}}" \
    "time_scale: $speed"
log tcp
start "$work/tcp.log" "$BIN/digsightd" -c "$work/tcp.yaml"
daemon=$started
wait_for 5 grep -q "waiting for bus" "$work/tcp.log"
start "$work/tcp.rig.err" "$BIN/digrig" serve "${digs[@]}" --machine "$machine" --speed "$speed" --modbus-tcp "127.0.0.1:$port" \
    --start-delay 6
rig=$started
wait_for 20 grep -q "running" "$work/tcp.log"
stops=0 longest_ms=0
while going; do
    for ms in 5 20 50 100 300 1000 4000; do
        kill -STOP "$daemon" || break
        sleep "$(printf '%d.%03d' $((ms / 1000)) $((ms % 1000)))"
        kill -CONT "$daemon"
        stops=$((stops + 1)) longest_ms=$((ms > longest_ms ? ms : longest_ms))
        sleep 0.3
    done
done
wait "$rig"
sleep 1
stop "$daemon"
check "the daemon lived, and ends with exit status 0" [ "$status" = 0 ]
read_log tcp
f=$work/tcp.txt
"$helpers/daemon_judge" "$work/tcp.lcm" "$work/truth.csv" 0.5 0.4 2200 >"$work/tcp.judged" 2>"$work/tcp.err"
sed 's/^/      /' "$work/tcp.judged"
judged=$work/tcp.judged
overruns=$(last health "$f" $h_overruns)
told $stops "times SIGSTOP for 5 ms to 4 s ($overruns ticks told as late by a period)"
told "$(last health "$f" $h_worst_us)" "us, the longest tick it told"
told "$(last late "$f" 2)" "us, the latest beginning of a tick it told ($longest_ms ms was the longest stop)"
check "no wrong match or prediction is published" [ "$(judged all 6) $(judged all 8)" = "0 0" ]
check "nor a wrong estimate" [ "$(judged all 3)" = 0 ]
check "a tick that is late is told, one for each stop" within "$overruns" $((stops * 9 / 10)) 1e9
check "and so is how late the latest was" within "$(last late "$f" 2)" $((longest_ms * 990)) 1e9
check "ticks without a fresh sample are counted" within "$(last health "$f" $h_missing)" 1 1e9
finish
