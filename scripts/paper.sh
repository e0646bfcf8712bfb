#!/bin/bash
# The paper's findings, tested on the rig table and on digs of LIGGGHTS (docs/paper.md): numbers into
# $OUT/paper.txt, plots into $PLOTS.
#   BIN=build/bin PAPER=build/tests/paper/paper scripts/paper.sh [TABLE.sqlite [EFFECTS.sqlite]]
set -euo pipefail
bin=${BIN:-build/bin} paper=${PAPER:-build/tests/paper/paper} out=${OUT:-build/paper} plots=${PLOTS:-docs/paper}
table=${1:-tables/reference_rig.sqlite} effects=${2:-tables/reference_rig_effects.sqlite}
[ -e "$effects" ] || effects=-
rm -rf "$out"
mkdir -p "$out" "$plots"
plots=$(cd "$plots" && pwd)
digs=tests/data/paper # our own digs of what no table holds; README.md there says how they were made

# Runs of a table of another stiffness as force recordings, whose poses are those of the
# reference's actual dig: the path is the same.
recordings() { # TABLE.sqlite NAME: $out/NAME_muF_seedN__actual.csv
    "$bin/digtable" export "$1" --runs | awk -F, -v n=0 -v name="$out/$2" '
        FNR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        NR == FNR { if (/^#/) next
                    if (n == 0) { for (k in at) of[k] = at[k] }
                    t[n] = $of["t_s"]; x[n] = $of["pin_x_m"]; z[n] = $of["pin_z_m"]; a[n++] = $of["theta_deg"]; next }
        { file = sprintf("%s_mu%s_seed%d__actual.csv", name, $at["friction"], $at["packing"] + 1)
          if (file != last) { print "t_s,pin_x_m,pin_z_m,theta_deg,Fx_N,Fy_N,Fz_N,Mx_Nm,My_Nm,Mz_Nm" > file; i = 0; last = file }
          s = $at["t_s"]
          while (i + 2 < n && t[i + 1] < s) i++
          w = (s - t[i]) / (t[i + 1] - t[i])
          printf "%s,%.9g,%.9g,%.9g,%s,0,%s,0,%s,0\n", s, x[i] + w * (x[i + 1] - x[i]), z[i] + w * (z[i + 1] - z[i]),
              a[i] + w * (a[i + 1] - a[i]), $at["Fx_N"], $at["Fz_N"], $at["My_Nm"] > file }' \
        tests/data/reference/mu0.5_mur0.5_rho2500__actual.csv -
}
recordings $digs/basic.sqlite basic
recordings $digs/steel.sqlite steel
"$paper" "$table" "$effects" "$out" tests/data/reference/*.csv tests/data/liggghts_digs/*__*.csv \
    $digs/basic_*.csv "$out"/basic_*.csv "$out"/steel_*.csv | tee "$out/paper.txt"

# (a), (b): the shapes of digs of one gravel together.
awk '/^shape/ { k = $2; sub(/(_seed[0-9]*)?__actual|_bed[0-9]*$/, "", k); if (k ~ /^table/) next
        v[k] += $11; m[k] += $13; n[k]++; if (n[k] == 1 || $11 < lo[k]) lo[k] = $11; if ($11 > hi[k]) hi[k] = $11 }
    END { for (k in v) printf "shapes %-28s %2d: valley/peak %.2f (%.2f to %.2f), middle/peaks %.2f\n", k, n[k], v[k] / n[k],
        lo[k], hi[k], m[k] / n[k] }' "$out/paper.txt" | sort >"$out/shapes.txt"
tee -a "$out/paper.txt" <"$out/shapes.txt"

# (d) gravels between the points: a table without the value .7 identifies each of the .7 gravels on its simple
# dig and predicts its actual dig; by the moment, as the paper does.
cp "$table" "$out/without.sqlite"
chmod u+w "$out/without.sqlite"
where="SELECT id FROM ground WHERE abs(friction - .7) < 1e-9 OR abs(rolling - .7) < 1e-9"
sqlite3 "$out/without.sqlite" "DELETE FROM seal WHERE ground IN ($where); DELETE FROM entry WHERE ground IN ($where); DELETE FROM run WHERE ground IN ($where);
    DELETE FROM ground WHERE abs(friction - .7) < 1e-9 OR abs(rolling - .7) < 1e-9; VACUUM"
one() { sed -nE "s/.*\"$1\": ([a-z0-9.e+-]+).*/\1/p" "$2" | head -n 1; }
: >"$out/objects.txt"
for simple in "$out"/X_*__simpleA.csv; do
    case=${simple%__simpleA.csv}
    [ -e "${case}__actual.csv" ] || continue
    "$bin/digloop" identify "$out/without.sqlite" "$simple" --moment-alone --json >"$case.json"
    "$bin/digloop" predict "$out/without.sqlite" --identified "$case.json" --trajectory actual \
        --measured "${case}__actual.csv" --json >"$case.next.json"
    gravel=$(sed -nE 's/.*"gravel": \{([^}]*)\}.*/\1/p' "$case.json" | head -n 1 | sed 's/"[A-Za-z0-9_]*": *//g; s/, */\//g')
    echo "object $(basename "$case") -> $gravel error $(one error "$case.next.json") floor $(one noise_floor "$case.next.json")" |
        tee -a "$out/objects.txt"
    for key in moment_Nm sigma_Nm; do # 256 points of path progress, as columns
        sed -nE "s/.*\"$key\": \[([^]]*)\].*/\1/p" "$case.next.json" | tr -d ' ' | tr ',' '\n' >"$case.$key"
    done
    paste -d' ' <(cut -d' ' -f1 "$out/table_0.5_0.5_2500.dat") "$case.moment_Nm" "$case.sigma_Nm" >"$case.dat"
done
cat "$out/objects.txt" >>"$out/paper.txt"
sort -k6 -n "$out/objects.txt" | awk '{ e[NR] = $6; f += $8 } END { printf "objects: %d, error in the median %.3f (%.3f to %.3f), " \
    "mean noise floor %.3f\n", NR, NR % 2 ? e[(NR + 1) / 2] : (e[NR / 2] + e[NR / 2 + 1]) / 2, e[1], e[NR], f / NR }' |
    tee -a "$out/paper.txt"

# Measured, smoothed as every curve here: +-0.16 s.
smooth() { # RECORDING: time and smoothed moment
    awk -F, 'BEGIN { n = 0 } /^t_s/ { for (i = 1; i <= NF; i++) if ($i == "My_Nm") c = i; next } !/^#/ { t[n] = $1; y[n++] = $c }
        END { for (i = 0; i < n; i++) { s = k = 0; for (j = i; j >= 0 && t[i] - t[j] <= .16; j--) { s += y[j]; k++ }
              for (j = i + 1; j < n && t[j] - t[i] <= .16; j++) { s += y[j]; k++ } print t[i], s / k } }' "$1"
}
smooth "$out/steel_mu0.3_seed1__actual.csv" >"$out/steel.dat"
smooth "$out/X_0.7_0.7_2500__actual.csv" >"$out/X_measured.dat"

svg() { # NAME: gnuplot's commands from stdin
    { echo "set terminal svg noenhanced size 760,380 font 'sans,12' background 'white'; set output '$plots/$1.svg'
            set xlabel 't [s]'; set ylabel 'My [N m]'; set key top left; set grid"
      cat; } | (cd "$out" && gnuplot)
}
curves() ( # HOW BEGIN: every BEGIN*actual.dat as gnuplot's plot wants it
    cd "$out" || exit 1
    for f in "$2"*actual.dat; do echo "'$f' $1, \\"; done
)
svg peaks <<'P'
set title 'a: the actual dig without and with rolling friction (LIGGGHTS, friction .5)'
plot 'mu0.5_mur0.0_rho2500__actual.dat' w l lw 2 t 'none', 'basic_mu0.6_seed1__actual.dat' w l lw 2 t 'basic model (ours, 1e8 Pa, .6)', 'mu0.5_mur0.5_rho2500__actual.dat' w l lw 2 t '.5', \
     'mu0.5_mur0.9_rho2500__actual.dat' w l lw 2 t '.9', 'table_0.5_0.5_2500.dat' w l dt 2 lc 'black' t '.5, ours, mean of ten beds'
P
svg sizes <<P
set title 'b: equal spheres and mixed sizes (LIGGGHTS, .5/.5)'
set y2tics; set y2label 'My [N m]'
plot $(curves "w l lc 'gray' notitle" mu0.5_mur0.5_rho2500)
     $(curves "w l lw 2 t 'mixed'" poly_)
     'table_0.5_0.5_2500.dat' w l lw 2 lc 'black' t 'equal, ours, mean of ten beds', \\
     'steel.dat' axes x1y2 w l dt 2 lc 'blue' t 'steel balls, ours (right axis)'
P
svg objects <<P
set title 'c: actual digs of objects A, B, C (LIGGGHTS) and of the gravels chosen for them'
plot $(for name in mu0.5_mur0.9_rho2500 mu0.3_mur0.9_rho2500 mu0.3_mur0.3_rho2500; do
    chosen=$(sed -nE "s#^choice ${name}__simpleA *-> ([0-9.]+)/([0-9.]+)/([0-9.]+) .*#\1_\2_\3#p" "$out/paper.txt")
    echo "'${name}__actual.dat' w l lw 2 t '$name', 'table_$chosen.dat' w l dt 2 lw 2 t 'chosen: $chosen', \\"
done)
     NaN notitle
P
svg object_x <<'P'
set title 'd: .7/.7/2500 between the points of a table without .7: the actual dig predicted from the simple dig'
plot 'X_0.7_0.7_2500.dat' u 1:($2-$3):($2+$3) w filledcurves fc 'gray90' t 'one dig, 1 sigma', \
     'X_0.7_0.7_2500.dat' w l lw 2 t 'predicted', 'X_measured.dat' w l lw 2 t 'dug'
P
echo "numbers: $out/paper.txt   plots: $plots/*.svg"
