#!/bin/bash
# A bus that comes and goes some hundred times a second, and one that answers wrongly: what the daemon says of it is held
# back, and counted.
. tests/system/daemon_lib.bash

make_digs
"$BIN/digrig" record "$work/simpleA.csv" --machine "$machine" -o "$work/run.csv" 2>"$work/rig.err"
# Every sample is fresh for a millisecond and missing for four.
config flood "{kind: replay, replay: {file: run.csv, speed: 2}}" "stale_ms: 1"
log flood
began=$("$simclock" now)
run "$work/daemon.log" "$BIN/digsightd" -c "$work/flood.yaml"
took=$(since "$began")
read_log flood
lines=$(grep -Ec '(starting|running|waiting for bus|stopping) \(' "$work/daemon.log")
spoken=$(awk '/lines held back/ { n++ } END { print n + 0 }' "$work/daemon.log")
held=$(awk '/lines held back/ { n += $NF } END { print n + 0 }' "$work/daemon.log")
# HEALTH comes at once with each change; LCM promises nothing, so that some may be missing there.
changes=$(awk '/^health/ { n += $2 != was; was = $2 } END { print n + 0 }' "$work/flood.txt")
echo "      $took s: $changes changes of state in HEALTH, $lines lines, $held held back"
check "the bus comes and goes many times a second" [ "$changes" -gt $((20 * took)) ]
check "a burst is said, and a line a second" within "$lines" 15 $((20 + took + 2))
check "each time it is said how many lines were held back before" within "$spoken" 2 $((took + 3))
check "no line is lost from the count" within $((lines + held)) "$changes" $((2 * changes))
check "what is no flood is said as ever" grep -q 'dig 1 (simpleA): friction' "$work/daemon.log"

# A slave that answers every fourth request with an exception.
config bad "{kind: modbus-tcp, modbus: {address: \"127.0.0.1:$port\", poll_Hz: 200, map: $PWD/config/signals/modbus_default.yaml}}" \
    "time_scale: 2"
began=$("$simclock" now)
daemon_begins bad
run "$work/serve.err" "$BIN/digrig" serve "$work/simpleA.csv" --machine "$machine" --speed 2 --modbus-tcp "127.0.0.1:$port" \
    --start-delay 1 --fault exception=0.25@0:60
daemon_ends bad
took=$(since "$began")
bad=$(last health "$f" $h_malformed)
lines=$(grep -c 'dropped so far' "$work/bad.log")
most=$(sed -nE 's/.*dropped so far: ([0-9]+) malformed.*/\1/p' "$work/bad.log" | tail -n 1)
echo "      $took s: $bad exceptions, told in $lines lines, the last of $most"
check "answers are refused by the hundred" [ "$bad" -gt 100 ]
check "and said every ten seconds at most" within "$lines" 1 $((took / 10 + 1))
check "with how many they are so far" within "$most" 1 "$bad"
finish
