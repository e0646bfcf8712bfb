#!/bin/bash
# The discrete element engine beside LIGGGHTS-PUBLIC (Debian's package liggghts): the same bed, law and
# time step, one core each in turn, LIGGGHTS at the best skin of a scan, ours at the best of three
# runs. Processor time of the program, so that a busy machine disturbs both alike. The largest bed is
# also stepped by all cores, by the time that passes: this asks for a quiet machine. One line each:
# name ratio unit detail.
#   BUILD=build tests/bench/dem.sh       minutes; BENCH_QUICK=1: two sizes, few steps, a short dig
set -eu
build=${BUILD:-build}
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
dem=$build/tests/bench/dem
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [ -n "${BENCH_QUICK:-}" ]; then
    sizes=${BENCH_SIZES:-"2000 7000"} budget=3e6 dig_steps=2000
else
    sizes=${BENCH_SIZES:-"2000 7000 30000 100000"} budget=3e7 dig_steps=108800
fi
skins="0.0003 0.0006 0.001 0.0015"

cpu_of() { # COMMAND…: seconds of processor time; its output goes to out.log
    local TIMEFORMAT='%U %S'
    { time "$@" >"$work/out.log" 2>&1; } 2>"$work/time" || { cat "$work/out.log" >&2; exit 1; }
    awk 'END { print $1 + $2 }' "$work/time"
}

data_of() { # BED.csv X_LOW X_HIGH Y_LOW Y_HIGH TYPES: as read_data wants it
    awk -F, -v xl="$2" -v xh="$3" -v yl="$4" -v yh="$5" -v types="$6" '$1 + 0 == $1 { line[n++] = $0 } END {
        printf "grains\n\n%d atoms\n\n%d atom types\n\n%s %s xlo xhi\n%s %s ylo yhi\n", n, types, xl, xh, yl, yh
        printf "-0.01 0.5 zlo zhi\n\nAtoms\n\n"
        for (k = 0; k < n; k++) { split(line[k], v, ","); print k + 1, 1, 0.0075, 2500, v[1], v[2], v[3] } }' "$1"
}

law_lines() { # TYPES: the paper's rolling model at .5/.5
    local row='' k
    for ((k = 0; k < $1; k++)); do row="$row 0.5"; done
    local square='' young='' poisson=''
    for ((k = 0; k < $1; k++)); do
        square="$square$row" young="$young 5e6" poisson="$poisson 0.2"
    done
    cat <<EOF
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
read_data bed.data
neigh_modify delay 0 every 1 check yes
fix m1 all property/global youngsModulus peratomtype$young
fix m2 all property/global poissonsRatio peratomtype$poisson
fix m3 all property/global coefficientRestitution peratomtypepair $1 ${square//0.5/0.2}
fix m4 all property/global coefficientFriction peratomtypepair $1 $square
fix m5 all property/global characteristicVelocity scalar 2
fix m6 all property/global coefficientRollingFriction peratomtypepair $1 $square
pair_style gran model hooke tangential history rolling_friction epsd2
pair_coeff * *
timestep 6.25e-05
fix gravi all gravity 9.81 vector 0 0 -1
EOF
}

wall() { # NAME AXISplane OFFSET
    echo "fix $1 all wall/gran model hooke tangential history rolling_friction epsd2 primitive type 1 $2 $3"
}

deck() { # SIDE_m SKIN STEPS
    law_lines 1
    echo "neighbor $2 bin"
    wall x1 xplane 0 && wall x2 xplane "$1" && wall y1 yplane 0 && wall y2 yplane "$1" && wall z1 zplane 0
    printf 'fix integr all nve/sphere\nthermo 1000000\nrun %s\n' "$3"
}

ours() { # SIDE_m STEPS: particle-steps a second and kB, the best of three runs
    local k
    for k in 1 2 3; do "$dem" step "$work/bed.csv" "$1" "$2"; done | sort -k2,2g | awk 'END { print $2, $3 }'
}

passed() { # SIDE_m STEPS THREADS: seconds that pass
    "$dem" step "$work/bed.csv" "$1" "$2" "$3" | awk '{ print $4 }'
}

theirs() { # SIDE_m SKIN STEPS: processor seconds of so many steps, the start taken off
    deck "$1" "$2" 200 >"$work/in.start"
    deck "$1" "$2" $((200 + $3)) >"$work/in.run"
    local start run
    start=$(cd "$work" && cpu_of liggghts -in in.start)
    run=$(cd "$work" && cpu_of liggghts -in in.run)
    awk -v a="$start" -v b="$run" 'BEGIN { print b - a }'
}

# Particle-steps a second at each size
ours_at="" first="" dig_skin=
for n in $sizes; do
    side=$("$dem" pour "$n" "$work/bed.csv")
    data_of "$work/bed.csv" -0.01 "$(awk -v s="$side" 'BEGIN { print s + .01 }')" \
        -0.01 "$(awk -v s="$side" 'BEGIN { print s + .01 }')" 1 >"$work/bed.data"
    grains=$(wc -l <"$work/bed.csv")
    steps=$(awk -v b=$budget -v n="$grains" 'BEGIN { print int(b / n) + 100 }')
    best=
    for try in $skins; do
        took=$(theirs "$side" "$try" "$steps")
        if [ -z "$best" ] || awk -v a="$took" -v b="$best" 'BEGIN { exit !(a < b) }'; then
            best=$took best_skin=$try
        fi
    done
    # The rig's bed holds 7000 grains.
    [ -n "$dig_skin" ] && [ "$n" != 7000 ] || dig_skin=$best_skin
    read -r speed kB < <(ours "$side" "$steps")
    awk -v n="$grains" -v ours="$speed" -v steps="$steps" -v took="$best" -v skin="$best_skin" 'BEGIN {
        theirs = n * steps / took
        printf "dem_steps_%dk %.2f ratio %d grains: %.2f M particle-steps/s, LIGGGHTS %.2f M at skin %s m\n",
            int(n / 1000), ours / theirs, n, ours / 1e6, theirs / 1e6, skin }'
    ours_at="$ours_at $grains $speed $kB"
    first=${first:-"$grains $kB"}
done
# shellcheck disable=SC2086 # numbers
echo $ours_at | awk 'NF > 3 { for (k = 1; k <= NF; k += 3) { x = log($k); y = log($k / $(k + 1)); n++
        sx += x; sy += y; sxx += x * x; sxy += x * y }
    printf "dem_exponent %.3f exponent processor time of a step over the number of grains, %d sizes\n",
        (n * sxy - sx * sy) / (n * sxx - sx * sx), n
    printf "dem_memory %.2f kB/grain peak, %d to %d grains\n", ($NF - $3) / ($(NF - 2) - $1), $1, $(NF - 2) }'

# The last bed once more, by all cores: in turn, the best of three runs of either
cores=$(nproc)
for k in 1 2 3; do
    echo "$(passed "$side" "$steps" 1) $(passed "$side" "$steps" "$cores")"
done | awk -v cores="$cores" -v n="$grains" '
    { alone = NR == 1 || $1 < alone ? $1 : alone; shared = NR == 1 || $2 < shared ? $2 : shared }
    END { printf "dem_threads %.2f ratio %d grains on %d cores: %.2f s, on one %.2f s\n",
        alone / shared, n, cores, shared, alone }'

# One whole dig of the rig scene: from the same bed, poured before the clock starts
dig="$build/bin/digtable dig $root/config/scenes/rig.yaml --trajectory actual --friction .5 --rolling .5 --density 2500"
if [ -n "${BENCH_QUICK:-}" ]; then
    sed 's/duration_s: 0.8/duration_s: 0.125/; /name: rotation1/,$d' <(sed '/- name: simpleA/,/- name: actual/{/- name: actual/!d}' \
        "$root/config/scenes/rig.yaml") >"$work/rig.yaml"
    dig="$build/bin/digtable dig $work/rig.yaml --trajectory actual --friction .5 --rolling .5 --density 2500"
fi
$dig --save-bed "$work/rig.csv" -o "$work/first.csv" 2>/dev/null
# shellcheck disable=SC2086 # a command with its options
ours=$(cpu_of $dig --bed "$work/rig.csv" -o "$work/again.csv")
data_of "$work/rig.csv" -0.01 0.32 -0.07 0.07 3 >"$work/bed.data"
# The bucket of config/scenes/rig.yaml: four plates across the width, two sides as fans.
awk 'function point(k, y) { print "   vertex", x[k], y, z[k] }
    function facet(a, ya, b, yb, c, yc) {
        print " facet normal 0 0 0\n  outer loop"; point(a, ya); point(b, yb); point(c, yc)
        print "  endloop\n endfacet" }
    BEGIN { h = .035
        split("0 -.04 -.052 -.04 -.012", x, " "); split("-.09 -.072 -.042 -.012 0", z, " ")
        print "solid bucket"
        for (k = 1; k < 5; k++) { facet(k, -h, k + 1, -h, k + 1, h); facet(k, -h, k + 1, h, k, h) }
        for (k = 2; k < 5; k++) { facet(1, -h, k, -h, k + 1, -h); facet(1, h, k, h, k + 1, h) }
        print "endsolid bucket" }' >"$work/bucket.stl"
{
    law_lines 3
    echo "neighbor $dig_skin bin"
    wall x1 xplane 0 && wall x2 xplane 0.31 && wall y1 yplane -0.06 && wall y2 yplane 0.06 && wall z1 zplane 0
    cat <<EOF
fix integr all nve/sphere
fix bucket all mesh/surface/stress file bucket.stl type 2 rotate axis 0 -1 0 angle -30 move 0.09 0 0.1629422863 reference_point 0.09 0 0.1629422863
fix bw all wall/gran model hooke tangential history rolling_friction epsd2 mesh n_meshes 1 meshes bucket
thermo 1000000
fix mv all move/mesh mesh bucket linear 0.02956559819 0 -0.04069355482
EOF
    if [ "$dig_steps" -lt 12800 ]; then
        echo "run $dig_steps"
    else
        cat <<EOF
run 12800
unfix mv
fix mv all move/mesh mesh bucket rotate origin 0.1136524786 0 0.1303874425 axis 0 -1 0 period 20.07808143
run 17600
unfix mv
fix mv all move/mesh mesh bucket linear 0.0463 0 0
run 35200
unfix mv
fix mv all move/mesh mesh bucket rotate origin 0.2155124786 0 0.1303874425 axis 0 -1 0 period 17.95511222
run 32000
unfix mv
fix mv all move/mesh mesh bucket linear 0 0 0.0915
run 11200
EOF
    fi
} >"$work/in.dig"
took=$(cd "$work" && cpu_of liggghts -in in.dig)
awk -v a="$ours" -v b="$took" -v s="$dig_steps" 'BEGIN {
    printf "dem_dig %.2f ratio processor time of %d steps of the actual dig: %.1f s, LIGGGHTS %.1f s\n", b / a, s, a, b }'
