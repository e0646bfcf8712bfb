#!/bin/bash
# The jar with which lcm-spy decodes our channels: what the daemon publishes, decoded in Java.
. tests/system/daemon_lib.bash

jar=$BIN/../digsight_types.jar lcm_jar=/usr/share/java/lcm.jar
make_digs
"$BIN/digrig" record "$work/simpleA.csv" "$work/simpleA.csv" --machine "$machine" -o "$work/run.csv" 2>"$work/rig.err"
config run "{kind: replay, replay: {file: run.csv, speed: 10}}"
log run
"$BIN/digsightd" -c "$work/run.yaml" 2>"$work/daemon.log" # by the machine's own clock, as in the field
read_log run
check "Java decodes every message of the daemon" \
    eval 'java -cp "$lcm_jar:$jar" tests/system/DecodeLog.java "$work/run.lcm" >"$work/java.txt" 2>"$work/java.err"'
for channel in SAMPLE ESTIMATE MATCH PREDICTION HEALTH; do
    check "DIGSIGHT_$channel is a type of the jar" \
        grep -qi "^DIGSIGHT_$channel digsight.${channel}_t [1-9]" "$work/java.txt"
done
check "and finds as many estimates as C does" \
    [ "$(sed -n 's/^DIGSIGHT_ESTIMATE .* //p' "$work/java.txt")" = "$(grep -c ^estimate "$work/run.txt")" ]
finish
