#!/bin/bash
# A laboratory rig whose bucket hangs on a force sensor: its recording through the daemon and digloop,
# and the log of that again.
. tests/system/daemon_lib.bash

hydraulic=$machine
make_digs
speed=4
machine=config/machines/rig_sensor.yaml
"$BIN/digrig" record "$work/simpleA.csv" "$work/actual.csv" --machine "$machine" -o "$work/run.csv" --truth "$work/truth.csv" \
    2>"$work/rig.err"
check "digrig records what the sensor reads" \
    [ "$(head -1 "$work/run.csv")" = "t_s,bucket_rad,pitch_rad,pin_X_m,pin_Z_m,sensor_Fx_N,sensor_Fz_N,sensor_My_Nm" ]
config csv "{kind: replay, replay: {file: run.csv, speed: 5}}"
"$BIN/digsightd" -c "$work/csv.yaml" --check >"$work/check.txt" 2>&1
check "--check finds nothing missing" eval '[ $? = 0 ] && grep -q rig_sensor "$work/check.txt" && ! grep -q "not measured" "$work/check.txt"'
check "the daemon replays it to the end" replay csv
check "the gravel is identified" identified "$work/csv.txt"
check "by moment and forces" [ "$(awk '$1 == "match" { f = $(NF - 3) } END { print f }' "$work/csv.txt")" = 1 ]
check "the actual dig is predicted while it goes on" [ "$(grep -c '^prediction 1 actual' "$work/csv.txt")" -ge 5 ]
check "nothing is missing from any estimate" eval '! grep "^estimate" "$work/csv.txt" | grep -qE "_N|_Nm|_m\""'

identify() { # RECORDING…: mean friction, rolling, density as digloop has them
    "$BIN/digloop" identify "$work/table.sqlite" "$@" --trajectory simpleA --json 2>"$work/identify.err" | tr -d '\n' |
        sed -nE 's/.*"mean": \{"friction": ([^,]*), "rolling": ([^,]*), "density_kgpm3": ([^}]*)\}.*/\1 \2 \3/p'
}
near() { # A B: three numbers each, within 5 %
    awk -v a="$1" -v b="$2" 'BEGIN { n = split(a, x, " "); if (n != 3 || split(b, y, " ") != 3) exit 1
        for (i = 1; i <= 3; i++) if ((y[i] / x[i] - 1) ^ 2 > 0.05 ^ 2) exit 1 }'
}
direct=$(identify "$work/simpleA.csv")
check "digloop identifies from it as from the dig itself" near "$direct" "$(identify "$work/run.csv" --machine "$machine")"
check "and from the daemon's log" near "$direct" "$(identify "$work/csv.lcm" --machine "$machine")"

# The same from a bus.
config bus "{kind: modbus-tcp, modbus: {address: \"127.0.0.1:$port\", poll_Hz: 400, map: $PWD/config/signals/modbus_sensor.yaml}}" \
    "$(paced)"
start "$work/rigbus.err" "$BIN/digrig" serve "$work/simpleA.csv" "$work/actual.csv" --machine "$machine" \
    --modbus-tcp "127.0.0.1:$port" --speed "$speed" --start-delay 1
rig=$started
daemon_begins bus
ends "$rig"
daemon_ends bus
check "from Modbus the gravel is identified, too" identified "$f"
check "by moment and forces" [ "$(awk '$1 == "match" { f = $(NF - 3) } END { print f }' "$f")" = 1 ]
check "and the actual dig is predicted" [ "$(grep -c '^prediction 1 actual' "$f")" -ge 5 ]

refused() { # STATUS WORDS FILE: exit status 2, and the words in the file
    [ "$1" = 2 ] && grep -q "$2" "$3"
}
machine=$hydraulic
config other "{kind: replay, replay: {file: run.csv}}"
"$BIN/digsightd" -c "$work/other.yaml" --check >/dev/null 2>"$work/other.txt"
check "a machine with cylinders is refused for such a recording" refused $? "machine: .* has cylinders" "$work/other.txt"
"$BIN/digloop" identify "$work/table.sqlite" "$work/run.csv" --machine "$machine" >/dev/null 2>"$work/other.txt"
check "so it is by digloop" refused $? "readings of a force sensor, expected what machine" "$work/other.txt"
"$BIN/digrig" serve "$work/simpleA.csv" --machine config/machines/rig_sensor.yaml --can vcan0 2>"$work/other.txt"
check "digrig says that its CAN layout has no force sensor" refused $? "expected Modbus or record" "$work/other.txt"
mkdir "$work/campaign"
cp "$work/run.csv" "$work/campaign"
cat >"$work/campaign/campaign.yaml" <<YAML
scene: rig
machine: $PWD/config/machines/rig_sensor.yaml
recordings:
  - {file: run.csv, trajectory: simpleA, role: identify}
  - {file: run.csv, trajectory: actual, role: holdout}
YAML
"$BIN/digloop" trace "$work/table.sqlite" "$work/campaign" >/dev/null 2>"$work/other.txt"
check "digloop trace says that it wants its digs as force recordings" refused $? "expected a machine with cylinders or force recordings" "$work/other.txt"
finish
