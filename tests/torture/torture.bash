# What the torture scripts share. Each goes on for $TORTURE_S seconds (30 unless told) and prints what it counted:
#   count NUMBER WHAT
# make torture makes a table of these lines. Sourced from the repository's root, behind tests/system/check.bash,
# digtable_lib.bash or daemon_lib.bash.
TORTURE_S=${TORTURE_S:-30}

# On the machine's own clock: what is tried is how programs live with it. SIMULATED=yes, set before, leaves the simulated
# clock of daemon_lib.bash.
if [ -z "${SIMULATED-}" ]; then
    export -n DIG_SIMCLOCK 2>/dev/null
    children=()

    pass() { # SECONDS
        sleep "$1"
    }

    start() { # OUTPUT COMMAND…
        "${@:2}" >"$1" 2>"${errors:-/dev/stdout}" </dev/null &
        started=$!
        children+=("$started")
    }

    ends() { # PID [SECONDS]: waits until a process we started has ended; its exit status is kept in $status
        local waited=0
        until ! kill -0 "$1" 2>/dev/null || [ $((waited++)) -ge $((${2:-1000} * 20)) ]; do sleep 0.05; done
        kill -KILL "$1" 2>/dev/null
        wait "$1" 2>/dev/null
        status=$?
    }
fi

told() { # NUMBER WHAT
    echo "count $1 $2"
}

# True until this script's time is over, which begins with the first call.
torture_end=
going() {
    torture_end=${torture_end:-$((SECONDS + TORTURE_S))}
    [ $SECONDS -lt $torture_end ]
}

# A random share of so many microseconds, in seconds, into $share.
share_of() { # MICROSECONDS
    local us=$(($1 * (RANDOM * 32768 + RANDOM) / 1073741824))
    printf -v share '%d.%06d' $((us / 1000000)) $((us % 1000000))
}

# Runs a command and kills it after a random share of the time that it needs undisturbed. $killed tells.
kill_within() { # MICROSECONDS COMMAND…
    share_of "$1"
    "${@:2}" >/dev/null 2>"$work/err" </dev/null &
    local pid=$!
    sleep "$share"
    kill -KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
    [ $? = 137 ] && killed=yes || killed=no
}

microseconds_of() { # COMMAND…
    local began=${EPOCHREALTIME/[.,]/}
    "$@" >/dev/null 2>&1 </dev/null
    echo $((${EPOCHREALTIME/[.,]/} - began))
}

# What a process holds in memory, kB.
memory_kB() { # PID
    awk '$1 == "VmRSS:" { print $2 }' "/proc/$1/status"
}

# A failure told once, with the words that led to it: the first time a fault is met.
wrong=0
fault() { # WORDS
    wrong=$((wrong + 1))
    [ $wrong -le 3 ] && { echo "wrong: $*"; tail -n 3 "$work/err" 2>/dev/null; }
    return 0
}
