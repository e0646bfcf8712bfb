#!/bin/bash
# Does resistance go with the density where stiffness does not? Digs config/scenes/product.yaml with grains of one Young's
# modulus for 1500, 2500 and 4000 kg/m3 and compares My over the density, smoothed over +-0.16 s, with that of 2500
# (docs/numerics/dem.md, "Density is a scale"). One line a trajectory and density: the norm of the difference of the mean
# curves over that of the curve, what the scatter of the beds alone would make of it, and the ratio of the mean moments
# with its standard error.
#   BIN=build/bin OUT=build/density_study scripts/density_study.sh [BEDS]      three beds take 25 minutes of one core
# What lies in OUT is not dug again, so it may be stopped and started.
set -euo pipefail
bin=${BIN:-build/bin} out=${OUT:-build/density_study} beds=${1:-3}
mkdir -p "$out"
sed '/young_at_kgpm3/d; s/^name: product$/name: product_one_modulus/' config/scenes/product.yaml >"$out/scene.yaml"
for ((seed = 201; seed < 201 + beds; seed++)); do
    for density in 2500 1500 4000; do
        for trajectory in simpleA actual; do
            dig=$out/$trajectory.$density.$seed.csv
            [ -e "$dig" ] || "$bin/digtable" dig -q "$out/scene.yaml" --trajectory $trajectory --friction .5 --rolling .5 \
                --density $density --seed "$seed" --threads "${THREADS:-1}" -o "$dig"
        done
    done
done
for trajectory in simpleA actual; do
    for density in 1500 2500 4000; do
        for ((seed = 201; seed < 201 + beds; seed++)); do
            awk -F, -v head="$trajectory $density $seed" -v density=$density '
                /^t_s/ { for (i = 1; i <= NF; i++) { if ($i == "My_Nm") my = i; if ($i == "t_s") t = i } next }
                my { at[n] = $t; value[n++] = $my / density }
                END { for (i = 0; i < n; i++) {
                          sum = in_it = 0
                          for (j = i - 32; j <= i + 32; j++) if (j >= 0 && j < n && (at[j] - at[i]) ^ 2 <= .0257) { sum += value[j]; in_it++ }
                          print head, i, sum / in_it } }' "$out/$trajectory.$density.$seed.csv"
        done
    done
done | awk -v beds="$beds" '
    { t = $1; d = $2; k = $4; n[t, d] = k + 1; sum[t, d, k] += $5 / beds; sum2[t, d, k] += $5 ^ 2 / beds; of[t, d, $3] += $5; seeds[$3]; trajectories[t] }
    function variance(t, d, k) { return (sum2[t, d, k] - sum[t, d, k] ^ 2) / (beds - 1) } # of the mean
    function mean(t, d,   s, m) { for (s in seeds) m += of[t, d, s] / beds; return m }
    function error2(t, d,   s, v) { for (s in seeds) v += (of[t, d, s] / mean(t, d) - 1) ^ 2; return v / beds / (beds - 1) }
    END {
        printf "%-10s %6s %11s %11s %11s %7s\n", "trajectory", "kg/m3", "difference", "by scatter", "mean ratio", "+-"
        for (t in trajectories) for (d = 1500; d <= 4000; d += 2500) {
            off = own = expected = 0
            for (k = 0; k < n[t, 2500]; k++) {
                off += (sum[t, d, k] - sum[t, 2500, k]) ^ 2; own += sum[t, 2500, k] ^ 2
                expected += variance(t, d, k) + variance(t, 2500, k)
            }
            ratio = mean(t, d) / mean(t, 2500)
            printf "%-10s %6d %11.3f %11.3f %11.3f %7.3f\n", t, d, sqrt(off / own), sqrt(expected / own), ratio,
                ratio * sqrt(error2(t, d) + error2(t, 2500))
        }
    }'
