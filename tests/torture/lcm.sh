#!/bin/bash
# A flood of garbage on the network on which the daemon publishes: it reads nothing there, so it identifies the gravel
# as ever, its memory is flat, and its log is read by our tools, up to what is not ours.
. tests/system/daemon_lib.bash
. tests/torture/torture.bash

torture=$BIN/../tests/torture
make_digs
speed=4
series $((1 + TORTURE_S / 8))
config run "{kind: replay, replay: {file: series.csv, speed: $speed}}"
# What it publishes goes to a logger on a network of its own, too: it is judged by that of the same daemon alone.
group=${lcm#udpm://} group=${group%%:*}
lcm_port=${lcm##*:} lcm_port=${lcm_port%%\?*}
start "$work/flood.out" "$torture/lcm_flood" "$group" "$lcm_port" $((TORTURE_S + 5)) $RANDOM
flood=$started
start "$work/run.log" "$BIN/digsightd" -c "$work/run.yaml"
daemon=$started
sleep 3
before_kB=$(memory_kB "$daemon")
sleep "$((TORTURE_S > 3 ? TORTURE_S - 3 : 1))"
after_kB=$(memory_kB "$daemon")
# A second daemon's worth of listeners: they hear garbage and the daemon, and must not die of either.
start "$work/spy.log" timeout 3 lcm-logger --lcm-url="$lcm&recv_buf_size=4000000" "$work/flooded.lcm"
wait "$started"
wait "$flood"
wait "$daemon"
status=$?
check "the daemon ends with exit status 0" [ "$status" = 0 ]
told "$(cat "$work/flood.out")" "datagrams of garbage on the daemon's LCM network"
told $((after_kB - before_kB)) "kB more memory after it than 3 s after the start"
check "every dig identifies the gravel" [ "$(grep -c "digsightd: dig .*friction 0\.[45]" "$work/run.log")" = ${#digs[@]} ]
check "its memory is flat" [ $((after_kB - before_kB)) -le 256 ]
if [ -s "$work/flooded.lcm" ]; then
    "$BIN/digloop" identify "$work/table.sqlite" "$work/flooded.lcm" --machine "$machine" >"$work/out" 2>"$work/err"
    code=$?
    check "a log with garbage in it is read or refused in words" eval '[ $code -le 2 ] && { [ $code = 0 ] || [ -s "$work/err" ]; }'
fi
finish
