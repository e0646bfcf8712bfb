#!/bin/bash
# One run of the demo: rig → bus → daemon → LCM log.
#   scripts/demo_run.sh can|modbus BIN OUT TABLE MACHINE SPEED RECORDING…
# Leaves OUT/BUS.lcm and the programs' words in OUT/BUS.*.log. Ends with the rig, or with 1.
set -eu
bus=$1 bin=$2 out=$3 table=$4 machine=$5 speed=$6
shift 6
here=$PWD

case $bus in
can)
    input="{kind: can, can: {interface: vcan0, dbc: $here/config/can/zx200.dbc, map: $here/config/signals/zx200_can.yaml}}"
    serve=(--can vcan0)
    port=7672
    ;;
modbus)
    tcp=127.0.0.1:$((20000 + $$ % 20000))
    input="{kind: modbus-tcp, modbus: {address: \"$tcp\", map: $here/config/signals/modbus_default.yaml}}"
    serve=(--modbus-tcp "$tcp")
    port=7671
    ;;
esac
lcm="udpm://239.255.76.67:$port?ttl=0"

# The daemon's clock runs as fast as the rig plays: an honest bench, not a machine.
cat >"$out/$bus.yaml" <<YAML
table: $table
machine: $here/$machine
input: $input
lcm: {url: "$lcm"}
time_scale: $speed
YAML

pids=()
cleanup() { for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done; wait 2>/dev/null || true; }
trap cleanup EXIT

rm -f "$out/$bus.lcm"
lcm-logger -q --lcm-url="$lcm" "$out/$bus.lcm" >"$out/$bus.logger.log" 2>&1 </dev/null &
pids+=($!)
sleep 0.5
"$bin/digsightd" -c "$out/$bus.yaml" >"$out/$bus.daemon.log" 2>&1 </dev/null &
pids+=($!)
sleep 0.5
"$bin/digrig" serve "$@" --machine "$machine" "${serve[@]}" --speed "$speed" >"$out/$bus.rig.log" 2>&1
sleep 1
