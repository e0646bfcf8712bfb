#!/bin/bash
# Two generates on one table at once, one or both of them killed now and then: one writes, the other is refused or
# waits its turn; the table is as ever.
. tests/system/digtable_lib.bash
. tests/torture/torture.bash

grid=$work/grid.yaml # 3 digs, a fraction of a second
printf 'friction: [0.3, 0.6, 0.9]\nrolling: [0.1]\ndensity_kgpm3: [2500]\npackings: 1\n' >"$grid"
one_us=$(microseconds_of "$BIN/digtable" generate $scene "$grid" -o "$work/whole.sqlite" -j 1)
"$BIN/digtable" export "$work/whole.sqlite" --runs -o "$work/whole.csv"
table=$work/table.sqlite rounds=0 pairs=0 refused=0 kills=0
one() { # WORDS
    "$BIN/digtable" generate $scene "$grid" -o "$table" -j 1 >/dev/null 2>"$1" </dev/null &
}
while going; do
    one "$work/a.err"
    a=$!
    share_of $((one_us / 2))
    sleep "$share"
    one "$work/b.err"
    b=$!
    pairs=$((pairs + 1))
    if [ $((RANDOM % 2)) = 0 ]; then
        share_of "$one_us"
        sleep "$share"
        kill -KILL $a 2>/dev/null && kills=$((kills + 1))
    fi
    wait $a 2>/dev/null
    code_a=$?
    wait $b 2>/dev/null
    code_b=$?
    cat "$work/a.err" "$work/b.err" >"$work/err"
    told_so=$(grep -c "another process is adding" "$work/err")
    refused=$((refused + told_so))
    for code in $code_a $code_b; do
        case $code in 0 | 137) ;; 1) [ "$told_so" = 1 ] || fault "refused for another reason" ;; *) fault "exit status $code" ;; esac
    done
    "$BIN/digtable" check "$table" >/dev/null 2>"$work/err" || grep -q "no rows" "$work/err" || fault "the table is not sound"
    [ "$(sqlite3 "$table" 'SELECT count(*) FROM run' 2>/dev/null)" = 3 ] || continue
    "$BIN/digtable" export "$table" --runs | cmp -s - "$work/whole.csv" || fault "other bytes than one generate's"
    rounds=$((rounds + 1))
    rm -f "$table"
done
told $pairs "two generates on one table ($refused refused, $kills killed, $rounds tables finished)"
check "two generates on one table make the table that one makes" [ $wrong = 0 ]
finish
