# A Slurm cluster of two nodes with one processor each, on this machine alone: munged, slurmctld and two slurmd, all of
# this user. Root gives it a network of its own, a loopback. Source it after tests/system/check.bash.
#   slurm_start    returns when both nodes are idle; sets SLURM_CONF
#   slurm_stop     cancels what is queued and ends the daemons

# A second address: with 127.0.0.1 alone glibc holds that there is no IPv4 here.
alone="ip link set lo up && ip address add 192.0.2.1/32 dev lo"
if [ -z "${SLURM_ALONE-}" ] && unshare --net sh -c "$alone" 2>/dev/null; then
    rm -rf "$work"
    SLURM_ALONE=1 exec unshare --net "$0"
fi
[ -z "${SLURM_ALONE-}" ] || sh -c "$alone"
PATH=$PATH:/usr/sbin:/sbin # the daemons, to an ordinary user
slurm_dir=$work/slurm
slurm_pids=

slurm_config() { # PORT: and the two behind it
    local me host
    me=$(id -un)
    host=$(hostname)
    cat <<EOF
ClusterName=digtest
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$me
SlurmdUser=$me
AuthType=auth/munge
AuthInfo=socket=$slurm_dir/munge.socket
CredType=cred/munge
SlurmctldPort=$1
StateSaveLocation=$slurm_dir/state
SlurmdSpoolDir=$slurm_dir/%n
SlurmctldPidFile=$slurm_dir/slurmctld.pid
SlurmdPidFile=$slurm_dir/%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
KillWait=5
SlurmctldTimeout=600
SlurmdTimeout=600
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$(($1 + 1)) CPUs=1
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$(($1 + 2)) CPUs=1
PartitionName=dig Nodes=n1,n2 Default=YES MaxTime=60 State=UP
EOF
}

daemon() { # NAME COMMAND…: in the background, remembered
    "${@:2}" >"$work/$1.log" 2>&1 </dev/null &
    slurm_pids="$slurm_pids $!"
}

wait_until() { # SECONDS COMMAND…: true as soon as the command is
    local i
    for ((i = 0; i < $1 * 10; i++)); do
        "${@:2}" >/dev/null 2>&1 && return 0
        sleep 0.1
    done
    return 1
}

both_idle() { [ "$(sinfo -h -N -t idle -o %N | sort -u | wc -l)" = 2 ]; }

answers() { timeout 20 scontrol ping | grep -q 'is UP'; }
answers_or_ended() { ! kill -0 "$1" || answers; }

slurm_try() { # PORT
    slurm_config "$1" >"$SLURM_CONF"
    daemon slurmctld slurmctld -D
    wait_until 30 answers_or_ended $! && answers || return 1
    daemon n1 slurmd -D -N n1
    daemon n2 slurmd -D -N n2
    wait_until 60 both_idle
}

slurm_start() {
    local port
    chmod 755 "$work" # munged wants its socket where all may come
    mkdir -p "$slurm_dir"/{state,n1,n2}
    chmod 755 "$slurm_dir"
    export SLURM_CONF=$slurm_dir/slurm.conf
    head -c 128 /dev/urandom >"$slurm_dir/munge.key"
    chmod 400 "$slurm_dir/munge.key"
    daemon munged munged --foreground --num-threads=2 --key-file="$slurm_dir/munge.key" --socket="$slurm_dir/munge.socket" \
        --pid-file="$slurm_dir/munge.pid" --log-file="$slurm_dir/munge.log" --seed-file="$slurm_dir/munge.seed"
    munged=$!
    wait_until 60 munge --socket="$slurm_dir/munge.socket" --no-input || return 1
    # Another program may have one of the ports.
    for port in $((20000 + RANDOM % 9000)) $((20000 + RANDOM % 9000)) $((20000 + RANDOM % 9000)); do
        slurm_try "$port" && return 0
        slurm_end
    done
    return 1
}

slurm_end() { # the daemons but munged
    local pid
    for pid in $slurm_pids; do
        [ "$pid" = "$munged" ] || { kill "$pid" && wait "$pid"; } 2>/dev/null
    done
    slurm_pids=$munged
}

queue_is_empty() { [ -z "$(squeue -h -a)" ]; }

slurm_stop() {
    [ -n "$slurm_pids" ] || return 0
    scancel --user="$(id -u)" 2>/dev/null
    wait_until 30 queue_is_empty
    slurm_end
    kill "$munged" 2>/dev/null
    wait "$munged" 2>/dev/null
    slurm_pids=
}
trap 'slurm_stop; rm -rf "$work"' EXIT
