#!/bin/bash
# kill -9 at random instants over the daemon and its state, and over digloop as it writes a model: what was kept is
# whole, and is known to the next that starts.
. tests/system/daemon_lib.bash
. tests/torture/torture.bash

make_digs
for _ in 1 2 3 4; do digs+=("$work/simpleA.csv"); done
"$BIN/digrig" record "${digs[@]}" --machine "$machine" -o "$work/four.csv" 2>"$work/four.err"
config run "{kind: replay, replay: {file: four.csv, speed: 100}}" "match: {state: match.json}"
run_us=$(microseconds_of "$BIN/digsightd" -c "$work/run.yaml")
rm -f "$work/match.json"

# A campaign of two digs of LIGGGHTS, its model with and without a dig more.
reference=$PWD/tests/data/reference/mu0.5_mur0.5_rho2500
mkdir "$work/campaign"
cp "$reference"__simpleA.csv "$work/campaign/a.csv"
cp "$reference"__actual.csv "$work/campaign/r.csv"
cp "$reference"_seed2__simpleA.csv "$work/campaign/a2.csv"
cat >"$work/campaign/campaign.yaml" <<YAML
scene: $PWD/config/scenes/rig.yaml
recordings:
  - {file: a.csv, trajectory: simpleA, role: identify}
  - {file: a2.csv, trajectory: simpleA, role: fit}
  - {file: r.csv, trajectory: actual, role: holdout}
YAML
trace() { "$BIN/digloop" trace tables/reference_rig.sqlite "$work/campaign" --add "$work/model.json"; }
trace_us=$(microseconds_of trace)
[ -s "$work/model.json" ] || fault "no model: $(trace 2>&1 | tail -n 2)"
sed '/digloop trace/d; /written/d' "$work/model.json" >"$work/model.whole"

daemons=0 knew=0 models=0 digs_kept=0
while going; do
    for _ in 1 2 3 4 5 6 7 8; do
        had=$(grep -c moment_Nm "$work/match.json" 2>/dev/null)
        kill_within "$run_us" "$BIN/digsightd" -c "$work/run.yaml"
        [ $killed = yes ] && daemons=$((daemons + 1))
        if [ "${had:-0}" -gt 0 ]; then
            # What it says first is what it knows from before.
            if grep -q "from before (" "$work/err"; then
                knew=$((knew + 1))
            elif grep -q "match.json" "$work/err"; then
                fault "the state is refused"
            fi
        fi
        [ -e "$work/match.json" ] || continue
        "$BIN/digloop" predict "$work/table.sqlite" --identified "$work/match.json" --trajectory actual -o "$work/curve.csv" \
            2>"$work/err" || fault "the state is not whole"
        now=$(grep -c moment_Nm "$work/match.json")
        [ "$now" -ge "${had:-0}" ] || fault "$had digs were kept, $now are left"
        digs_kept=$now
    done
    [ $((RANDOM % 8)) = 0 ] && rm -f "$work/match.json"
    kill_within "$trace_us" trace
    [ $killed = yes ] && models=$((models + 1))
    sed '/digloop trace/d; /written/d' "$work/model.json" | cmp -s - "$work/model.whole" || fault "the model is not whole"
done
told $daemons "kill -9 of the daemon (the next one knew the gravel $knew times)"
told $models "kill -9 of digloop as it makes a model"
check "a daemon that is killed leaves a state that the next one knows" [ $wrong = 0 ]
finish
