#!/bin/bash
# digtable submit and status without a queue: a table in shards on this machine, one of which fails, interrupted, with a
# shard that is damaged, with another plan. Slurm has tests/system/slurm.sh.
. tests/system/digtable_lib.bash

grid=tests/data/formats/grid.yaml # 6 points x 2 packings x 1 trajectory
folder="$work/it's a \"folder\"; touch %a \$(touch x) \`touch y\` \\"
mkdir "$folder"
table="$folder/-o.sqlite"
jobs=$table.jobs
submit() { digtable submit $scene $grid -o "$table" -j 2 "$@"; }
state() { # KEY: of status --json
    "$BIN/digtable" status "$table" --json | sed -n "s/^ \"$1\": \"\{0,1\}\([^\",]*\)\"\{0,1\},\$/\1/p"
}

digtable status "$table"
check "what was never submitted has no status" eval 'is $code 2 && grep -q "plan.yaml: no such file, expected a table that .digtable submit. computes" $work/err'
digtable submit "$work/no.yaml" $grid -o "$table"
check "a scene that is not there is bad input" eval 'is $code 2 && grep -q "no.yaml" $work/err && [ ! -e "$jobs" ]'
submit --tasks 13
check "more tasks than beds are refused" eval 'is $code 2 && grep -q "tasks 13: the grid has 12 beds" $work/err && [ ! -e "$jobs" ]'
submit --tasks 0
check "and none" eval 'is $code 2 && grep -q "expected 1 to 10000" $work/err'
submit --partition fast
check "options for Slurm are none here" eval 'is $code 2 && grep -q "is for --slurm" $work/err && [ ! -e "$jobs" ]'
digtable submit $scene $grid -o "$work/bad
name.sqlite"
check "a name of two lines is refused" eval 'is $code 2 && grep -q "without control characters" $work/err'
digtable submit $scene $grid -o "$folder/.."
check "and one that is none" is "$code" 2
mkdir -p "$work/taken.sqlite.jobs"
echo mine >"$work/taken.sqlite.jobs/notes"
digtable submit $scene $grid -o "$work/taken.sqlite"
check "so is a folder of somebody else's, which stays" eval 'is $code 2 && grep -q "is in the way" $work/err && is "$(ls "$work/taken.sqlite.jobs")" notes'
# A folder that came with somebody's files: what a submit opens leads nowhere else, and nothing waits.
echo kept >"$work/target"
mkdir "$work/target.d"
for lure in log/1.log log/merge.log lock slurm part shards log plan.yaml; do
    rm -rf "$work/lured.sqlite.jobs"
    mkdir -p "$work/lured.sqlite.jobs/log"
    touch "$work/lured.sqlite.jobs/lock"
    rm -rf "$work/lured.sqlite.jobs/$lure"
    case $lure in
    part | shards | log) ln -s "$work/target.d" "$work/lured.sqlite.jobs/$lure" ;;
    *) ln -s "$work/target" "$work/lured.sqlite.jobs/$lure" ;;
    esac
    digtable submit $scene $grid -o "$work/lured.sqlite"
    check "$lure that is a link is refused, and its target stays" eval 'is $code 2 && grep -q "jobs/$lure: expected a" $work/err && is "$(cat "$work/target")" kept && is "$(ls "$work/target.d")" ""'
    digtable status "$work/lured.sqlite"
    check "status does not follow it either" eval 'is $code 2 && grep -q "jobs/$lure: expected a" $work/err'
done
rm -rf "$work/lured.sqlite.jobs/plan.yaml"
mkfifo "$work/lured.sqlite.jobs/slurm"
digtable submit $scene $grid -o "$work/lured.sqlite"
check "and a pipe makes nobody wait" eval 'is $code 2 && grep -q "jobs/slurm: expected a file" $work/err'
touch "$work/there.sqlite"
digtable submit $scene $grid -o "$work/there.sqlite"
check "and a table that is there" eval 'is $code 2 && grep -q "there.sqlite: exists" $work/err'

# One of four fails: its table cannot be begun.
mkdir -p "$jobs/part"
touch "$jobs/lock" # as a submit leaves it that was killed while it planned
echo "no table" >"$jobs/part/3.sqlite"
submit --tasks 4
check "a shard that fails is named, with why" eval 'is $code 1 && grep -q "1 of 4 shards failed, the first, 3: digtable: part/3.sqlite: not a digsight table" $work/err'
check "the others are done" eval 'is "$(state done)" 3 && is "$(state failed)" 1 && is "$(state digs_done)" 9 && [ ! -e "$table" ]'
check "meanwhile it says how far it is" grep -qE "^[0-9]+ of 12 digs, [0-4] shards running, .* elapsed, .* left$" $work/err
digtable status "$jobs/"
check "status says so of the folder, too" eval 'is $code 0 && grep -q "^shard 3 failed: .*not a digsight table" $work/out && grep -q "s a dig" $work/out'
made=$(stat -c %Y.%i "$jobs"/shards/[124].sqlite)

# Other plans.
digtable submit $scene $grid -o "$table" --tasks 5
check "another number of tasks is refused" eval 'is $code 2 && grep -q "planned with --tasks 4, not 5" $work/err'
digtable submit $scene tests/data/formats/grid_effects.yaml -o "$table"
check "and another grid" eval 'is $code 2 && grep -q "planned with another scene or grid" $work/err'
submit --packings 1
check "and another number of packings" eval 'is $code 2 && grep -q "planned with another scene or grid" $work/err'
submit --engine ode
check "and another engine" eval 'is $code 2 && grep -q "planned with the engine single, not ode" $work/err'
sed -i.kept 's/^version: .*/version: "0.0.1"/' "$jobs/plan.yaml"
submit
check "and another version" eval 'is $code 2 && grep -q "planned with version 0.0.1" $work/err'
mv "$jobs/plan.yaml.kept" "$jobs/plan.yaml"
cp "$jobs/grid.yaml" "$work/kept.yaml"
sed -i 's/packings: 2/packings: 3/' "$jobs/grid.yaml"
submit
check "a copy that was changed is found" eval 'is $code 2 && grep -q "expected them as they were planned" $work/err'
cp "$work/kept.yaml" "$jobs/grid.yaml"

# Somebody is at the one that is left.
rm "$jobs/part/3.sqlite"
"$BIN/digtable" generate $scene $grid -o "$jobs/part/3.sqlite" --shard 3/4 -j 1 -q 2>"$work/hand.err" </dev/null &
pid=$!
for ((i = 0; i < 600; i++)); do [ -s "$jobs/part/3.sqlite" ] && break; sleep 0.05; done
kill -STOP $pid
check "a shard that grows is running" eval 'is "$(state running)" 1 && is "$(state failed)" 0'
submit
check "and not begun again" eval 'is $code 1 && grep -q "1 shards are left, 1 of them computed elsewhere" $work/err'
kill -CONT $pid
wait $pid
submit
check "the same command goes on with what is left, and merges" eval 'is $code 0 && [ -s "$table" ] && is "$(state merge)" done'
check "what was done stays as it is" is "$(stat -c %Y.%i "$jobs"/shards/[124].sqlite)" "$made"
check "no word of the name was run" eval '! ls "$folder" "$jobs" . | grep -qE "^(x|y|%a)$"'
submit
check "and once more there is nothing to do" is "$code" 0
digtable generate $scene $grid -o "$work/one.sqlite" -j 2
digtable export "$work/one.sqlite" --runs -o "$work/one.csv"
digtable export "$table" --runs
check "the runs are those of a table without shards, byte by byte" cmp "$work/one.csv" "$work/out"

# A shard that is damaged is found by the merge.
rm "$table"
cp "$jobs/shards/2.sqlite" "$work/kept.sqlite"
printf 'X' | dd of="$jobs/shards/2.sqlite" bs=1 seek=$(($(stat -c %s "$jobs/shards/2.sqlite") / 2)) conv=notrunc 2>/dev/null
submit
check "a damaged shard is named, with 2" eval 'is $code 2 && grep -q "the merge failed: digtable: shards/2.sqlite: " $work/err && [ ! -e "$table" ] && [ ! -e "$table.part" ]'
check "status says so" eval 'is "$(state merge)" failed'
rm "$jobs/shards/2.sqlite"
submit
check "without it, it is computed again" eval 'is $code 0 && [ -s "$table" ]'
digtable export "$table" --runs
check "and the runs are the same" cmp "$work/one.csv" "$work/out"

# Interrupted, with all it started.
"$BIN/digtable" submit $scene $grid -o "$work/cut.sqlite" --tasks 2 -j 2 2>"$work/err" </dev/null &
pid=$!
for ((i = 0; i < 600; i++)); do [ -s "$work/cut.sqlite.jobs/part/1.sqlite" ] && break; sleep 0.05; done
kill -TERM $pid
wait $pid
code=$?
check "a polite kill ends it with 1, or 0 if it was done" eval '[ $code = 0 ] || { is $code 1 && grep -q "interrupted" $work/err; }'
check "and what it started" eval '! pgrep -f "part/1.sqlite --shard 1/2" >/dev/null'
digtable submit $scene $grid -o "$work/cut.sqlite" -j 2 -q
check "the same command finishes it, -q without a word" eval 'is $code 0 && [ -s "$work/cut.sqlite" ] && [ ! -s $work/err ]'
finish
