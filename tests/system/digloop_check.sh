#!/bin/bash
# digloop check: digrig's machine in free air, its file right and wrong, as text, JSON and page.
. tests/system/check.bash
machine=config/machines/crawler_14t.yaml
air=$work/air.csv

run_check() { # FILE RECORDING OPTION…: $text, $status
    text=$("$BIN/digloop" check "$@" 2>"$work/err")
    status=$?
}
said() { grep -q -e "$1" <<<"$text" || { sed 's/^/      | /' <<<"$text"; return 1; }; }
refused() { # WORD ARGUMENT…: exit status 2 and a word of why, nothing on standard output
    run_check "${@:2}"
    is "$status" 2 && is "$text" "" && grep -q -e "$1" "$work/err"
}
column() { # NAME EXPRESSION FILE: a recording whose column is another
    awk -F, -v OFS=, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) c = i }
        NR > 1 { $c = '"$2"' } { print }' "$air" >"$3"
}

"$BIN/digrig" air -q --machine "$machine" -o "$air"
check "a machine moves in free air for about a minute" within "$(tail -n 1 "$air" | cut -d, -f1)" 45 90
run_check "$machine" "$air"
check "the right file ends well" is "$status" 0
check "and is said to fit" said '^crawler_14t fits this recording in free air\.$'
check "in lines that are all ok" is "$(grep -c '^\(wrong\|doubtful\|not told\)' <<<"$text")" 0
check "of at most 80 columns" is "$(awk 'length > 80' <<<"$text")" ""

column boom_rad '-$c' "$work/turned.csv"
run_check "$machine" "$work/turned.csv" --json "$work/turned.json" --html "$work/turned.html"
check "an angle that counts down ends with 2" is "$status" 2
check "and is named" said '^wrong *boom angle counts up *no: it counts down'
check "with what to do" said 'sign: -1 of boom_rad'
check "the JSON is JSON" eval 'is_json <"$work/turned.json"'
check "the page has six pictures" is "$(grep -c '<figure>' "$work/turned.html")" 6
check "and names no folder" is "$(grep -c "$work" "$work/turned.html")" 0
run_check "$machine" "$work/turned.csv" --json - --quiet
check "JSON on standard output is alone there" is "$(head -c 1 <<<"$text")" "{"
run_check "$machine" "$work/turned.csv" --quiet
check "quiet says nothing" is "$text" ""

column bucket_head_Pa '$c + 2e6' "$work/offset.csv"
run_check "$machine" "$work/offset.csv"
check "20 bar too much are named, and how much" said '^wrong *bucket head reads more by *+\(19\.[5-9]\|20\.[0-4]\)'

heavier 300 "$work/heavy.yaml"
run_check "$work/heavy.yaml" "$air"
check "a bucket filed 300 kg too heavy is named" said '^wrong *bucket weighs more by *-\(29\|30\)[0-9] '

cut -d, -f1-4,9- "$air" >"$work/bucket.csv"
run_check "$machine" "$work/bucket.csv"
check "with the bucket's pressures alone the bucket is judged" said '^ok *bucket: what is left'
check "and boom and arm are not" said '^not told *boom: what is left *not judged'

check "a recording that is not there is refused" refused 'no.csv' "$machine" "$work/no.csv"
check "so is a machine that is not there" refused 'no.yaml' "$work/no.yaml" "$air"
check "and one recording is asked for" refused 'MACHINE.yaml RECORDING' "$machine"
check "a bucket on a force sensor has no cylinders to check" \
    refused 'force sensor' config/machines/rig_sensor.yaml tests/data/formats/machine_recording_sensor.csv
finish
