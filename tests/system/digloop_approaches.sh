#!/bin/bash
# Plain gravel that is in no table, dug deeper than the table was, with the bucket turned, fast or off its path, and with recordings that begin in the air: nothing is
# missing there, by force recordings and by a machine's.
. tests/system/check.bash

scripts/trace_approaches.py tables/product.sqlite tests/data/product/approaches.sqlite deeper opened closed air >"$work/out" 2>"$work/err" || cat "$work/err"
sed 's/^/      /' "$work/out"
check "every kind of campaign is traced" [ "$(grep -c '^0.60/0.45/2300' "$work/out")" = 7 ]
check "depths are told" grep -q "deeper  *force .* 1.15 0.0, 1.15 0.0$" "$work/out"
check "attacks are told, a machine's too" [ "$(grep -cE "(opened .* 1.00 -5.0, 1.00 -5.0|closed .* 1.00 2.5, 1.00 2.5)$" "$work/out")" = 4 ]
check "no force recording of it has a name" grep -q "^force recordings: 4 campaigns, named 0;" "$work/out"
check "nor has a machine's" grep -q "^a machine's: 3 campaigns, named 0;" "$work/out"
check "and every density is held" [ "$(grep -cE "4 campaigns.* density 4$|3 campaigns.* density 3$" "$work/out")" = 2 ]
# As deep and as shallow as the table goes, by the table's own digs.
scripts/trace_approaches.py tables/product.sqlite tables/product.sqlite mixed >"$work/out" 2>"$work/err" || cat "$work/err"
sed 's/^/      /' "$work/out"
check "nor has what was dug at the table's own depths" [ "$(grep -c 'campaigns, named 0;' "$work/out")" = 2 ]
check "where a path tells the depth the density is told" grep -q '^force recordings: .* density 3$' "$work/out"
# Three times as fast as the table's, gravel .6/.45/2300.
scene=$PWD/config/scenes/product.yaml machine=$PWD/config/machines/zx200_trench.yaml
told() { # KEY: value, and ends of its interval
    tr -d '\n' <"$work/$kind.json" | sed -E "s/.*\"material\": .*\"$1\": \{\"value\": ([^,]*), \"low\": ([^,]*), \"high\": ([^}]*)\}.*\"material_before.*/\1 \2 \3/"
}
for kind in force machine; do
    mkdir "$work/$kind"
    { echo "scene: $scene"; [ $kind = force ] || echo "machine: $machine"; echo "recordings:"; } >"$work/$kind/campaign.yaml"
    role=identify
    for along in simpleA simpleB actual; do
        dug=tests/data/product/fast/$along.csv
        if [ $kind = force ]; then cp $dug "$work/$kind/$along.csv"; else
            "$BIN/digrig" record $dug --machine "$machine" --scene "$scene" -q -o "$work/$kind/$along.csv"
        fi
        echo "  - {file: $along.csv, trajectory: $along, role: $role}" >>"$work/$kind/campaign.yaml"
        role=fit
    done
    "$BIN/digloop" trace tables/product.sqlite "$work/$kind" --json "$work/$kind.json" -q 2>"$work/err" || cat "$work/err"
    echo "      $kind: $(grep -oE '"(verdict": [^]]*\]|p_complete": [^,]*)' "$work/$kind.json" | tr '\n' ' ') friction $(told friction), rolling $(told rolling), density $(told density_kgpm3)"
    check "a fast dig has no effect of the list ($kind)" grep -qE '"verdict": \["(none|unlisted)"\]' "$work/$kind.json"
    check "and its density is told" within "$(told density_kgpm3 | cut -d ' ' -f 1)" 2070 2530
done
# A drag that leaves its trajectory, up by a quarter of the depth at its end or down by half as much, the same gravel.
for way in up down; do
    for kind in force machine; do
        folder=$work/${way}_$kind
        mkdir "$folder"
        { echo "scene: $scene"; [ $kind = force ] || echo "machine: $machine"; echo "recordings:"; } >"$folder/campaign.yaml"
        role=identify
        for along in simpleA actual; do
            dug=tests/data/product/off_path/${way}_$along.csv
            if [ $kind = force ]; then cp "$dug" "$folder/$along.csv"; else
                "$BIN/digrig" record "$dug" --machine "$machine" --scene "$scene" -q -o "$folder/$along.csv"
            fi
            echo "  - {file: $along.csv, trajectory: $along, role: $role}" >>"$folder/campaign.yaml"
            role=fit
        done
        kind=${way}_$kind
        "$BIN/digloop" trace tables/product.sqlite "$folder" --json "$work/$kind.json" -q 2>"$work/err" || cat "$work/err"
        echo "      $kind: $(grep -oE '"(verdict": [^]]*\]|p_complete": [^,]*)' "$work/$kind.json" | tr '\n' ' ') density $(told density_kgpm3)"
        check "a dig off its trajectory has no name ($kind)" grep -q '"verdict": \["none"\]' "$work/$kind.json"
        check "and its density is told" within "$(told density_kgpm3 | cut -d ' ' -f 1)" 2150 2450
    done
done
identified=$("$BIN/digloop" identify tables/product.sqlite "$work/machine/simpleA.csv" --machine "$machine" --json | tr -d '\n' | sed -E 's/.*"mean": \{[^}]*"density_kgpm3": ([^}]*)\}.*/\1/')
check "a machine's fast dig is identified, smoothed over as much path ($identified)" within "$identified" 2070 2530
finish
