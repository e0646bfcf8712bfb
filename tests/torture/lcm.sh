#!/bin/bash
# A flood of garbage on the network on which the daemon publishes: it reads nothing there, so it identifies the gravel
# as ever, its memory is flat, and its log is read by our tools, up to what is not ours. digwatch reads there, and lives.
. tests/system/daemon_lib.bash
. tests/torture/torture.bash

torture=$BIN/../tests/torture
make_digs
speed=4
series $((1 + TORTURE_S / 8))
config run "{kind: replay, replay: {file: series.csv, speed: $speed}}"
group=${lcm#udpm://} group=${group%%:*}
lcm_port=${lcm##*:} lcm_port=${lcm_port%%\?*}
start "$work/flood.out" "$torture/lcm_flood" "$group" "$lcm_port" $((TORTURE_S + 5)) $RANDOM
flood=$started
start "$work/run.log" "$BIN/digsightd" -c "$work/run.yaml"
daemon=$started
wait_for 60 grep -q "running" "$work/run.log"
sleep 1
before_kB=$(memory_kB "$daemon")
after_kB=$before_kB
watch_kB=0
start "$work/watch.log" "$BIN/digwatch" --lcm-url "$lcm" --prometheus "$work/health.prom"
watch=$started
# A listener hears the garbage and the daemon. Of liblcm's it may kill one, which leaves what it heard.
start "$work/spy.log" timeout 3 lcm-logger --lcm-url="$lcm&recv_buf_size=4000000" "$work/flooded.lcm"
while kill -0 "$daemon" 2>/dev/null; do
    now_kB=$(memory_kB "$daemon" 2>/dev/null)
    after_kB=${now_kB:-$after_kB}
    now_kB=$(memory_kB "$watch" 2>/dev/null)
    [ "${now_kB:-0}" -le "$watch_kB" ] || watch_kB=$now_kB
    sleep 1
done
check "digwatch is alive after the flood" kill "$watch"
wait "$watch"
check "and ends as ever" [ $? = 0 ]
check "it heard the daemon, and much that was not understood" \
    awk '$1 == "digsight_digs_total" { digs = $2 } $1 == "digsight_misread_total" { misread = $2 } END { exit !(digs >= 1 && misread >= 100) }' "$work/health.prom"
check "it took 8 MB at most" [ "$watch_kB" -le 8192 ]
wait "$flood"
wait "$daemon"
status=$?
check "the daemon ends with exit status 0" [ "$status" = 0 ]
told "$(cat "$work/flood.out")" "datagrams of garbage on the daemon's LCM network"
told $((after_kB - before_kB)) "kB more memory at the end than a second after the start"
check "every dig identifies the gravel" [ "$(grep -c "digsightd: dig .*friction 0\.[45]" "$work/run.log")" = ${#digs[@]} ]
check "its memory is flat" [ $((after_kB - before_kB)) -le 256 ]
if [ -s "$work/flooded.lcm" ]; then
    "$BIN/digloop" identify "$work/table.sqlite" "$work/flooded.lcm" --machine "$machine" >"$work/out" 2>"$work/err"
    code=$?
    check "a log with garbage in it is read or refused in words" eval '[ $code -le 2 ] && { [ $code = 0 ] || [ -s "$work/err" ]; }'
fi
finish
