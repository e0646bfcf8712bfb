# Short runs of each program, for scripts that take something away from them. Sourced behind daemon_lib.bash and
# torture.bash. A program's words go to $work/err; what it makes, to $work/made.*; $code is its exit status.

programs_prepare() {
    make_digs
    "$BIN/digrig" record "$work/simpleA.csv" --machine "$machine" -o "$work/run.csv" 2>/dev/null
    "$BIN/digloop" identify "$work/table.sqlite" "$work/simpleA.csv" --json >"$work/id.json" 2>/dev/null
    config replay "{kind: replay, replay: {file: run.csv, speed: 100}}" "match: {state: made.match.json}"
    "$BIN/digtable" generate tests/data/formats/scene.yaml tests/data/formats/grid.yaml --packings 1 -o "$work/grid.sqlite" 2>/dev/null
    "$BIN/digtable" export "$work/grid.sqlite" --runs | cut -d, -f1-6,10-14 >"$work/curves.csv"
}

programs="daemon_check daemon_run table_check table_merge table_import table_export identify predict record"

# PROGRAM [BEFORE…]: runs it behind the words BEFORE (env, prlimit …)
run_program() {
    local before=("${@:2}")
    rm -f "$work"/made.*
    case $1 in
    daemon_check) set -- digsightd -c "$work/replay.yaml" --check ;;
    daemon_run) set -- digsightd -c "$work/replay.yaml" ;;
    table_check) set -- digtable check "$work/table.sqlite" ;;
    table_merge) set -- digtable merge "$work/made.sqlite" "$work/table.sqlite" ;;
    table_import) set -- digtable import "$work/curves.csv" --map tests/data/formats/curve_map.yaml -o "$work/made.sqlite" ;;
    table_export) set -- digtable export "$work/table.sqlite" -o "$work/made.csv" ;;
    identify) set -- digloop identify "$work/table.sqlite" "$work/simpleA.csv" --json ;;
    predict) set -- digloop predict "$work/table.sqlite" --identified "$work/id.json" --trajectory actual -o "$work/made.csv" ;;
    record) set -- digrig record "$work/simpleA.csv" --machine "$machine" -o "$work/made.csv" ;;
    esac
    "${before[@]}" "$BIN/$1" "${@:2}" >"$work/said" 2>"$work/err" </dev/null
    code=$?
}

# What each makes undisturbed, to compare with.
programs_undisturbed() {
    local program
    for program in $programs; do
        run_program "$program"
        [ "$code" = 0 ] || fault "$program fails undisturbed"
        made_of "$program" >"$work/undisturbed.$program"
    done
}

# What the last run made, but for dates and times.
made_of() { # PROGRAM
    case $1 in
    table_import) "$BIN/digtable" export "$work/made.sqlite" --runs 2>/dev/null | cut -d, -f1-5,10-14 ;;
    daemon_run) grep -c moment_Nm "$work/made.match.json" 2>/dev/null ;;
    daemon_check | table_check | identify) cat "$work/said" ;;
    *) cat "$work"/made.*[cq]* 2>/dev/null ;;
    esac | sha256sum
}

# After a run from which something was taken away: it ended by itself, done as ever, or refused in words with
# nothing half made.
judge_program() { # PROGRAM WHAT
    if [ "$code" -gt 2 ]; then
        fault "$1, $2: exit status $code"
    elif [ "$code" != 0 ]; then
        [ -s "$work/err" ] || fault "$1, $2: refused without a word"
        [ "$1" = daemon_run ] || [ -z "$(ls "$work" | grep '^made')" ] || fault "$1, $2: half made: $(ls "$work" | grep '^made' | tr '\n' ' ')"
    elif [ "$1" != daemon_run ]; then
        [ "$(made_of "$1")" = "$(cat "$work/undisturbed.$1")" ] || fault "$1, $2: done, but not as undisturbed"
    fi
}
