#!/bin/bash
# A wall clock that jumps five times a second, by an hour, by years, to 1970 and to 2040, while the machine digs:
# nothing wrong is published, and the digs identify the gravel.
. tests/system/daemon_lib.bash
. tests/torture/torture.bash

make_digs
speed=4
series $((1 + TORTURE_S / 8))
config run "{kind: replay, replay: {file: series.csv, speed: $speed}}" "match: {state: match.json}"
log run
start "$work/run.log" timeout $((60 + 3 * TORTURE_S)) env LD_PRELOAD="$(realpath "$BIN/../tests/torture/fail_clock.so")" \
    "$BIN/digsightd" -c "$work/run.yaml"
daemon=$started began=$SECONDS
wait "$daemon"
status=$?
check "the daemon ends with exit status 0" [ "$status" = 0 ]
read_log run
judge run
told $(((SECONDS - began) * 5)) "jumps of the wall clock (the gravel identified in $(last health "$work/run.txt" $h_matches) of ${#digs[@]} digs)"
told "$(last health "$work/run.txt" $h_worst_us)" "us, the worst tick while the clock jumped"
check "every dig identifies the gravel" [ "$(last health "$work/run.txt" $h_matches)" = ${#digs[@]} ]
check "and the state is kept" [ -s "$work/match.json" ]
finish
