#!/bin/bash
# The main job, end to end, on digs that another DEM code computed: add to a table, let a machine
# dig on a real bus, let the daemon identify the gravel and predict the actual dig, show how right it was.
#   BIN=build/bin OUT=build/demo scripts/demo.sh
set -eu
bin=${BIN:-build/bin} out=${OUT:-build/demo}
machine=config/machines/zx200_trench.yaml
reference=tests/data/liggghts_product
gravel=${DIG_DEMO_GRAVEL:-mu0.6_mur0.4_rho2200_bucket0.4_seed1} truth=${DIG_DEMO_TRUTH:-.6,.4,2200}
simple=$reference/${gravel}__simpleA.csv actual=$reference/${gravel}__actual.csv
speed=${DIG_DEMO_SPEED:-1}

say() { if [ -t 1 ]; then printf '\n\033[1m%s\033[0m\n' "$*"; else printf '\n%s\n' "$*"; fi; }
rm -rf "$out" && mkdir -p "$out"
out=$(cd "$out" && pwd)

say "1. Table: the one that ships, and one more bed of two gravels, computed now by the DEM"
cp tables/product.sqlite "$out/table.sqlite"
chmod u+w "$out/table.sqlite"
"$bin/digtable" generate config/scenes/product.yaml config/grids/demo.yaml -o "$out/table.sqlite" --time-limit 60
"$bin/digtable" check "$out/table.sqlite"

say "2. Machine, bus and daemon: a simple dig, then an actual dig, in gravel nobody here computed"
echo "  recordings: LIGGGHTS, $(basename "$simple") then $(basename "$actual"), on a machine 10 times the rig"
runs=("Modbus TCP=$out/modbus.lcm")
scripts/demo_run.sh modbus "$bin" "$out" "$out/table.sqlite" "$machine" "$speed" "$simple" "$actual" &
modbus=$!
can=
if command -v linux.uml >/dev/null; then
    tools/vcan/with-vcan -t 150 scripts/demo_run.sh can "$bin" "$out" "$out/table.sqlite" "$machine" "$speed" "$simple" "$actual" &
    can=$!
else
    echo "  SocketCAN: skipped, this machine has no User Mode Linux (package user-mode-linux)"
fi
failed=0
wait "$modbus" || { failed=1; tail -n 5 "$out"/modbus.*.log >&2; }
if [ -n "$can" ]; then
    if wait "$can"; then
        runs+=("SocketCAN in User Mode Linux=$out/can.lcm")
    else
        echo "  SocketCAN: User Mode Linux does not run here; see $out/can.*.log" >&2
    fi
fi
[ "$failed" = 0 ]
grep -h "real time\|realtime\|locked" "$out"/modbus.daemon.log | head -n 3 || true

say "3. What was identified, and how right the prediction of the actual dig was"
"$bin/digreport" --table "$out/table.sqlite" --machine "$machine" --truth "$truth" \
    --title "Digsight demo: $gravel" --recording "$simple" --recording "$actual" \
    --html "$out/report.html" --json "$out/report.json" "${runs[@]}" 2>&1 || {
    echo "  On a busy machine samples are lost: see $out/*.daemon.log, and try again." >&2
    exit 1
}
echo
echo "  report with plots: $out/report.html"
echo "  LCM logs: $out/*.lcm   (make spy, then lcm-logplayer LOG, shows them live)"
