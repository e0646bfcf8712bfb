#!/bin/bash
# Every program and each of its commands, as they list themselves: help with an example, version, a wrong word and what was
# probably meant, JSON that a program reads, and no escape code where no terminal is.
. tests/system/check.bash

commands_of() { # PROGRAM: one a line
    "$BIN/$1" --help | sed -n '/^Commands:$/,/^$/s/^  \([a-z]\{1,\}\)  .*/\1/p'
}
run() { # ARGUMENT…: a program and what stands behind it; leaves $work/out, $work/err, $code
    "$BIN/$1" "${@:2}" >"$work/out" 2>"$work/err" </dev/null
    code=$?
}
is_plain() { ! LC_ALL=C grep -q $'\033' "$work/out" "$work/err"; }
helps() { # PROGRAM [COMMAND]
    run "$@" --help
    [ "$code" = 0 ] && [ ! -s "$work/err" ] && is_plain && ! grep -nE '.{81}' "$work/out" &&
        head -n 1 "$work/out" | grep -q "^Usage: $*" && grep -A1 '^Examples:' "$work/out" | grep -q "^  $*"
}
says_version() { # PROGRAM [COMMAND]
    run "$@" --version
    [ "$code" = 0 ] && grep -qE "^$1 [0-9]+\.[0-9]+\.[0-9]+$" "$work/out" && [ ! -s "$work/err" ]
}
refuses() { # SUGGESTION PROGRAM ARGUMENT…
    run "${@:2}"
    [ "$code" = 2 ] && [ ! -s "$work/out" ] && is_plain && grep -qF "did you mean \"$1\"?" "$work/err"
}
swapped() { # WORD: its last two letters in each other's place
    echo "$1" | sed -E 's/(.)(.)$/\2\1/'
}

# What a full disk cuts ends in 1 and is told, whatever was computed.
tells_full() { # PROGRAM ARGUMENT…
    "$BIN/$1" "${@:2}" >/dev/full 2>"$work/err" </dev/null
    is $? 1 && grep -q "^$1: standard output: " "$work/err"
}

programs=$(cd "$BIN" && ls)
asked="" # what takes --json
for program in $programs; do
    for command in "" $(commands_of "$program"); do
        name="$program${command:+ $command}"
        check "$name: --help has its usage and an example" helps $name
        takes_json=$(grep -E '^ {6}--json' "$work/out")
        options=$(sed -nE 's/^  (-., |    )(--[a-z]{5,}) .*/\2/p' "$work/out")
        check "$name: --version" says_version $name
        check "$name: help that a full disk cuts is told" tells_full $name --help
        for option in $options; do
            [ "$option" = "$(swapped "$option")" ] || refuses "$option" $name "$(swapped "$option")" || { echo "$name $option" >>"$work/wrong"; cat "$work/err"; }
        done
        check "$name: a misspelt option is recognised" [ ! -e "$work/wrong" ]
        rm -f "$work/wrong"
        [ -z "$command" ] || check "$program: so is \"$(swapped "$command")\"" refuses "$command" "$program" "$(swapped "$command")"
        [ -z "$takes_json" ] || asked="$asked$name
"
    done
done

table=tables/reference_rig.sqlite machine=config/machines/zx200_trench.yaml
dig=tests/data/reference/mu0.5_mur0.5_rho2500
mkdir "$work/campaign"
printf 'scene: rig\nrecordings:\n' >"$work/campaign/campaign.yaml"
for one in __simpleA:identify __actual:fit _seed2__simpleA:fit _seed2__actual:holdout; do
    cp "$dig${one%:*}.csv" "$work/campaign"
    echo "  - {file: $(basename "$dig")${one%:*}.csv, trajectory: ${one##*__}, role: ${one#*:}}" |
        sed 's/:[a-z]*, role/, role/' >>"$work/campaign/campaign.yaml"
done
"$BIN/digloop" identify $table ${dig}__simpleA.csv --json >"$work/id.json" 2>"$work/err"
reads() { # COMMAND ARGUMENT…: what it prints is JSON to Python
    run "$@"
    [ "$code" = 0 ] && is_plain && /usr/bin/python3 -c 'import json, sys
def no(word): raise ValueError(word)
sys.exit(not json.load(sys.stdin, parse_constant=no))' <"$work/out" 2>>"$work/err"
}
read_so_far=""
json() { # NAME ARGUMENT…: NAME is a program, or one and its command
    check "$1: its JSON is read by Python" reads $1 "${@:2}"
    [[ " $* " == *" - "* ]] || check "$1: JSON that a full disk cuts is told" tells_full $1 "${@:2}"
    read_so_far="$read_so_far$1
"
}
for command in "digtable list $table" "digtable show $table 0" "digtable check tests/data/formats/table.sqlite" \
    "digloop identify $table ${dig}__simpleA.csv" "digloop predict $table --identified $work/id.json --trajectory actual" \
    "digloop design $table" "digsightd -c config/digsightd.yaml --check" "digreport shift tests/data/formats/daemon.lcm"; do
    # shellcheck disable=SC2086 # words
    check "$(cut -d' ' -f1,2 <<<"$command"): so is a result" tells_full $command
done

/usr/bin/python3 -c pass 2>"$work/err" || { skip_check "JSON" "no Python here"; finish; exit; }
json "digtable list" $table --json
mkdir "$work/t.sqlite.jobs"
cp tests/data/formats/plan.yaml "$work/t.sqlite.jobs"
json "digtable status" "$work/t.sqlite" --json
json "digtable check" tests/data/formats/table.sqlite --json
json "digtable show" $table 0 --json
json "digloop identify" $table ${dig}__simpleA.csv --json
json "digloop predict" $table --identified "$work/id.json" --trajectory actual --json
json "digloop design" $table --json
json "digloop trace" $table "$work/campaign" --json - --quiet
check "and --quiet leaves out what people read" eval '! grep -q "noise floor" "$work/err"'
"$BIN/digrig" air -q --machine $machine -o "$work/air.csv" 2>"$work/err"
json "digloop check" $machine "$work/air.csv" --json - --quiet
json "digrig serve" ${dig}__simpleA.csv --machine $machine --modbus-tcp 127.0.0.1:$((20000 + $$ % 20000)) --speed 100 --json
json "digsightd" -c config/digsightd.yaml --check --json
json "digreport shift" tests/data/formats/daemon.lcm --json - --quiet
check "and --quiet says nothing else" [ ! -s "$work/err" ]
# A run with digs of both kinds is in tests/system/daemon_replay.sh, which reads this one.
read_so_far="${read_so_far}digreport
"
check "that was all that takes --json" diff <(sort <<<"$asked") <(sort <<<"$read_so_far")
finish
