#!/bin/bash
# scripts/fine_picture.sh OUT.svg [LINES.txt]: how the moment falls as grains grow finer. Takes the lines across_N that
# scripts/bed_study.sh prints (LINES.txt: docs/pictures/fine.txt), fits mean(N) = finest + c / N to them by their standard
# errors, prints both numbers and what is left of the lines, and draws them. N: grains across the bucket; w: its width.
set -euo pipefail
to=${1:?usage: fine_picture.sh OUT.svg [LINES.txt]} lines=${2:-docs/pictures/fine.txt}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Grains across, mean and its standard error over rho g w^4. Two beds do not tell how they scatter: they
# have the relative scatter of the beds before them.
awk -v unit=0.5888 '/^across_[0-9]+ / { n = substr($1, 8) + 0
        for (i = 1; i <= NF; i++) { if ($i == "mean" && $(i + 1) + 0 > 0 && !(n in mean)) { mean[n] = $(i + 1); error[n] = $(i + 3) } if ($(i + 1) == "beds") beds[n] = $i }
        order[++k] = n }
    END { for (i = 1; i <= k; i++) { n = order[i]
              if (beds[n] > 2) share = error[n] * sqrt(beds[n]) / mean[n]
              else error[n] = share * mean[n] / sqrt(beds[n])
              printf "%.4f %.5f %.5f\n", n == 9 ? 28 / 3 : n, mean[n] / unit, error[n] / unit } }' "$lines" >"$work/points"
awk '{ w = 1 / $3 ^ 2; x = 1 / $1; s += w; sx += w * x; sy += w * $2; sxx += w * x * x; sxy += w * x * $2; X[NR] = x; Y[NR] = $2; W[NR] = w }
    END { d = s * sxx - sx * sx; b = (s * sxy - sx * sy) / d; a = (sy - b * sx) / s
          for (i = 1; i <= NR; i++) chi2 += W[i] * (Y[i] - a - b * X[i]) ^ 2
          printf "%.4f %.4f %.2f %d\n", a, b, chi2, NR - 2 }' "$work/points" >"$work/fit"
read -r finest c chi2 freedom <"$work/fit"
echo "mean moment over rho g w^4: $finest + $c / N; chi squared $chi2 for $freedom"
gnuplot >"$work/fine.svg" <<PLOT
set terminal svg noenhanced size 760,380 font 'sans-serif,13' background 'white'
set xlabel 'grains across the bucket'; set ylabel 'mean moment over ρ g w⁴'
set key top right; set grid lc rgb '#dddddd'; set border 3; set tics nomirror; set xrange [5:45]; set yrange [0:*]
plot $finest + $c / x with lines lw 2 dt (8,5) lc rgb '#1f5fa8' title "$(printf '%.2f + %.1f / N' "$finest" "$c")", \
     $finest with lines lc rgb '#999999' title 'grains that are nothing beside the bucket', \
     '$work/points' with yerrorbars pt 7 lw 2 lc rgb '#c0392b' title 'simpleA, .5/.5/2500'
PLOT
mv "$work/fine.svg" "$to"
