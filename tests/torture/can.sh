#!/bin/bash
# One dig after the other is disturbed: by the full load of a bus of other identifiers, frames of wrong length, FD
# frames, requests, error frames and a second sender of the same identifiers. Nothing wrong is published, all is counted,
# and the digs identify the gravel. Then comes a flood as fast as the kernel takes it. In User Mode Linux, where the
# kernel has a bus; on the simulated clock, so that the rig is never late there.
SIMULATED=yes
. tests/system/daemon_lib.bash
. tests/torture/torture.bash

if [ "${1-}" != inside ]; then
    make_digs
    DIG_DATA=$work tools/vcan/with-vcan -t $((1700 + 3 * TORTURE_S)) "$0" inside
    status=$?
    if [ "$status" = 125 ]; then
        echo "SKIP: User Mode Linux does not start here"
        echo "0 passed, 0 failed, 1 skipped"
        exit 0
    fi
    exit "$status"
fi
cp "$DIG_DATA"/* "$work"
flood=$BIN/../tests/torture/can_flood
speed=2
series 7
ip link set vcan0 down
ip link set vcan0 mtu 72 # CAN FD
ip link set vcan0 up
mapfile -t ids < <(awk '$1 == "BO_" { printf "%x\n", $2 % 2147483648 }' tests/data/sealed/zx200_sealed.dbc)
config can "{kind: can, can: {interface: vcan0, dbc: $PWD/tests/data/sealed/zx200_sealed.dbc, map: $PWD/tests/data/sealed/signals.yaml}}" \
    "time_scale: $speed"
log can
start "$work/can.log" "$BIN/digsightd" -c "$work/can.yaml"
daemon=$started
wait_for 10 grep -q "waiting for bus" "$work/can.log"
before_kB=$(memory_kB "$daemon")

disturb() { # KIND DIG RATE: from that dig's contact on, for four seconds
    pass "$(awk -v c="${contacts[$2 - 1]}" -v speed=$speed -v began="$began" -v now="$("$simclock" now)" \
        'BEGIN { print began + c / speed - now }')"
    start "$work/$1.out" "$flood" vcan0 "$1" "$3" $(($3 * 4)) "$2" "${ids[@]}"
}
began=$("$simclock" now)
start_series can --can vcan0 --can-sealed
# 1 Mbit/s is some 8000 frames a second.
for kind in "others 1 8000" "lengths 2 250" "fd 3 250" "rtr 4 250" "error 5 250" "second 6 250"; do
    # shellcheck disable=SC2086 # three words
    disturb $kind
done
ends "$rig"
run "$work/flood.out" "$flood" vcan0 others 1000000000 $((20000 * TORTURE_S)) 7 "${ids[@]}"
after_kB=$(memory_kB "$daemon")
stop "$daemon"
check "the daemon lives, and ends with exit status 0" [ "$status" = 0 ]
read_log can
f=$work/can.txt
judge can
told "$(cat "$work/flood.out")" "CAN frames of other identifiers, as fast as the kernel takes them"
for kind in others lengths fd rtr error second; do told "$(cat "$work/$kind.out")" "CAN frames: $kind"; done
told "$(last health "$f" $h_matches)" "of ${#digs[@]} digs on that bus identified the gravel"
told $((after_kB - before_kB)) "kB more memory after it than before"
told "$(last health "$f" $h_worst_us)" "us, the longest tick (User Mode Linux)"
check "wrong lengths are counted" within "$(last health "$f" $h_malformed)" 300 1e6
check "error frames are counted" within "$(last health "$f" $h_error_frames)" 300 1e6
check "a second sender's frames fail their checksum" within "$(last health "$f" $h_checksum)" 300 1e6
check "a dig under the load of others identifies the gravel" [ "$(judged dig 6 1)" = 1 ]
check "the last dig identifies the gravel" [ "$(judged dig 6 "$(last health "$f" $h_digs)")" = 1 ]
check "its memory is flat" [ $((after_kB - before_kB)) -le 512 ]
finish
