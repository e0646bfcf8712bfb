#!/bin/bash
# Files whose names mean harm, as they come out of somebody else's archive, given to every program: none commands the
# terminal it is told on, none runs, none is markup in a page.
. tests/system/check.bash
BIN=$(realpath "$BIN")
formats=$PWD/tests/data/formats
machine=$PWD/config/machines/zx200_trench.yaml
reference=$PWD/tests/data/reference/mu0.5_mur0.5_rho2500

# A terminal's title, a command twice, markup, a turn of the writing.
bad=$'a\e]0;owned\a`touch OWNED`$(touch OWNED);<blink>\xe2\x80\xae'
printable='a`touch OWNED`$(touch OWNED); <blink>"'"'"
mkdir "$work/in" && cd "$work/in" || exit 1
cp "$formats/table.sqlite" "$bad.sqlite"
cp "$OLDPWD/tables/reference_rig.sqlite" "rig$bad.sqlite"
cp "$formats/scene.yaml" "scene$bad.yaml"
cp "$formats/grid.yaml" "grid$bad.yaml"
cp "$formats/daemon.lcm" "$bad.lcm"
cp "$machine" "$bad.yaml"
cp "${reference}__simpleA.csv" "$bad.csv"

harmless() { # what was said, and what was made
    ! LC_ALL=C grep -qaP '[\x00-\x08\x0b-\x1f\x7f]|\xe2\x80[\xaa-\xae]' "$work/out" "$work/err" &&
        [ -z "$(find "$work" -name OWNED)" ]
}
told() { # SENTENCE STATUS PROGRAM WORDS…
    timeout -k 5 120 "$BIN/$3" "${@:4}" >"$work/out" 2>"$work/err" </dev/null
    local rc=$? want=$2
    check "$3: $1" eval '[ $rc = "$want" ] && harmless'
}

told "a table is listed" 0 digtable list "$bad.sqlite"
told "checked" 0 digtable check "$bad.sqlite"
told "shown" 0 digtable show "$bad.sqlite" 0
told "exported" 0 digtable export "$bad.sqlite"
told "merged" 0 digtable merge "merged$bad.sqlite" "$bad.sqlite"
told "made" 0 digtable generate "scene$bad.yaml" "grid$bad.yaml" -o "made$bad.sqlite"
dig=(--trajectory scrape --friction .5 --rolling .5 --density 2500)
told "a dig is told with its file" 0 digtable dig "scene$bad.yaml" "${dig[@]}" -o "dig$bad.csv"
told "a trajectory that is none" 2 digtable dig "scene$bad.yaml" "${dig[@]}" --trajectory "$bad" -o dig.csv
told "a folder for pictures that cannot be" 1 digtable dig "scene$bad.yaml" "${dig[@]}" -o dig.csv --vtk "no/$bad"
told "an entry that is none" 2 digtable show "$bad.sqlite" "$bad"
told "too many files" 2 digtable list "$bad.sqlite" "$bad"
told "its runs are exported" 0 digtable export "made$bad.sqlite" --runs
cut -d, -f1-6,10-14 "$work/out" >"curves$bad.csv"
told "and imported" 0 digtable import "curves$bad.csv" --map "$formats/curve_map.yaml" -o "import$bad.sqlite"
told "identified" 0 digloop identify "rig$bad.sqlite" "$bad.csv" --json
cp "$work/out" "id$bad.json"
told "predicted" 0 digloop predict "rig$bad.sqlite" --identified "id$bad.json" --trajectory actual -o "p$bad.csv"
check "the gravel is JSON" eval 'is_json <"id$bad.json"'
told "read from a log" 0 digreport shift "$bad.lcm" --csv "shift$bad.csv" --json "shift$bad.json" --html "shift$bad.html" --title "$bad"
check "a page holds no markup of a title" eval '! grep -qa "<blink>" "shift$bad.html"'
told "a log that is none" 1 digreport "$bad=$bad.lcm" --table "rig$bad.sqlite" --machine "$bad.yaml" --html page.html
told "recorded" 0 digrig record "$bad.csv" --machine "$bad.yaml" -o "record$bad.csv"
told "no terminal" 2 digwatch --log "$bad.lcm"
told "a configuration that is none" 2 digsightd -c "$bad" --check
for program in digtable digloop digreport digrig digsightd digwatch; do
    told "a word that is none" 2 $program "$bad"
    told "an option that is none" 2 $program "--$bad"
done

# A campaign from elsewhere. Its recordings' names are printable, or they would be refused.
mkdir "$bad"
cp "${reference}__simpleA.csv" "$bad/$printable.csv"
cp "${reference}__actual.csv" "$bad/$printable 2.csv"
cat >"$bad/campaign.yaml" <<'END'
scene: rig
recordings:
  - {file: "a`touch OWNED`$(touch OWNED); <blink>\"'.csv", trajectory: simpleA, role: identify}
  - {file: "a`touch OWNED`$(touch OWNED); <blink>\"' 2.csv", trajectory: actual, role: fit}
END
told "a campaign is traced" 0 digloop trace "rig$bad.sqlite" "$bad" --html "t$bad.html" --json "t$bad.json" --add "m$bad.json"
check "its page has no markup of its names" eval '! grep -qa "<blink>" "t$bad.html" && grep -qa "&lt;blink&gt;" "t$bad.html"'
check "its results are JSON" eval 'is_json <"t$bad.json" && is_json <"m$bad.json"'
told "its model is read" 0 digloop identify "rig$bad.sqlite" "$bad.csv" --model "m$bad.json"
for word in '\e[2J' '\u202e' '\n' '\x7f' '\x9b'; do
    sed -i "0,/file: \"[^}]*csv\"/s//file: \"a${word//\\/\\\\}.csv\"/" "$bad/campaign.yaml"
    told "a recording's name with $word is refused" 2 digloop trace "rig$bad.sqlite" "$bad"
done
cd "$OLDPWD" || exit 1
finish
