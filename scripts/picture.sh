#!/bin/bash
# scripts/picture.sh OUT.svg: a predicted dig against the measured one. LIGGGHTS dug a gravel that lies between
# the points of the table; the gravel is identified from its simpleA dig, and its actual dig is predicted.
#   BIN=build/bin scripts/picture.sh docs/pictures/predicted.svg
#   BIN=build/bin scripts/picture.sh OUT.svg TABLE SIMPLE.csv DIG.csv TRAJECTORY WHO
# The second takes other digs; WHO says in the legend who dug them.
set -euo pipefail
to=${1:?usage: picture.sh OUT.svg [TABLE SIMPLE.csv DIG.csv TRAJECTORY WHO]}
dig=tests/data/liggghts_product/mu0.6_mur0.4_rho2200_bucket0.4_seed1
bin=${BIN:-build/bin} table=${2:-tables/product.sqlite} simple=${3:-${dig}__simpleA.csv} actual=${4:-${dig}__actual.csv}
trajectory=${5:-actual} who=${6:-dug by LIGGGHTS}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$bin/digloop" identify "$table" "$simple" --json >"$work/gravel.json"
"$bin/digloop" predict "$table" --identified "$work/gravel.json" --trajectory "$trajectory" \
    --measured "$actual" --json >"$work/predicted.json"

array() { sed -nE "s/^ *\"$1\": \[([^]]*)\].*/\1/p" "$work/predicted.json" | tr -d ' ' | tr ',' '\n'; }
number() { sed -nE "s/.*\"$1\": ([0-9.e+-]+).*/\1/p" "$work/predicted.json" | head -n 1; }
paste <(array moment_Nm) <(array sigma_Nm) | awk '{ print (NR - 1) / 2.55, $1, 1.645 * $2 }' >"$work/predicted"

# Measured: smoothed over ±0.16 s, then over the path, |pin| + tooth length · |turn|.
tooth=$("$bin/digtable" list "$table" --json | sed -nE 's/.*"tooth_m": ([0-9.e+-]+).*/\1/p' | head -n 1)
awk -F, -v tooth="$tooth" '
    BEGIN { n = 0 }
    /^#/ { next }
    /^t_s/ { for (i = 1; i <= NF; i++) column[$i] = i; next }
    { t[n] = $column["t_s"]; y[n] = $column["My_Nm"]; x = $column["pin_x_m"]; z = $column["pin_z_m"]
      a = tooth * $column["theta_deg"] * 3.14159265 / 180
      way[n] = n ? way[n - 1] + sqrt((x - x0) ^ 2 + (z - z0) ^ 2) + (a > a0 ? a - a0 : a0 - a) : 0
      x0 = x; z0 = z; a0 = a; n++ }
    END { for (i = 0; i < n; i += 4) { sum = k = 0
              for (j = i; j >= 0 && t[i] - t[j] <= .16; j--) { sum += y[j]; k++ }
              for (j = i + 1; j < n && t[j] - t[i] <= .16; j++) { sum += y[j]; k++ }
              print 100 * way[i] / way[n - 1], sum / k } }' "$actual" >"$work/measured"

gnuplot >"$work/picture.svg" <<PLOT
set terminal svg noenhanced size 860,400 font 'sans-serif,14' background 'white'
set title 'An actual dig, predicted from one simple dig: error $(printf %.2f "$(number error)"), noise floor $(printf %.2f "$(number noise_floor)")'
set xlabel 'trajectory progress, %'; set ylabel 'moment about the bucket pin, N·m'
set key top left reverse Left; set grid lc rgb '#dddddd'; set border 3; set tics nomirror; set yrange [*<0:*]
plot '$work/predicted' using 1:(\$2-\$3):(\$2+\$3) with filledcurves fc rgb '#c8d7ec' title 'predicted, 90 % band of one dig', \
     '' using 1:2 with lines lw 2 dt (8,5) lc rgb '#1f5fa8' title 'predicted', \
     '$work/measured' with lines lw 2 lc rgb '#c0392b' title 'measured ($who)'
PLOT
mkdir -p "$(dirname "$to")"
mv "$work/picture.svg" "$to"
