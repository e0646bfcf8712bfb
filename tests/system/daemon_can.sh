#!/bin/bash
# SocketCAN inside User Mode Linux, where a bus exists. The rig serves one dig on CAN and on Modbus at
# once; a daemon on each must find the same.
. tests/system/daemon_lib.bash
in_uml "$@"

# The rig runs without noise here: what is left between CAN and Modbus is CAN's quantisation. A machine
# whose sensors are perfect makes the published sigma just that.
sed -E 's/(pressure_sigma_Pa:) *[0-9.e+]+/\1 1/; s/(angle_sigma_rad:) *[0-9.e+-]+/\1 1e-9/' "$machine" >"$work/perfect.yaml"
config can "{kind: can, can: {interface: vcan0, dbc: $PWD/config/can/zx200.dbc, map: $PWD/config/signals/zx200_can.yaml}}"
sed -i "s|^machine:.*|machine: perfect.yaml|" "$work/can.yaml"
config absent "{kind: can, can: {interface: vcan7, dbc: $PWD/config/can/zx200.dbc, map: $PWD/config/signals/zx200_can.yaml}}"
config tcp "$modbus"

# A bus that is not there at first: the interface is made while the daemon waits.
start "$work/absent.log" "$BIN/digsightd" -c "$work/absent.yaml"
absent=$started
check "an interface that is absent is said" wait_for 30 grep -q "can vcan7: cannot be opened: No such device" "$work/absent.log"
ip link add vcan7 type vcan
ip link set vcan7 up
start "$work/rig7.err" "$BIN/digrig" serve "$work/simpleA.csv" --machine "$machine" --can vcan7
rig=$started
check "and found when it comes" wait_for 30 grep -q "running (can vcan7)" "$work/absent.log"
ip link set vcan7 down
check "an interface that goes down is said" wait_for 30 grep -q "can vcan7: .*Network is down" "$work/absent.log"
ip link set vcan7 up
check "and taken up again" wait_for 30 eval '[ "$(grep -c "running (can vcan7)" "$work/absent.log")" -ge 2 ]'
stop "$absent"
check "SIGTERM ends it with exit status 0" [ "$status" = 0 ]
stop "$rig"

# Without a route for its multicast there is no LCM network; it comes while the daemon runs.
ip route del 224.0.0.0/4
ip route del 239.255.76.67 2>/dev/null
start "$work/nolcm.log" "$BIN/digsightd" -c "$work/absent.yaml"
nolcm=$started
check "an LCM network that is absent is said" wait_for 30 grep -q "LCM .*no such network" "$work/nolcm.log"
ip route add 224.0.0.0/4 dev lo
check "and joined when it comes" wait_for 30 grep -q "publishing on" "$work/nolcm.log"
stop "$nolcm"
check "all this while the daemon ran on" [ "$status" = 0 ]

speed=2
echo "time_scale: $speed" | tee -a "$work/tcp.yaml" >>"$work/can.yaml"
before=$(cat /sys/class/net/vcan0/statistics/tx_packets)
logs_itself can can
logs_itself tcp tcp
start "$work/candump.log" candump -e vcan0,0:0,#FFFFFFFF
dump=$started
start "$work/can.log" "$BIN/digsightd" -c "$work/can.yaml"
daemon_can=$started
start "$work/tcp.log" "$BIN/digsightd" -c "$work/tcp.yaml"
daemon_tcp=$started
digs=("$work/simpleA.csv")
serve_series rig --no-noise --can vcan0 --modbus-tcp "127.0.0.1:$port"
pass 0.2
stop "$daemon_can"
stop "$daemon_tcp"
stop "$dump"
read_log can
read_log tcp

sent=$(sed -E 's/.*"can_sent": ([0-9]+).*/\1/' "$work/rig.json")
check "the bus carried the rig's frames and no other" \
    [ $(($(cat /sys/class/net/vcan0/statistics/tx_packets) - before)) = "$sent" ]
check "candump saw the rig's four messages and no other" \
    [ "$(awk '/vcan0/ { print $2 }' "$work/candump.log" | sort -u | tr '\n' ' ')" = "18FF79E8 18FF7DE8 18FF7EE8 18FF84E8 " ]
check "every frame was received" [ "$(last health "$work/can.txt" $h_frames)" = "$sent" ]
check "none was malformed" [ "$(last health "$work/can.txt" $h_malformed)" = 0 ]
# Pressures and angles are sent every other tick. Pressures that stand while the bucket moves, as at the end of a dig
# without noise, make no sample.
paired=$(($(last samples "$work/can.txt" 2) + $(last health "$work/can.txt" $h_stuck)))
check "pressures and angles are paired as they were sent" within "$paired" $(($(rig ticks) / 2 - 1)) $((($(rig ticks) + 1) / 2))
check "and dated so, each 10 ms of the machine after the last but for that one stand" awk '
    $1 == "estimate" { if (n++ && ($2 - last - 0.01) ^ 2 > 1e-4 ^ 2) off++; last = $2 }
    END { exit !(n > 1000 && off <= 1) }' "$work/can.txt"
check "the gravel is identified over CAN" identified "$work/can.txt"
check "and over Modbus" identified "$work/tcp.txt"

# Each CAN estimate against Modbus' at the same instant, in sigmas of CAN's quantisation. Modbus' own
# is 200 times finer. Return sides hold back_Pa, which lies on CAN's grid and is off by nothing, so the
# difference is a good deal less than one sigma.
compare=$(awk '
    $1 != "estimate" { next }
    FNR == NR { t[n] = $2; m[n++] = $6; next }
    {
        while (i < n - 2 && t[i + 1] < $2) i++
        if ($2 < t[i] || $2 > t[i + 1] || t[i + 1] - t[i] > 0.05) next
        w = ($2 - t[i]) / (t[i + 1] - t[i])
        d = ($6 - m[i] - w * (m[i + 1] - m[i])) / $7
        sum += d; square += d * d; count++
        if (d * d > worst * worst) worst = d
    }
    END { printf "%d %.3f %.3f %.3f", count, sum / count, sqrt(square / count), worst }' "$work/tcp.txt" "$work/can.txt")
echo "      estimates compared, mean, rms and worst difference in sigmas: $compare"
# shellcheck disable=SC2086 # four words
set -- $compare
check "enough estimates are compared" within "$1" 1000 1e9
check "CAN and Modbus give the same estimates within quantisation: mean" within "$2" -0.3 0.3
check "CAN and Modbus give the same estimates within quantisation: rms" within "$3" 0.3 1
check "CAN and Modbus give the same estimates within quantisation: worst" within "$4" -5 5
finish
