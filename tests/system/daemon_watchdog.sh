#!/bin/bash
# What a service manager hears: READY once, WATCHDOG while the tick ticks and not while it hangs, STOPPING.
# By the machine's own clock: a thread that is held cannot be told from one that computes.
. tests/system/daemon_lib.bash

make_digs
"$BIN/digrig" record "$work/simpleA.csv" --machine "$machine" -o "$work/one.csv" 2>"$work/one.err"
config slow "{kind: replay, replay: {file: one.csv, speed: 0.1}}"

wait_for() { # SECONDS COMMAND…: until it succeeds
    local i
    for ((i = 0; i < $1 * 10; i++)); do
        "${@:2}" >/dev/null 2>&1 && return 0
        sleep 0.1
    done
    return 1
}

socat -u "UNIX-RECV:$work/socket" STDOUT >"$work/heard" &
children+=($!)
heard() { # WORD: how often the manager heard it
    grep -o "$1=1" "$work/heard" | wc -l
}
check "a manager listens" wait_for 60 [ -S "$work/socket" ]
NOTIFY_SOCKET=$work/socket WATCHDOG_USEC=200000 "$BIN/digsightd" -c "$work/slow.yaml" >"$work/daemon.log" 2>&1 &
daemon=$!
children+=("$daemon")
fed() { [ "$(heard WATCHDOG)" -gt "$1" ]; }
check "it hears READY" wait_for 60 eval '[ "$(heard READY)" = 1 ]'
check "and then is fed" wait_for 60 fed 3

# The tick is the first thread that is started, and has a second to be late in.
"$helpers/hold_thread" "$daemon" 1 >"$work/held" 2>"$work/hold.err" &
holding=$!
children+=("$holding")
fed_no_more() { # in five intervals
    local before
    before=$(heard WATCHDOG)
    sleep 1
    [ "$(heard WATCHDOG)" = "$before" ]
}
wait_for 60 eval '[ -s "$work/held" ] || ! kill -0 "$holding"'
if [ -s "$work/held" ]; then
    check "while the tick hangs it is fed no more" wait_for 10 fed_no_more
    before=$(heard WATCHDOG)
    kill -TERM "$holding"
    check "when it goes on, it is" wait_for 60 fed "$before"
else
    skip_check "a tick that hangs" "no thread can be stopped here"
fi
kill -TERM "$daemon"
status=0
wait "$daemon" || status=$?
check "SIGTERM ends the daemon with exit status 0" [ "$status" = 0 ]
check "the manager hears STOPPING, and READY once" eval '[ "$(heard STOPPING) $(heard READY)" = "1 1" ]'
finish
