#!/bin/bash
# digrig as a user meets it: options, files, exit codes, a real Modbus server and, in User Mode Linux,
# a real CAN interface. Run from the repository's root; BIN is where the programs are.
. tests/system/check.bash
rig=$BIN/digrig
simple=tests/data/reference/mu0.5_mur0.5_rho2500__simpleA.csv
actual=tests/data/reference/mu0.5_mur0.5_rho2500__actual.csv
machine=config/machines/zx200_trench.yaml
. tests/system/simclock.bash

exits() { # STATUS COMMAND…: runs it, output in $work/out and err
    local want=$1
    shift
    "$@" >"$work/out" 2>"$work/err" </dev/null
    [ $? -eq "$want" ]
}

says() { grep -qF -- "$1" "$work/err"; }

check "no command is bad usage" exits 2 "$rig"
check "a machine that is not there is bad input" \
    exits 2 "$rig" record $simple --machine nowhere.yaml -o "$work/a.csv"
check "a recording that is not there is bad input" \
    exits 2 "$rig" record nowhere.csv --machine $machine -o "$work/a.csv"
check "a dig beyond the machine is refused" \
    exits 2 "$rig" record $actual --machine config/machines/zx200.yaml -o "$work/a.csv"
check "the refusal names what stops it, its peak and its limit" \
    grep -Eq 'zx200 cannot do this dig: .*(relief|holds|weighs) [0-9.]+ (MPa|kNm|kN)' "$work/err"
check "nothing is left behind by a refusal" test ! -e "$work/a.csv"
check "a folder that cannot be written to is a failure" \
    exits 1 "$rig" record $simple --machine $machine -o "$work/none/a.csv"

check "two digs are recorded" \
    exits 0 "$rig" record $simple $actual --machine $machine -o "$work/a.csv" --truth "$work/t.csv"
exits 0 "$rig" record $simple $actual --machine $machine -o "$work/b.csv"
exits 0 "$rig" record $simple $actual --machine $machine -o "$work/c.csv" --seed 2
check "one seed gives one recording, byte for byte" cmp -s "$work/a.csv" "$work/b.csv"
exits 0 "$rig" record $simple --machine $machine -o "$work/d.csv"
check "whose bucket is taken for granted is said" says "0.090 m from pin to tooth"
exits 0 "$rig" record $simple --machine $machine --scene config/scenes/rig.yaml -o "$work/d.csv"
check "but not where a scene says it" eval '! says "from pin to tooth"'
check "another seed gives another" bash -c "! cmp -s '$work/a.csv' '$work/c.csv'"
check "truth has as many rows as the recording" \
    test "$(wc -l <"$work/a.csv")" = "$(wc -l <"$work/t.csv")"
check "truth peaks at the recording's moment times lambda to the fourth" awk -F, '
    FNR == 1 { file++ }
    FNR > 1 && file == 1 && $9 > rig { rig = $9 }
    FNR > 1 && file == 2 && $7 > top { top = $7 }
    END { exit !(top > 0.98e4 * rig && top < 1.0001e4 * rig) }' $actual "$work/t.csv"

# The exact run is what a served one is compared with.
exits 0 "$rig" record $simple --machine $machine -o "$work/exact.csv" --exact

serve() { # OPTIONS…: starts a server in the background
    errors=$work/serve start "$work/json" "$rig" serve $simple --machine $machine --no-noise "$@"
    server=$started
    wait_for 5 grep -qs serving "$work/serve"
}
port() { sed -n 's/.*Modbus TCP on 127.0.0.1:\([0-9]*\).*/\1/p' "$work/serve"; }

check "a Modbus server starts on a free port" serve --modbus-tcp 127.0.0.1:0 --speed 5 --json
run "$work/polls" "$BIN/../tests/system/rig_poll" "$(port)" 60
ends "$server"
check "serving ends by itself and well" [ "$status" = 0 ]
check "updates of the map were seen" test "$(wc -l <"$work/polls")" -gt 50
# Counter n is row n - 1: the alive counter starts at 1 with the first row.
registers_are_right() { # POLLS
    awk -F, '
    function sign(x) { return x > 32767 ? x - 65536 : x }
    function off(a, b) { return a > b ? a - b : b - a }
    FNR == 1 { file++ }
    file == 1 && FNR > 1 { for (c = 2; c <= 10; c++) v[FNR - 1, c] = $c }
    file == 2 {
        n = $1
        for (c = 2; c <= 4; c++) if (off(sign($c), v[n, c] * 1e4) > 0.501) bad++
        for (c = 5; c <= 10; c++) if (off($(c + 1), v[n, c] / 1e3) > 0.501) bad++
        rows++
    }
    END { exit !(rows > 50 && bad == 0) }' "$work/exact.csv" "$1"
}
check "registers are the recording's values, to the last bit" registers_are_right "$work/polls"
check "the report counts reads alone" \
    grep -Eq '"modbus_served": \{"4": [0-9]+\}, "modbus_refused": \{\}' "$work/json"

check "a server loops" serve --modbus-tcp 127.0.0.1:0 --loop
stop "$server"
check "SIGTERM ends it cleanly" [ "$status" = 0 ]

check "a frozen and a missing bus are served" \
    serve --modbus-tcp 127.0.0.1:0 --speed 5 --fault frozen@2:3 --fault missing@15 --json
run "$work/polls" "$BIN/../tests/system/rig_poll" "$(port)" 8
ends "$server"
check "the counter stands while frozen and requests stay open while missing" awk -F, '
    $1 > last { last = $1 }
    END { exit !(last > 2000 && last < 2500) }' "$work/polls" # 15 s less 3 s, at 200 a second
check "the unanswered request is counted" \
    grep -Eq '"modbus_unanswered": [1-9]' "$work/json"

check "a CAN interface that is not there is a clear failure" \
    exits 1 "$rig" serve $simple --machine $machine --can nocan9
check "and is named" says "nocan9"

if ! command -v linux.uml >/dev/null || ! command -v candump >/dev/null ||
    ! command -v socat >/dev/null; then
    check "CAN is skipped where it may be" [ -z "${DIG_NO_SKIP-}" ]
    skip_check "three buses at once" "they need user-mode-linux, can-utils and socat"
    finish
fi
# All three buses at once, from one motion. A serial line is two pseudo terminals back to back.
cat >"$work/can.sh" <<INNER
. tests/system/check.bash
. tests/system/simclock.bash
export DIG_SIMCLOCK_TERMINALS=1
start "$work/dump" candump -r 16777216 -L vcan0
dump=\$started
start "$work/socat" socat PTY,raw,echo=0,link=$work/a PTY,raw,echo=0,link=$work/b
until [ -e $work/a ] && [ -e $work/b ]; do sleep 0.05; done
errors=$work/serve start "$work/json" $rig serve $simple --machine $machine --no-noise --can vcan0 \\
    --modbus-tcp 127.0.0.1:1502 --modbus-rtu $work/a --speed 2 --json
rig=\$started
wait_for 5 grep -q RTU "$work/serve"
start "$work/polls_tcp" $BIN/../tests/system/rig_poll 1502 5
start "$work/polls_rtu" $BIN/../tests/system/rig_poll $work/b 5
ends \$rig
served=\$status
stop \$dump
exit \$served
INNER
check "one motion is served on CAN, Modbus TCP and Modbus RTU at once" \
    exits 0 env DIG_DATA="$work" tools/vcan/with-vcan -t 1700 bash "$work/can.sh"
check "the registers on TCP are right" registers_are_right "$work/polls_tcp"
check "the registers on RTU are right" registers_are_right "$work/polls_rtu"
check "the report counts what candump saw" bash -c "
    grep -q '\"can_sent\": '\$(wc -l <'$work/dump')', \"can_lost\": 0' '$work/json'"
count() { grep -c " $1#" "$work/dump"; }
check "each frame comes at its own period" \
    test "$(count 18FF79E8) $(count 18FF7DE8) $(count 18FF7EE8) $(count 18FF84E8)" = \
    "$(awk 'END { n = NR - 1; print int((n + 1) / 2), int((n + 1) / 2), int((n + 3) / 4), int((n + 9) / 10) }' "$work/exact.csv")"
# The k-th pressure or angle frame is row 2 k of the run at 200 Hz.
check "frames are the recording's values, to the last bit" awk '
    function hex(s,    i, x) {
        for (i = 1; i <= length(s); i++) x = 16 * x + index("0123456789ABCDEF", substr(s, i, 1)) - 1
        return x
    }
    function off(a, b) { return a > b ? a - b : b - a }
    FNR == 1 { file++ }
    file == 1 && FNR > 1 { split($0, f, ","); for (c = 2; c <= 10; c++) v[FNR - 2, c] = f[c] }
    file == 2 {
        split($3, p, "#"); d = p[2]
        if (p[1] == "18FF79E8") {
            for (c = 0; c < 6; c++)
                if (off(hex(substr(d, 2 * c + 1, 2)), (v[2 * np, 5 + c] / 1e6 + 10) / 0.2) > 0.501) bad++
            np++
        }
        if (p[1] == "18FF7DE8") {
            for (c = 0; c < 3; c++)
                if (off(hex(substr(d, 4 * c + 3, 2) substr(d, 4 * c + 1, 2)),
                        (v[2 * na, 2 + c] + 10) / 0.0004) > 0.501) bad++
            na++
        }
    }
    END { exit !(np > 1000 && na > 1000 && bad == 0) }' "$work/exact.csv" "$work/dump"
check "alive counter goes up by one each time" awk '
    { split($3, p, "#") }
    p[1] == "18FF84E8" { c = substr(p[2], 15, 2); if (c == last) same++; last = c; n++ }
    END { exit !(n > 100 && same == 0) }' "$work/dump"

finish
