#!/bin/bash
# A disk that is full when the gravel known is to be kept: said, what was kept before stays whole, the match
# is published; and the next dig is kept when there is room again. The disk is a tmpfs of a few kilobytes.
. tests/system/daemon_lib.bash

if ! unshare -Urm mount -t tmpfs tmpfs /mnt 2>/dev/null; then
    skip_check "a disk that is full" "no file system can be mounted here, not even in a namespace"
    finish
fi
make_digs
"$BIN/digrig" record "$work/simpleA.csv" --machine "$machine" -o "$work/one.csv" 2>"$work/one.err"
"$BIN/digrig" record "$work/simpleA.csv" "$work/simpleA.csv" "$work/simpleA.csv" "$work/simpleA.csv" --machine "$machine" \
    -o "$work/four.csv" 2>"$work/four.err"
config first "{kind: replay, replay: {file: one.csv, speed: 10}}" "match: {state: match.json}"
run "$work/first.log" "$BIN/digsightd" -c "$work/first.yaml"
check "where there is room the gravel known is kept" [ -s "$work/match.json" ]

# Room for what is there and one page more.
mkdir "$work/disk"
pages=$((($(stat -c %s "$work/match.json") + 4095) / 4096 + 1))
config full "{kind: replay, replay: {file: four.csv, speed: 5}}" "match: {state: disk/match.json}
tick_Hz: 250"
logs_itself full full
# shellcheck disable=SC2016 # expanded by the inner shell
start "$work/full.log" unshare -Urm bash -c 'mount -t tmpfs -o size="$1" tmpfs "$2/disk" && cp -p "$2/match.json" "$2/disk" &&
    exec "$3" -c "$2/full.yaml"' - $((pages * 4096)) "$work" "$(realpath "$BIN/digsightd")"
daemon=$started
disk=/proc/$daemon/root$work/disk # as the daemon sees it
check "what was kept is known at start" wait_for 30 grep -q "from before (" "$work/full.log"
check "a disk that is full is said" wait_for 60 grep -q "disk/match.json.*: No space left on device" "$work/full.log"
check "what was kept before is whole" cmp -s "$work/match.json" "$disk/match.json"
check "and nothing half written lies beside it" [ "$(ls "$disk")" = match.json ]
check "room is made" nsenter -U --preserve-credentials -m -t "$daemon" mount -o remount,size=1m "$work/disk"
digs_kept() { # COUNT: that many, or more
    [ "$(grep -c moment_Nm "$disk/match.json")" -ge "$1" ]
}
before=$(grep -c moment_Nm "$work/match.json")
check "a dig after that is kept, with those before" wait_for 60 digs_kept $((before + 2))
ends "$daemon"
check "the daemon ends with exit status 0" [ "$status" = 0 ]
read_log full
f=$work/full.txt
check "each dig was matched all the same" [ "$(last health "$f" $h_matches)" = 4 ]
check "the gravel is identified" identified "$f"
finish
