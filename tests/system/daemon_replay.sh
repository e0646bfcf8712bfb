#!/bin/bash
# A recording through the daemon onto LCM, and the log of that through the daemon again.
. tests/system/daemon_lib.bash

make_digs
beat="tick_Hz: 250" # of all but the first, which has the default's
"$BIN/digrig" record "$work/simpleA.csv" "$work/actual.csv" --machine "$machine" -o "$work/run.csv" 2>"$work/rig.err"
config csv "{kind: replay, replay: {file: run.csv, speed: 5}}"
config again "{kind: replay, replay: {file: csv.lcm, speed: 5}}" "$beat"

check "--check loads everything and says what it found" \
    eval '"$BIN/digsightd" -c "$work/csv.yaml" --check >"$work/check.txt" &&
          grep -q "scene rig" "$work/check.txt" && grep -q "zx200_trench" "$work/check.txt"'

log csv # over a network, as it is used
check "a replay ends by itself with exit status 0" run "$work/daemon.log" "$BIN/digsightd" -c "$work/csv.yaml"
read_log csv
rows=$(($(grep -vc '^#' "$work/run.csv") - 1))
# LCM promises nothing: a receiver that does not get its turn in time loses messages.
check "the lines of the recording are published as samples" \
    within "$(last samples "$work/csv.txt" 2)" $((rows * 98 / 100)) "$rows"
check "the gravel is identified from the simple dig" identified "$work/csv.txt"
# going_on, at a share of the path: wide, never wrong, and before the dig is over.
check "the simple dig is matched while it goes on" \
    awk '$1 == "match" && $NF && $2 { n++; if ($7 > .5 || $8 < .5 || $10 > .4 || $11 < .4 || $13 > 2200 || $14 < 2200) bad++ }
         END { exit !(n >= 1 && !bad) }' "$work/csv.txt"
check "and that before most of it is dug" \
    within "$(awk '$1 == "match" { print $(NF - 1); exit }' "$work/csv.txt")" 0.3 0.8
check "what part of a dig does not tell is told: a family, by rolling friction" grep -q '^family 1 ".*rolling' "$work/csv.txt"
check "and no family once the dig is over" [ "$(awk '$1 == "family" { was = $0 } END { print was }' "$work/csv.txt")" = 'family 0 "" 1' ]
# What resists is density times friction and density times rolling friction: 1100 and 880, which .9, .6, 1500 comes nearest to.
check "the entry nearest by the noise-weighted distance is told" \
    [ "$(awk '$1 == "weighted" { e = ($2 >= 0) " " $3 " " $4 " " $5 " " ($6 > 1 && $6 < 10) } END { print e }' "$work/csv.txt")" = "1 0.9000 0.6000 1500.0 1" ]
check "and the log says it" grep -q 'noise-weighted entry 0\.90 / 0\.60 / 1500 at ' "$work/daemon.log"
check "the actual dig does not identify" [ "$(last match "$work/csv.txt" 5)" = simpleA ]
check "the actual dig is predicted while it goes on" \
    [ "$(grep -c '^prediction 1 actual' "$work/csv.txt")" -ge 5 ]
check "peak, energy and forces of each prediction have their sigma" \
    awk '$1 == "spread" && $2 > 0 { n++; bad += !($3 > 0 && $4 > 0 && $5 > 0 && $6 > 0 && $7 > 0) } END { exit !(n >= 5 && !bad) }' "$work/csv.txt"
check "the end of the dig ends its prediction" grep -q '^prediction 0 ' "$work/csv.txt"
check "in the air each dig is predicted whole" \
    eval 'grep -q "^prediction 1 actual 0\.00000 " "$work/csv.txt" &&
          grep -q "^prediction 1 simpleA 0\.00000 " "$work/csv.txt"'
# simpleA penetrates, is dragged, lifted; actual penetrates, curls, is dragged, curls, is lifted. The data's soil
# is hardly felt before the first leg ends.
motions() { # FILE DIG: what the bucket did in a dig, counted from 0
    awk -v dig="$2" '$1 == "estimate" && $NF != 0 && $8 == dig && $NF != was { printf "%s", $NF; was = $NF }' "$1"
}
check "what the bucket does is told leg by leg" \
    eval '[[ "$(motions "$work/csv.txt" 0)" =~ ^1?24$ && "$(motions "$work/csv.txt" 1)" =~ ^1?3234$ ]]'
check "both digs are counted" [ "$(last health "$work/csv.txt" $h_digs)" = 2 ]
endings() { # FILE: digs whole, aborted, unknown
    awk '$1 == "endings" { e = $2 " " $3 " " $4 } END { print e }' "$1"
}
# The data's actual is not felt along its last leg: how it ended is not told.
check "the simple dig is told to be whole" [ "$(endings "$work/csv.txt")" = "1 0 0" ]
check "health goes from waiting over running to stopping" \
    [ "$(awk '/^health/ && $2 != was { was = $2; print $2 }' "$work/csv.txt" | sort -u | tr '\n' ' ')" = \
      "running stopping waiting_for_bus " ]
check "nothing was lost" [ "$(last health "$work/csv.txt" $h_lost)" = 0 ]
forces() { # FILE: whether the last match says that forces were used
    awk '$1 == "match" { f = $(NF - 3) } END { print f }' "$1"
}
check "the match says that it is of moment and forces" [ "$(forces "$work/csv.txt")" = 1 ]

"$BIN/digrig" record "$work/simpleA.csv" "$work/simpleA.csv" "$work/simpleA.csv" "$work/actual.csv" --machine "$machine" \
    -o "$work/thrice.csv" 2>"$work/rig.err"
config thrice "{kind: replay, replay: {file: thrice.csv, speed: 10}}" "match: {state: thrice.json}
$beat"
replay thrice
check "three simple digs are matched together" [ "$(awk '$1 == "match" { n = $(NF - 2) } END { print n }' "$work/thrice.txt")" = 3 ]
check "which narrows the interval" awk '$1 == "match" && !$NF { w = $8 - $7; first = first ? first : w } END { exit !(w < first) }' "$work/thrice.txt"
check "and keeps the gravel" identified "$work/thrice.txt"
check "and the digs in the state file" [ "$(grep -c moment_Nm "$work/thrice.json")" = 3 ]
check "with their forces" [ "$(grep -c '"force": {' "$work/thrice.json")" = 3 ]
config fourth "{kind: replay, replay: {file: run.csv, speed: 10}}" "match: {state: thrice.json}
$beat"
replay fourth
check "a daemon started anew goes on with them, forces and all" \
    [ "$(awk '$1 == "match" && $3 == 0 { n = $(NF - 2) } END { print n }' "$work/fourth.txt") $(forces "$work/fourth.txt")" = "4 1" ]
# Without a machine's noise the packings' scatter alone weighs: all of it is one factor, so what counts is the curve's shape.
"$BIN/digloop" identify "$work/table.sqlite" "$work/simpleA.csv" --json >"$work/A.json" 2>"$work/A.err"
check "digloop identify tells such an entry, too" \
    eval '"$BIN/digloop" identify "$work/table.sqlite" "$work/simpleA.csv" | grep -q "^  noise-weighted: entry 0.6 / 0.3 / 1500, [1-9]" &&
          grep -q "\"weighted_nearest\": {\"friction\": 0.6, \"rolling\": 0.3, \"density_kgpm3\": 1500}" "$work/A.json"'
check "digloop matches simple digs along several trajectories together" \
    eval '"$BIN/digloop" identify "$work/table.sqlite" "$work/simpleA.csv" "$work/simpleB.csv" |
          grep -q "^  2 digs (simpleA, simpleB): moment and forces$"'

# An actual that is given up.
awk -F, '/^[^0-9]/ { print; next } $1 < 0.7 * end' \
    end="$(tail -n 1 "$work/actual.csv" | cut -d, -f1)" "$work/actual.csv" >"$work/half.csv"
"$BIN/digrig" record "$work/simpleA.csv" "$work/half.csv" "$work/actual.csv" --machine "$machine" \
    -o "$work/aborts.csv" 2>"$work/rig.err"
config aborts "{kind: replay, replay: {file: aborts.csv, speed: 10}}" "$beat"
replay aborts
check "a dig that was aborted is counted as such" [ "$(endings "$work/aborts.txt")" = "1 1 0" ]
check "and said" grep -Eq 'dig 2 \(actual\): aborted at [67][0-9] % of its path' "$work/daemon.log"
check "the gravel stays known" identified "$work/aborts.txt"

replay again
check "the log of the daemon is accepted as a recording and gives the gravel again" identified "$work/again.txt"
identify() { # NAME RECORDING…: with digloop, offline
    "$BIN/digloop" identify "$work/table.sqlite" "${@:2}" --json >"$work/$1.json" 2>"$work/$1.err" &&
        sed -nE 's/.*"mean": \{"friction": ([^,]*), "rolling": ([^,]*), "density_kgpm3": ([^}]*)\}.*/\1 \2 \3/p' "$work/$1.json"
}
by_force=$(identify by_force "$work/simpleA.csv")
by_log=$(identify by_log "$work/csv.lcm" --machine "$machine" --trajectory simpleA)
check "digloop finds the dig in the log and the same gravel as in the force recording" \
    awk -v a="$by_force" -v b="$by_log" 'BEGIN { exit !(split(a, x, " ") == 3 && split(b, y, " ") == 3 &&
        (y[1] / x[1] - 1) ^ 2 < 0.15 ^ 2 && (y[2] / x[2] - 1) ^ 2 < 0.15 ^ 2 && (y[3] / x[3] - 1) ^ 2 < 0.15 ^ 2) }'
mkdir "$work/campaign"
cp "$work/csv.lcm" "$work/campaign/day.lcm"
cp "$machine" "$work/campaign/machine.yaml"
cat >"$work/campaign/campaign.yaml" <<YAML
scene: rig
machine: machine.yaml
recordings:
  - {file: day.lcm, trajectory: simpleA, role: identify}
  - {file: day.lcm, trajectory: actual, role: fit}
  - {file: day.lcm, trajectory: actual, role: holdout}
YAML
"$BIN/digloop" trace "$work/table.sqlite" "$work/campaign" --json "$work/trace.json" 2>"$work/trace.err"
check "digloop trace finds each dig of a campaign in the log" \
    within "$(tr -d '\n' <"$work/trace.json" | sed -nE 's/.*"error_before": \{"holdout": ([0-9.]+).*/\1/p')" 0 0.1
# A machine whose bucket cylinder alone is instrumented.
grep -v '^#' "$work/run.csv" | cut -d, -f1-4,9- >"$work/bucket.csv"
config bucket "{kind: replay, replay: {file: bucket.csv, speed: 5}}" "$beat"
bare='boom_head_Pa, boom_rod_Pa, arm_head_Pa, arm_rod_Pa'
"$BIN/digsightd" -c "$work/bucket.yaml" --check >"$work/check.txt"
check "--check says what is not measured" grep -q "not measured: $bare;" "$work/check.txt"
replay bucket
check "the bucket's pressures alone identify the gravel" identified "$work/bucket.txt"
check "and the match says so" [ "$(forces "$work/bucket.txt")" = 0 ]
check "every estimate has the moment and names what is missing of the force" \
    eval '[ "$(grep -c "^estimate" "$work/bucket.txt")" -ge "$((rows * 95 / 100))" ] &&
          ! grep "^estimate" "$work/bucket.txt" | grep -vqF " 0 \"$bare\""'
check "so does health" eval '[ "$(grep -cF "\"$bare\"" <(grep "^health running" "$work/bucket.txt"))" -ge 3 ]'
check "where nothing is missing nothing is named" eval '! grep "^health" "$work/csv.txt" | grep -qF "_Pa"'
by_bucket=$(identify by_bucket "$work/bucket.csv" --machine "$machine" --trajectory simpleA)
check "digloop identifies from such a recording, too" \
    awk -v a="$by_force" -v b="$by_bucket" 'BEGIN { exit !(split(a, x, " ") == 3 && split(b, y, " ") == 3 &&
        (y[1] / x[1] - 1) ^ 2 < 0.15 ^ 2 && (y[2] / x[2] - 1) ^ 2 < 0.15 ^ 2 && (y[3] / x[3] - 1) ^ 2 < 0.15 ^ 2) }'
"$BIN/digreport" --table "$work/table.sqlite" --machine "$machine" --truth .5,.4,2200 --recording "$work/simpleA.csv" \
    --recording "$work/actual.csv" --html "$work/page.html" --json "$work/page.json" "a replay=$work/csv.lcm" \
    >"$work/report.txt" 2>"$work/report.err"
check "digreport finds the dig that identified and the one that was predicted" [ $? = 0 ]
check "and that the prediction was right" \
    within "$(sed -nE 's/.*"error":([0-9.e-]+),.*/\1/p' "$work/page.json")" 0 0.1
check "its table is for people, its JSON for programs" eval '[ ! -s "$work/report.txt" ] && [ -s "$work/report.err" ] && is_json <"$work/page.json"'
check "that it identified by moment and forces" grep -q "simpleA identified the gravel by moment and forces, then actual" "$work/report.err" "$work/page.html"
check "on a page with both curves" [ "$(grep -c '<svg' "$work/page.html")" = 2 ]
shift_of() { "$BIN/digreport" shift "$@" >"$work/shift.txt" 2>"$work/err"; }
field() { awk -F, -v name="$1" -v row="$2" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) f = i } NR == row + 1 { print $f }' "$work/shift.csv"; }
check "digreport shift makes a page and a table of both logs" shift_of --html "$work/shift.html" --csv "$work/shift.csv" \
    --table "$work/table.sqlite" --machine "$machine" "$work/csv.lcm" "$work/aborts.lcm"
check "with every dig" [ "$(cut -d, -f3 "$work/shift.csv" | tr '\n' ' ')" = "trajectory simpleA actual simpleA actual actual " ]
check "and how it ended, where the daemon could tell" [ "$(cut -d, -f4 "$work/shift.csv" | tr '\n' ,)" = ended,whole,,whole,aborted,, ]
check "says it in a sentence" grep -Eq '^5 digs in [0-9]+ min, 1 aborted; the gravel at the end: friction 0\.[45].* predictions, off by [0-9] % ' "$work/shift.txt"
check "has the error of the actual dig's prediction" within "$(field error 2)" 0 0.1
check "and a peak and an energy within four sigma of the predicted" eval '
    within "$(awk -v a="$(field peak_Nm 2)" -v b="$(field predicted_peak_Nm 2)" -v s="$(field predicted_peak_sigma_Nm 2)" "BEGIN { print (a - b) / s }")" -4 4 &&
    within "$(awk -v a="$(field energy_J 2)" -v b="$(field predicted_energy_J 2)" "BEGIN { print a / b }")" 0.8 1.2'
check "the dig that identified is not judged by itself" [ -z "$(field error 1)" ]
check "the page needs nothing from elsewhere, and names no folder" eval '[ "$(grep -c "<svg" "$work/shift.html")" = 7 ] &&
    ! grep -o "[a-z]*://[a-z.0-9]*" "$work/shift.html" | grep -qv "://www.w3.org" && ! grep -qF "$work" "$work/shift.html"'
check "an aborted dig is among the troubles" grep -q 'dig 2 (actual): aborted at [67][0-9] % of its path' "$work/shift.html"
rig_peak=$(field rig_peak_Nm 2) peak=$(field peak_Nm 2)
check "from the logs alone it makes both, at machine scale" eval 'shift_of --html "$work/alone.html" --csv "$work/shift.csv" "$work/csv.lcm" "$work/aborts.lcm" &&
    grep -q "All at machine scale" "$work/alone.html" && [ -z "$(field rig_peak_Nm 2)" ] && [ -n "$rig_peak" ] &&
    within "$(awk -v a="$(field peak_Nm 2)" -v b="$peak" "BEGIN { print a / b }")" 0.99 1.01'
check "and JSON, what people read going to standard error" eval 'shift_of --json - "$work/csv.lcm" && is_json <"$work/shift.txt" &&
    grep -q "^2 digs in" "$work/err"'
for args in "" --json=-; do
    check "a page that cannot be drawn leaves nothing${args:+, nor other results}" eval '! PATH=/nonexistent shift_of --html "$work/no.html" $args "$work/csv.lcm" &&
        grep -q "gnuplot: .*package gnuplot-nox" "$work/err" && [ ! -s "$work/shift.txt" ] && ! ls "$work"/no.* 2>/dev/null'
done
head -c 5000 /dev/urandom >"$work/rubbish.lcm"
check "a log that is none is refused, and nothing is written" eval '! shift_of --html "$work/no.html" --csv "$work/no.csv" "$work/csv.lcm" "$work/rubbish.lcm" &&
    grep -q "rubbish.lcm:1: does not begin with ED A1 DA 01" "$work/err" && ! ls "$work"/no.* 2>/dev/null'
check "so is one that is not there" eval 'shift_of "$work/csv.lcm" "$work/nowhere.lcm"; [ $? = 2 ] && grep -q "nowhere.lcm: No such file" "$work/err"'
check "without a log it says what is missing" eval 'shift_of; [ $? = 2 ] && grep -q "shift: expected at least one LOG.lcm" "$work/err"'
check "a table without a machine does not tell the scale" eval 'shift_of --table "$work/table.sqlite" "$work/csv.lcm"; [ $? = 2 ] &&
    grep -q "expected --table and --machine, or neither" "$work/err"'

# A table dug at several depths and attacks: a simple dig at 1.12 of its depth, the same again, one at 1.7.
"$helpers/daemon_data" "$scene" "$work" ways >"$work/ways.log" 2>&1
"$BIN/digrig" record "$work/deep.csv" "$work/deep.csv" "$work/far.csv" --machine "$machine" -o "$work/ways.csv" 2>"$work/rig.err"
config ways "{kind: replay, replay: {file: ways.csv, speed: 20}}" "publish: {estimate_every: 10}
$beat"
sed -i 's/table.sqlite/ways.sqlite/' "$work/ways.yaml"
replay ways
# DEPTH, ATTACK_deg, MATCHED_DEPTH, MATCHED_ATTACK_deg of the last match: a dig in the table, whose depth is told to a tenth.
check "the match says how deep the dig was" within "$(last match "$work/ways.txt" 18)" 1.02 1.22
check "and how its bucket stood" within "$(last match "$work/ways.txt" 19)" -1 1
check "and at what it was matched" within "$(last match "$work/ways.txt" 20)" 1.02 1.2
check "both deep digs are of one gravel, the one told" eval '[ "$(awk "\$1 == \"match\" { n = \$(NF - 2) } END { print n }" "$work/ways.txt")" = 2 ] &&
    within "$(last match "$work/ways.txt" 6)" 0.35 0.65 && [ "$(last match "$work/ways.txt" 3)" = 0 ]'
check "the second is predicted as deep as it is dug" \
    awk '$1 == "prediction" && $2 && $4 > .4 && $8 > 1.02 && $8 < 1.22 { n++ } END { exit !(n >= 2) }' "$work/ways.txt"
check "one that is too deep is off the table" grep -q '^prediction 0 .* -\?nan -\?nan "off the table"$' "$work/ways.txt"
check "and is no match" [ "$(last match "$work/ways.txt" 4) $(last health "$work/ways.txt" $h_matches)" = "2 2" ]
check "the log says it, too" grep -q "dig 1 (simpleA, depth 1\.[0-2][0-9], attack -\?[01]\.[0-9] deg" "$work/daemon.log"
finish
