#!/bin/sh
# Digs in gravels that hold one effect, computed with LIGGGHTS-PUBLIC 3.8 (Debian's package liggghts).
#   ./make.sh GRAVEL SEED [TRAJECTORY...]   the rig scene (config/scenes/rig.yaml), some ten minutes of one core a seed:
#                                           GRAVEL_seedN__TRAJECTORY.csv beside this file
#   ./make.sh muF_murR_rhoD SEED            the same of a plain gravel, named by its parameters
#   ./make.sh muF_murR_rhoD_bucketB SEED    the same with a bucket of its own friction and rolling friction B
#   ./make.sh GRAVEL_muF_murR_rhoD_bucketB SEED   and with the effect of GRAVEL
#   ./make.sh GRAVEL SEED scratch           a small scene, seconds: the phases' means and
#                                           the spheres of the levelled bed on stdout, as small.csv has them
# OUT=FOLDER: recordings go there. SCENE=product: config/scenes/product.yaml in place of the rig's, at two thirds of the time step.
# ACROSS=N, even, with SCENE=product: so many grains across the bucket in place of 10, at a step as much shorter.
# YOUNG_PA=E: Young's modulus, otherwise the scene's, which in the product scene goes with the density.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=$(cd "${OUT:-$here}" && pwd)
gravel=$1
seed=$2
shift 2
trajectories=${*:-simpleA actual}
# LIGGGHTS takes primes only, and not one of its seeds twice: seeds 9 and 10 are its other seeds and
# fail, of poly 5 and 8 too.
primes="15485867 67867967 86028121 32452867 49979693 15485863 67867979 86028157 32452843 49979687 \
20000003 21234593 22469173 23703761 24938359 26172929 27407509 28642079 29876657 31111237 \
32345813 33580397 34814971 36049543 37284119 38518687 39753257 40987841 42222409 43456991 \
50000017 51234587 52469171 53703743 54938321 56172889 57407477 58642057 59876629 61111217 \
62345791 63580367 64814941 66049513 67284097 68518699 69753289 70987897 72222497 73457077 \
74691647 75926231 77160827 78395399 79630013 80864629 82099211 83333801 84568381 85802953 \
87037523 88272101 89506709 90741293 91975879 93210449 94445023 95679629 96914197 98148773 \
99383341 100617931 101852519 103087087 104321663"
prime=$(echo "$primes" | cut -d' ' -f"$seed")
[ "$prime" ] || { echo "seed: $seed, expected 1 to 75" >&2; exit 2; }

# The scene: bucket (in parts of the rig's), box, height of the poured column, steps of settling.
scale=1 length=.31 half=.06 height=.085 column=.196747 settle=7200 relax=2400 finer=1
if [ "$trajectories" = scratch ]; then
    scale=.4 length=.08 half=.0225 height=.03 column=.0694 settle=4800 relax=1600
fi
radius=.00375 floor=0 periodic=
if [ "${SCENE:-rig}" = product ]; then
    length=.40 column=.229614 settle=8000 radius=.0035 floor=-.025 periodic=yes finer="3 / 2"
    [ -z "${ACROSS:-}" ] || { radius=$(awk "BEGIN { print .035 / $ACROSS }") finer="3 * $ACROSS / 20"; }
fi

# What a gravel is. Types 1 to 3 are grains (by size), 4 is the bucket; walls have type 1 unless said.
friction=.5 rolling=.5 density=2500
radii="$radius" shares="1" clump= slope_deg=0 rock=
young=5e6
bucket= # its friction and rolling friction; none: the grains' own
normal=hooke roll=epsd2 wall_type=1
pull=0 stick=0 # cohesion energy density between grains, and between grains and bucket and walls
kind=$gravel
case $gravel in
*mu[0-9]*_mur*_rho*)
    numbers=mu${gravel#*mu} kind=${gravel%%mu[0-9]*}
    kind=${kind%_} kind=${kind:-plain}
    friction=${numbers#mu} friction=${friction%%_*}
    rolling=${numbers#*_mur} rolling=${rolling%%_*}
    density=${numbers#*_rho} density=${density%%_*}
    case $numbers in *_bucket*) bucket=${numbers#*_bucket} ;; esac ;;
esac
case $kind in
plain) ;;
poly) radii=".003 .00375 .005" shares=".3 .4 .3" ;;
cohesion) pull=1e5 ;; # and at the walls, which are of the grains' type
cohesion_grains) pull=1e5 wall_type=4 ;; # between grains alone
cohesion_all) pull=1e5 stick=1e5 ;;
cohesion_2e5) pull=2e5 stick=2e5 ;;
clump) clump=yes ;;
clump_fine) clump=yes finer=2 ;; # the same, at half the time step
obstacle) rock=.015 ;; # radius of a fixed sphere, where offline_dem/dig/variant.h has it
other) friction=.7 density=1500 ;;
slope_up) slope_deg=8 ;;
slope_down) slope_deg=-8 ;;
hertz) normal=hertz roll=cdt ;;
*) echo "gravel: $gravel, expected muF_murR_rhoD, muF_murR_rhoD_bucketB or one of the case above" >&2; exit 2 ;;
esac

[ "${SCENE:-rig}" != product ] || young=$(awk "BEGIN { print 5e6 * $density / 2500 }")
young=${YOUNG_PA:-$young}
# LIGGGHTS asks for leave below 5 MPa.
soft=$(awk "BEGIN { if ($young < 5e6) print \"soft_particles yes\" }")
law="$normal tangential history rolling_friction $roll"
[ "$pull" = 0 ] || law="$normal tangential history cohesion sjkr rolling_friction $roll"

work=$(mktemp -d)
[ -n "${KEEP:-}" ] || trap 'rm -rf "$work"' EXIT
cd "$work"

awk -v s="$scale" -f "$here/bucket_stl.awk" >bucket.stl
[ -z "$rock" ] || awk -v r="$rock" -v x0=.1138 -v z0="$height" -f "$here/rock_stl.awk" >rock.stl

wall() { # NAME AXISplane OFFSET
    echo "fix $1 all wall/gran model $law primitive type $wall_type $2 $3"
}
pairs() { # GRAIN-GRAIN GRAIN-OTHER: a 4 x 4 matrix of types
    echo "4 $1 $1 $1 $2  $1 $1 $1 $2  $1 $1 $1 $2  $2 $2 $2 $2"
}

laws() {
    cat <<EOF
atom_style granular
atom_modify map array
boundary f $([ "$periodic" ] && echo p || echo f) f
newton off
$soft
communicate single vel yes
units si
region reg block -0.01 $(if [ "$periodic" ]; then echo 0.41 -$half $half -0.035; else echo 0.32 -0.07 0.07 -0.01; fi) 0.6 units box
create_box 4 reg
neighbor 0.0015 bin
neigh_modify delay 0 every 1 check yes
fix m1 all property/global youngsModulus peratomtype $young $young $young $young
fix m2 all property/global poissonsRatio peratomtype .2 .2 .2 .2
fix m3 all property/global coefficientRestitution peratomtypepair $(pairs .2 .2)
fix m4 all property/global coefficientFriction peratomtypepair $(pairs $friction ${bucket:-$friction})
fix m5 all property/global characteristicVelocity scalar 2
fix m6 all property/global coefficientRollingFriction peratomtypepair $(pairs $rolling ${bucket:-$rolling})
fix m7 all property/global cohesionEnergyDensity peratomtypepair $(pairs $pull $stick)
pair_style gran model $law
pair_coeff * *
timestep $(awk "BEGIN { printf \"%.10g\", 6.25e-5 / ($finer) }")
fix gravi all gravity 9.81 vector 0 0 -1
EOF
    wall x1 xplane 0
    wall x2 xplane $length
    [ "$periodic" ] || wall y1 yplane -$half
    [ "$periodic" ] || wall y2 yplane $half
    # Walls know grains by the type that is named here; all grains have the same constants.
    wall z1 zplane $floor
}

# Volume poured: 0.694401 times the levelled box, at a volume fraction of 0.3.
pour() {
    type=0
    names=
    for radius in $radii; do
        type=$((type + 1))
        share=$(echo "$shares" | cut -d' ' -f$type)
        names="$names pts$type $share"
        seed_of=$(echo "32452843 49979693 86028157" | cut -d' ' -f$type)
        if [ "$clump" ]; then
            # Two spheres a radius apart, together as large as one of 7.5 mm.
            echo "fix pts$type all particletemplate/multisphere $seed_of atom_type 1 volume_limit 1e-15 density constant $density nspheres 2 ntry 4000000 spheres" \
                "-.00157481 0 0 .00314962  .00157481 0 0 .00314962 type 1"
        else
            echo "fix pts$type all particletemplate/sphere $seed_of atom_type $type density constant $density radius constant $radius"
        fi
    done
    fall="vel constant 0 0 -0.3 insert_every once overlapcheck yes all_in yes maxattempt 300 region fill ntry_mc 10000 volumefraction_region 0.3"
    [ -z "$clump" ] || fall="vel constant 0 0 -0.3 orientation random insert_every once overlapcheck yes all_in yes maxattempt 300 region fill ntry_mc 10000 volumefraction_region 0.3"
    cat <<EOF
fix pdd all particledistribution/discrete 49979687 $type$names
region fill block 0 $length -$half $half $floor $column units box
fix ins all insert/pack seed $prime distributiontemplate pdd $fall
fix integr all $([ "$clump" ] && echo multisphere || echo nve/sphere)
thermo_style custom step atoms ke cpu
thermo 3200
thermo_modify lost ignore norm no
run 1
unfix ins
run $((settle * $finer))
EOF
    # A slope turns the surface about the place where the bucket enters.
    type=0
    for radius in $radii; do
        type=$((type + 1))
        awk -v r="$radius" -v t=$type -v s="$slope_deg" -v c="$clump" -v h="$height" 'BEGIN {
            a = s * atan2(0, -1) / 180
            if (c != "") r = .00314962
            printf "region cut%d plane .09 0 %.8g %.8g 0 %.8g side in units box\n", t, h - r / cos(a), -sin(a), cos(a)
            printf "group type%d type %d\ngroup top%d region cut%d\ngroup del%d intersect type%d top%d\n", t, t, t, t, t, t, t }'
        echo "delete_atoms group del$type compress no"
    done
    # A rock takes the place of the grains that are there.
    [ -z "$rock" ] || cat <<EOF
region hole sphere .1138 0 $height $(awk -v r="$rock" 'BEGIN { print r + .00375 }') side in units box
delete_atoms region hole compress no
fix rock all mesh/surface file rock.stl type 1
fix rw all wall/gran model $law mesh n_meshes 1 meshes rock
EOF
    echo "run $((relax * $finer))"
}

# The trajectories of config/scenes/rig.yaml.
dig() { # TRAJECTORY
    case $1 in
    simpleA) start=".08329371406 .1719333244 -15" phases="L 9600 .02515 -.04356107781
L 32000 .0463 0
L 6400 0 .0915" ;;
    actual) start=".09 .1629422863 -30" phases="L 12800 .02956559819 -.04069355482
R 17600 17.93 .1136524786 .1303874425
L 35200 .0463 0
R 32000 20.05 .2155124786 .1303874425
L 11200 0 .0915" ;;
    scratch) start=".03 .08 0" phases="L 3200 0 -.13
L 4800 .06 0
R 1600 28.64788976 .048 .054" ;;
    esac
    echo "$start" | { read -r x z theta
        echo "fix bucket all mesh/surface/stress file bucket.stl type 4 rotate axis 0 -1 0 angle $theta move $x 0 $z reference_point $x 0 $z"; }
    # All meshes are one wall.
    [ -z "$rock" ] || echo "unfix rw"
    cat <<EOF
fix bw all wall/gran model $law mesh $([ "$rock" ] && echo n_meshes 2 meshes bucket rock || echo n_meshes 1 meshes bucket)
thermo 16000
run 0
reset_timestep 0
fix out all ave/time 1 $((80 * $finer)) $((80 * $finer)) f_bucket[1] f_bucket[2] f_bucket[3] f_bucket[4] f_bucket[5] f_bucket[6] f_bucket[7] f_bucket[9] file $1.txt
EOF
    echo "$phases" | while read -r kind steps a b c; do
        if [ "$kind" = L ]; then
            echo "fix mv all move/mesh mesh bucket linear $a 0 $b"
        else
            echo "fix mv all move/mesh mesh bucket rotate origin $b 0 $c axis 0 -1 0 period $(awk -v w="$a" 'BEGIN { printf "%.10g", 360 / w }')"
        fi
        echo "run $((steps * $finer))"
        echo "unfix mv"
    done
}

# Windows of 80 steps into a force recording.
recording() { # TRAJECTORY
    echo "# LIGGGHTS-PUBLIC 3.8, gravel $gravel, seed $seed: tests/data/liggghts_digs/make.sh"
    echo "t_s,pin_x_m,pin_z_m,theta_deg,Fx_N,Fy_N,Fz_N,Mx_Nm,My_Nm,Mz_Nm"
    awk -v name="$1" -v window="$((80 * $finer))" '!/^#/ {
        t = ($1 - (window - 1) / 2) * .005 / window
        theta = -15
        if (name == "actual") {
            theta = -30 + 17.93 * (t < .8 ? 0 : t < 1.9 ? t - .8 : 1.1) + 20.05 * (t < 4.1 ? 0 : t < 6.1 ? t - 4.1 : 2)
        }
        printf "%.6f,%.6f,%.6f,%.4f,%.5g,%.5g,%.5g,%.5g,%.5g,%.5g\n", t, $8, $9, theta, $2, $3, $4, $5, $6, $7 }' "$1.txt"
}

# The same, by phase: gravel, seed, phase, My, Fx, Fz, spheres.
phase_means() {
    # How many the first line of the last run counts.
    spheres=$(awk '/^ +0 +[0-9]+ / { n = $2 } END { print n }' scratch.log)
    awk -v g="$gravel" -v s="$seed" -v n_spheres="$spheres" -v finer="$(($finer))" '!/^#/ {
        p = $1 <= 3200 * finer ? 0 : $1 <= 8000 * finer ? 1 : 2
        n[p]++; my[p] += $6; fx[p] += $2; fz[p] += $4 }
        END { for (p = 0; p < 3; p++) printf "%s,%d,%d,%.6g,%.6g,%.6g,%d\n", g, s, p, my[p] / n[p], fx[p] / n[p], fz[p] / n[p], n_spheres }' scratch.txt
}

for trajectory in $trajectories; do
    { laws; pour; dig "$trajectory"; } > "in.$trajectory"
    liggghts -in "in.$trajectory" > "$trajectory.log" || { tail -20 "$trajectory.log" >&2; exit 1; }
    if [ "$trajectory" = scratch ]; then
        phase_means
    else
        recording "$trajectory" > "$out/${gravel}_seed${seed}__$trajectory.csv"
    fi
done
