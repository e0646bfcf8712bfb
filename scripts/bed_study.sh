#!/bin/bash
# How much do digs scatter from packing to packing with more grains across the bucket, and how wide,
# deep and long must a bed be before the bucket stops feeling its box? Varies config/scenes/rig.yaml one
# thing at a time and prints a line for every variant (docs/numerics/dem.md, "Bed size"): grains, beds, mean of
# the moment in time with its standard error, scatter of one dig's mean, and of its moment after
# +-0.16 s (relative L2 against the beds' mean, 1 sigma), user seconds a dig, of actual the mean while it turns up. What lies in OUT
# is not dug again, so it may be stopped and started, also with more BEDS.
#   BIN=build/bin OUT=build/bed_study [ENGINE=kernel] [JOBS=1] scripts/bed_study.sh [across] [finest] [finer] [forty] [room] [hard] [firm] [shipped]
# On one of two busy threads of a core `across` takes half an hour, `room` 25 minutes, `hard` and `firm` 5 each; STIFFEST=1 adds
# 150 MPa to `firm`, at .9/.9 as well. `finest`, 20 grains across, is for a graphics card: ENGINE=cuda JOBS=4, three minutes. `finer`, 28 across, takes ENGINE=single 50 minutes of a core a bed, ENGINE=cuda JOBS=2 five minutes for two.
# `forty`, 40 across, takes a card ten minutes for two beds. A bed that is poured is not poured again.
set -euo pipefail
bin=${BIN:-build/bin} out=${OUT:-build/bed_study} engine=${ENGINE:-kernel} jobs=${JOBS:-1} scene=config/scenes/rig.yaml
mkdir -p "$out"

# The beds of one variant, those that are not there yet, and its line.
study() { # NAME BEDS TRAJECTORY FRICTION (and as much rolling friction) SED-SCRIPT
    local name=$1 beds=${BEDS:-$2} trajectory=$3 friction=$4 seed
    sed -e 's/^time_step_s: .*/time_step_s: 0/' -e "$5" "$scene" >"$out/$name.yaml"
    for seed in $(seq "$beds"); do
        local dig=$out/$name.$seed
        [ ! -e "$dig.csv" ] || continue
        while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n; done
        dig_one "$dig" "$seed" "$trajectory" "$friction" "$out/$name.yaml" &
    done
    while [ "$(jobs -rp | wc -l)" -gt 0 ]; do wait -n; done
    line "$name"
}

dig_one() { # DIG SEED TRAJECTORY FRICTION SCENE: a bed that is there is not poured again
    local bed=(--save-bed "$1.bed.csv")
    [ ! -s "$1.bed.csv" ] || bed=(--bed "$1.bed.csv")
    TIMEFORMAT=%U
    { time "$bin/digtable" dig "$5" --trajectory "$3" --friction "$4" --rolling "$4" --density 2500 --seed "$2" \
        --engine "$engine" "${bed[@]}" -o "$1.csv" 2>"$1.log"; } 2>"$1.user_s" || {
        cat "$1.log" >&2
        exit 1
    }
    rm "$1.bed.csv"
}

# One line of all digs of a variant that are there: the columns are the output windows, the same in all.
line() { # NAME
    local digs=("$out/$1".[0-9]*.csv)
    awk -F, -v name="$1" -v half_s=.16 -v user_s="$(cat "${digs[@]/%.csv/.user_s}" | awk '{ s += $1 } END { print s / NR }')" \
        -v grains="$(cat "${digs[@]/%.csv/.log}" | awk '/grains/ { s += $1; n++ } END { printf "%.0f", s / n }')" '
        FNR == 1 { for (i = 1; i <= NF; i++) if ($i == "My_Nm") my = i; beds++; n = 0; next }
        { t[n] = $1; moment[beds, n++] = $my }
        $1 >= 4.1 && $1 < 6.1 { turn += $my; turning++ } # the second turn of actual
        function smoothed(bed, i,    sum, k, j) {
            for (j = i; j >= 0 && t[i] - t[j] <= half_s; j--) { sum += moment[bed, j]; k++ }
            for (j = i + 1; j < n && t[j] - t[i] <= half_s; j++) { sum += moment[bed, j]; k++ }
            return sum / k
        }
        END {
            for (i = 0; i < n; i++) {
                mean = square = 0
                for (b = 1; b <= beds; b++) {
                    y = smoothed(b, i)
                    mean += y / beds; square += y * y; of[b] += y / n
                }
                if (beds > 1) scatter += (square - beds * mean * mean) / (beds - 1)
                norm += mean * mean
            }
            for (b = 1; b <= beds; b++) { s += of[b] / beds; q += of[b] * of[b] }
            sd = beds > 1 ? sqrt((q - beds * s * s) / (beds - 1)) : 0
            printf "%-24s %6d grains %2d beds  mean %.4f +- %.4f Nm  one mean %.3f  one dig %.3f  %6.1f s", name, grains, beds,
                s, sd / sqrt(beds), sd / s, sqrt(scatter / norm), user_s
            if (turning > 0) printf "  second turn %.3f Nm", turn / turning
            print ""
        }' "${digs[@]}" | tee -a "$out/lines.txt"
}

grain() { echo "s/^  diameter_m: .*/  diameter_m: $1/"; }
beside() { awk -v mm="$1" 'BEGIN { h = 0.035 + mm / 1000; printf "s/^  y: .*/  y: [-%g, %g]/", h, h }'; }
floor() { echo "s/^  z: .*/  z: [$1, 0.085]/"; }
ends() { echo "s/^  x: .*/  x: [$1, $2]/"; }
stiff() { echo "s/^  young_Pa: .*/  young_Pa: $1/"; }
join() { printf '%s\n' "$@"; }
seven=$(grain 0.01) nine=$(grain 0.0075) periodic='$a bed: {periodic_y: true}'

plain() { study across_7 11 simpleA .5 "$(join "$seven" "$periodic")"; } # what the others are compared with

across() { # Grains across the bucket; the rig's box with sides that are one.
    plain
    study across_9 4 simpleA .5 "$(join "$nine" "$periodic")"
    study across_14 3 simpleA .5 "$(join "$(grain 0.005)" "$periodic")"
}

finest() { study across_20 4 simpleA .5 "$(join "$(grain 0.0035)" "$periodic")"; }

finer() { study across_28 3 simpleA .5 "$(join "$(grain 0.0025)" "$periodic")"; }

forty() { study across_40 2 simpleA .5 "$(join "$(grain 0.00175)" "$periodic")"; }

room() { # Walls or sides that are one so many mm beside the bucket; the floor; the ends.
    study walls_25 12 simpleA .5 "$seven"
    study walls_50 8 simpleA .5 "$(join "$seven" "$(beside 50)")"
    study walls_80 8 simpleA .5 "$(join "$seven" "$(beside 80)")"
    study walls_25_across_9 4 simpleA .5 "$nine"
    plain
    study periodic_50 8 simpleA .5 "$(join "$seven" "$periodic" "$(beside 50)")"
    study deeper_25 8 simpleA .5 "$(join "$seven" "$periodic" "$(floor -0.025)")"
    study across_7_actual 4 actual .5 "$(join "$seven" "$periodic")" # whose heap reaches the far end
    study longer_actual 4 actual .5 "$(join "$seven" "$periodic" "$(ends -0.04 0.39)")"
    study longest_actual 3 actual .5 "$(join "$seven" "$periodic" "$(ends -0.04 0.47)")"
}

shipped() { # The rig's own digs, nine grains and walls, as tables/reference_rig.sqlite holds them: nothing is dug.
    local trajectory
    "$bin/digtable" export tables/reference_rig.sqlite --runs -o "$out/rig.csv"
    for trajectory in simpleA actual; do
        rm -f "$out/shipped_$trajectory".*
        awk -F, -v trajectory=$trajectory -v to="$out/shipped_$trajectory." '
            NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; next }
            $1 == .5 && $2 == .5 && $3 == 2500 && $4 == trajectory && $(column["effect"]) == "" {
                dig = to ($5 + 1)
                if (!($5 in seen)) {
                    seen[$5] = 1
                    print "t_s,My_Nm" >(dig ".csv")
                    print $(column["grains"]), "grains" >(dig ".log")
                    print 0 >(dig ".user_s")
                }
                print $(column["t_s"]) "," $(column["My_Nm"]) >(dig ".csv")
            }' "$out/rig.csv"
        line "shipped_$trajectory"
    done
}

hard() { # The same where gravel jams most.
    study hard_walls_25 6 simpleA .9 "$seven"
    study hard_walls_80 6 simpleA .9 "$(join "$seven" "$(beside 80)")"
    study hard_periodic_25 6 simpleA .9 "$(join "$seven" "$periodic")"
}

firm() { # Stiffer grains.
    plain
    study firm_20_MPa 6 simpleA .5 "$(join "$seven" "$periodic" "$(stiff 20e6)")"
    [ -n "${STIFFEST:-}" ] || return 0
    study firm_150_MPa 4 simpleA .5 "$(join "$seven" "$periodic" "$(stiff 150e6)")"
    study hard_periodic_25 6 simpleA .9 "$(join "$seven" "$periodic")"
    study hard_150_MPa 3 simpleA .9 "$(join "$seven" "$periodic" "$(stiff 150e6)")"
}

for part in "${@:-across room hard firm shipped}"; do
    for one_part in $part; do $one_part; done
done
