#!/bin/bash
# kill -9 at random instants over generate, merge and import: what was stored stays, byte by byte, and the same
# command goes on to the same table.
. tests/system/digtable_lib.bash
. tests/torture/torture.bash

grid=tests/data/formats/grid.yaml # 12 digs
map=tests/data/formats/curve_map.yaml
first=$work/first.sqlite whole=$work/whole.sqlite

"$BIN/digtable" generate $scene $grid -o "$whole" 2>/dev/null
generate_us=$(microseconds_of "$BIN/digtable" generate $scene $grid -o "$work/timed.sqlite" -j 2)
"$BIN/digtable" export "$whole" --runs -o "$work/whole.csv"
cut -d, -f1-6,10-14 "$work/whole.csv" >"$work/curves.csv"
sed 's/^0.3,/0.4,/; s/^0.6,/0.7,/' "$work/curves.csv" >"$work/other.csv"
"$BIN/digtable" generate $scene $grid -o "$first" --shard 1/2 2>/dev/null
"$BIN/digtable" generate $scene $grid -o "$work/second.sqlite" --shard 2/2 2>/dev/null
merge_us=$(microseconds_of "$BIN/digtable" merge "$work/merged_once.sqlite" "$first" "$work/second.sqlite")
cp "$first" "$work/import_once.sqlite"
import_us=$(microseconds_of "$BIN/digtable" import "$work/other.csv" --map $map -o "$work/import_once.sqlite")
"$BIN/digtable" export "$work/import_once.sqlite" --runs | cut -d, -f1-5,10-14 >"$work/imported.csv"

runs() { sqlite3 "$1" 'SELECT count(*) FROM run' 2>/dev/null | grep . || echo 0; }
stored() { sqlite3 "$1" "SELECT hex(curve) || made_utc || wall_s FROM (SELECT * FROM run ORDER BY id LIMIT $2)" | sha256sum; }
sound() { # TABLE
    "$BIN/digtable" check "$1" >/dev/null 2>"$work/err" || grep -q "no rows" "$work/err"
}

generates=0 generated=0 before=0 was= table=$work/killed.sqlite
torture_generate() {
    kill_within $((generate_us / 2)) "$BIN/digtable" generate $scene $grid -o "$table" -j 2
    [ $killed = yes ] && generates=$((generates + 1))
    [ -s "$table" ] || return 0
    sound "$table" || fault "generate: the table is not sound"
    local now
    now=$(runs "$table")
    [ "$now" -ge "$before" ] || fault "generate: $before digs were stored, $now are left"
    [ "$before" = 0 ] || [ "$(stored "$table" "$before")" = "$was" ] || fault "generate: a stored dig changed"
    before=$now was=$(stored "$table" "$now")
    [ "$now" = 12 ] || return 0
    "$BIN/digtable" generate $scene $grid -o "$table" 2>/dev/null
    "$BIN/digtable" export "$table" --runs | cmp -s - "$work/whole.csv" || fault "generate: other bytes than undisturbed"
    rm -f "$table"
    generated=$((generated + 1)) before=0
}

merges=0
torture_merge() {
    local out=$work/merged.sqlite
    kill_within "$merge_us" "$BIN/digtable" merge "$out" "$first" "$work/second.sqlite"
    [ $killed = yes ] && merges=$((merges + 1))
    [ ! -e "$out" ] || cmp -s "$out" "$work/merged_once.sqlite" || fault "merge: half a table under its name"
    [ -e "$out" ] || "$BIN/digtable" merge "$out" "$first" "$work/second.sqlite" 2>"$work/err" ||
        fault "merge: does not go on after a kill"
    cmp -s "$out" "$work/merged_once.sqlite" || fault "merge: other bytes than undisturbed"
    rm -f "$out"
}

imports=0
torture_import() {
    local out=$work/import.sqlite had
    [ -e "$out" ] || cp "$first" "$out"
    had=$(runs "$out")
    kill_within "$import_us" "$BIN/digtable" import "$work/other.csv" --map $map -o "$out"
    [ $killed = yes ] && imports=$((imports + 1))
    sound "$out" || fault "import: the table is not sound"
    if [ "$(runs "$out")" = "$had" ]; then
        "$BIN/digtable" import "$work/other.csv" --map $map -o "$out" 2>"$work/err" || fault "import: does not go on after a kill"
    fi
    "$BIN/digtable" export "$out" --runs | cut -d, -f1-5,10-14 | cmp -s - "$work/imported.csv" ||
        fault "import: other digs than undisturbed"
    rm -f "$out"
}

while going; do
    torture_generate
    for _ in 1 2 3 4 5; do
        torture_merge
        torture_import
    done
done
told $generates "kill -9 of generate ($generated tables finished)"
told $merges "kill -9 of merge"
told $imports "kill -9 of import"
check "kill -9 loses nothing that was stored, and the same command goes on to the same bytes" [ $wrong = 0 ]
finish
