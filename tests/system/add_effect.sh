#!/bin/bash
# CONTRIBUTING.md's example of an effect, added as it stands there to a copy of the sources: what is tested of every effect
# holds for it, and digloop names it in a campaign that has it. Without it digloop has another answer.
. tests/system/check.bash
table=${TABLE:-tables/reference_rig.sqlite}
built=$(dirname "$BIN")
copy=$work/copy

block() { # FILE: the fenced block that CONTRIBUTING.md heads with it
    awk -v head="\`\`\`c $1" '/^```/ { inside = $0 == head; next } inside' CONTRIBUTING.md
}

# The sources, and what is built of them already: make compiles again what reads the list.
folders=(core files tables estimator offline_dem closed_loop firmware_host tools messages)
mkdir -p "$copy/build"
find Makefile scripts "${folders[@]}" tests/*.[ch] tests/estimator -type f ! -name '*.sqlite' -print0 |
    tar -c --null -T - | tar -x -C "$copy"
(cd "$built" && find "${folders[@]}" tests/*.[od] tests/estimator \( -name '*.[odch]' -o -name .made \) -print0 |
    tar -c --null -T -) | tar -x -C "$copy/build"
find "$copy/build" -name '*.d' -exec sed -i -E "s#(^| )$built/#\1build/#g" {} +
ln -s "$PWD/config" "$copy"

line=$(block core/effect.h)
check "the example is a line of the list" eval '[ -n "$line" ] && [ "$(wc -l <<<"$line")" = 1 ]'
check "... and a file" eval '[ "$(block estimator/effects/thaw.c | wc -l)" -gt 10 ]'
awk -v line="${line//\\/\\\\}" '{ print } /effect\(WEAR, / { print line }' core/effect.h >"$copy/core/effect.h"
block estimator/effects/thaw.c >"$copy/estimator/effects/thaw.c"
make_copy() {
    env -u MAKEFLAGS make -C "$copy" -j 2 BUILD=build CFLAGS="${CFLAGS--O1}" build/bin/digloop build/tests/estimator/test_effects \
        >"$work/make.log" 2>&1
}
check "with them the sources build" make_copy
[ "$failed" = 0 ] || finish
check "... without a warning" eval '! grep -i warning "$work/make.log"'
check "what is tested of every effect holds" eval '(cd "$copy" && build/tests/estimator/test_effects) >"$work/err" 2>&1'

# Digs of LIGGGHTS in one gravel. Each thaws 39 % of what is frozen still, with which 60 % of the resistance goes.
mkdir "$work/thaw"
{
    echo "scene: rig"
    echo "recordings:"
    frozen=1 role=identify
    for seed in "" _seed2 _seed3 _seed4; do
        for trajectory in simpleA actual; do
            awk -F, -v OFS=, -v frozen=$frozen '/^[-0-9]/ { for (i = 5; i <= NF; i++) $i *= 0.4 + 0.6 * frozen } { print }' \
                "tests/data/reference/mu0.5_mur0.5_rho2500${seed}__$trajectory.csv" >"$work/thaw/$frozen.csv"
            echo "  - {file: $frozen.csv, trajectory: $trajectory, role: $role}"
            role=fit
            frozen=$(awk "BEGIN { print $frozen * 0.60653 }")
        done
    done
} >"$work/thaw/campaign.yaml"

verdict() { tr -d ' \n' <"$work/$1.json" | sed -nE 's/.*"verdict":\[([^]]*)\].*/\1/p'; }
softening() { tr -d ' \n' <"$work/with.json" | sed -nE "s/.*\"effects\":\[[^]]*\"softening\":\{[^}]*\"$1\":([-0-9.e+]+).*/\1/p"; }

check "ground that thaws is traced with it" \
    "$copy/build/bin/digloop" trace "$table" "$work/thaw" --json "$work/with.json" --add "$work/model.json" --html "$work/with.html" 2>"$work/err"
check "... and named" is "$(verdict with)" '"thaw"'
check "... with what it softens by in its interval" within 0.6 "$(softening low)" "$(softening high)"
check "... and to a tenth" within "$(softening value)" 0.54 0.66
check "... and no beds are advised, which it needs not" eval '! grep -q "in its beds" "$work/err"'
check "the model goes on from the eighth dig" eval 'tr -d " \n" <"$work/model.json" | grep -q "\"name\":\"digs\",\"value\":8,"'
check "the page has its number and every dig before and after it" \
    eval 'grep -q "<th>thaw: softening" "$work/with.html" && [ "$(grep -c ">after</text>" "$work/with.html")" = 24 ]'
ln -s "$(realpath "$table")" "$work/alone.sqlite"
"$copy/build/bin/digloop" trace "$work/alone.sqlite" "$work/thaw" --json - >/dev/null 2>"$work/err"
check "it is among those that need no table of effects" grep -q "need no beds (.*thaw.*)" "$work/err"
"$BIN/digloop" trace "$table" "$work/thaw" --json "$work/without.json" 2>"$work/err"
check "without it nothing of the list is named" is "$(verdict without)" '"unlisted"'

finish
