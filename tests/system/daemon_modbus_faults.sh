#!/bin/bash
# What goes wrong on Modbus before and while a machine digs, what its server loses, damages or lets stand, a table that changes under
# the daemon, a disk without room: nothing wrong is published as good, every loss is counted, the next dig identifies the
# gravel.
. tests/system/daemon_lib.bash

make_digs
"$helpers/daemon_data" "$scene" "$work" other >>"$work/data.log" 2>&1
speed=4
series 9
config tcp "$modbus" "$(paced)
match: {state: full/match.json}"
mkdir "$work/full" # where nothing can be written: a disk without room, as far as the daemon can tell
mkdir "$work/full/match.json.part"

daemon_begins tcp
# The table it runs on: cut off, asked for, refused; put back, asked for, taken; another one in its place,
# asked for in a dig; removed.
change_tables() {
    pass 0.5
    cp "$work/table.sqlite" "$work/good.sqlite"
    truncate -s 50000 "$work/table.sqlite"
    kill -HUP "$daemon"
    pass 0.5
    cp "$work/good.sqlite" "$work/table.sqlite"
    kill -HUP "$daemon"
    pass "$(awk -v c="${contacts[1]}" -v speed="$speed" 'BEGIN { print 1 + (c + 3) / speed }')"
    cp "$work/other.sqlite" "$work/table.sqlite"
    kill -HUP "$daemon"
    pass 1
    rm "$work/table.sqlite"
}
# In free air values that are none and a server that is silent. Digs: lost answers, exceptions, answers 30 ms late, half of the answers lost, a server that goes away in the middle,
# damaged ones, registers that stand still, pressures alone that do, nothing.
start_series tcp --modbus-tcp "127.0.0.1:$port" --start-delay 2 \
    --fault not-available@0.5:1 --fault out-of-range@2:1 --fault missing@3.5:1.5 --fault "$(fault drop=0.1 1)" --fault "$(fault exception=0.1 2)" \
    --fault "$(fault slow=0.03 3)" --fault "missing@$(awk -v c="${contacts[4]}" 'BEGIN { print c + 3 }'):4" \
    --fault "$(fault drop=0.5 4)" --fault "$(fault corrupt=0.1 6)" --fault "$(fault frozen 7)" --fault "$(fault stuck-pressures 8)"
change_tables
ends "$rig"
daemon_ends tcp
judge tcp
digs_told=$(last health "$f" $h_digs)
check "a dig with exceptions identifies the gravel" [ "$(judged dig 6 2)" = 1 ]
check "so does one with late answers" [ "$(judged dig 6 3)" = 1 ]
check "one with damaged answers, behind the one with a hole" [ "$(judged dig 6 6)" = 1 ]
check "and the one after them all" [ "$(judged dig 6 "$digs_told")" = 1 ]
# A request whose answer is lost is one that timed out; one at the very end may wait for it still.
check "requests without an answer are counted" within "$(last health "$f" $h_timeouts)" \
    $(($(rig modbus_unanswered) - 1)) "$(rig modbus_unanswered)"
check "exceptions and damaged answers are counted" eval '[ "$(rig modbus_excepted)" -gt 20 ] && [ "$(rig modbus_damaged)" -gt 20 ] &&
    [ "$(last health "$f" $h_malformed)" = $(($(rig modbus_excepted) + $(rig modbus_damaged))) ]'
check "values that are not available are counted" within "$(last health "$f" $h_not_available)" 100 1e6
check "values out of range are counted" within "$(last health "$f" $h_out_of_range)" 100 1e6
check "ticks without a fresh sample are counted" within "$(last health "$f" $h_missing)" 50 1e6
check "the state is published as it changes" eval '[ "$(grep -c "^health waiting_for_bus" "$f")" -ge 4 ]'
check "no estimate is made of what was dropped" eval '[ "$(grep -c ^estimate "$f")" -lt "$(last samples "$f" 2)" ]'
check "a person is told" grep -q "dropped so far: [1-9][0-9]* " "$work/tcp.log"
check "frozen registers are counted" within "$(last health "$f" $h_frozen)" 100 1e6
check "a table that is cut off is refused, and said" \
    eval '[ "$(last health "$f" $h_reloads_refused)" = 1 ] && grep -q "reload refused, the table before stays: .*table.sqlite" "$work/tcp.log"'
check "a good one is taken without a gap, and so is another one in its place" \
    eval '[ "$(last health "$f" $h_reloads)" = 2 ] &&
          [ "$(sed -nE "s/.*table exchanged: scene rig .*, ([0-9]+) gravels/\1/p" "$work/tcp.log" | tr "\n" " ")" = "18 27 " ]'
check "a match that cannot be kept is said, and stands" grep -q "full/match.json" "$work/tcp.log"
check "nothing was lost on the way" [ "$(last health "$f" $h_lost)" = 0 ]

# The server is killed in a dig and comes back; what is known survives the daemon.
cp "$work/good.sqlite" "$work/table.sqlite"
config tcp "$modbus" "$(paced)
match: {state: match.json}"
series 2
log gone
start "$work/gone.log" "$BIN/digsightd" -c "$work/tcp.yaml"
daemon=$started
wait_for 5 grep -q "waiting for bus" "$work/gone.log"
# It stands still until the daemon, which waits up to 5 s between two attempts, has surely found it.
start_series first --modbus-tcp "127.0.0.1:$port" --start-delay 6
pass "$(awk -v c="${contacts[0]}" -v speed="$speed" 'BEGIN { print 6 + (c + 4) / speed }')"
stop "$rig" KILL
check "a server that went away is said" wait_for 5 grep -q "127.0.0.1:$port: " "$work/gone.log"
pass 0.1 # what was seen of it is published
read_log gone
judge gone
check "it went away in a dig" eval '[ "$(awk '"'"'$1 == "estimate" { phase = $3 } END { print phase }'"'"' "$work/gone.txt")" = 2 ]'
check "which is no whole dig" [ "$(last health "$work/gone.txt" $h_matches)" = 0 ]
log back
# It is back where its motion begins: as long away as a machine takes for that, and then found within two seconds.
pass 4
serve_series back --modbus-tcp "127.0.0.1:$port" --start-delay 6
daemon_ends back
judge back
check "the server is found again" within "$(last health "$f" $h_reconnects)" 1 100
check "the gravel is identified after that" identified "$f"

start "$work/again.log" "$BIN/digsightd" -c "$work/tcp.yaml"
daemon=$started
check "what was known is known again after a restart" wait_for 5 grep -q "from before (" "$work/again.log"
stop "$daemon"
touch -d "13 hours ago" "$work/match.json"
start "$work/old.log" "$BIN/digsightd" -c "$work/tcp.yaml"
daemon=$started
check "unless it is too old" wait_for 5 grep -q "match.json: 13.0 h old, expected at most 12.0 h" "$work/old.log"
stop "$daemon"
finish
