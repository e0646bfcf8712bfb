#!/bin/bash
# What the daemon costs and how late it is, beside what cyclictest finds on the same machine at the same
# time: lines `name ratio unit detail`. BENCH_QUICK=1: a tenth of the ticks.
#   BUILD=build tests/bench/daemon.sh
set -eu
BUILD=${BUILD:-build}
BIN=${BIN:-$BUILD/bin}
ticks=1000000 passes=5 loops=20000
[ -z "${BENCH_QUICK-}" ] || { ticks=100000 passes=3 loops=5000; }
machine=config/machines/zx200_trench.yaml
make --no-print-directory -s BUILD="$BUILD" "$BUILD"/tests/system/daemon_{data,log} "$BUILD/tests/bench/daemon_tick"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$BIN/../tests/system/daemon_data" config/scenes/rig.yaml "$work" >/dev/null
"$BIN/digrig" record "$work/simpleA.csv" "$work/actual.csv" --machine "$machine" -o "$work/run.csv" 2>/dev/null

# The tick alone, at 1 kHz, on its thread's CPU clock.
"$BIN/../tests/bench/daemon_tick" "$work/table.sqlite" "$machine" "$work/run.csv" "$ticks" "$passes" >"$work/ticks"
{
    read -r _ mean p99 _ worst second n digs matches
    read -r _ still_mean still_worst still_second
    read -r _ least least_second _
} <"$work/ticks"

# cyclictest, at the tick's priority and beat: how late this machine wakes a thread. Its histogram's 99 %.
cyclic_p99=- cyclic_max=-
if command -v cyclictest >/dev/null; then
    cyclictest -q -m -p 80 -i 1000 -l "$loops" -h 20000 2>/dev/null >"$work/cyclic" || cyclictest -q -i 1000 -l "$loops" -h 20000 >"$work/cyclic"
    cyclic_max=$(sed -nE 's/^# Max Latencies: 0*([0-9]+).*/\1/p' "$work/cyclic")
    cyclic_p99=$(awk '/^[0-9]/ { sum += $2; at[n++] = $1; below[n] = sum } END { for (i = 1; i <= n; i++) if (below[i] >= .99 * sum) { print at[i - 1] + 0; exit } }' "$work/cyclic")
fi

# The whole daemon on Modbus: from a reading's stamp to LCM.
port=$((30000 + $$ % 10000))
cat >"$work/run.yaml" <<YAML
table: table.sqlite
machine: $PWD/$machine
input: {kind: modbus-tcp, modbus: {address: "127.0.0.1:$port", map: $PWD/config/signals/modbus_default.yaml}}
lcm: {url: "udpm://239.255.76.67:$((20000 + $$ % 10000))?ttl=0"}
YAML
lcm-logger -q --lcm-url="udpm://239.255.76.67:$((20000 + $$ % 10000))?ttl=0" "$work/run.lcm" >/dev/null 2>&1 &
logger=$!
"$BIN/digsightd" -c "$work/run.yaml" 2>"$work/daemon.log" &
daemon=$!
"$BIN/digrig" serve "$work/simpleA.csv" --machine "$machine" --modbus-tcp "127.0.0.1:$port" 2>/dev/null
sleep 1.5
kill "$daemon" && wait "$daemon" || true
kill -INT "$logger" && wait "$logger" || true
"$BIN/../tests/system/daemon_log" "$work/run.lcm" >"$work/run.txt"
read -r overruns beats worst_cpu latency < <(awk '$1 == "health" { l = $16 " " $15 " " $29 " " $30 } END { print l }' "$work/run.txt")

ratio() { # A B: A / B, or - when one is not known
    awk -v a="$1" -v b="$2" 'BEGIN { if (b + 0 > 0) printf "%.2f", a / b; else printf "-" }'
}
echo "daemon-tick-worst $(ratio "$worst" 50) x-of-50us worst $worst us CPU (next $second) of $n ticks at 1 kHz with $digs digs, $matches matched; mean $mean, 99 % $p99; cyclictest's worst $cyclic_max us"
echo "daemon-tick-worst-still $(ratio "$worst" "$still_worst") x-arithmetic worst of as many runs of the same arithmetic of $still_mean us, after every tick: $still_worst us (next $still_second)"
echo "daemon-tick-worst-itself $(ratio "$least" 50) x-of-50us worst tick by the least that it took in $passes passes: $least us (next $least_second)"
echo "daemon-tick-mean $(ratio "$mean" 1000) of-the-beat $mean us CPU of each ms"
echo "daemon-latency-p99 $(ratio "$latency" "$cyclic_p99") x-cyclictest-p99 99 % of samples published within $latency us of their stamp; cyclictest wakes 99 % within $cyclic_p99 us"
echo "daemon-latency-p99-limit $(ratio "$latency" 2000) x-of-2ms $overruns overruns in $beats ticks, worst tick $worst_cpu us CPU"
