#!/bin/bash
# The systemd unit: systemd finds no fault in it, thinks well of its sandbox, and it says what the daemon and
# the documents promise.
set -u
. tests/system/check.bash
unit=config/systemd/digsightd.service
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

says() { # LINE
    grep -qxF "$1" "$unit"
}
check "it waits for READY" says Type=notify
check "it has a watchdog, which the daemon feeds" says WatchdogSec=5
check "a reload is SIGHUP" says 'ExecReload=/bin/kill -HUP $MAINPID'
check "it runs as no one in particular" says DynamicUser=yes
check "with no capability but the one for priorities" \
    eval 'says AmbientCapabilities=CAP_SYS_NICE && says CapabilityBoundingSet=CAP_SYS_NICE'
check "a flood of words is cut" eval 'says LogRateLimitIntervalSec=10 && says LogRateLimitBurst=100'

if ! command -v systemd-analyze >/dev/null; then
    echo "SKIP: no systemd-analyze here to read the unit"
    echo "$passed passed, $failed failed, 1 skipped"
    [ "$failed" = 0 ]
    exit
fi
# The program need not be installed where the unit expects it.
sed "s|/usr/local/bin/digsightd|$(realpath "${BIN:-build/bin}/digsightd")|" "$unit" >"$work/digsightd.service"
check "systemd reads it without a word" \
    eval 'systemd-analyze verify --man=no "$work/digsightd.service" >"$work/err" 2>&1 && ! grep -q "digsightd.service" "$work/err"'
sed 's/^ProtectClock=yes/ProtectClok=yes/' "$work/digsightd.service" >"$work/misspelt.service"
check "who would not, of a misspelt line" \
    eval 'systemd-analyze verify --man=no "$work/misspelt.service" 2>&1 | grep -q ProtectClok'
if systemd-analyze security --help >/dev/null 2>&1 && systemd-analyze --help | grep -q -- --offline; then
    # 10 is a unit without any; below 3 systemd calls it OK. No root, no namespace is its own doing.
    check "its exposure is small" \
        eval 'systemd-analyze security --offline=yes --threshold=30 --no-pager "$work/digsightd.service" >"$work/err" 2>&1'
    tail -n 1 "$work/err"
fi
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
