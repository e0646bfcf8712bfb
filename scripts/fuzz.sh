#!/bin/bash
# Runs fuzzers that libFuzzer leads by coverage: FUZZERS=FOLDER scripts/fuzz.sh SECONDS TARGET…
# SECONDS are of processor time, each target's own: how busy the machine is changes nothing but how long it takes.
# Each begins with what tests/fuzz/corpus/TARGET holds and with seeds made of the tree's own examples, and keeps
# what reached something new in $CORPORA (build/fuzz-corpora). Prints a line a target; what broke one is
# left in $CORPORA/TARGET.found.
set -u
seconds=${1:?}
shift
fuzzers=${FUZZERS:?} corpora=${CORPORA:-build/fuzz-corpora}
# Inputs are files: in memory, where there is such a disk.
FUZZ_DIR=$(mktemp -d -p /dev/shm 2>/dev/null || mktemp -d)
export FUZZ_DIR
trap 'rm -rf "$FUZZ_DIR"' EXIT

hex() { # BYTES… in hex, as they are
    # shellcheck disable=SC2059 # the format is the text
    printf "$(printf '%s' "$*" | tr -d ' ' | sed 's/../\\x&/g')"
}
prefixed() { # BYTE FILE…: each file behind the byte that names its reader
    local byte=$1 file
    shift
    for file in "$@"; do
        { printf '%s' "$byte"; cat "$file"; } >"$byte.$(basename "$file")"
    done
}
seed() { # TARGET, into the folder it stands in
    local tree=$OLDPWD formats=$OLDPWD/tests/data/formats line cell n=0
    case $1 in
    dbc | can_map) cp "$tree"/config/can/*.dbc "$tree"/tests/data/sealed/*.dbc . ;;
    recording_csv) cp "$formats"/*recording*.csv . ;;
    bed_csv) cp "$formats/bed.csv" "$formats/curves.csv" . ;;
    campaign_yaml) cp "$formats/campaign/campaign.yaml" "$formats/plan.yaml" . ;;
    lcm_log) cp "$formats/daemon.lcm" . ;;
    model_json) cp "$formats/model.json" . ;;
    identity_json) cp "$formats/identity.json" . ;;
    config_yaml)
        prefixed c "$tree"/config/digsightd*.yaml "$formats/digsightd.yaml"
        prefixed s "$formats"/scene*.yaml "$tree/config/scenes/rig.yaml"
        prefixed g "$formats"/grid*.yaml "$tree/config/grids/reference_rig.yaml"
        prefixed m "$formats"/machine*.yaml "$tree/config/machines/zx200.yaml"
        prefixed r "$tree"/config/signals/modbus*.yaml
        prefixed a "$tree/config/signals/zx200_can.yaml"
        prefixed f "$formats/curve_map.yaml"
        ;;
    table) # bytes of the header and of a page; cells of every column: a number, a whole one, a blob
        hex 000000 10 53514c69746520666f726d6174203300 >head
        hex 640000 04 0d000000 >page
        for ((n = 0; n < 54; n++)); do
            cell=$(printf '%02x' $n)
            hex "$cell" 0180 08 000000000000f03f >"number$n"
            hex "$cell" 0180 01 02 00 >"whole$n"
            hex "$cell" 0180 03 616263 00 >"blob$n"
        done
        ;;
    can_frame)
        while read -r line; do
            hex 00 "$(printf '%02x' $((n++ % 8)))" 08 00ff "${line#*#}" >"frame$n"
        done <"$tree/tests/fuzz/corpus/can.txt"
        cat frame* >all && mv all frames
        ;;
    modbus_answer)
        while read -r line; do
            hex 00 "$(printf '%02x' $((${#line} / 2)))" "$line" >"answer$((n++))"
        done <"$tree/tests/fuzz/corpus/modbus.txt"
        cat answer* >all && mv all answers
        ;;
    esac
}

# Runs a command until it has had so much of the processor; its exit status in $status, what it had in $cpu_s.
for_cpu() { # SECONDS COMMAND…
    local stat
    cpu_s=0
    "${@:2}" &
    while sleep 0.5 && read -r -a stat <"/proc/$!/stat"; do
        cpu_s=$(((stat[13] + stat[14]) / $(getconf CLK_TCK)))
        [ $cpu_s -lt "$1" ] || kill -USR1 $! # libFuzzer ends with its figures
    done 2>/dev/null
    wait $!
    status=$?
}

failed=0 ran=0
for target in "$@"; do
    corpus=$corpora/$target kept=tests/fuzz/corpus/$target log=$corpora/$target.log
    mkdir -p "$corpus" "$corpora/$target.found"
    (cd "$corpus" && OLDPWD=$OLDPWD seed "$target") || exit 2
    folders=("$corpus")
    [ -d "$kept" ] && folders+=("$kept")
    begun=$(ls "$corpora/$target.found" | wc -l)
    # shellcheck disable=SC2086 # options
    for_cpu "$seconds" "$fuzzers/$target" -timeout=20 -rss_limit_mb=2048 -print_final_stats=1 -use_value_profile=1 \
        -max_len=65536 -artifact_prefix="$corpora/$target.found/" ${FUZZ_OPTIONS-} "${folders[@]}" >"$log" 2>&1
    found=$(($(ls "$corpora/$target.found" | wc -l) - begun))
    awk -v target="$target" -v found=$found -v cpu_s="$cpu_s" '
        $1 == "stat::number_of_executed_units:" { runs = $2 }
        $2 ~ /^(INITED|NEW|REDUCE|pulse|DONE|RELOAD)$/ { for (i = 1; i < NF; i++) if ($i == "cov:") { if (!first) first = $(i + 1); last = $(i + 1) } }
        END { printf "%-15s %10d executions in %d s of processor time, coverage %d to %d, findings %d\n", target, runs, cpu_s, first, last, found }' "$log"
    [ $status = 0 ] || { failed=$((failed + 1)); tail -n 30 "$log"; }
    ran=$((ran + 1))
done
echo "$((ran - failed)) passed, $failed failed"
[ $failed = 0 ]
