#!/bin/bash
# digloop and digreport as a user meets them: LIGGGHTS digs against the table that ships, and bad input.
. tests/system/check.bash
table=${TABLE:-tables/reference_rig.sqlite}
reference=tests/data/reference/mu0.5_mur0.5_rho2500

"$BIN/digloop" identify "$table" "$reference"__simpleA.csv "$reference"_seed{2,3,4,5}__simpleA.csv --json \
    >"$work/id.json" 2>"$work/err"
check "digs of LIGGGHTS are identified" [ $? = 0 ]
check "and the table's too long step is told of" grep -q "gravel of 1500 kg/m3 trembles" "$work/err"
check "as gravel of the table" grep -q '"outside": false' "$work/id.json"
check "pooled, by moment and forces" grep -q '"digs": 5, "forces": true' "$work/id.json"
"$BIN/digloop" predict "$table" --identified "$work/id.json" --trajectory actual -o "$work/next.csv" >"$work/out" 2>"$work/err"
check "another dig is predicted" [ $? = 0 ]
check "people are told of it where no script reads" eval '[ ! -s "$work/out" ] && grep -q "actual: peak" "$work/err"'
"$BIN/digloop" predict "$table" --identified "$work/id.json" --trajectory actual -o - 2>/dev/null >"$work/stdout.csv"
check "the curve may go to standard output, alone" cmp -s "$work/next.csv" "$work/stdout.csv"
check "but not into other results" refuses "two results on standard output" -- \
    "$BIN/digloop" predict "$table" --identified "$work/id.json" --trajectory actual -o - --json
# Every result for a program is one JSON value, and there is nothing else where a script reads it.
gives_json() { "$BIN/$1" "${@:2}" --json 2>"$work/err" | is_json; }
json() { check "$1 $2 --json is JSON" gives_json "$@"; } # TOOL ARGUMENT…
json digloop identify "$table" "$reference"__simpleA.csv
json digloop predict "$table" --identified "$work/id.json" --trajectory actual --measured "$reference"__actual.csv
json digloop predict "$table" --identified "$work/id.json" --trajectory actual -o "$work/next.csv"
json digloop predict "$table" --identified "$work/id.json" --trajectory actual --machine config/machines/zx200_trench.yaml
"$BIN/digloop" predict "$table" --identified "$work/id.json" --trajectory actual --json --machine config/machines/zx200_trench.yaml \
    >"$work/machine.txt" 2>"$work/err"
# A bucket ten times as long: moments and energies 10^4 times, times the root of 10.
check "by a machine, peak and energy are lambda^4 times the table's" awk '
    function of(key) { return match(text, "\"" key "\": [0-9.e+-]+") ? substr(text, RSTART + length(key) + 4, RLENGTH) + 0 : 0 }
    /"machine": / { text = $0; big = of("peak_Nm"); work = of("energy_J"); lambda = of("lambda"); long = of("duration_s") }
    NR == 1 { text = $0; small = of("peak_Nm"); less = of("energy_J") }
    END { exit !((lambda - 10) ^ 2 < 1e-3 && (big / small / 1e4 - 1) ^ 2 < 1e-8 && (work / less / 1e4 - 1) ^ 2 < 1e-8 &&
        (long / sqrt(10) - 6.8) ^ 2 < 1e-4) }' "$work/machine.txt"
"$BIN/digloop" predict "$table" --identified "$work/id.json" --trajectory actual --machine config/machines/zx200_trench.yaml \
    >"$work/machine.txt" 2>"$work/err"
check "and people are told so" grep -q "^  by zx200_trench, 10.00 times the table's bucket: peak .* kN·m" "$work/machine.txt"
json digloop design "$table"
json digtable list "$table"
json digtable check "$table"
json digtable show "$table" 0
check "as a force recording that can be read again" \
    eval '[ "$(head -n 1 "$work/next.csv")" = "$(grep -v "^#" '"$reference"'__actual.csv | head -n 1)" ]'
"$BIN/digloop" identify "$table" "$work/next.csv" >"$work/out" 2>&1
check "the predicted dig is a dig of the table" [ $? = 0 ]

one=("$reference"__simpleA.csv)
"$BIN/digloop" identify "$table" "${one[@]}" >"$work/all.txt"
"$BIN/digloop" identify "$table" "${one[@]}" --moment-alone >"$work/moment.txt"
check "what was measured is said" grep -q "^  1 dig (simpleA): moment and forces$" "$work/all.txt"
check "forces are left out where that is asked for" grep -q "^  1 dig (simpleA): moment alone$" "$work/moment.txt"
width() { # FILE: of the density's 90 % interval
    sed -nE 's/.*density_kgpm3.*90 %: ([0-9.e+]+) to ([0-9.e+]+) .*/\1 \2/p' "$1" | awk '{ print $2 - $1 }'
}
check "and tell the density, which the moment hardly does" within "$(width "$work/all.txt")" 1 "$(width "$work/moment.txt")"

# The same digs through a machine: joint angles and pressures with the bus' steps and noise.
machine=config/machines/zx200_trench.yaml
number() { # FILE KEY AXIS: of an identity
    sed -nE "s/.*\"$2\": \{[^}]*\"$3\": ([0-9.e+-]+).*/\1/p" "$1"
}
agrees() { # A B: A's mean lies within B's 90 % interval, on every axis
    local axis
    for axis in friction rolling density_kgpm3; do
        awk -v v="$(number "$1" mean $axis)" -v low="$(number "$2" low $axis)" -v high="$(number "$2" high $axis)" \
            'BEGIN { exit !(v != "" && low != "" && v >= low && v <= high) }' || { echo "      $axis"; return 1; }
    done
}
"$BIN/digrig" record "$reference"{,_seed2}__simpleA.csv "$reference"__actual.csv --machine "$machine" -o "$work/run.csv" 2>"$work/err"
"$BIN/digloop" identify "$table" "$reference"{,_seed2}__simpleA.csv --json >"$work/force.json" 2>"$work/err"
check "digs are found in a machine recording and identified" eval '"$BIN/digloop" identify "$table" "$work/run.csv" \
    --machine "$machine" --trajectory simpleA --json >"$work/machine.json" 2>"$work/err"'
check "both of the trajectory asked for, by moment and forces" grep -q '"digs": 2, "forces": true' "$work/machine.json"
grep -v '^#' "$work/run.csv" | cut -d, -f1-4,9- >"$work/bucket.csv"
"$BIN/digloop" identify "$table" "$work/run.csv" "$work/bucket.csv" --machine "$machine" --trajectory simpleA >"$work/out" 2>"$work/err"
check "digs that lack the forces leave the moment to all" \
    grep -q "^  4 digs (simpleA): moment alone; forces in 2 of them$" "$work/out"
check "as the gravel that the force recordings say" agrees "$work/machine.json" "$work/force.json"
check "and the other way round" agrees "$work/force.json" "$work/machine.json"
"$BIN/digloop" predict "$table" --identified "$work/force.json" --trajectory actual --measured "$reference"__actual.csv --json \
    >"$work/by_force.json"
"$BIN/digloop" predict "$table" --identified "$work/force.json" --trajectory actual --measured "$work/run.csv" \
    --machine "$machine" --json >"$work/by_machine.json"
check "a prediction is as wrong against the machine recording as against the force recording" \
    awk -v a="$(sed -nE 's/.*"error": ([0-9.e-]+).*/\1/p' "$work/by_force.json")" \
        -v b="$(sed -nE 's/.*"error": ([0-9.e-]+).*/\1/p' "$work/by_machine.json")" \
        'BEGIN { exit !(a > 0 && b > 0 && (a - b) ^ 2 < 0.02 ^ 2) }'
# A boom that comes down briskly before a dig in the open: what its inertia reads as is no ground.
open_dig=tests/data/liggghts_product/mu0.4_mur0.6_rho3000_bucket0.4_seed1__simpleA.csv
brisk_depth() { # PACE
    "$BIN/digrig" record "$open_dig" --machine "$machine" --scene config/scenes/product.yaml --air-pace "$1" -q -o "$work/brisk.csv" &&
        "$BIN/digloop" identify tables/product.sqlite "$work/brisk.csv" --machine "$machine" --json |
        sed -nE 's/.*"depth": ([0-9.]+).*/\1/p' | head -n 1
}
check "a boom lowered nine times as briskly leaves a dig as deep" awk -v a="$(brisk_depth 1)" -v b="$(brisk_depth 3)" \
    'BEGIN { exit !(a > .9 && (a - b) ^ 2 < .06 ^ 2) }'
# A machine whose bucket is 250 kg heavier than its file says, and a model that says so.
heavier 250 "$work/heavy.yaml"
model() { # SCENE_HASH
    cat <<JSON
{"version": 1, "table": "rig.sqlite", "effects_table": "", "scene_hash": "$1",
 "gravel": {"friction": 0.5, "rolling": 0.5, "density_kgpm3": 2500},
 "low": {"friction": 0.4, "rolling": 0.4, "density_kgpm3": 2000},
 "high": {"friction": 0.6, "rolling": 0.6, "density_kgpm3": 3000}, "provenance": "digloop.sh",
 "effects": [{"name": "bucket_weight", "probability": 1, "parameters": [
   {"name": "mass_kg", "value": 250, "low": 250, "high": 250}]}]}
JSON
}
hash=$(sed -nE 's/.*"scene_hash": "([0-9a-f]{64})".*/\1/p' "$work/force.json")
model "$hash" >"$work/model.json"
model "${hash//[0-9]/f}" >"$work/elsewhere.json"
"$BIN/digrig" record "$reference"__simpleA.csv --machine "$work/heavy.yaml" -o "$work/heavy.csv" 2>"$work/err"
error_of() { # RECORDING OPTION…: of the prediction for simpleA
    "$BIN/digloop" predict "$table" --identified "$work/force.json" --trajectory simpleA --measured "$@" --json |
        sed -nE 's/.*"error": ([0-9.e-]+).*/\1/p'
}
errors="$(error_of "$reference"__simpleA.csv) $(error_of "$work/heavy.csv" --machine "$machine" --model "$work/model.json")
    $(error_of "$work/heavy.csv" --machine "$machine")"
check "a model takes off a recording what it says of the machine" \
    awk -v e="$errors" 'BEGIN { exit !(split(e, x, " ") == 3 && (x[1] - x[2]) ^ 2 < 0.02 ^ 2 && x[3] > x[2] + 0.04) }'
doubts() { "$BIN/digloop" identify "$table" "$work/heavy.csv" --machine "$machine" "$@" 2>"$work/err" | grep -q "perhaps it is the machine"; }
check "outside the table it may be the machine" doubts
sed 's/"value": 250, "low": 250, "high": 250/"value": 1, "low": 1, "high": 1/' "$work/model.json" >"$work/little.json"
check "not where a model says how that is" eval '! doubts --model "$work/little.json"'
check "though it lies outside by that, too" grep -q OUTSIDE <("$BIN/digloop" identify "$table" "$work/heavy.csv" --machine "$machine" \
    --model "$work/little.json" 2>/dev/null)
sed 's/"friction": 0/"friction": 99/' "$work/force.json" >"$work/wild.json"
check "an identity beyond the table is refused" refuses "wild.json: friction 99" "expected 0.3 to 0.9" -- \
    "$BIN/digloop" predict "$table" --identified "$work/wild.json" --trajectory actual
check "a dig that is named twice is refused" refuses "named twice" -- \
    "$BIN/digloop" identify "$table" "$reference"__simpleA.csv "$PWD/$reference"__simpleA.csv
check "a model of another scene is refused" refuses "elsewhere.json" "scene_hash" -- \
    "$BIN/digloop" identify "$table" "$work/run.csv" --machine "$machine" --model "$work/elsewhere.json"
check "digs along two trajectories are not pooled" refuses "different trajectories" "--trajectory" -- \
    "$BIN/digloop" identify "$table" "$work/run.csv" --machine "$machine"
check "without its machine a machine recording is refused" refuses "run.csv" "--machine" -- \
    "$BIN/digloop" identify "$table" "$work/run.csv"
sed 's/^bucket_width_m: .*/bucket_width_m: 1.0/' "$machine" >"$work/wide.yaml"
check "a machine with a bucket of another shape is refused, both named" refuses "wide.yaml" "rig.sqlite" "same shape" -- \
    "$BIN/digloop" identify "$table" "$work/run.csv" --machine "$work/wide.yaml"
head -n 300 "$work/run.csv" >"$work/air.csv"
check "a recording without a dig is refused" refuses "air.csv" "digs in it: 0" -- \
    "$BIN/digloop" identify "$table" "$work/air.csv" --machine "$machine"

check "digloop without arguments is bad usage" refuses "expected a command" -- "$BIN/digloop"
check "an unknown command is named" refuses "frobnicate" -- "$BIN/digloop" frobnicate "$table"
check "a table that is none is named" refuses README.md -- "$BIN/digloop" identify README.md "$reference"__simpleA.csv
simple=${reference}__simpleA.csv
awk -F, -v OFS=, 'NR == 50 { $7 = "" } 1' "$simple" >"$work/holed.csv"
check "forces that are missing are put on no machine" refuses "holed.csv" "is missing at t_s" -- \
    "$BIN/digrig" record "$work/holed.csv" --machine "$machine" -o "$work/never"
check "a missing recording is bad input, and named" refuses none.csv "No such file" -- "$BIN/digloop" identify "$table" "$work/none.csv"
check "so is a missing table" refuses none.sqlite "No such file" -- "$BIN/digloop" identify "$work/none.sqlite" "$simple"
check "... machine" refuses none.yaml "No such file" -- "$BIN/digloop" identify "$table" "$work/run.csv" --machine "$work/none.yaml"
check "... machine's recording or log" refuses none.lcm "No such file" -- "$BIN/digloop" identify "$table" "$work/none.lcm" --machine "$machine"
check "... model" refuses none.json "No such file" -- "$BIN/digloop" identify "$table" "$simple" --model "$work/none.json"
check "... identity" refuses none.json "No such file" -- "$BIN/digloop" predict "$table" --identified "$work/none.json" --trajectory actual -o "$work/never"
check "... dig to compare with" refuses none.csv "No such file" -- \
    "$BIN/digloop" predict "$table" --identified "$work/id.json" --trajectory actual --measured "$work/none.csv" -o "$work/never"
check "... table of effects" refuses none.sqlite "No such file" -- "$BIN/digloop" trace "$table" "$work" --effects "$work/none.sqlite"
check "a folder is no recording" refuses "$work: no regular file" -- "$BIN/digloop" identify "$table" "$work"
"$BIN/digloop" predict "$table" --identified "$work/id.json" --trajectory actual -o "$work/no/folder.csv" >"$work/out" 2>"$work/err"
check "a file that cannot be written is a failure of the work" eval '[ $? = 1 ] && grep -q "no/folder.csv" "$work/err"'
sed '3s/[^,]*$/x/' "$reference"__simpleA.csv >"$work/bad.csv"
check "a bad number is named by file, line and column" \
    refuses "bad.csv:3" "Mz_Nm" "expected" -- "$BIN/digloop" identify "$table" "$work/bad.csv"
check "recordings of two trajectories are not pooled" \
    refuses "different trajectories" -- "$BIN/digloop" identify "$table" "$reference"__simpleA.csv "$reference"__actual.csv
awk -F, -v OFS=, 'NR > 1 { $2 = 0.1; $3 = 0.1 + $1 } 1' "$reference"__simpleA.csv >"$work/lift.csv"
check "a path that is none of the table's is refused with its distance" \
    refuses "lift.csv" "bucket lengths away" -- "$BIN/digloop" identify "$table" "$work/lift.csv"
check "a misspelt trajectory is answered with those there are" refuses "actaul: no such trajectory" "$table: simpleA, " -- \
    "$BIN/digloop" predict "$table" --identified "$work/id.json" --trajectory actaul -o "$work/never"
check "an unknown trajectory is named" refuses "nowhere" -- \
    "$BIN/digloop" predict "$table" --identified "$work/id.json" --trajectory nowhere -o "$work/never"
sed 's/"scene_hash": "./"scene_hash": "x/' "$work/id.json" >"$work/other.json"
check "an identity of another scene is refused, both named" refuses "other.json" "rig.sqlite" "expected one scene" -- \
    "$BIN/digloop" predict "$table" --identified "$work/other.json" --trajectory actual -o "$work/never"
sed 's/"digs": 5/"digs": many/' "$work/id.json" >"$work/broken.json"
check "a broken identity is named by file, line and key" refuses "broken.json:1" "digs" "expected" -- \
    "$BIN/digloop" predict "$table" --identified "$work/broken.json" --trajectory actual -o "$work/never"

# A table dug at several depths and attacks: a coarse tub, half a second a dig.
tub=tests/data/formats/scene.yaml
"$BIN/digtable" generate $tub tests/data/formats/grid_approaches.yaml -o "$work/ways.sqlite" 2>"$work/err"
dig() { # FILE OPTIONS…
    "$BIN/digtable" dig $tub --trajectory scrape --friction .3 --rolling .2 --density 2500 --seed 7 -o "$@" 2>"$work/err"
}
dig "$work/deep.csv" --depth 1.1 --attack-deg 2
"$BIN/digloop" identify "$work/ways.sqlite" "$work/deep.csv" >"$work/out"
check "how deep and how turned a dig was is told" eval 'grep -qE "^  dig 1 at depth 1\.(09|10)[0-9], attack (1\.9|2\.0)[0-9] deg" "$work/out"'
"$BIN/digloop" identify "$work/ways.sqlite" "$work/deep.csv" --json >"$work/ways.json"
check "and kept in the identity" grep -qE '"depth": 1\.(09|10)[0-9]*, "attack_deg": (1\.9|2\.0)[0-9]*,$' "$work/ways.json"
"$BIN/digloop" predict "$work/ways.sqlite" --identified "$work/ways.json" --trajectory scrape --depth 1.1 --attack-deg 2 --json >"$work/ways.out"
"$BIN/digloop" predict "$work/ways.sqlite" --identified "$work/ways.json" --trajectory scrape --json >"$work/plain.out"
check "a prediction may be of a dig as deep, which is another" eval 'grep -q "\"depth\": 1.1, \"attack_deg\": 2" "$work/ways.out" && ! cmp -s <(tail -4 "$work/ways.out") <(tail -4 "$work/plain.out")'
check "and is compared with a dig as it was made" eval '"$BIN/digloop" predict "$work/ways.sqlite" \
    --identified "$work/ways.json" --trajectory scrape --measured "$work/deep.csv" | grep -q "error against"'
check "a depth off the table is no prediction" refuses "scrape, depth 1.9, attack 0 deg: off the table by 0." "bucket lengths" -- \
    "$BIN/digloop" predict "$work/ways.sqlite" --identified "$work/ways.json" --trajectory scrape --depth 1.9 -o "$work/never"
check "a table that was dug plainly alone has none" refuses "off the table" -- \
    "$BIN/digloop" predict "$table" --identified "$work/id.json" --trajectory actual --depth 1.2

shift_of() { "$BIN/digreport" shift tests/data/formats/daemon.lcm --table tables/product.sqlite --machine "$@"; }
check "digreport shift refuses a table of another scene than the log's" refuses "product.sqlite" "predicted from scene" -- \
    shift_of config/machines/zx120.yaml
check "digreport refuses a machine whose bucket has another shape" refuses "wide.yaml" "same shape" -- shift_of "$work/wide.yaml"
check "digreport without a log is bad usage" refuses "NAME=LOG.lcm" -- "$BIN/digreport" --table "$table" --machine config/machines/zx200_trench.yaml
check "a truth that is no gravel is named" refuses "--truth" "expected FRICTION" -- \
    "$BIN/digreport" --table "$table" --machine config/machines/zx200_trench.yaml --truth 1,2 "a=b"
check "a log that is none is named" refuses README.md -- \
    "$BIN/digreport" --table "$table" --machine config/machines/zx200_trench.yaml --html "$work/never" "a=README.md"
check "an unknown command has none" refuses frobnicate -- "$BIN/digloop" frobnicate --help

finish
