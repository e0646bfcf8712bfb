#!/bin/bash
# digtable submit on a real Slurm: two at once, a task killed, a task that fails, a shard begun twice, sbatch that is not
# there or refuses, a controller that is gone. In the end the table of one machine, byte by byte.
. tests/system/digtable_lib.bash
. tests/system/slurm.bash

missing=
for program in munged slurmctld slurmd sbatch squeue scontrol; do command -v $program >/dev/null || missing=yes; done
if [ -n "$missing" ]; then
    # shellcheck disable=SC2016
    [ -n "${DIG_NO_SKIP-}" ] && check "Slurm is installed, by \`scripts/setup.sh test\`" false || skip_check "Slurm" "not installed"
    finish
fi

grid=tests/data/formats/grid.yaml # 6 points x 2 packings x 1 trajectory: 4 digs a shard
folder="$work/an analyst's \"best\"; \$HOME"
table="$folder/table.sqlite"
jobs=$table.jobs
mkdir "$folder"

submit() { digtable submit $scene $grid -o "$table" --tasks 3 "$@"; }
state() { # KEY: of status --json
    "$BIN/digtable" status "$table" --json 2>"$work/err" | sed -n "s/^ \"$1\": \"\{0,1\}\([^\",]*\)\"\{0,1\},\$/\1/p"
}
state_is() { [ "$(state "$1")" = "$2" ]; }
tasks_queued() { squeue -h -a -r -o %K | grep -c '^[0-9]'; }
merges_queued() { squeue -h -a -o %K | grep -c '^N/A'; }
# The digtable that computes a shard works in the job folder; the oldest is the sweep, not a worker of its own.
computes() { # SHARD: its process
    local pid
    for pid in $(pgrep -f "digtable generate scene.yaml grid.yaml -o part/$1.sqlite --shard $1/3"); do
        [ "$(readlink "/proc/$pid/cwd")" = "$jobs" ] && { echo "$pid"; return 0; }
    done
    return 1
}
stop_process() { # SHARD: as soon as it is computed, until it is killed or goes on; its process in $pid
    wait_until 120 computes "$1" && pid=$(computes "$1") && kill -STOP "$pid"
}

# Without Slurm.
PATH_BEFORE=$PATH
mkdir "$work/few"
PATH=$work/few submit
check "without sbatch on PATH it says so and plans nothing" eval 'is $code 2 && grep -q "sbatch: No such file.*expected on PATH" $work/err && [ ! -e "$jobs" ]'
PATH=$PATH_BEFORE

check "munged, slurmctld and two slurmd run" slurm_start
[ "$failed" = 0 ] || finish

submit --partition nowhere
check "what sbatch refuses is said in its words, with 2" eval 'is $code 2 && grep -q "sbatch: .*Invalid partition" $work/err && is $(tasks_queued) 0'
check "nothing of it counts as begun" eval 'is "$(state waiting)" 3 && is "$(state failed)" 0'

mkdir "$work/%a"
digtable submit $scene $grid -o "$work/%a/table.sqlite"
check "a name that Slurm would replace a part of is refused" eval 'is $code 2 && grep -q "without % and" $work/err && is $(tasks_queued) 0'

# Two at the same time, before anything runs: the nodes take nothing yet.
scontrol update PartitionName=dig State=DOWN

# One that is killed when its array is queued, and before it knows.
mkdir "$work/cut"
cat >"$work/cut/sbatch" <<EOF
#!/bin/sh
$(command -v sbatch) "\$@"
case "\$*" in *--array=*) kill -KILL \$PPID ;; esac
EOF
chmod +x "$work/cut/sbatch"
PATH=$work/cut:$PATH digtable submit $scene $grid -o "$work/cut.sqlite" --tasks 3
check "a submit is killed behind sbatch" eval 'is $code 137 && is $(tasks_queued) 3 && is $(merges_queued) 0'
digtable submit $scene $grid -o "$work/cut.sqlite"
check "the next one finds its tasks, and submits the merge alone" \
    eval 'is $code 0 && grep -q "3 pending; the merge submitted" $work/err && is $(tasks_queued) 3 && is $(merges_queued) 1'
scancel --user="$(id -u)"
check "both are taken out of the queue" wait_until 60 queue_is_empty

for i in 1 2; do
    "$BIN/digtable" submit $scene $grid -o "$table" --tasks 3 --time 30 2>"$work/submit$i.err" </dev/null &
    eval "submit$i=$!"
done
wait "$submit1"; code1=$?
wait "$submit2"; code2=$?
check "two at the same time submit each shard once" eval 'is $code1 0 && is $code2 0 && is $(tasks_queued) 3 && is $(merges_queued) 1'
check "one of them says how many, the other that there is nothing" \
    eval 'grep -q "3 submitted as job" $work/submit*.err && grep -q "3 pending; nothing to submit" $work/submit*.err'
check "all are pending" eval 'is "$(state pending)" 3 && is "$(state merge)" pending && is "$(state left_s)" null'
SQUEUE_PARTITION=nowhere submit
check "a filter of the user's own for squeue hides nothing" eval 'is $code 0 && is $(tasks_queued) 3'

# The third one cannot begin: what is no table stands where it is to grow.
echo "no table" >"$jobs/part/3.sqlite"
scontrol update PartitionName=dig State=UP
check "two run" eval 'stop_process 1 && pid1=$pid && stop_process 2 && pid2=$pid'
[ "$failed" = 0 ] || finish
check "status counts them" eval 'is "$(state running)" 2 && is "$(state pending)" 1'
submit
check "submit leaves what runs and what is pending alone" eval 'is $code 0 && grep -q "nothing to submit" $work/err && is $(tasks_queued) 3'

# A shard begun twice: by hand, while the first is at it.
sbatch --parsable --array=2 --job-name=twice --chdir="$jobs" --output="log/twice.log" "$jobs/run.sh" >"$work/out" 2>"$work/err"
kill -KILL "$pid1" # one task is killed; the one that fails comes next, then the one that is there already
check "the one killed, the one that fails and the second of one shard end" wait_until 120 eval '[ "$(tasks_queued)" = 1 ]'
check "the second says why" grep -q "2.sqlite: another process is adding to this table" "$jobs/log/twice.log"
check "two failed, and the merge waits for the one that runs" eval 'is "$(state failed)" 2 && is "$(state running)" 1 && is "$(state merge)" pending'
digtable status "$table"
check "and status says what of" eval 'grep -q "^shard 1 failed: Killed" $work/out && grep -q "^shard 3 failed: digtable: part/3.sqlite: not a digsight table" $work/out'
kill -CONT "$pid2"
check "the other is done" wait_until 120 state_is done 1
check "no merge of a part" eval 'wait_until 60 queue_is_empty && is "$(state merge)" failed && [ ! -e "$table" ]'

rm "$jobs/part/3.sqlite"
submit
check "the same command submits what failed, and only that" eval 'is $code 0 && grep -q "1 done.*2 submitted as job" $work/err && is "$(tail -n 2 "$jobs/slurm" | cut -d" " -f2 | xargs)" "1,3 merge"'
check "then all are merged" wait_until 240 test -e "$table"
check "and all is done" eval 'is "$(state done)" 3 && is "$(state merge)" done && is "$(state digs_done)" 12 && wait_until 60 queue_is_empty'

digtable generate $scene $grid -o "$work/one.sqlite"
check "on one machine" is "$code" 0
for what in "" --runs; do
    digtable export "$work/one.sqlite" $what -o "$work/one.csv"
    digtable export "$table" $what
    check "the same is computed, byte by byte: export $what" cmp "$work/one.csv" "$work/out"
done
"$BIN/digtable" merge "$work/by_hand.sqlite" "$jobs/shards" "$jobs/shards/2.sqlite"
check "the file is what one machine merges of the shards, one of them twice" cmp "$table" "$work/by_hand.sqlite"
submit
check "once more, and there is nothing to do" eval 'is $code 0 && grep -q "3 done.*nothing to submit" $work/err && queue_is_empty'

mv "$table" "$work/kept.sqlite"
slurm_stop
digtable status "$table"
check "where the queue does not answer, nothing is guessed" eval 'is $code 1 && grep -q "squeue: " $work/err'
submit
check "nor submitted" eval 'is $code 1 && grep -q "squeue: " $work/err'
finish
