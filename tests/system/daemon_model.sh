#!/bin/bash
# A machine whose bucket is heavier than its file says, on the rig's Modbus: the daemon with a model
# that says so shows the smaller residual on the same digs. A model that cannot be is refused.
. tests/system/daemon_lib.bash

make_digs
speed=2
hash=$("$BIN/digtable" list "$work/table.sqlite" --json | grep -o '[0-9a-f]\{64\}' | head -1)

# The machine as it is: 250 kg more, in the file's own centre of mass.
mass=$(awk '/^[a-z]/ { part = $1 } part == "bucket:" && $1 == "mass_kg:" { print $2 }' "$machine")
awk -v more=250 '/^[a-z]/ { part = $1 }
    part == "bucket:" && $1 == "mass_kg:" { $0 = "  mass_kg: " $2 + more } { print }' "$machine" >"$work/true.yaml"
check "the machine served is another than the file's" [ "$mass" = 330 ]

model() { # NAME EFFECT PARAMETER VALUE
    cat >"$work/$1.json" <<JSON
{"version": 1, "table": "table.sqlite", "effects_table": "", "scene_hash": "$hash",
 "gravel": {"friction": 0.5, "rolling": 0.4, "density_kgpm3": 2200},
 "low": {"friction": 0.4, "rolling": 0.3, "density_kgpm3": 2000},
 "high": {"friction": 0.6, "rolling": 0.5, "density_kgpm3": 2400},
 "provenance": "tests/system/daemon_model.sh",
 "effects": [{"name": "$2", "probability": 1, "parameters": [
   {"name": "$3", "value": $4, "low": $4, "high": $4}]}]}
JSON
}

input="{kind: modbus-tcp, modbus: {address: \"127.0.0.1:$port\", poll_Hz: 400, map: $PWD/config/signals/modbus_default.yaml}}"
# The bias that is learnt in free air would take off what the model is for: it is off. The machine stands still in
# the air for four seconds of the clock first, and the daemon finds it there.
run() { # NAME MORE: the digs over the bus; mean moment of the first six seconds, in the air
    config "$1" "$input" "estimator: {air_bias_s: 0}
$2"
    log "$1"
    start "$work/rig.err" "$BIN/digrig" serve "$work/simpleA.csv" --machine "$work/true.yaml" \
        --modbus-tcp "127.0.0.1:$port" --speed "$speed" --start-delay 4
    rig=$started
    wait_for 5 grep -q "serving Modbus" "$work/rig.err"
    start "$work/$1.log" "$BIN/digsightd" -c "$work/$1.yaml"
    daemon=$started
    ends "$rig"
    stop "$daemon"
    read_log "$1"
    residual=$(awk '$1 == "estimate" { if (n == 0) t0 = $2
        if ($2 < t0 + 6) { sum += $6; n++ } }
        END { mean = n > 0 ? sum / n : 1e9; print mean < 0 ? -mean : mean }' "$work/$1.txt")
}

model heavier bucket_weight mass_kg 250
run plain "time_scale: $speed"
plain=$residual
run with_model "time_scale: $speed
model: heavier.json"
echo "mean moment in the air, Nm: $plain without the model, $residual with it"
# Where it stands, the bucket's centre of mass lies 0.134 m beside its pin (boom + arm + bucket = -95.1 deg, com_m):
# 250 kg weigh 329 Nm there, and six seconds of noise leave 18 Nm.
check "without the model the air is not empty" within "$plain" 250 410
check "with it the residual is a fifth or less" within "$residual" 0 "$(awk -v p="$plain" 'BEGIN { print p / 5 }')"

refused() { # NAME: refused with exit status 2, naming the file
    config "$1" "$input" "model: $1.json"
    "$BIN/digsightd" -c "$work/$1.yaml" --check >"$work/$1.out" 2>&1
    [ $? = 2 ] && grep -q "$1.json" "$work/$1.out"
}
model unknown bucket_weight mass_lb 250
check "a parameter the effect does not have is refused" refused unknown
model heaviest bucket_weight mass_kg -5000
check "a machine that cannot be is refused" refused heaviest
model cohesive cohesion cohesion_Jpm3 1e4
check "an effect no table at hand tells is refused" refused cohesive
hash=$(printf 'c%.0s' {1..64})
model elsewhere bucket_weight mass_kg 250
check "a model of another scene is refused" refused elsewhere
finish
