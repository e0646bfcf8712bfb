#!/bin/bash
# Plain gravel that is in no table, dug deeper than the table was, and with recordings that begin in the air: nothing is missing there, by
# force recordings and by a machine's.
. tests/system/check.bash

scripts/trace_depths.py tables/product.sqlite tests/data/product/depths.sqlite deeper air >"$work/out" 2>"$work/err" || cat "$work/err"
sed 's/^/      /' "$work/out"
check "every kind of campaign is traced" [ "$(grep -c '^0.60/0.45/2300' "$work/out")" = 3 ]
check "their depths are told" grep -q "deeper  *force .* 1.15,1.15$" "$work/out"
check "no force recording of it has a name" grep -q "^force recordings: 2 campaigns, named 0;" "$work/out"
check "nor has a machine's" grep -q "^a machine's: 1 campaigns, named 0;" "$work/out"
held=$(sed -nE 's/^force recordings: .* friction ([0-9]+), rolling friction ([0-9]+), density ([0-9]+)$/\1 + \2 + \3/p' "$work/out")
check "and their intervals hold, mostly" [ "$((held))" -ge 5 ]
# As deep and as shallow as the table goes, by the table's own digs.
scripts/trace_depths.py tables/product.sqlite tables/product.sqlite mixed >"$work/out" 2>"$work/err" || cat "$work/err"
sed 's/^/      /' "$work/out"
check "nor has what was dug at the table's own depths" [ "$(grep -c 'campaigns, named 0;' "$work/out")" = 2 ]
check "where a path tells the depth the density is told" grep -q '^force recordings: .* density 3$' "$work/out"
finish
