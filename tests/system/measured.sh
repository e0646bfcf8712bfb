#!/bin/bash
# What the loop makes of measured data of others, read by a user's own means (python/examples/plates.py): real plates
# pressed into real sand, six repeats each. Three are a table, the other three a campaign, in all 60 ways: nothing is
# missing there, and where all forces are twice as large something is. DIG_PLATES names the folder of the data, which is
# no part of the sources.
#   tests/system/measured.sh [-v]    -v: a line a campaign
. tests/system/check.bash
exec 3>&1
data=${DIG_PLATES:-../shared/data/cmu_3d_terramechanics/plates} verbose=${1-} found= python=/usr/bin/python3
if ! "$python" -c 'import pandas' 2>/dev/null; then
    skip_check "measured plates" "$python has no pandas (python3-pandas)"
    [ -z "${DIG_NO_SKIP-}" ] || exit 1
    finish
elif [ ! -f "$data/large_1_ft.csv" ]; then
    skip_check "measured plates" "no $data (DIG_PLATES says where they are)"
    finish
fi

verdict() { tr -d '\n' <"$1/trace.json" | grep -oE '"verdict": \[[^]]*\]' | grep -oE '\[.*'; }
traced() { # FACTOR: writes tables and campaigns, traces all; $found: how many give each verdict
    local folder
    "$python" python/examples/plates.py "$data" "$work/$1" "$1" 2>"$work/err" || return
    for folder in "$work/$1"/*; do
        "$BIN/digtable" import "$folder/curves.csv" --map "$folder/map.yaml" -o "$folder/table.sqlite" &&
            "$BIN/digloop" trace "$folder/table.sqlite" "$folder/campaign" --json "$folder/trace.json" || return
        [ "$verbose" != -v ] || echo "$1 ${folder##*/} $(verdict "$folder")" >&3
    done >"$work/said" 2>"$work/err"
    found=$(for folder in "$work/$1"/*; do verdict "$folder"; done | sort | uniq -c | awk '{ printf "%s%d times %s", s, $1, $2; s = ", " }')
    echo "forces times $1: $found"
}
times() { grep -oE "[0-9]+ times \\[\"$1\"\\]" <<<"$found" | grep -oE '^[0-9]+' || echo 0; } # VERDICT
only() { [ $(($(times none) + $(times unlisted))) = 60 ]; }

check "60 tables and campaigns of repeats are made, imported and traced" traced 1
check "no effect that has a name is found in repeats" only
# The level is 1 of 100: more than three of sixty would come once in three hundred times, were they independent.
check "no more is found in repeats than the level says" [ "$(times unlisted)" -le 3 ]
check "the same with forces twice as large" traced 2
check "... is mostly found to lack something" [ "$(times unlisted)" -gt 30 ]
check "... and still nothing that has a name" only
finish
