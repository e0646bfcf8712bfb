# What the daemon's system tests share. Sourced from the repository's root. Gives $scene, $machine, $lcm (an LCM network
# of this test alone), $port (for a Modbus server), the inputs $modbus and $sealed_can (whose frames carry a counter and a
# checksum), and the functions below.
#
# LCM wants a route for its multicast group. Where there is none and none can be added, the test moves
# into a network namespace of its own, whose loopback carries it; that needs no privilege.
. tests/system/check.bash
helpers=$BIN/../tests/system
scene=config/scenes/rig.yaml
machine=config/machines/zx200_trench.yaml

if ! ip route get 239.255.76.67 >/dev/null 2>&1; then
    ip link set lo up multicast on 2>/dev/null
    if ! ip route add 239.255.76.67 dev lo 2>/dev/null; then
        [ -z "${DIG_IN_NAMESPACE-}" ] || { echo "no multicast"; echo "0 passed, 1 failed"; exit 1; }
        rmdir "$work"
        DIG_IN_NAMESPACE=1 exec unshare -Urn "$0" "$@"
    fi
fi

. tests/system/simclock.bash
lcm="udpm://239.255.76.67:$((20000 + $$ % 10000))?ttl=0"
# Below those that the kernel gives to clients: one of another test may hold such a port, and who asks for one that nobody
# serves may be given it and reach itself.
port=$((20000 + $$ % 10000))
modbus="{kind: modbus-tcp, modbus: {address: \"127.0.0.1:$port\", poll_Hz: 400, map: $PWD/config/signals/modbus_default.yaml}}"
sealed_can="{kind: can, can: {interface: vcan0, dbc: $PWD/tests/data/sealed/zx200_sealed.dbc, map: $PWD/tests/data/sealed/signals.yaml}}"

config() { # NAME INPUT [MORE]: writes $work/NAME.yaml; INPUT is the input's mapping
    cat >"$work/$1.yaml" <<YAML
table: table.sqlite
machine: $PWD/$machine
input: $2
lcm: {url: "$lcm"}
${3-}
YAML
}

log() { # NAME: starts recording LCM into $work/NAME.lcm
    # At many times real time the default receive buffer of the kernel is too small for the logger.
    start "$work/logger.log" lcm-logger --lcm-url="$lcm&recv_buf_size=4000000" "$work/$1.lcm"
    logger=$started
    pass 0.1
}

# liblcm writes what is published into $work/NAME.lcm, whole when the daemon has ended. Without a network and a logger on
# it, which daemon_replay, daemon_lcm, daemon_talk and digwatch have: a third of the work in User Mode Linux.
logs_itself() { # NAME CONFIG
    sed -i "s|^lcm:.*|lcm: {url: \"file://$work/$1.lcm?mode=w\"}|" "$work/$2.yaml"
    logger=
}

read_log() { # NAME: ends the recording and prints it into $work/NAME.txt
    [ -z "$logger" ] || stop "$logger" INT
    "$helpers/daemon_log" "$work/$1.lcm" >"$work/$1.txt" 2>"$work/$1.err"
}

daemon_begins() { # NAME [CONFIG]: logs itself, its words into $work/NAME.log; until it has sought its bus
    logs_itself "$1" "${2-$1}"
    start "$work/$1.log" "$BIN/digsightd" -c "$work/${2-$1}.yaml"
    daemon=$started
    wait_for 5 grep -qE "(waiting for bus|running) \(" "$work/$1.log"
}

daemon_ends() { # NAME: by SIGTERM; what it published is in $f
    stop "$daemon"
    check "$1: SIGTERM ends the daemon with exit status 0" [ "$status" = 0 ]
    read_log "$1"
    f=$work/$1.txt
}

replay() { # NAME: a daemon to the end of its recording, which logs itself, its words into $work/daemon.log; its exit status
    logs_itself "$1" "$1"
    run "$work/daemon.log" "$BIN/digsightd" -c "$work/$1.yaml"
    local rc=$?
    read_log "$1"
    return "$rc"
}

make_digs() { # makes the table and the digs, whose truth is friction 0.5, rolling 0.4, density 2200
    "$helpers/daemon_data" "$scene" "$work" >"$work/data.log" 2>&1
}

in_uml() { # ARGUMENTS…: what follows runs in User Mode Linux, where SocketCAN exists, with table and digs in $work
    if [ "${1-}" = inside ]; then
        cp "$DIG_DATA"/* "$work"
        return
    fi
    make_digs
    DIG_DATA=$work tools/vcan/with-vcan -t 1700 "$0" inside
    status=$?
    if [ "$status" = 125 ] && [ -z "${DIG_NO_SKIP-}" ]; then
        echo "0 passed, 0 failed, 1 skipped (User Mode Linux does not start here)"
        status=0
    fi
    exit "$status"
}

last() { # KIND FILE FIELD: a field of the last line of a kind
    awk -v kind="$1" -v field="$3" '$1 == kind { value = $field } END { print value }' "$2"
}

identified() { # FILE: the last match is near the truth
    within "$(last match "$1" 6)" 0.38 0.62 && within "$(last match "$1" 9)" 0.30 0.50 &&
        within "$(last match "$1" 12)" 1750 2500 && [ "$(last match "$1" 3)" = 0 ]
}

series() { # N: $digs is the simple dig N times; their truth goes to $work/truth.csv, the contacts to $contacts
    local i
    digs=()
    for ((i = 0; i < $1; i++)); do digs+=("$work/simpleA.csv"); done
    "$BIN/digrig" record "${digs[@]}" --machine "$machine" -o "$work/series.csv" --truth "$work/truth.csv" 2>"$work/series.err"
    mapfile -t contacts < <(awk -F, 'NR > 1 { if ($7 != 0 && before == 0) print $1; before = $7 }' "$work/truth.csv")
}

fault() { # KIND DIG: --fault's value for all of that dig, counted from 1
    awk -v kind="$1" -v contact="${contacts[$2 - 1]}" 'BEGIN { printf "%s@%.2f:12", kind, contact - 2 }'
}

# In a configuration, for a rig at $speed times real time: a quarter of the default's beats, each of 4 ms.
paced() {
    printf 'time_scale: %s\ntick_Hz: 250' "$speed"
}

# Begins to serve it at $speed times real time; the rig's counts go to $work/NAME.json, its pid to $rig, the time to $began.
start_series() { # NAME OPTION…
    began=$("$simclock" now)
    errors=$work/$1.rig.err start "$work/$1.json" "$BIN/digrig" serve "${digs[@]}" --machine "$machine" \
        --speed "$speed" --json "${@:2}"
    rig=$started
    rig_json=$work/$1.json
}

till() { # DIG SECONDS: until the rig is so long after a dig's contact
    pass "$(awk -v c="${contacts[$1 - 1]}" -v s="$2" -v speed="$speed" -v began="$began" -v now="$("$simclock" now)" \
        'BEGIN { print began + (c + s) / speed - now }')"
}

serve_series() { # NAME OPTION…: to its end
    start_series "$@"
    ends "$rig"
}

rig() { # KEY: a number of the rig's counts
    sed -E "s/.*\"$1\": ([0-9]+).*/\1/" "$rig_json"
}

# Judges $work/NAME.lcm into $work/NAME.judged. In dig BLIND the angles stand still: nothing can tell at
# once; it has to be told before two seconds of wrong estimates are published.
judge() { # NAME [BLIND]
    "$helpers/daemon_judge" "$work/$1.lcm" "$work/truth.csv" 0.5 0.4 2200 >"$work/$1.judged" 2>"$work/$1.err"
    sed 's/^/      /' "$work/$1.judged"
    judged=$work/$1.judged
    check "$1: estimates are published" within "$(judged all 2)" 100 1e9
    local blind=0
    [ -z "${2-}" ] || blind=$("$helpers/daemon_judge" "$work/$1.lcm" "$work/truth.csv" 0.5 0.4 2200 \
        "$(awk -v c="${contacts[$2 - 1]}" 'BEGIN { print c - 2 }')" 12 | awk '$1 == "within" { print $2 }')
    check "$1: no wrong estimate is published as good" [ "$(judged all 3)" = "$blind" ]
    check "$1: but for two seconds at most while angles stand" within "$blind" 0 200
    check "$1: nor a wrong match or prediction" [ "$(judged all 6) $(judged all 8)" = "0 0" ]
}

judged() { # KIND FIELD [DIG]: a field of the line "all", or of a dig's
    awk -v kind="$1" -v field="$2" -v dig="${3-}" '$1 == kind && (dig == "" || $2 == dig) { print $field }' "$judged"
}

# Fields of a health line, for last().
h_state=2 h_frames=4 h_malformed=5 h_nan=6 h_not_available=7 h_out_of_range=8 h_frozen=9 h_missing=10
h_reconnects=11 h_digs=12 h_matches=13 h_lost=14 h_ticks=15 h_overruns=16 h_worst_us=17 h_checksum=18
h_repeated=19 h_jump=20 h_stuck=21 h_missed=22 h_error_frames=23 h_bus_offs=24 h_timeouts=25 h_unsent=26
h_reloads=27 h_reloads_refused=28 h_worst_cpu_us=29 h_p99_us=30 h_without_force=31
