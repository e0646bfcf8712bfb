#!/bin/bash
# A disk that is full, at every size, and one that cannot be written: it is said, nothing is half made, and what was
# there stays.
. tests/system/daemon_lib.bash
. tests/torture/torture.bash
. tests/torture/programs.bash

programs_prepare
programs_undisturbed
writers="daemon_run table_merge table_import table_export predict record"

# A limit of a file's size stands for a full disk.
runs=0 refusals=0
declare -A most
for program in $writers; do
    run_program "$program"
    most[$program]=$(($(stat -c %s "$work"/made.* | sort -n | tail -n 1) / 1024 + 1))
done
while going; do
    for program in $writers; do
        kB=$((RANDOM % (most[$program] + 1)))
        # shellcheck disable=SC2016 # expanded by the inner shell
        run_program "$program" bash -c 'trap "" XFSZ; ulimit -f "$1"; shift; exec "$@"' - $kB
        judge_program "$program" "$kB kB of room"
        runs=$((runs + 1))
        [ "$code" = 0 ] || refusals=$((refusals + 1))
    done
done
told $runs "programs on a disk that is full after 0 to ${most[table_merge]} kB ($refusals refused)"

if unshare -Urm mount -t tmpfs tmpfs /mnt 2>/dev/null; then
    # shellcheck disable=SC2016 # expanded by the inner shell
    unshare -Urm bash -c 'mount --bind "$1" "$1" && mount -o remount,ro,bind "$1" && shift && exec "$@"' - "$work" \
        env BIN="$(realpath "$BIN")" bash -c '
        cd "$1"
        fails() { "$@" >/dev/null </dev/null && echo "done: $*"; }
        fails "$BIN/digtable" merge made.sqlite table.sqlite
        fails "$BIN/digtable" generate "$2/tests/data/formats/scene.yaml" "$2/tests/data/formats/grid.yaml" -o grid.sqlite
        fails "$BIN/digtable" import curves.csv --map "$2/tests/data/formats/curve_map.yaml" -o made.sqlite
        fails "$BIN/digtable" import curves.csv --map "$2/tests/data/formats/curve_map.yaml" -o grid.sqlite
        fails "$BIN/digtable" export table.sqlite -o made.csv
        fails "$BIN/digloop" predict table.sqlite --identified id.json --trajectory actual -o made.csv
        "$BIN/digsightd" -c replay.yaml >/dev/null || echo "the daemon ended with $?"
        ' - "$work" "$PWD" >"$work.ro" 2>"$work.ro.err"
    cp "$work.ro" "$work/ro" && cp "$work.ro.err" "$work/ro.err"
    rm -f "$work.ro" "$work.ro.err"
    [ ! -s "$work/ro" ] || fault "read-only: $(cat "$work/ro")"
    said=$(grep -c "Read-only file system\|readonly database\|unable to open" "$work/ro.err")
    [ "$said" -ge 7 ] || fault "read-only: said $said times of 7: $(cat "$work/ro.err")"
    told 7 "programs on a disk that cannot be written"
else
    skip_check "a disk that cannot be written" "no file system can be mounted here, not even in a namespace"
fi
check "a disk without room, or read-only, is said, and nothing is half made" [ $wrong = 0 ]
finish
