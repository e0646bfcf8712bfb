#!/bin/bash
# The table that ships is what this program computes: the begin of one run again, in a new table, bit by bit.
. tests/system/digtable_lib.bash

table=tables/reference_rig.sqlite
digtable check $table
check "$table is sound" is "$code" 0
check "and says that its light gravel trembled" grep -q "gravel of 1500 kg/m3 trembles" "$work/out"
sed "s|: ../tables/product.sqlite|: $PWD/$table|; s|: machines/|: $PWD/config/machines/|; s|: signals/|: $PWD/config/signals/|" config/digsightd.yaml \
    >"$work/rig.yaml"
"$BIN/digsightd" -c "$work/rig.yaml" --check >"$work/out"
check "as digsightd does" grep -q "gravel of 1500 kg/m3 trembles" "$work/out"
digtable check tables/reference_rig_effects.sqlite
check "tables/reference_rig_effects.sqlite is sound" is "$code" 0
digtable check tables/product_effects.sqlite --complete
check "tables/product_effects.sqlite is sound, and the whole grid" is "$code" 0
cp tables/product_effects.sqlite "$work/effects.sqlite"
digtable generate config/scenes/product.yaml config/grids/product_effects.yaml -o "$work/effects.sqlite" --time-limit 0
check "and its digs are those of its grid" eval 'is $code 0 && grep -q "135 of 135 digs" $work/err'
digtable check tables/product.sqlite
check "tables/product.sqlite is sound" is "$code" 0
check "and nothing in it trembled" eval '! grep -q trembles $work/out'
check "its bucket is of steel" grep -q "of friction 0.4 and rolling friction 0.4; resistance goes with the density" "$work/out"
check "what finer gravel is taken for is said" grep -q "finer gravel resists less" "$work/out"
"$BIN/digsightd" -c config/digsightd.yaml --check >"$work/out"
check "it is the table that digsightd begins with" eval 'grep -q "scene product (.*), 144 gravels" $work/out && ! grep -q trembles $work/out'
cp tables/product.sqlite "$work/begun.sqlite"
digtable generate config/scenes/product.yaml config/grids/product.yaml -o "$work/begun.sqlite" --time-limit 0
check "and its digs are those of the product grid" eval 'is $code 0 && grep -q "468 of 468 digs" $work/err'
digtable generate config/scenes/product.yaml config/grids/product.yaml -o "$work/product.sqlite" --time-limit 0
check "every dig of the product grid can be begun" eval 'is $code 0 && grep -q "0 of 468 digs" $work/err'

# The quickest run of a build that names its numerics: tables may hold older ones, carried over. What a dig is later
# changes nothing of how it begins, so it ends soon after the bucket is in the ground and drags.
gravel=$(sqlite3 -separator , $table "SELECT friction, rolling, density_kgpm3 FROM run JOIN ground g ON g.id = ground
    WHERE engine = 'kernel' AND version LIKE '%+%' AND effect = '' AND packing = 0 AND trajectory = 0 ORDER BY wall_s LIMIT 1")
IFS=, read -r friction rolling density <<<"$gravel"
printf 'points:\n  - {friction: %s, rolling: %s, density_kgpm3: %s, packings: 1}\ntrajectories: [simpleA]\n' \
    "$friction" "$rolling" "$density" >"$work/one.yaml"
sed -E '/name: simpleB/,$b; s/(name: drag, duration_s:) 2,/\1 0.1,/; /name: lifting/d' config/scenes/rig.yaml >"$work/short.yaml"
digtable generate "$work/short.yaml" "$work/one.yaml" -o "$work/one.sqlite" --engine kernel
check "a bed and a dig of $gravel are computed again" is "$code" 0
run() { # TABLE: 0.7 s of it, all but the engine's version and what another build may know besides
    "$BIN/digtable" export "$1" --runs | awk -F, -v OFS=, -v f="$friction" -v r="$rolling" -v d="${density%.0}" \
        '$1 == f && $2 == r && $3 == d && $4 == "simpleA" && $5 == 0 && $15 == "" && $10 < 0.7 { $8 = ""; print }'
}
check "with the bits that ship" eval '[ "$(run "$work/one.sqlite" | wc -l)" = 140 ] && cmp <(run "$work/one.sqlite") <(run $table)'
finish
