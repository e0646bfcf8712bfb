#!/bin/bash
# docs/tutorial.md as a newcomer types it: every ```sh block of each part, in order, a part in a folder of its own. A block
# must succeed. Each line of a ```text block that follows it must be among its output lines, in that order; … stands for
# anything, and blanks count once. Run from the repository's root; BIN is where the programs are, TUTORIAL another text.
#
# A ```sh can block runs in User Mode Linux, where can0 exists; there this script is called again for it.
# What is computed for the first part is lent to the others, whose commands then find it done.
if [ -z "${DIG_DATA-}${DIG_IN_NAMESPACE-}" ] && unshare -Urn true 2>/dev/null; then # ports and messages of its own
    DIG_IN_NAMESPACE=1 exec unshare -Urn "$0" "$@"
fi
. tests/system/check.bash
BIN=$(realpath "$BIN")
. tests/system/simclock.bash
ip link set lo up multicast on 2>/dev/null
ip route add 239.255.76.67 dev lo 2>/dev/null
export DIGSIGHT=$PWD PATH=$BIN:$PATH
text=$(realpath "${TUTORIAL:-docs/tutorial.md}")

# Blocks as files, but inside: PART.NUMBER.sh and what it must say, PART.NUMBER.text.
[ "${1-}" = inside ] || awk -v to="$work/" '
    /^## Part / { part++; number = 0 }
    /^```sh( can)?$/ { if ($2 == "can") print "" >(sprintf("%s%d.%02d.can", to, part, number + 1)) }
    /^```sh( can)?$/ { number++; name = sprintf("%s%d.%02d", to, part, number); kind = ".sh"; print FNR >(name ".line"); next }
    /^```text$/ { kind = ".text"; next }
    /^```$/ { kind = ""; next }
    kind != "" { print >(name kind) }' "$text"

# What needs time to pass, in words of the simulated clock: programs begun, waited for, ended. A screen is a terminal.
on_simclock() { # BLOCK
    sed -E -e 's/^(digsightd .*|lcm-logger .*|digrig serve .*) &$/begin \1/' \
        -e 's/^(digrig serve|canplayer) .*[^&]$/begin &; ends "$started"; (exit "$status")/' \
        -e 's/^sleep /pass /' -e 's/^kill %1( %2)?$/stop_all/' -e 's/^digwatch .*/on_screen "&"/' "$1"
}
begin() {
    LD_PRELOAD=$preload "$@" </dev/null &
    started=$!
    children+=("$started")
    "$simclock" joined "$started"
}
stop_all() {
    local pid
    for pid in "${children[@]}"; do stop "$pid"; [ "$status" = 0 ] || return 1; done
}
stop_left() { # what a block that failed has left running
    for pid in "${children[@]-}"; do [ -z "$pid" ] || kill -KILL "$pid" 2>/dev/null; done
}
on_screen() { # COMMAND: in a terminal of 80 by 24 until it has drawn, then q; it has to end well
    local tmux=(tmux -u -f /dev/null -S "$work/tmux") status=0
    "${tmux[@]}" new-session -d -x 80 -y 24 "$1; echo ended \$?; sleep 1000"
    drawn ^Health && "${tmux[@]}" send-keys q && drawn '^ended 0' || status=1
    "${tmux[@]}" kill-server
    return $status
}
drawn() { # PATTERN: within a minute; else the screen is shown
    local i
    for ((i = 0; i < 600; i++)); do
        "${tmux[@]}" capture-pane -p >screen && grep -q -e "$1" screen && return
        sleep 0.1
    done
    cat screen
    return 1
}

said() { # OUTPUT TEXT: every line of TEXT is in OUTPUT, in order; the first that is not is shown
    local want line want_pattern=
    exec 3< <(tr -s ' ' <"$1")
    while read -r want; do
        want=$(tr -s ' ' <<<"$want")
        while read -r line <&3; do
            # … alone is free, all else is taken as it stands.
            [[ $line == ${want_pattern:=$(sed 's/[][\\*?]/\\&/g; s/…/*/g' <<<"$want")} ]] && { want_pattern=; continue 2; }
        done
        echo "      not said: $want"
        return 1
    done <"$2"
}

run_block() { # FILE OUTPUT: in this shell, as jobs begun in one block end in it
    set -e
    . <(on_simclock "$1")
}

if [ "${1-}" = inside ]; then # FOLDER BLOCK
    cd "$2" && run_block "$3"
    exit
fi

for part in 1 2 3; do
    mkdir "$work/part$part"
    cd "$work/part$part" || exit 1
    [ "$part" = 1 ] || cp -r "$work/part1/yard.sqlite" "$work/part1/ground" .
    for block in "$work/$part".*.sh; do
        [ -e "$block" ] || { check "part $part has commands" false; continue; }
        where="line $(cat "${block%.sh}.line")"
        out=${block%.sh}.log
        if [ -e "${block%.sh}.can" ]; then
            (cd "$DIGSIGHT" && DIG_DATA=$work tools/vcan/with-vcan -t 600 -i can0 tests/system/tutorial.sh inside "$work/part$part" "$block") >"$out" 2>&1
            status=$?
            if [ "$status" = 125 ] && [ -z "${DIG_NO_SKIP-}" ]; then
                skip_check "$where" "User Mode Linux does not start here"
                continue
            fi
        else
            (trap stop_left EXIT; run_block "$block") >"$out" 2>&1
            status=$?
        fi
        check "$where: $(head -n 1 "$block")" [ "$status" = 0 ] || true
        [ "$status" = 0 ] || sed 's/^/      | /' "$out" | tail -n 15
        [ ! -e "${block%.sh}.text" ] || check "$where: says what the tutorial shows" said "$out" "${block%.sh}.text" ||
            sed 's/^/      | /' "$out" | tail -n 15
    done
    cd "$DIGSIGHT" || exit 1
done

check "the tutorial has three parts and its commands were found" [ "$(ls "$work"/*.sh | wc -l)" -ge 15 ]
finish
