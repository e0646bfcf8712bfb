#!/bin/bash
# digloop trace on digs of another DEM code, of gravels off the table's grid and with an effect in
# them, one bed or two: what it is to find there, with its values, and what not.
. tests/system/check.bash
table=${TABLE:-tables/reference_rig.sqlite} scene=rig
data=$PWD/tests/data/liggghts_more

trace() { # GRAVEL OPTION…: all its beds, into $work/GRAVEL.json and .txt
    local role=identify simple other=${OTHER:-actual}
    mkdir -p "$work/$1"
    {
        echo "scene: $scene"
        echo "recordings:"
        for simple in "$data/${1}"_seed?__simpleA.csv; do
            echo "  - {file: $simple, trajectory: simpleA, role: $role}"
            echo "  - {file: ${simple%simpleA.csv}$other.csv, trajectory: $other, role: fit}"
            role=fit
        done
    } >"$work/$1/campaign.yaml"
    "$BIN/digloop" trace "$table" "$work/$1" --json "$work/$1.json" "${@:2}" 2>"$work/$1.txt" || cat "$work/$1.txt"
    sed -n "/^Missing\|^  gravel:\|^Nothing\|90 %:.*to/s/^ */found in $1: /p" "$work/$1.txt"
    echo "found in $1: density, 90 %: $(number "$1" density_kgpm3 low) to $(number "$1" density_kgpm3 high) kg/m3"
}
verdict() { tr -d ' \n' <"$work/$1.json" | sed -nE 's/.*"verdict":\[([^]]*)\].*/\1/p'; }
number() { # GRAVEL KEY FIELD: a field of the first object of that key
    tr -d ' \n' <"$work/$1.json" | sed -nE "s/.*\"$2\":\{[^}]*\"$3\":([-0-9.e+]+).*/\1/p"
}

for gravel in mu0.4_mur0.6_rho2000 mu0.6_mur0.6_rho2200; do
    trace "$gravel"
    check "$gravel: nothing is missing" [ "$(verdict "$gravel")" = '"none"' ]
done

# A table of fewer gravels knows less well what lies between them.
if /usr/bin/python3 -c 'import sqlite3' 2>/dev/null; then
    /usr/bin/python3 scripts/thinner_table.py "$table" "$work/thin.sqlite" 10 .3,.5,.9 .3,.9 >/dev/null
    held=0
    for gravel in mu0.4_mur0.4_rho2000 mu0.4_mur0.6_rho2000 mu0.6_mur0.6_rho2200; do
        table=$work/thin.sqlite trace "$gravel" --effects "${table%.sqlite}_effects.sqlite"
        check "$gravel by a third of the gravels: nothing is missing" [ "$(verdict "$gravel")" = '"none"' ]
        IFS=_ read -r friction rolling density <<<"${gravel//[a-z]/}"
        for truth in "$friction friction" "$rolling rolling" "$density density_kgpm3"; do
            ! within "${truth% *}" "$(number "$gravel" "${truth#* }" low)" "$(number "$gravel" "${truth#* }" high)" || held=$((held + 1))
        done
    done
    check "... and its intervals hold: $held of 9" [ "$held" -ge 8 ]
    /usr/bin/python3 scripts/thinner_table.py "$table" "$work/two.sqlite" 10 .3,.9 >/dev/null
    table=$work/two.sqlite trace mu0.4_mur0.4_rho2000
    check "two frictions are said to be too few" grep -q "its two frictions" "$work/mu0.4_mur0.4_rho2000.txt"
else
    skip_check "tables of fewer gravels" "no Python here"
fi

# The table of effects is a copy, for the command that the report prints is run below.
cp "${table%.sqlite}_effects.sqlite" "$work/effects.sqlite"
trace slope_up --effects "$work/effects.sqlite"
check "ground that rises by 8 degrees is a slope" [ "$(verdict slope_up)" = '"ground_slope"' ]
check "... of 8 degrees, within its interval" within 8 "$(number slope_up slope_deg low)" "$(number slope_up slope_deg high)"
check "... which is narrower than 6 degrees" within \
    "$(awk -v l="$(number slope_up slope_deg low)" -v h="$(number slope_up slope_deg high)" 'BEGIN { print h - l }')" 0.5 6
check "... in gravel of friction .5, to .1" within "$(number slope_up friction value)" 0.4 0.6
check "... and of 2500 kg/m3, within its interval" within 2500 \
    "$(number slope_up density_kgpm3 low)" "$(number slope_up density_kgpm3 high)"
check "... which is narrower than three tenths" within "$(awk -v l="$(number slope_up density_kgpm3 low)" \
    -v h="$(number slope_up density_kgpm3 high)" 'BEGIN { print (h - l) / 2500 }')" 0.02 0.3

# The command, pasted as it stands; digtable gets no time, so it reads the grid and the table and stops.
sed -n '/^cat >/,/^digtable/p' "$work/slope_up.txt" >"$work/paste.sh"
ln -s "$PWD/config" "$work/config"
digtable() { "$bin/digtable" "$@" -j 1 --time-limit 0; }
paste() (
    bin=$(realpath "$BIN")
    cd "$work" || exit
    # shellcheck disable=SC1091 # written above
    . ./paste.sh
)
check "the report prints a digtable command" eval '[ "$(grep -c "^digtable generate " "$work/paste.sh")" = 1 ]'
check "... that digtable takes as it stands" paste 2>"$work/err"
check "... for beds with the slope found" eval 'grep -q "8 digs" "$work/err" && grep -qE "ground_slope, magnitudes: \[[-0-9.]+\]" "$work/effects_grid.yaml"'
check "nothing is asked for where nothing is missing" eval '! grep -q digtable "$work/mu0.4_mur0.6_rho2000.txt"'

# Cohesion of this size and a gravel of more rolling friction dig alike: no claim is made.
trace cohesion
check "cohesion that another gravel stands in for is not named" [ "$(verdict cohesion)" = '"none"' ]

trace cohesion_all
check "nor is what sticks to the bucket, too" [ "$(verdict cohesion_all)" = '"none"' ]
trace cohesion_2e5
check "twice as much is named" [ "$(verdict cohesion_2e5)" = '"cohesion"' ]
check "... and measured to a fifth" within "$(number cohesion_2e5 cohesion_Jpm3 value)" 1.6e5 2.4e5
check "... within its interval" within 2e5 "$(number cohesion_2e5 cohesion_Jpm3 low)" "$(number cohesion_2e5 cohesion_Jpm3 high)"

trace obstacle
check "a rock in the way is named" [ "$(verdict obstacle)" = '"obstacle"' ]

# By a force sensor whose noise is three tenths of each channel's rms.
seed=0
noisy() { # GRAVEL: its beds, as noisy_GRAVEL into $work/noisy
    mkdir -p "$work/noisy"
    for dig in "$data/${1}"_seed?__*.csv; do
        awk -F, -v OFS=, -v seed="$((seed += 1))" 'BEGIN { srand(seed) }
            function normal() { return sqrt(-2 * log(1 - rand())) * cos(6.28318531 * rand()) }
            /^t_s/ { for (i = 1; i <= NF; i++) if ($i ~ /^(Fx_N|Fz_N|My_Nm)$/) at[i] = 1 }
            NR == FNR { n += /^[0-9]/; for (i in at) square[i] += $i ^ 2; next }
            /^[0-9]/ { for (i in at) $i += .3 * sqrt(square[i] / n) * normal() }
            { print }' "$dig" "$dig" >"$work/noisy/noisy_$(basename "$dig")"
    done
}
for gravel in mu0.4_mur0.6_rho2000 mu0.6_mur0.6_rho2200 obstacle; do noisy $gravel; done
plain=$data data=$work/noisy
for gravel in noisy_mu0.4_mur0.6_rho2000 noisy_mu0.6_mur0.6_rho2200; do
    trace $gravel
    check "$gravel: nothing is missing" [ "$(verdict $gravel)" = '"none"' ]
done
trace noisy_obstacle
check "a rock in the way is named beside noise" [ "$(verdict noisy_obstacle)" = '"obstacle"' ]
data=$plain

# One bed recorded four times tells no more than once, and what it has of its own is no effect.
mkdir "$work/repeated" "$work/smooth"
for seed in 1 2 3 4; do
    for trajectory in simpleA actual; do
        ln -s "$data/mu0.4_mur0.4_rho2000_seed1__$trajectory.csv" "$work/repeated/repeated_seed${seed}__$trajectory.csv"
    done
done
data=$work/repeated
trace repeated
check "one bed recorded four times: nothing is missing" [ "$(verdict repeated)" = '"none"' ]

# Grains without rolling friction resist less than any gravel of the table.
for dig in tests/data/reference/mu0.5_mur0.0_rho2500__*.csv; do ln -s "$PWD/$dig" "$work/smooth/smooth_seed1__${dig##*__}"; done
data=$work/smooth
trace smooth
check "a gravel beyond the table is no effect" [ "$(verdict smooth)" = '"none"' ]
check "... and the table is said to lack it" grep -q "the gravel lies beyond the table" "$work/smooth.txt"
data=$plain

# By a force sensor whose filter lags, no soil is named.
lagging() { # GRAVEL SECONDS: its beds, as lagging_GRAVEL into $work/lagging
    mkdir -p "$work/lagging"
    for dig in "$data/${1}"_seed?__*.csv; do
        awk -F, -v OFS=, -v lag="$2" '
            /^t_s/ { for (i = 1; i <= NF; i++) if ($i ~ /^(Fx_N|Fz_N|My_Nm)$/) at[i] = 1 }
            /^[0-9]/ { for (i in at) $i = read[i] += ($i - read[i]) * (began ? 1 - exp((before - $1) / lag) : 1); before = $1; began = 1 }
            { print }' "$dig" >"$work/lagging/lagging_$(basename "$dig")"
    done
}
for gravel in mu0.4_mur0.6_rho2000 mu0.6_mur0.6_rho2200; do
    lagging $gravel .1
    data=$work/lagging trace lagging_$gravel --add "$work/lagging.model"
    check "$gravel by a sensor that lags: sensor_delay" [ "$(verdict lagging_$gravel)" = '"sensor_delay"' ]
    check "... of .1 s, within its interval" within .1 "$(number lagging_$gravel delay_s low)" "$(number lagging_$gravel delay_s high)"
    check "... of a gravel of its density, within its interval" within "${gravel#*rho}" \
        "$(number lagging_$gravel density_kgpm3 low)" "$(number lagging_$gravel density_kgpm3 high)"
    check "... and no machine is corrected by it" eval 'tr -d " \n" <"$work/lagging.model" | grep -q "\"effects\":\[\]"'
done

# One dig along either of two trajectories. By one alone a fit may take any rock, or any contrast of a layer.
data=$PWD/tests/data/liggghts_judge
for case in rock22:obstacle:diameter_m:.022 layer45:layering:layer_m:.045; do
    IFS=: read -r kind name parameter truth <<<"$case"
    OTHER=simpleB trace fast_${kind}_mu0.35_mur0.75_rho1800
    check "a ${kind%%[0-9]*} of two digs is named" [ "$(verdict fast_${kind}_mu0.35_mur0.75_rho1800)" = "\"$name\"" ]
    check "... within its interval" within $truth "$(number fast_${kind}_mu0.35_mur0.75_rho1800 $parameter low)" \
        "$(number fast_${kind}_mu0.35_mur0.75_rho1800 $parameter high)"
done

# A bucket of friction .15 in gravel of .6; the table's is as rough as the gravel.
data=$PWD/tests/data/liggghts_bucket
smooth=mu0.6_mur0.4_rho2500_bucket0.15
trace $smooth
check "a smooth bucket is named" [ "$(verdict $smooth)" = '"bucket_friction"' ]
check "... and what it has of friction measured to a third" within "$(awk -v m="$(number $smooth bucket_smoothness value)" \
    -v f="$(number $smooth friction value)" 'BEGIN { print (1 - m) * f }')" .1 .2

# In the open, with a bucket of steel: as the table has it, and half as rough.
table=tables/product.sqlite scene=product data=$PWD/tests/data/liggghts_product
for gravel in mu0.6_mur0.4_rho2200_bucket0.4 mu0.4_mur0.6_rho3000_bucket0.4; do
    trace $gravel
    check "nothing is missing in $gravel, dug with the table's bucket" [ "$(verdict $gravel)" = '"none"' ]
done

# As a machine records them, which does not know where the ground lies.
for dig in "$data"/*_seed[12]__simpleA.csv; do
    bed=$(basename "${dig%__simpleA.csv}")
    "$BIN/digrig" record "$dig" --machine config/machines/zx200_trench.yaml --scene config/scenes/product.yaml -o "$work/run.csv" -q
    "$BIN/digloop" identify $table "$work/run.csv" --machine config/machines/zx200_trench.yaml --trajectory simpleA >"$work/$bed.txt"
    check "a machine takes $bed for a dig of the table's depth" within \
        "$(sed -nE 's/.*at depth ([0-9.]+).*/\1/p' "$work/$bed.txt")" .9 1.1
    check "... by its forces, in gravel of the table" eval 'grep -q "moment and forces" "$work/$bed.txt" && ! grep -q OUTSIDE "$work/$bed.txt"'
done

# With 14 grains across the bucket for 10 a dig resists less, by 2.1 N m (1/10 - 1/14) of gravel of 2500 kg/m3
# (docs/numerics/dem.md, "Fine gravel"). One dig's mean scatters by .05.
mean_moment() { awk -F, '/^t_s/ { for (i = 1; i <= NF; i++) if ($i == "My_Nm") c = i } /^[0-9]/ { s += $c; n++ } END { print s / n }' "$1"; }
coarse=$(for bed in "$data"/mu0.6*__simpleA.csv; do mean_moment "$bed"; done | awk '{ s += $1 } END { print s / NR }')
fine=$(mean_moment "$data"/fine/mu0.6_mur0.4_rho2200_bucket0.4_seed1__simpleA.csv)
told=$(awk -v coarse="$coarse" 'BEGIN { printf "%.3f", coarse - 2.1 * 2200 / 2500 * (1 / 10 - 1 / 14) }')
echo "mean moment with 10 grains across $coarse, with 14 $fine, told $told N m"
check "finer grains of LIGGGHTS resist as much less as ours" within "$fine" "$(awk -v t="$told" 'BEGIN { print t * .9 }')" "$(awk -v t="$told" 'BEGIN { print t * 1.1 }')"

data=$data/smooth smooth=mu0.5_mur0.6_rho2600_bucket0.2
trace $smooth
check "a bucket smoother than steel is named" [ "$(verdict $smooth)" = '"bucket_friction"' ]
check "... half of it, within its interval" within .5 "$(number $smooth bucket_smoothness low)" "$(number $smooth bucket_smoothness high)"
check "... and said as a friction" grep -q "bucket: friction 0.2.*where the table's has 0.4, 0.4" "$work/$smooth.txt"
check "... in gravel of friction .5, within its interval" within .5 "$(number $smooth friction low)" "$(number $smooth friction high)"
check "... and of 2600 kg/m3, within its interval" within 2600 "$(number $smooth density_kgpm3 low)" "$(number $smooth density_kgpm3 high)"
smooth=mu0.6_mur0.4_rho2200_bucket0.2
trace $smooth
check "the same bucket is named in another gravel" [ "$(verdict $smooth)" = '"bucket_friction"' ]
check "... and of 2200 kg/m3, within its interval" within 2200 "$(number $smooth density_kgpm3 low)" "$(number $smooth density_kgpm3 high)"

finish
