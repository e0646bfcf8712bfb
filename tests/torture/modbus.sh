#!/bin/bash
# A Modbus TCP server that lies, hangs up and comes back: the daemon lives, its memory is flat, what it was told is
# counted, and no sample is made of a lie.
. tests/system/daemon_lib.bash
. tests/torture/torture.bash

torture=$BIN/../tests/torture
make_digs
config tcp "{kind: modbus-tcp, modbus: {address: \"127.0.0.1:$port\", poll_Hz: 400, map: $PWD/config/signals/modbus_default.yaml}}"
log tcp
start "$work/liar.out" "$torture/modbus_liar" "$port" $((TORTURE_S + 5)) $RANDOM
liar=$started
start "$work/tcp.log" "$BIN/digsightd" -c "$work/tcp.yaml"
daemon=$started
sleep 5
before_kB=$(memory_kB "$daemon")
wait "$liar"
after_kB=$(memory_kB "$daemon")
stop "$daemon"
check "the daemon lives, and ends with exit status 0" [ "$status" = 0 ]
read_log tcp
f=$work/tcp.txt
read -r connections requests right lies <"$work/liar.out"
read -r samples poisoned < <("$torture/poisoned" "$work/tcp.lcm")
told "$connections" "connections to a Modbus server that lies ($(last health "$f" $h_reconnects) reconnects told)"
told "$requests" "requests, $right answered right, $lies with a lie"
told "$samples" "samples published, $poisoned of a lie"
told $((after_kB - before_kB)) "kB more memory after it than 5 s after the start"
told "$(last health "$f" $h_worst_us)" "us, the longest tick while the server lied"
check "no sample is made of a lie" eval '[ "$samples" -gt 0 ] && [ "$poisoned" = 0 ]'
check "lies are counted" within "$(last health "$f" $h_malformed)" $((TORTURE_S / 10)) 1e9
check "silence is counted" within "$(last health "$f" $h_timeouts)" 1 1e9
check "so are reconnects" within "$(last health "$f" $h_reconnects)" $((TORTURE_S / 4)) 1e9
check "its memory is flat" [ $((after_kB - before_kB)) -le 256 ]
finish
