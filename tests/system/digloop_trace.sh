#!/bin/bash
# digloop trace as a user meets it: LIGGGHTS digs in plain gravel, and campaigns that cannot be traced.
. tests/system/check.bash
table=${TABLE:-tables/reference_rig.sqlite}
reference=$PWD/tests/data/reference/mu0.5_mur0.5_rho2500

traced() { "$BIN/digloop" trace "$table" "$1" --json "$work/never"; } # FOLDER

campaign() { # FOLDER SCENE, then FILE TRAJECTORY ROLE…
    mkdir -p "$work/$1"
    { echo "scene: $2"; echo "recordings:"; } >"$work/$1/campaign.yaml"
    local folder=$1
    shift 2
    while [ $# -gt 0 ]; do
        echo "  - {file: $1, trajectory: $2, role: $3}" >>"$work/$folder/campaign.yaml"
        shift 3
    done
}

A=$reference R=__actual.csv S=__simpleA.csv
campaign plain rig "$A$S" simpleA identify "$A$R" actual fit "${A}_seed2$S" simpleA fit "${A}_seed2$R" actual fit \
    "${A}_seed3$S" simpleA fit "${A}_seed3$R" actual holdout "${A}_seed4$R" actual holdout
"$BIN/digloop" trace "$table" "$work/plain" --json "$work/t.json" --html "$work/t.html" --add "$work/m.json" \
    >"$work/text" 2>"$work/err"
check "digs of LIGGGHTS in plain gravel are traced" [ $? = 0 ]
check "nothing is found in them" grep -q '"verdict": \["none"\]' "$work/t.json"
check "in words too" grep -qi "nothing is missing" "$work/err"
check "which are not where scripts read" [ ! -s "$work/text" ]
check "the file is JSON" is_json <"$work/t.json"
check "before and after are the same then" \
    eval '[ "$(sed -nE "s/.*error_before\": (\{[^}]*\}).*/\1/p" "$work/t.json")" = "$(sed -nE "s/.*error_after\": (\{[^}]*\}).*/\1/p" "$work/t.json")" ]'
check "the page needs no network" eval '! grep -qE "(src|href)=\"https?:" "$work/t.html"'
check "the model names its table" grep -q "\"table\": \"$table\"" "$work/m.json"
"$BIN/digloop" trace "$table" "$work/plain" --json - --html /dev/stdout >"$work/stdout.json" 2>"$work/err"
check "two results may not" eval '[ $? = 2 ] && [ ! -s "$work/stdout.json" ] && grep -q "two results" "$work/err"'

# Where results may go: by two digs, which are traced sooner.
campaign named config/scenes/rig.yaml "$A$S" simpleA identify "$A$R" actual fit
sed -i "s|scene: .*|scene: $PWD/config/scenes/rig.yaml|" "$work/named/campaign.yaml"
"$BIN/digloop" trace "$table" "$work/named" --json "$work/n.json" --add "$work/named.json" >/dev/null 2>&1
check "a scene may be a file; without a holdout the errors are not known" \
    eval '[ $? = 0 ] && grep -q "\"holdout\": null" "$work/n.json"'
"$BIN/digloop" trace "$table" "$work/named" >"$work/text" 2>"$work/err"
check "asked for nothing else, words are the result" eval 'grep -qi "nothing is missing" "$work/text" && ! grep -v trembles "$work/err"'
"$BIN/digloop" trace "$table" "$work/named" --json - >"$work/stdout.json" 2>/dev/null
check "JSON may go to standard output, alone, and the same campaign gives the same answer" cmp -s "$work/n.json" "$work/stdout.json"
(program=$(realpath "$BIN/digloop") data=$(realpath "$table") && cd "$work" && "$program" trace "$data" named --html - >page 2>told)
check "so may the page" eval 'head -n 1 "$work/page" | grep -q "<!doctype html>" && tail -n 1 "$work/page" | grep -q "</html>" && [ ! -e "$work/-" ] && [ ! -e "$work/-.part" ]'
check "... with what is for people on standard error" grep -qi "nothing is missing" "$work/told"
"$BIN/digloop" trace "$table" "$work/named" --add - 2>"$work/told" | sed 's/digloop trace .*/x/' >"$work/page"
check "... and the model, alone" eval \
    'cmp -s "$work/page" <(sed "s/digloop trace .*/x/" "$work/named.json") && grep -qi "nothing is missing" "$work/told"'
echo old >"$work/old.json" && cp "$work/old.json" "$work/old_model.json"
for option in "--json $work/old.json" "--add $work/old_model.json"; do
    # No file may grow; what is said goes through a pipe.
    # shellcheck disable=SC2086 # two words
    told=$( (trap '' XFSZ && ulimit -f 0 && exec "$BIN/digloop" trace "$table" "$work/named" $option) 2>&1 >/dev/null)
    status=$? file=${option#* }
    check "what cannot be written whole leaves the old file: ${option%% *}" \
        eval '[ "$status" = 1 ] && [ "$(cat "$file")" = old ] && [ ! -e "$file.part" ] && [[ $told == *"$file"* ]]'
done

# The moment alone; and all of it, with samples lost: every tenth line, and Fz on a stretch.
campaign moment rig moment_a.csv simpleA identify moment_b.csv actual fit
campaign lossy rig lossy_a.csv simpleA identify lossy_b.csv actual fit
for dig in "a $A$S" "b $A$R"; do
    cut -d, -f1-4,9 "${dig#* }" >"$work/moment/moment_${dig%% *}.csv"
    awk -F, -v OFS=, 'NR > 1 && NR % 10 == 0 { $5 = $6 = $7 = $8 = $9 = $10 = "" } NR > 99 && NR < 120 { $7 = "" } 1' \
        "${dig#* }" >"$work/lossy/lossy_${dig%% *}.csv"
done
for name in moment lossy; do
    "$BIN/digloop" trace "$table" "$work/$name" --json "$work/$name.json" >/dev/null 2>"$work/err"
    check "digs of which not all was measured are traced: $name" eval '[ $? = 0 ] && grep -q "\"verdict\": \[\"none\"\]" "$work/$name.json"'
done
cp "$work/moment/moment_a.csv" "$work/kept.csv"
check "a result does not take the place of a recording" refuses "moment_a.csv: to be written, and read by the campaign" -- \
    "$BIN/digloop" trace "$table" "$work/moment" --json "$work/moment/moment_a.csv"
check "which stays as it was" cmp -s "$work/moment/moment_a.csv" "$work/kept.csv"
friction() { tr -d ' \n' <"$1" | sed -nE 's/.*"friction":\{"value":([-0-9.e+]+).*/\1/p'; }
check "lost samples hardly change the gravel" within "$(friction "$work/lossy.json")" \
    "$(awk -v f="$(friction "$work/n.json")" 'BEGIN { print f - .01 }')" "$(awk -v f="$(friction "$work/n.json")" 'BEGIN { print f + .01 }')"
awk -F, -v OFS=, 'NR > 99 && NR < 140 { $9 = "" } 1' "$A$R" >"$work/lossy/lossy_b.csv"
check "of a moment lost for longer nothing is made up" refuses "lossy/lossy_b.csv: My_Nm is missing for longer than 0.16 s" -- traced "$work/lossy"

# The rig at another size: the scene, and digs as they would be recorded there (Froude similarity).
scaled_scene() { # LAMBDA
    awk -v l="$1" '
        function times(line, f,    out) { # every number behind the key
            out = ""
            while (match(line, /-?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?/)) {
                out = out substr(line, 1, RSTART - 1) sprintf("%.17g", f * substr(line, RSTART, RLENGTH))
                line = substr(line, RSTART + RLENGTH)
            }
            return out line
        }
        { sub(/#.*/, "") }
        /^    - \[|^  [xyz]: \[/ || /width_m:|diameter_m:/ { $0 = times($0, l) }
        /young_Pa:/ { $0 = times($0, l) }
        /velocity_mps:/ { $0 = times($0, sqrt(l)) }
        /start_pin_m:/ { $0 = times($0, l) }
        /- \{name:/ {
            n = split($0, part, /, */)
            $0 = part[1]
            for (i = 2; i <= n; i++) {
                f = part[i] ~ /omega/ ? 1 / sqrt(l) : sqrt(l)
                $0 = $0 ", " times(part[i], f)
            }
        }
        1' config/scenes/rig.yaml
}
scaled_dig() { # LAMBDA FILE
    awk -F, -v OFS=, -v CONVFMT=%.12g -v l="$1" \
        'NR > 1 { $1 *= sqrt(l); $2 *= l; $3 *= l; for (i = 5; i < 8; i++) $i *= l ^ 3; for (i = 8; i < 11; i++) $i *= l ^ 4 } 1' "$2"
}
tell() { tr -d ' \n' <"$1" | grep -oE '"(verdict|material)":(\[[^]]*\]|\{("[a-z_0-9]*":\{[^}]*\},?)*\})'; }
campaign times2 "$work/scene2.yaml" a.csv simpleA identify b.csv actual fit
scaled_scene 2 >"$work/scene2.yaml"
scaled_dig 2 "$A$S" >"$work/times2/a.csv"
scaled_dig 2 "$A$R" >"$work/times2/b.csv"
"$BIN/digloop" trace "$table" "$work/times2" --json "$work/times2.json" >/dev/null 2>"$work/err" || cat "$work/err"
check "digs twice as large say the same of the gravel" \
    eval '[ -n "$(tell "$work/n.json")" ] && [ "$(tell "$work/times2.json")" = "$(tell "$work/n.json")" ]'
cp "$A$S" "$work/times2/a.csv"
check "a dig of one size in a scene of another is refused" refuses "times2/a.csv: the recording's path is none of the table's" -- traced "$work/times2"

# A scene file that is the rig's with one thing changed, or another that ships.
scene_is() { # NAME SED-SCRIPT
    sed "$2" config/scenes/rig.yaml >"$work/$1.yaml"
    campaign "$1" "$work/$1.yaml" "$A$S" simpleA identify "$A$R" actual fit
}
other_scene() { # NAME KEY: refused, both scenes and the table named, and what of them differs
    check "another scene is refused: $1" \
        refuses "$1.yaml: scene \"" "is not similar to \"rig\" of $table: $2" "expected" -- traced "$work/$1"
}
scene_is product ""
cp config/scenes/product.yaml "$work/product.yaml"
other_scene product "box_m.x"
scene_is flat 's/- \[-0.04, -0.072\]/- [-0.01, -0.072]/; s/- \[-0.052, -0.042\]/- [-0.015, -0.042]/; s/- \[-0.04, -0.012\]/- [-0.01, -0.012]/'
other_scene flat "bucket.profile_m"
scene_is fine 's/diameter_m: .*/diameter_m: 0.003/'
other_scene fine "material.diameter_m: 0.003, expected 0.0075"
scene_is deep 's/z: \[0, 0.085\]/z: [-0.025, 0.085]/'
other_scene deep "box_m.z"
scene_is open 's/^output_s/bed:\n  periodic_y: true\noutput_s/'
other_scene open "bed.periodic_y"
scene_is stiff 's/young_Pa: .*/young_Pa: 2.0e+7/'
other_scene stiff "material.young_Pa"
scene_is elsewhere 's/start_pin_m: \[0.09,/start_pin_m: [0.11,/'
other_scene elsewhere 'trajectory "actual"'
sed 's/bucket_width_m: .*/bucket_width_m: 1.0/' config/machines/zx200_trench.yaml >"$work/wide.yaml"
recording=$PWD/tests/data/formats/machine_recording.csv
cp "$recording" "$work/again.csv"
campaign wide rig "$recording" simpleA identify "$work/again.csv" actual fit
echo "machine: ../wide.yaml" >>"$work/wide/campaign.yaml"
check "a machine whose bucket is of another shape is refused" refuses "wide.yaml does not fit" "fit $table: scene \"rig\"" -- traced "$work/wide"

campaign mixed rig "$A$S" simpleA identify "$A$R" actual fit "$PWD/tests/data/formats/machine_recording.csv" actual fit
check "recordings of a rig and of a machine are not mixed" \
    refuses "machine_recording.csv: a machine recording, but mu0.5_mur0.5_rho2500__simpleA.csv is a force recording" -- traced "$work/mixed"
campaign colour rig colour.csv simpleA identify "$A$R" actual fit
sed 's/^t_s/colour,t_s/; 2,$s/^/0,/' "$A$S" >"$work/colour/colour.csv"
check "a column that nobody knows is named" refuses 'colour/colour.csv:1: column "colour": unknown' -- traced "$work/colour"
# A machine's recordings, and the same with a pressure cut off at half of its peak, as a sensor too small would.
machine=$PWD/config/machines/zx200_trench.yaml
clip() { # COLUMN FILE
    local column
    column=$(head -n 1 "$2" | tr , '\n' | grep -nx "$1" | cut -d: -f1)
    awk -F, -v OFS=, -v c="$column" 'NR == FNR { if (FNR > 1 && $c > most) most = $c; next } FNR > 1 && $c > most / 2 { $c = most / 2 } 1' \
        OFMT=%.9g CONVFMT=%.9g "$2" "$2"
}
campaign whole rig a.csv simpleA identify b.csv actual fit
echo "machine: $machine" >>"$work/whole/campaign.yaml"
"$BIN/digrig" record "$A$S" --machine "$machine" -o "$work/whole/a.csv" 2>"$work/err" &&
    "$BIN/digrig" record "$A$R" --machine "$machine" -o "$work/whole/b.csv" 2>"$work/err"
"$BIN/digloop" trace "$table" "$work/whole" --json "$work/w.json" >/dev/null 2>"$work/err"
check "recordings of a machine are traced" eval '[ $? = 0 ] && grep -q "\"verdict\": \[\"none\"\]" "$work/w.json"'
mkdir "$work/clipped" && cp "$work/whole/"* "$work/clipped"
for chamber in arm_head_Pa bucket_head_Pa; do
    clip $chamber "$work/whole/b.csv" >"$work/clipped/b.csv"
    check "a pressure that was cut off is named: $chamber" \
        refuses "clipped/b.csv: $chamber stays at its highest value" "clipped, expected" -- traced "$work/clipped"
done

mkdir "$work/cut" && cp "$work/whole/"* "$work/cut"
awk -F, '!($1 > 12 && $1 < 13)' "$work/whole/b.csv" >"$work/cut/b.csv"
check "rows missing within a dig are told as such" refuses "b.csv: its moment is not told: no whole sample for 1 s after t_s 12, expected none missing" -- traced "$work/cut"

mkdir "$work/joined" && cp "$work/whole/"* "$work/joined"
awk -F, -v OFS=, 'FNR == 1 { begin = last } FNR > 1 { last = $1 + .01; $1 += begin } FNR > 1 || NR == 1' OFMT=%.9g CONVFMT=%.9g "$work/whole/b.csv" "$work/whole/a.csv" >"$work/joined/b.csv"
check "recordings put together are told as such" refuses "b.csv: bucket_rad jumps by" "one recording a file" -- traced "$work/joined"

campaign one rig "$A$S" simpleA identify
check "one dig is too few" refuses "expected two or more" -- traced "$work/one"
campaign other another "$A$S" simpleA identify "$A$R" actual fit
check "another scene is refused" refuses "another" "rig" -- traced "$work/other"
campaign swapped rig "$A$S" actual identify "$A$R" actual fit
check "a dig along another trajectory is named" refuses "swapped/campaign.yaml:3: recordings[0].trajectory: \"actual\", expected simpleA, along which" "mu0.5_mur0.5_rho2500__simpleA.csv is dug" -- traced "$work/swapped"
campaign nowhere rig "$A$S" sideways identify "$A$R" actual fit
check "a trajectory that the table lacks is named" refuses "nowhere/campaign.yaml:3: recordings[0].trajectory: \"sideways\", expected one of the table's: simpleA, simpleB, actual" -- traced "$work/nowhere"
campaign gone rig none.csv simpleA identify "$A$R" actual fit
check "a recording in place of a folder is named" refuses "gone/campaign.yaml: expected a folder with a campaign.yaml" -- traced "$work/gone/campaign.yaml"
check "a missing recording is named" refuses "file: $work/gone/none.csv: No such file" "campaign.yaml:" -- traced "$work/gone"
sed -i 1d "$work/gone/campaign.yaml"
echo "scene: none.yaml" >>"$work/gone/campaign.yaml"
check "so is a missing scene" refuses "gone/none.yaml: no such scene file" -- traced "$work/gone"
campaign machine rig "$recording" simpleA identify "$work/again.csv" actual fit
check "machine recordings need a machine" refuses "expected campaign.yaml to name a machine" -- traced "$work/machine"
sed 's/^scene/machine: none.yaml\n&/' "$work/machine/campaign.yaml" >"$work/m" && mv "$work/m" "$work/machine/campaign.yaml"
check "a machine that is not there is named" refuses "machine: $work/machine/none.yaml: No such file" "campaign.yaml:" -- traced "$work/machine"

# A recording may end before its dig does.
until_s() { awk -F, -v end="$2" 'NR == 1 || $1 <= end' "$1" >"$3"; } # RECORDING SECONDS OUT
until_s "$PWD/tests/data/reference/mu0.9_mur0.9_rho2500_seed3$S" 2.5 "$work/short.csv"
campaign short rig "$work/short.csv" simpleA identify "$PWD/tests/data/reference/mu0.9_mur0.9_rho2500_seed3$R" actual fit
"$BIN/digloop" trace "$table" "$work/short" -q --json "$work/short.json"
check "nothing is missing in a dig that ends before its bucket is out" grep -q '"verdict": \["none"\]' "$work/short.json"
until_s "$work/short.csv" 2 "$work/shorter.csv"
campaign shorter rig "$work/shorter.csv" simpleA identify "$PWD/tests/data/reference/mu0.9_mur0.9_rho2500_seed3$R" actual fit
check "one that lacks more is refused" refuses "shorter.csv: the recording's path is none of the table's" 'it lacks more than three tenths of "simpleA" at an end' -- traced "$work/shorter"

check "a folder without a campaign is named" refuses "$work/campaign.yaml: No such file" -- traced "$work"
check "so is a folder that is not there" refuses "nothing/campaign.yaml: No such file" -- traced "$work/nothing"
"$BIN/digloop" trace "$table" "$work/plain" --effects "$work/none.sqlite" >/dev/null 2>"$work/err"
check "and a table of effects" eval '[ $? = 2 ] && grep -q "none.sqlite: No such file" "$work/err"'

finish
