#!/bin/bash
# A table computed under kill -9, with workers that die and a disk that is full: nothing is lost, nothing
# is computed twice, and what comes out is what an undisturbed computation gives.
. tests/system/digtable_lib.bash

grid=tests/data/formats/grid.yaml # 6 points x 2 packings x 1 trajectory
sed 's/young_Pa: 5.0e+6/young_Pa: 1.25e+6/' $scene >"$work/tub.yaml" # softer grains, half as many steps
scene=$work/tub.yaml

made() { sqlite3 "$1" "SELECT group_concat(key || ' ' || made_utc || ' ' || wall_s) FROM (SELECT ground || '/' || packing AS key, made_utc, wall_s FROM run ORDER BY id LIMIT $2)"; }

digtable generate $scene $grid -o "$work/whole.sqlite"
check "an undisturbed table" is "$code" 0
digtable export "$work/whole.sqlite" --runs -o "$work/whole.csv"

# Kill -9 some instant after the first new run: each attempt goes on behind what the last one left, whose rows stay as
# they are, dates and wall times included.
kept=yes grew=0
for attempt in $(seq 1 5); do
    before=0
    [ -e "$work/killed.sqlite" ] && before=$(runs "$work/killed.sqlite")
    was=
    [ "$before" != 0 ] && was=$(made "$work/killed.sqlite" "$before")
    "$BIN/digtable" generate $scene $grid -o "$work/killed.sqlite" -j 2 2>/dev/null </dev/null &
    pid=$!
    for _ in $(seq 1 300); do
        [ "$(runs "$work/killed.sqlite")" -gt "$before" ] && break
        sleep 0.05
    done
    sleep "0.$((RANDOM % 3))$((RANDOM % 10))"
    kill -KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
    [ -s "$work/killed.sqlite" ] || continue
    "$BIN/digtable" check "$work/killed.sqlite" >/dev/null 2>"$work/err" || grep -q "no rows" "$work/err" || kept=no
    after=$(runs "$work/killed.sqlite")
    [ "$after" -gt "$before" ] && grew=$((grew + 1))
    [ "$after" -ge "$before" ] && { [ "$before" = 0 ] || [ "$(made "$work/killed.sqlite" "$before")" = "$was" ]; } || kept=no
done
check "5 times kill -9: every run that was stored stays, in a sound table" eval 'is $kept yes && [ $grew -ge 3 ]'
digtable generate $scene $grid -o "$work/killed.sqlite"
check "the same command finishes it" eval 'is $code 0 && grep -q "12 of 12 digs" $work/err'
digtable export "$work/killed.sqlite" --runs
check "into the table of an undisturbed computation, byte by byte (it grew in $grew of the attempts)" cmp "$work/whole.csv" "$work/out"

# A worker that is killed is given its bed once more.
"$BIN/digtable" generate $scene $grid -o "$work/worker.sqlite" -j 1 2>"$work/err" </dev/null &
pid=$!
hit=no
for _ in $(seq 1 200); do
    worker=$(cat "/proc/$pid/task/$pid/children" 2>/dev/null)
    # shellcheck disable=SC2086 # there is one
    [ -n "$worker" ] && kill -KILL $worker 2>/dev/null && { hit=yes; break; }
    sleep 0.01
done
wait $pid
code=$?
check "a worker was killed, and the table is complete" eval 'is $hit yes && is $code 0 && grep -q "12 of 12 digs" $work/err'
digtable export "$work/worker.sqlite" --runs
check "with the same runs" cmp "$work/whole.csv" "$work/out"

# A limit of the file's size stands for a full disk: SQLite's write fails in the same way.
size=$(($(stat -c %s "$work/whole.sqlite") / 1024))
(trap '' XFSZ; ulimit -f $((size / 2)); exec "$BIN/digtable" generate $scene $grid -o "$work/full.sqlite" -j 2) 2>"$work/err" </dev/null
code=$?
check "a full disk ends it with 1 and says so" eval 'is $code 1 && grep -qE "full.sqlite: (disk|database or disk)" $work/err'
digtable check "$work/full.sqlite"
check "what is stored is sound" eval 'is $code 0 && [ $(runs "$work/full.sqlite") -gt 0 ] && [ $(runs "$work/full.sqlite") -lt 12 ]'
digtable generate $scene $grid -o "$work/full.sqlite"
check "and with room it is finished" eval 'is $code 0 && grep -q "12 of 12 digs" $work/err'
digtable export "$work/full.sqlite" --runs
check "with the same runs as ever" cmp "$work/whole.csv" "$work/out"
(trap '' XFSZ; ulimit -f 8; exec "$BIN/digtable" merge "$work/merged.sqlite" "$work/whole.sqlite") 2>"$work/err" </dev/null
code=$?
check "a merge onto a full disk leaves nothing behind" eval 'is $code 1 && ! ls $work | grep -q ^merged'
# A table's file takes the place of no stream that is closed: what is said there would be written over it.
digtable generate $scene $grid -o "$work/closed.sqlite" --shard 1/12 -q
"$BIN/digtable" generate $scene $grid -o "$work/closed.sqlite" --shard 2/12 0<&- 1>&- 2>&-
digtable check "$work/closed.sqlite"
check "with every stream closed a table grows and stays sound" eval 'is $code 0 && is $(runs "$work/closed.sqlite") 2'
"$BIN/digtable" list "$work/closed.sqlite" 2>"$work/err" </dev/null >&-
check "a list for an output that is closed is told" eval 'is $? 1 && grep -q "^digtable: standard output: Bad file descriptor" $work/err'
(trap '' XFSZ; ulimit -f 1; exec "$BIN/digtable" dig $scene --trajectory scrape --friction .5 --rolling .2 --density 2500 -o "$work/curve.csv") 2>"$work/err" </dev/null
code=$?
check "a curve that does not fit neither" eval 'is $code 1 && grep -q "curve.csv" $work/err && ! ls $work | grep -q ^curve'
finish
