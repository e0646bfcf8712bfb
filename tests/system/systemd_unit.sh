#!/bin/bash
# The systemd unit: systemd finds no fault in it, thinks well of its sandbox, and it says what the daemon and
# the documents promise.
. tests/system/check.bash
unit=config/systemd/digsightd.service

says() { # LINE
    grep -qxF "$1" "$unit"
}
number() { # KEY: the number the unit gives it
    sed -n "s/^$1=//p" "$unit"
}
check "it waits for READY" says Type=notify
check "it has a watchdog, which the daemon feeds" says WatchdogSec=5
check "a reload is SIGHUP" says 'ExecReload=/bin/kill -HUP $MAINPID'
check "it comes back after a crash, however often" \
    eval 'says Restart=on-failure && says StartLimitIntervalSec=0 && says RestartPreventExitStatus=2'
check "it runs as a user of its own" eval 'says DynamicUser=yes && says User=digsight'
check "without any capability" eval 'says AmbientCapabilities= && says CapabilityBoundingSet='
check "in the group of serial lines" says SupplementaryGroups=dialout
check "a flood of words is cut" eval 'says LogRateLimitIntervalSec=10 && says LogRateLimitBurst=100'

# A kernel of its own, whose root may set limits: the unit's are enough for real time, without any capability, in
# a user namespace, and a CAN socket is to be had there too.
rights() { # the daemon's words in $work/said
    cp config/machines/zx200_trench.yaml config/can/zx200.dbc config/signals/zx200_can.yaml "$work"
    "${BIN:-build/bin}/../tests/system/daemon_data" config/scenes/rig.yaml "$work" >/dev/null || return 1
    cat >"$work/can.yaml" <<YAML
table: table.sqlite
machine: zx200_trench.yaml
input: {kind: can, can: {interface: vcan0, dbc: zx200.dbc, map: zx200_can.yaml}}
lcm: {url: "udpm://239.255.76.67:7667?ttl=0"}
YAML
    cp "${BIN:-build/bin}/digsightd" "$work"
    chmod -R a+rX "$work"
    tools/vcan/with-vcan bash -c '
        ip link set lo up multicast on
        ip route add 239.255.76.67 dev lo
        prlimit --rtprio="$2:$2" --memlock=unlimited:unlimited \
            setpriv --reuid=65534 --regid=65534 --clear-groups --inh-caps=-all --bounding-set=-all --no-new-privs \
            unshare -U --map-user=65534 --map-group=65534 "$1/digsightd" -c "$1/can.yaml" >"$1/said" 2>&1 &
        for ((i = 0; i < 600; i++)); do
            grep -q "waiting for bus" "$1/said" && grep -qsw raw /proc/net/can/rcvlist_eff && break
            sleep 0.1
        done
        cat /proc/net/can/rcvlist_eff >"$1/sockets"
        kill %1' - "$work" "$1" >"$work/err" 2>&1
    cat "$work/said" >>"$work/err"
}
if command -v linux.uml >/dev/null; then
    check "with the unit's limits and no capability" eval 'rights "$(number LimitRTPRIO)"; grep -q "waiting for bus" "$work/said"'
    check "real time is granted, and locked memory" grep -q "SCHED_FIFO 80 granted, memory locked" "$work/said"
    check "and the CAN bus is open" grep -q "vcan0 .* raw$" "$work/sockets"
else
    skip_check "the unit's limits" "no User Mode Linux here, whose root may set some"
fi

if ! command -v systemd-analyze >/dev/null; then
    skip_check "what systemd thinks of the unit" "no systemd-analyze here"
    finish
fi
# The program need not be installed where the unit expects it.
sed "s|/usr/local/bin/digsightd|$(realpath "${BIN:-build/bin}/digsightd")|" "$unit" >"$work/digsightd.service"
check "systemd reads it without a word" \
    eval 'systemd-analyze verify --man=no "$work/digsightd.service" >"$work/err" 2>&1 && ! grep -q "digsightd.service" "$work/err"'
sed 's/^ProtectClock=yes/ProtectClok=yes/' "$work/digsightd.service" >"$work/misspelt.service"
check "who would not, of a misspelt line" \
    eval 'systemd-analyze verify --man=no "$work/misspelt.service" 2>&1 | grep -q ProtectClok'
if systemd-analyze security --help >/dev/null 2>&1 && systemd-analyze --help | grep -q -- --offline; then
    # 10 is a unit without any.
    check "its exposure is 2.0 or less" \
        eval 'systemd-analyze security --offline=yes --threshold=20 --no-pager "$work/digsightd.service" >"$work/err" 2>&1'
    tail -n 1 "$work/err"
    cp "$work/err" "$work/report"
    without_reason() { # what stays open and no comment of the unit names
        awk '$1 == "✗" { sub(/[=~].*/, "", $2); print $2 }' "$work/report" | sort -u | while read -r name; do
            grep "^# " "$unit" | grep -qw "$name" || echo "$name"
        done
    }
    check "each exception has its reason" eval '[ -z "$(without_reason | tee "$work/err")" ]'
    sed '/^CapabilityBoundingSet=/d' "$work/digsightd.service" >"$work/open.service"
    check "a unit more open than that fails" \
        eval '! systemd-analyze security --offline=yes --threshold=20 --no-pager "$work/open.service" >"$work/err" 2>&1'
fi
finish
