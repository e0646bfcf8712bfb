#!/bin/bash
# digwatch in a pseudo-terminal (tmux): what stands on the screen of a log and of a live daemon, resizing, quitting, and
# messages of others.
. tests/system/daemon_lib.bash

watch=$(realpath "$BIN/digwatch")
socket=$work/tmux
tmux() { command tmux -u -f /dev/null -S "$socket" "$@"; }
begin() { # ARGUMENT…: in a shell whose screen says "before", 80 by 24
    tmux kill-server 2>/dev/null
    while [ -e "$socket" ] && tmux has-session 2>/dev/null; do sleep 0.05; done
    rm -f "$socket"
    # Where the machine is busy a server gives up at times.
    for _ in {1..20}; do
        tmux new-session -d -x 80 -y 24 "env LC_ALL=${locale-C.UTF-8} TERM=screen bash --norc" && break
        sleep 0.5
    done
    tmux send-keys -l "echo be''fore; $watch $*; echo ended \$?"
    tmux send-keys Enter
}
shown() { tmux capture-pane -p; }
shows() { shown | grep -q -e "$1"; }
# On the machine's own clock: up to a minute.
until_shows() { # PATTERN
    local i
    for ((i = 0; i < ${patience:-600}; i++)); do shows "$1" && return; sleep 0.1; done
    shown 2>&1 | sed 's/^/      | /'
    return 1
}
given_back() { # the shell's screen is shown again, with its cursor
    shows '^before' && [ "$(tmux display-message -p '#{alternate_on} #{cursor_flag}')" = "0 1" ]
}
pid_of() { pgrep -P "$(tmux display-message -p '#{pane_pid}')" digwatch; }
trap 'tmux kill-server 2>/dev/null; kill ${prometheus-} ${daemon-} 2>/dev/null; cleanup' EXIT

make_digs
"$BIN/digrig" record "$work/simpleA.csv" "$work/actual.csv" --machine "$machine" -o "$work/run.csv" 2>"$work/rig.err"
config run "{kind: replay, replay: {file: run.csv, speed: 1}}" "tick_Hz: 200"
log run # by lcm-logger, as a person has it
run "$work/daemon.log" "$BIN/digsightd" -c "$work/run.yaml"
read_log run

# The log as it would be in the middle of the second dig: cut behind the 30th prediction of it.
cut=$(grep -abo DIGSIGHT_PREDICTION "$work/run.lcm" | sed -n "$(($(grep ^prediction "$work/run.txt" | grep -n '1 actual 0\.[1-9]' |
    sed -n '30s/:.*//p') + 1))s/:.*//p")
head -c "$cut" "$work/run.lcm" >"$work/cut.lcm"
begin --log "$work/cut.lcm" --speed 10000
check "a log is shown to its end" until_shows '^digwatch cut.lcm, 10000x, at its end .* UTC q: quit$'
check "the state, the source and the digs" shows '^running, replay .*; 1 dig (0 aborted), 1 identified'
check "the moment, measured and predicted" shows '^Moment    -\?[0-9.]* +- [0-9.]* kNm, predicted -\?[0-9.]* (-\?[0-9.]* to [0-9.]*)$'
check "phase, motion, trajectory and progress" shows '^Phase     dig, [a-z]* *actual  *=*-* [0-9]* %$'
check "the residual" shows '^Residual  [+-][0-9.]* kNm, [+-][0-9.]* sigma'
check "the whole dig as predicted" shows '^Predicted actual: peak [0-9.]* +- [0-9.]* kNm, energy [0-9.]* +- [0-9.]* kJ'
gravel() { shown | sed -nE 's/^Gravel +friction ([0-9.]+) .*/\1/p'; }
check "the gravel" within "$(gravel)" 0.4 0.6
check "its interval" shows '^  90 %    0\.[0-9]* to 0\.[0-9]*  *0\.[0-9]* to [01]\.[0-9]*  *[0-9]* to [0-9]* *with force$'
check "a chart in braille, with the band" eval '[ "$(shown | LC_ALL=C grep -acP "\|.*\xe2[\xa0-\xa3]")" -ge 4 ] && shows "|.*░"'
check "nothing beyond 80 columns and 24 rows" eval '[ "$(shown | wc -l)" -le 24 ] && [ "$(shown | LC_ALL=C.UTF-8 wc -L)" -le 80 ]'

tmux resize-window -x 120 -y 40
check "a larger window is filled" until_shows '^         27\.8 s before now  *now$'
tmux resize-window -x 80 -y 18
check "nor beyond 18 rows" eval 'until_shows "^digwatch cut.lcm, 10000x, at its end *[-0-9]* [0-9:]* UTC q: quit$" && shows "^Gravel .* kg/m3" && shows "^Health"'
tmux resize-window -x 50 -y 10
check "one too small asks for more" until_shows '^50 x 10 is too small: 80 x 18 at least. q: quit'
tmux resize-window -x 80 -y 24
check "and the first one is filled again" until_shows '^Gravel '
tmux send-keys q
check "q ends it with 0" until_shows '^ended 0$'
check "and gives the terminal back" given_back

for signal in TERM HUP INT QUIT; do
    begin --log "$work/cut.lcm" --speed 10000
    until_shows 'at its end' && kill -"$signal" "$(pid_of)"
    check "SIG$signal ends it with 0 and the terminal back" eval 'until_shows "^ended 0$" && given_back'
done
for signal in SEGV ABRT; do
    begin --log "$work/cut.lcm" --speed 10000
    until_shows 'at its end' && kill -"$signal" "$(pid_of)"
    check "a fault ($signal) gives the terminal back, too" eval 'until_shows "^ended 1[0-9][0-9]$" && given_back'
done
locale=C begin --log "$work/cut.lcm" --speed 10000
check "without UTF-8 it is drawn in ASCII" eval 'until_shows "|.*#" && shows "# measured  - predicted  . 90 % of digs" && ! shown | LC_ALL=C grep -aqP "[^\x20-\x7e]"'

# Logs that are damaged, or hold what a daemon does not say.
{ cat "$work/cut.lcm"; head -c 100000 "$work/run.lcm" | tr '\0-\377' '\377\0-\376'; } >"$work/damaged.lcm"
begin --log "$work/damaged.lcm" --speed 10000
check "a damaged log is shown up to there, and that is said" \
    eval 'until_shows "damaged\.lcm: damaged at byte [0-9]*" && shows "^Gravel    friction 0"'
tmux send-keys q
check "and ends with 0" until_shows '^ended 0$'
sed 's/DIGSIGHT_PREDICTION/DIGSIGHT_ESTIMATE\x00\x00/g' "$work/cut.lcm" >"$work/other.lcm"
begin --log "$work/other.lcm" --speed 10000
check "messages that are not understood are counted" until_shows '^Health .*[1-9][0-9]* messages on its channels were not understood'

# Live: a daemon, then nobody, then somebody else.
begin "--lcm-url '$lcm'"
check "where no daemon is, it says so" until_shows '^Health    no message of a daemon was heard yet'
"$BIN/digwatch" --prometheus "$work/health.prom" --lcm-url "$lcm" 2>"$work/prom.err" &
prometheus=$!
config live "{kind: replay, replay: {file: run.csv, speed: 8}}"
"$BIN/digsightd" -c "$work/live.yaml" 2>"$work/daemon.log" &
daemon=$!
check "a daemon is shown as it runs" until_shows '^running, replay'
check "with its gravel, once it is known" until_shows '^Gravel    friction 0'
metric() { awk -v name="digsight_$1" '$1 == name { print $2 }' "$work/health.prom"; }
check "its health goes into a file for Prometheus" [ "$(metric up) $(metric running) $(metric digs_aborted_total)" = "1 1 0" ]
check "in lines of its format alone" eval '! grep -vqE "^(# (HELP|TYPE) digsight_[a-z0-9_]+ .*|digsight_[a-z0-9_]+ [0-9.e+-]+)$" "$work/health.prom"'
wait "$daemon"
check "when it has ended, that is said" until_shows '^Health    no message for [0-9]* s: what is shown is old'
check "and Prometheus is told" eval 'for i in {1..100}; do [ "$(metric up)" = 1 ] || break; sleep 0.1; done; [ "$(metric up) $(metric digs_total)" = "0 2" ]'
"$helpers/lcm_garbage" "$lcm" 2000
to_all() { group=${lcm#*//}; socat - "UDP4-DATAGRAM:${group%%\?*}" 2>/dev/null; }
head -c 1400 /dev/urandom | to_all
# Of a message of 1000 bytes, 32 bytes before 4 GB: of liblcm's listeners it kills each.
{ printf 'LC03\0\0\0\1\0\0\3\350\377\377\377\340\0\0\0\2DIGSIGHT_HEALTH\0'; head -c 64 /dev/zero; } | to_all
printf 'LC02\0\0\0\1DIGSIGHT_HEALTH' | to_all # whose channel has no end
check "rubbish on its channels is counted" until_shows '[1-9][0-9]* messages on its channels were not understood'
check "no text of a message commands the terminal" eval 'until_shows "OWNED" && [ "$(tmux display-message -p "#{alternate_on}")" = 1 ]'
tmux send-keys q
check "it lives, and ends as ever" eval 'until_shows "^ended 0$" && given_back'
kill "$prometheus"
wait "$prometheus"
check "so does the one for Prometheus" [ $? = 0 ]
check "which left the file and nothing beside it" eval '[ -s "$work/health.prom" ] && [ ! -e "$work/health.prom.part" ]'

refused() { # PATTERN ARGUMENT…: exit status 2, one line and a hint
    "$BIN/digwatch" "${@:2}" >"$work/out" 2>"$work/err" </dev/null
    [ $? = 2 ] && grep -q -e "$1" "$work/err" && [ ! -s "$work/out" ]
}
check "without a terminal it is refused" refused 'standard input and output: expected a terminal' --log "$work/run.lcm"
check "a log that is not there" refused 'none.lcm: No such file' --log "$work/none.lcm"
check "a log that is none" refused 'run.csv:1: does not begin with ED A1 DA 01' --log "$work/run.csv"
check "a speed that is none" refused 'speed 0: expected 0.01 to 10000' --log "$work/run.lcm" --speed 0
check "a speed without a log" refused 'expected --speed with --log' --speed 2
check "an argument" refused 'run.lcm: expected options alone' run.lcm
check "an unknown option" refused '--colour: unknown option' --colour
finish
