#!/bin/bash
# digtable submit and status with a queue that runs at once what it is given: a table in shards, one of which fails, with
# a shard that is damaged, with another plan. A real Slurm has tests/system/slurm.sh.
. tests/system/digtable_lib.bash

mkdir "$work/bin"
cat >"$work/bin/sbatch" <<'END'
#!/bin/sh
# In place of Slurm's: computes the shards of --array one by one, or merges, and gives a number.
for word; do
    case $word in
    --version) exit 0 ;;
    --array=*) tasks=$(echo "${word#--array=}" | tr , '\n' | while IFS=- read -r from to; do seq "$from" "${to:-$from}"; done) ;;
    */run.sh) script=$word ;;
    merge) tasks=merge ;;
    esac
done
for task in $tasks; do sh "$script" "$task" || true; done
echo 1
END
printf '#!/bin/sh\n' >"$work/bin/squeue"
chmod +x "$work/bin/"*
PATH=$work/bin:$PATH

grid=tests/data/formats/grid.yaml # 6 points x 2 packings x 1 trajectory
folder="$work/it's a \"folder\"; touch z \$(touch x) \`touch y\`"
mkdir "$folder"
table="$folder/-o.sqlite"
jobs=$table.jobs
submit() { digtable submit $scene $grid -o "$table" "$@"; }
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
check "four are submitted" eval 'is $code 0 && grep -q "4 submitted as job 1" $work/err'
check "the others are done" eval 'is "$(state done)" 3 && is "$(state failed)" 1 && is "$(state digs_done)" 9 && [ ! -e "$table" ]'
digtable status "$table"
check "one that fails is named, with why" eval 'is $code 0 && grep -q "^shard 3 failed: digtable: part/3.sqlite: not a digsight table" $work/out && grep -q "s a dig" $work/out'
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
check "and not begun again" eval 'is $code 0 && grep -q "3 done, 1 running, 0 pending; the merge submitted" $work/err && [ ! -e "$table" ]'
kill -CONT $pid
wait $pid
submit
check "the same command goes on with what is left, and merges" eval 'is $code 0 && [ -s "$table" ] && is "$(state merge)" done'
check "what was done stays as it is" is "$(stat -c %Y.%i "$jobs"/shards/[124].sqlite)" "$made"
check "no word of the name was run" eval '! ls "$folder" "$jobs" . | grep -qE "^(x|y|z)$"'
submit
check "and once more there is nothing to do" eval 'is $code 0 && grep -q "nothing to submit" $work/err'
digtable generate $scene $grid -o "$work/one.sqlite" -j 2
digtable export "$work/one.sqlite" --runs -o "$work/one.csv"
digtable export "$table" --runs
check "the runs are those of a table without shards, byte by byte" cmp "$work/one.csv" "$work/out"

# A shard that is damaged is found by the merge.
rm "$table"
cp "$jobs/shards/2.sqlite" "$work/kept.sqlite"
printf 'X' | dd of="$jobs/shards/2.sqlite" bs=1 seek=$(($(stat -c %s "$jobs/shards/2.sqlite") / 2)) conv=notrunc 2>/dev/null
submit
digtable status "$table"
check "a damaged shard is named" eval 'grep -q "^merge failed: digtable: shards/2.sqlite: " $work/out && [ ! -e "$table" ] && [ ! -e "$table.part" ]'
rm "$jobs/shards/2.sqlite"
submit
check "without it, it is computed again" eval 'is $code 0 && [ -s "$table" ]'
digtable export "$table" --runs
check "and the runs are the same" cmp "$work/one.csv" "$work/out"

digtable submit $scene $grid -o "$work/quiet.sqlite" --tasks 2 -q
check "-q: without a word" eval 'is $code 0 && [ -s "$work/quiet.sqlite" ] && [ ! -s $work/err ]'
finish
