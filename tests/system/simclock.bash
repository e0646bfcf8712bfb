# The simulated clock (tests/simclock/simclock.h) in a system test. Sourced behind tests/system/check.bash.
#
# Programs are begun by `start` or `run`. Time passes in `pass`, `ends`, `stop`, `wait_for` and `run` alone, as fast
# as the programs compute; no program is ever late on a busy machine. All seconds here are of that clock.
simclock=$BIN/../tests/simclock/simclock
preload=$(realpath "$BIN/../tests/simclock/preload.so")
children=()
DIG_SIMCLOCK=$(mktemp -p "$([ -w /dev/shm ] && echo /dev/shm || echo /tmp)" digsight.XXXXXXXX)
export DIG_SIMCLOCK
"$simclock" begin
# In User Mode Linux, which has one processor; a program may have all of it. When the host is slow its kernel leaves
# frames to ksoftirqd, which has to hand them over before time passes.
if [ -n "${DIG_DATA-}" ]; then
    export DIG_SIMCLOCK_ONE_CPU=1
    echo -1 >/proc/sys/kernel/sched_rt_runtime_us
    chrt -f -p 99 "$(grep -lx ksoftirqd/0 /proc/[0-9]*/comm | cut -d / -f 3)"
fi

pass() { # SECONDS
    "$simclock" pass "$1"
}

since() { # BEGAN, as `$simclock now` printed it: whole seconds since then, rounded up
    awk -v began="$1" -v now="$("$simclock" now)" 'BEGIN { printf "%d", now - began + 1 }'
}

ends() { # PID [SECONDS]: lets time pass until a process we started has ended; its exit status is kept in $status
    local left=() pid
    "$simclock" await "$1" "${2:-1000}" || kill -KILL "$1" 2>/dev/null
    wait "$1" 2>/dev/null
    status=$?
    for pid in "${children[@]-}"; do [ "$pid" = "$1" ] || left+=("$pid"); done
    children=("${left[@]-}")
}

stop() { # PID [SIGNAL]: ends it; it has a minute
    kill -"${2:-TERM}" "$1" 2>/dev/null
    ends "$1" 60 2>/dev/null
}

cleanup() {
    local pid
    for pid in "${children[@]-}"; do [ -n "$pid" ] && stop "$pid" KILL; done
    rm -f "$DIG_SIMCLOCK" "$DIG_SIMCLOCK".*
    [ -n "${DIG_KEEP-}" ] && echo "kept $work" || rm -rf "$work"
}
trap cleanup EXIT

# Starts a command in the background; its pid is in $started. With $errors its errors go to that file.
start() { # OUTPUT COMMAND…
    if [ -n "${errors-}" ]; then
        LD_PRELOAD=$preload "${@:2}" >"$1" 2>"$errors" </dev/null &
    else
        LD_PRELOAD=$preload "${@:2}" >"$1" 2>&1 </dev/null &
    fi
    started=$!
    children+=("$started")
    "$simclock" joined "$started"
}

run() { # OUTPUT COMMAND…: to its end; with its exit status
    start "$@"
    ends "$started"
    return "$status"
}

wait_for() { # SECONDS COMMAND…: until it succeeds
    local i
    for ((i = 0; i < $1 * 10; i++)); do
        "${@:2}" >/dev/null 2>&1 && return 0
        pass 0.1
    done
    return 1
}
