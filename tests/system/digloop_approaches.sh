#!/bin/bash
# Plain gravel that is in no table, dug deeper than the table was or with the bucket turned, and with recordings that begin in the air: nothing is
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
finish
