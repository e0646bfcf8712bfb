#!/bin/bash
# The clock of the system tests: it goes when it is told to, waits for every program that computes, however busy the
# machine is, and wakes who sleeps, polls or waits for a signal at the time they asked for.
. tests/system/check.bash
. tests/system/simclock.bash
user=$BIN/../tests/system/clock_user

# A busy machine: as many programs that compute on and on as it has processors, and one more.
hogs=()
for ((i = 0; i <= $(nproc); i++)); do
    (while :; do :; done) &
    hogs+=("$!")
done
trap 'kill "${hogs[@]}" 2>/dev/null; cleanup' EXIT

start "$work/idle" "$user" sleep 5
idle=$started
sleep 0.3
check "no time passes by itself" is "$("$simclock" now)" 0.000000
began=$SECONDS
pass 3600
check "an hour takes no hour" [ $((SECONDS - began)) -lt 600 ]
check "it is an hour" is "$("$simclock" now)" 3600.000000
wait "$idle"
check "who sleeps wakes at its time" is "$(cat "$work/idle")" 5.000

start "$work/long" "$user" compute 0.5
long=$started
start "$work/short" "$user" sleep 0.001
pass 1
check "nobody is outrun while it computes" is "$(cat "$work/long" "$work/short")" "$(printf '3600.001\n3600.001')"
wait "$long"

mkfifo "$work/pipe"
start "$work/reader" "$user" poll "$work/pipe" 50
start "$work/writer" "$user" write "$work/pipe" 2
pass 10
check "what is waited for ends a wait at once" is "$(cat "$work/reader" "$work/writer")" "$(printf 'ready 3603.000\nwrote 3604.000')"
start "$work/reader" "$user" poll "$work/pipe" 2
pass 10
check "and without it the wait ends at its time" is "$(cat "$work/reader")" "silent 3613.000"
start "$work/signal" "$user" signal 50
signalled=$started
start "$work/none" "$user" signal 4
pass 2
kill -USR1 "$signalled"
pass 20
check "a signal ends a wait for it" is "$(cat "$work/signal")" "USR1 3623.000"
check "and no signal ends none" is "$(cat "$work/none")" "none 3625.000"

mkfifo "$work/order"
exec 9<>"$work/order"
for ((i = 0; i < 8; i++)); do
    start "$work/order" "$user" sleep 1
    start "$work/order" "$user" signal 1
    start "$work/order" "$user" poll "$work/pipe" 1
    pass 2
done
echo end >&9
check "waits that end together end in the order in which their threads began" \
    is "$(sed '/^end$/q' <&9 | awk '{ print $1 ~ /^[0-9]/ ? "slept" : $1 }' | tr '\n' ' ')" \
    "$(for ((i = 0; i < 8; i++)); do printf 'slept none silent '; done)end "

run "$work/rig" "$BIN/digrig" serve tests/data/reference/mu0.5_mur0.5_rho2500__simpleA.csv \
    --machine config/machines/zx200_trench.yaml --modbus-tcp 127.0.0.1:0 --speed 20 --json
check "a rig beside all this is never late by a millisecond" \
    within "$(sed -nE 's/.*"worst_late_ms": ([0-9.]+).*/\1/p' "$work/rig")" 0 1
start "$work/killed" "$user" sleep 100
stop "$started" KILL
pass 200
check "who was killed is waited for no more" within "$("$simclock" now)" 3800 4000
finish
