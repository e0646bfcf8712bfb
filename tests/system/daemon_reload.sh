#!/bin/bash
# A model that is exchanged while the daemon runs: the curves and the machine's correction are taken up at
# SIGHUP without a sample lost; a model that cannot be is refused, and the one before stays. At start it is refused too.
. tests/system/daemon_lib.bash

make_digs
speed=2
hash=$("$BIN/digtable" list "$work/table.sqlite" --json | grep -o '[0-9a-f]\{64\}' | head -1)

# The machine as it is: 250 kg more in the bucket than its file says.
heavier 250 "$work/true.yaml"
model() { # EFFECT PARAMETER VALUE: writes model.json
    cat >"$work/model.json" <<JSON
{"version": 1, "table": "table.sqlite", "effects_table": "", "scene_hash": "$hash",
 "gravel": {"friction": 0.5, "rolling": 0.4, "density_kgpm3": 2200},
 "low": {"friction": 0.4, "rolling": 0.3, "density_kgpm3": 2000},
 "high": {"friction": 0.6, "rolling": 0.5, "density_kgpm3": 2400},
 "provenance": "tests/system/daemon_reload.sh",
 "effects": [{"name": "$1", "probability": 1, "parameters": [
   {"name": "$2", "value": $3, "low": $3, "high": $3}]}]}
JSON
}
config tcp "$modbus" "time_scale: $speed
estimator: {air_bias_s: 0}"

# It stands in the air for the whole of the test.
start "$work/rig.err" "$BIN/digrig" serve "$work/simpleA.csv" --machine "$work/true.yaml" --modbus-tcp "127.0.0.1:$port" \
    --speed "$speed" --start-delay 120
rig=$started
wait_for 30 grep -q "serving Modbus" "$work/rig.err"
start "$work/daemon.log" "$BIN/digsightd" -c "$work/tcp.yaml"
daemon=$started
wait_for 30 grep -q "running" "$work/daemon.log"
config tcp "$modbus" "time_scale: $speed
estimator: {air_bias_s: 0}
model: model.json"
said() { # PATTERN TIMES
    [ "$(grep -c "$1" "$work/daemon.log")" = "$2" ]
}
turn() { # MASS_kg PATTERN TIMES: a model of that mass, asked for; until the log has said so
    model bucket_weight mass_kg "$1"
    kill -HUP "$daemon"
    wait_for 30 said "$2" "$3"
}
air() { # NAME: the size of the mean moment of some seconds in the air, Nm
    log "$1"
    pass 3
    read_log "$1"
    awk '$1 == "estimate" { sum += $6; n++ } END { mean = n >= 300 ? sum / n : 1e9; printf "%.0f", mean < 0 ? -mean : mean }' "$work/$1.txt"
}
missing() { # NAME: ticks without a fresh sample, so far
    last health "$work/$1.txt" $h_missing
}

# Where it stands, the bucket's centre of mass lies 0.134 m beside its pin (boom + arm + bucket = -95.1 deg, com_m):
# 250 kg weigh 329 Nm there, and noise leaves 18 Nm. The bias that is learnt in free air would take them off: it is off.
check "without the model the air is not empty" within "$(air without)" 250 410
check "a model is taken at SIGHUP" turn 250 "table exchanged" 1
check "with it the air is empty" within "$(air with)" 0 60
check "one that cannot be is refused, and said" turn -5000 "reload refused, the table before stays: .*model.json" 1
check "and the one before stays" within "$(air refused)" 0 60
check "another one is taken" turn 125 "table exchanged" 2
check "with half of the mass half of the moment is left" within "$(air half)" 110 220
stop "$daemon"
check "SIGTERM ends the daemon with exit status 0" [ "$status" = 0 ]
stop "$rig"
f=$work/half.txt
check "what was taken and refused is counted" \
    [ "$(last health "$f" $h_reloads) $(last health "$f" $h_reloads_refused)" = "2 1" ]
check "no sample was lost" [ "$(last health "$f" $h_lost)" = 0 ]
check "nor was the tick without one" within $(($(missing half) - $(missing without))) 0 20

refused() { # EFFECT PARAMETER VALUE: with exit status 2, the file named
    model "$@"
    "$BIN/digsightd" -c "$work/tcp.yaml" --check >"$work/err" 2>&1
    [ $? = 2 ] && grep -q model.json "$work/err"
}
check "a parameter the effect does not have is refused" refused bucket_weight mass_lb 250
check "a machine that cannot be is refused" refused bucket_weight mass_kg -5000
check "an effect no table at hand tells is refused" refused cohesion cohesion_Jpm3 1e4
hash=$(printf 'c%.0s' {1..64})
check "a model of another scene is refused" refused bucket_weight mass_kg 250
finish
