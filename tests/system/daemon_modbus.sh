#!/bin/bash
# The rig's Modbus TCP server and the daemon: a bus that comes late, a dig, a bus that goes away.
. tests/system/daemon_lib.bash

make_digs
speed=4
config tcp "$modbus" "$(paced)"
daemon_begins tcp
check "a bus that is absent is said" grep -q "waiting for bus" "$work/tcp.log"
check "and why" grep -q "127.0.0.1:$port.*refused" "$work/tcp.log"
# It stands still until the daemon, which waits up to 5 s between two attempts, has surely found it.
digs=("$work/simpleA.csv" "$work/actual.csv")
serve_series tcp --modbus-tcp "127.0.0.1:$port" --start-delay 6
check "a bus that appears later is found" grep -q "running" "$work/tcp.log"
check "a bus that goes away is said" wait_for 5 eval '[ "$(grep -c "waiting for bus" "$work/tcp.log")" -ge 2 ]'
daemon_ends tcp
check "the gravel is identified" identified "$f"
check "the actual dig is predicted" [ "$(grep -c '^prediction 1 actual' "$f")" -ge 10 ]
check "health is published while the bus is absent" grep -q '^health waiting_for_bus' "$f"
check "health names the trouble" grep -q '^health waiting_for_bus .*refused' "$f"
check "only functions that read were asked for" \
    eval 'grep -q "\"modbus_served\": {\"4\": [0-9]*}" "$rig_json" &&
          grep -q "\"modbus_refused\": {}" "$rig_json"'

# Pressures in another block of registers, at half the rate.
config blocks "{kind: modbus-tcp, modbus: {address: \"127.0.0.1:$port\", poll_Hz: 400, map: $PWD/config/signals/modbus_blocks.yaml}}" \
    "$(paced)"
daemon_begins blocks
digs=("$work/simpleA.csv")
serve_series blocks --modbus-tcp "127.0.0.1:$port" --start-delay 2
daemon_ends blocks
check "registers far apart are asked for in blocks and identify the gravel" identified "$f"
check "and in no others" \
    eval 'grep -q "\"modbus_served\": {\"4\": [0-9]*}" "$work/blocks.json" && grep -q "\"modbus_refused\": {}" "$work/blocks.json"'
# Angles at 400, pressures at 200 requests a second: a sample for each of the pressures.
served=$(sed -nE 's/.*"modbus_served": \{"4": ([0-9]+)\}.*/\1/p' "$work/blocks.json")
check "a sample comes of the slower block, not of every request" \
    within "$(last samples "$f" 2)" $((served / 5)) $((served / 2))

# Boom's and arm's pressures in a block of their own, refused for the first half of the dig and then there again.
sed -E -e 's/register: 0, registers: 5/register: 0, registers: 12/' -e 's/register: 1005, registers: 6/register: 1005, registers: 4/' \
    -e '/registers: 1, poll_Hz: 1/d' -e '/bucket_head_Pa/s/1009/9/' -e '/bucket_rod_Pa/s/1010/10/' \
    config/signals/modbus_blocks.yaml >"$work/force.map.yaml"
config force "{kind: modbus-tcp, modbus: {address: \"127.0.0.1:$port\", poll_Hz: 400, map: force.map.yaml}}" "$(paced)"
series 1
start_series force --modbus-tcp "127.0.0.1:$port" --start-delay 1 \
    --fault "far@$(awk -v c="${contacts[0]}" 'BEGIN { printf "%.2f:%.2f", c - 3, 9 }')"
daemon_begins force
ends "$rig"
daemon_ends force
bare='boom_head_Pa, boom_rod_Pa, arm_head_Pa, arm_rod_Pa'
check "without the block of the other pressures the moment goes on" \
    within "$(grep -cF " 0 \"$bare\"" <(grep '^estimate' "$f"))" 200 1e9
check "and identifies the gravel by itself" eval 'identified "$f" && [ "$(awk '"'"'$1 == "match" { f = $(NF - 3) } END { print f }'"'"' "$f")" = 0 ]'
check "health names what is missing" grep -q "^health running .*\"$bare\"" "$f"
check "and counts the samples without" within "$(last health "$f" $h_without_force)" 200 1e9
check "without a new connection" [ "$(last health "$f" $h_reconnects)" = 0 ]
check "the force is told before and again when the block is back" \
    awk '$1 == "estimate" { n = split($0, part, "\""); has = $9; if (has != was || !seen) turns = turns has; was = has; seen = 1 }
         END { exit !(turns ~ /10+1$/) }' "$f"

# The same block without any answer, from the first request to the last: it is asked now and then only, so
# that the moment hardly loses a sample.
start_series mute --modbus-tcp "127.0.0.1:$port" --start-delay 1 --fault far-silent@0
began=$("$simclock" now)
daemon_begins mute force
ends "$rig"
took=$(since "$began")
daemon_ends mute
check "a block that does not answer is said to be silent" grep -q "registers 1005 … 1008: silent while others answer" "$work/mute.log"
check "it is asked three times, then every five seconds" within "$(last health "$f" $h_timeouts)" 3 $((4 + took / 5))
check "the moment identifies the gravel beside it" identified "$f"
check "without a new connection" [ "$(last health "$f" $h_reconnects)" = 0 ]
finish
