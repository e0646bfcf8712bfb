#!/bin/sh
# Digs of the rig's scene (config/scenes/rig.yaml) that judge `digloop trace`, computed with LIGGGHTS-PUBLIC 3.8, a minute or two of
# a core each. The bed's recipe and the laws are those of ../liggghts_digs/make.sh, which has neither simpleB nor what is in `case` below.
#   tests/data/liggghts_judge/make.sh [-n]                          what campaigns.txt lists and is not here yet; -n: only say it
#   tests/data/liggghts_judge/make.sh [fast_][KIND_]muF_murR_rhoD SEED [TRAJECTORY...]
# OUT=FOLDER: recordings go there. BEDS=FOLDER: poured beds are kept there.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=$(cd "${OUT:-$here}" && pwd)
if [ $# = 0 ] || [ "$1" = -n ]; then
    sed 's/#.*//' "$here/campaigns.txt" | while read -r gravel seed trajectories; do
        missing=
        for trajectory in $trajectories; do
            [ -e "$out/${gravel}_seed${seed}__$trajectory.csv" ] || missing="$missing $trajectory"
        done
        [ "$missing" ] || continue
        echo "$gravel seed $seed$missing"
        # shellcheck disable=SC2086 # one word a trajectory
        [ "${1:-}" = -n ] || OUT=$out "$here/make.sh" "$gravel" "$seed" $missing </dev/null
    done
    exit
fi
gravel=$1 seed=$2
shift 2
trajectories=${*:-simpleA simpleB}
prime=$(echo "15485867 67867967 86028121" | cut -d' ' -f"$seed")

numbers=mu${gravel#*mu} kind=${gravel%%mu[0-9]*}
kind=${kind%_} pace=1
case $kind in fast | fast_*) kind=${kind#fast} kind=${kind#_} pace=3 ;; esac # dug at three times the pace
kind=${kind:-plain}
friction=${numbers#mu} friction=${friction%%_*}
rolling=${numbers#*_mur} rolling=${rolling%%_*}
density=${numbers#*_rho} density=${density%%_*}

# Types 1 to 3 are grains, 4 is the bucket; walls have type 1.
length=.31 right=.06 height=.085 column=.196747 gravity=9.81 restitution=.2
radii=.00375 shares=1 other_friction=$friction other_rolling=$rolling # what grains of type 2 have, and the bucket
bucket_friction=$friction bucket_rolling=$rolling
pull=0 slope_deg=0 rock= tooth="0 -.09" drag= wiggle= prepare=
case $kind in
plain) ;;
slope_down6) slope_deg=-6 ;;
slope_up5) slope_deg=5 ;;
rock22) rock=.011 ;;         # radius of a fixed sphere 113.8 mm along the box, at the ground's height
cohesion15e4) pull=1.5e5 ;;  # SJKR between grains, and at walls, which have their type; none at the bucket
cohesion5e4) pull=5e4 ;;
sizes2) radii=".0026517 .00375 .0053033" shares=".3 .4 .3" column=.205 ;;
layer45) other_friction=.9 other_rolling=.8 prepare=layer ;; # grains up to 45 mm from the floor
bucket03) bucket_friction=.3 bucket_rolling=.3 ;;
submerged) # buoyancy, and a drag that lets a grain sink at .6 m/s
    gravity=$(awk "BEGIN { print 9.81 * (1 - 1000 / $density) }")
    drag=$(awk "BEGIN { print $density * 4 / 3 * 3.14159265 * .00375 ^ 3 * $gravity / .6 }") ;;
shaken) prepare=shaken ;;    # from side to side by a third of its weight, twelve times, before levelling
loose) prepare=loose column=.225 ;; # a seventh of the grains taken out before levelling
bouncy) restitution=.6 ;;
coarse) radii=.0075 column=.215 ;;
wall_beside) right=.041 ;;   # a wall 6 mm beside the bucket on one side
short_bed) length=.20 ;;     # a wall 32 mm ahead of where the tooth of simpleA ends, 8 mm of simpleB
bump) prepare=bump ;;        # a ridge across, 10 mm high and 45 wide, in the middle of simpleA's drag
windrow) prepare=windrow ;;  # a ridge along, 10 mm high and 45 wide, over the bucket's left edge
worn_tooth) tooth="-.00730 -.08672" ;; # the plate that cuts is 8 mm shorter
vibrating) wiggle=yes ;;     # the bucket swings by .5 mm across at 20 Hz
refilled) prepare=refilled ;; # dug along simpleA before, filled up and levelled
*) echo "kind: $kind, expected one of the case above" >&2; exit 2 ;;
esac

law="hooke tangential history rolling_friction epsd2"
[ "$pull" = 0 ] || law="hooke tangential history cohesion sjkr rolling_friction epsd2"
work=$(mktemp -d)
[ -n "${KEEP:-}" ] || trap 'rm -rf "$work"' EXIT
cd "$work"

awk -v s=1 -v tooth="$tooth" -f "$here/../liggghts_digs/bucket_stl.awk" >bucket.stl
[ -z "$rock" ] || awk -v r="$rock" -v x0=.1138 -v z0="$height" -f "$here/../liggghts_digs/rock_stl.awk" >rock.stl

# A 4 x 4 matrix of types: grains of type 1 and 3, grains of type 2 among themselves, the bucket. Unlike grains have the mean.
pairs() { # GRAINS OTHER_GRAINS BUCKET
    mean=$(awk "BEGIN { print ($1 + $2) / 2 }")
    echo "4 $1 $mean $1 $3  $mean $2 $mean $3  $1 $mean $1 $3  $3 $3 $3 $3"
}

head() { # [RESTART]: laws and walls, of grains that are there already or of none
    cat <<END
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
$([ "${1:-}" ] && echo "read_restart $1" || echo "region reg block -0.01 0.32 -0.07 0.07 -0.01 0.6 units box
create_box 4 reg")
neighbor 0.0015 bin
neigh_modify delay 0 every 1 check yes
fix m1 all property/global youngsModulus peratomtype 5e6 5e6 5e6 5e6
fix m2 all property/global poissonsRatio peratomtype .2 .2 .2 .2
fix m3 all property/global coefficientRestitution peratomtypepair $(pairs $restitution $restitution $restitution)
fix m4 all property/global coefficientFriction peratomtypepair $(pairs $friction $other_friction $bucket_friction)
fix m5 all property/global characteristicVelocity scalar 2
fix m6 all property/global coefficientRollingFriction peratomtypepair $(pairs $rolling $other_rolling $bucket_rolling)
fix m7 all property/global cohesionEnergyDensity peratomtypepair $(pairs $pull $pull 0)
pair_style gran model $law
pair_coeff * *
timestep 6.25e-5
fix gravi all gravity $gravity vector 0 0 -1
fix x1 all wall/gran model $law primitive type 1 xplane 0
fix x2 all wall/gran model $law primitive type 1 xplane $length
fix y1 all wall/gran model $law primitive type 1 yplane -.06
fix y2 all wall/gran model $law primitive type 1 yplane $right
fix z1 all wall/gran model $law primitive type 1 zplane 0
$([ -z "$drag" ] || echo "fix water all viscous $drag")
fix integr all nve/sphere
thermo_style custom step atoms ke cpu
thermo 3200
thermo_modify lost ignore norm no
END
}

templates() { # what is poured
    type=0 names=
    for radius in $radii; do
        type=$((type + 1))
        names="$names pts$type $(echo "$shares" | cut -d' ' -f$type)"
        echo "fix pts$type all particletemplate/sphere $(echo "32452843 49979693 86028157" | cut -d' ' -f$type) atom_type $type density constant $density radius constant $radius"
    done
    echo "fix pdd all particledistribution/discrete 49979687 $type$names"
}
fall="distributiontemplate pdd vel constant 0 0 -0.3 insert_every once overlapcheck yes all_in yes maxattempt 300 ntry_mc 10000"

pour() {
    head
    templates
    cat <<END
region fill block 0 $length -.06 $right 0 $column units box
fix ins all insert/pack seed $prime $fall region fill volumefraction_region 0.3
run 1
unfix ins
run 7200
write_restart poured.rst
END
}

level() { # Takes out the grains that stand above the ground, but for a ridge's.
    case $prepare in
    bump) echo "region ridge cylinder y .125 .065 .03 -.06 .06 side in units box" ;;
    windrow) echo "region ridge cylinder x -.025 .065 .03 0 $length side in units box" ;;
    esac
    case $prepare in bump | windrow) echo "group ridge region ridge" ;; esac
    type=0
    for radius in $radii; do
        type=$((type + 1))
        awk -v r="$radius" -v t=$type -v n="$1" -v s="$slope_deg" -v h="$height" 'BEGIN {
            a = s * atan2(0, -1) / 180
            printf "region cut%d%s plane .09 0 %.8g %.8g 0 %.8g side in units box\n", t, n, h - r / cos(a), -sin(a), cos(a)
            printf "group type%d%s type %d\ngroup top%d%s region cut%d%s\ngroup del%d%s intersect type%d%s top%d%s\n", t, n, t, t, n, t, n, t, n, t, n, t, n }'
        case $prepare in
        bump | windrow) echo "group rid$type subtract del$type$1 ridge"; echo "delete_atoms group rid$type compress no" ;;
        *) echo "delete_atoms group del$type$1 compress no" ;;
        esac
    done
}

bed() {
    head poured.rst
    echo "run 1" # before it nothing may be taken out
    case $prepare in
    layer)
        cat <<END
region lower block 0 $length -.06 .06 0 .045 units box
set region lower type 2
END
        ;;
    shaken)
        for way in .33 -.33 .33 -.33 .33 -.33 .33 -.33 .33 -.33 .33 -.33; do
            echo "unfix gravi"
            echo "fix gravi all gravity 9.81 vector $way 0 -1"
            echo "run 800"
        done
        echo "unfix gravi"
        echo "fix gravi all gravity 9.81 vector 0 0 -1"
        echo "run 1600" ;;
    loose)
        echo "region whole block -.01 .32 -.07 .07 -.01 .3 units box"
        echo "delete_atoms porosity whole .14 20000003"
        echo "run 1600" ;;
    esac
    level a
    [ -z "$rock" ] || cat <<END
region hole sphere .1138 0 $height $(awk -v r="$rock" 'BEGIN { print r + .00375 }') side in units box
delete_atoms region hole compress no
fix rock all mesh/surface file rock.stl type 1
fix rw all wall/gran model $law mesh n_meshes 1 meshes rock
END
    echo "run 2400"
    if [ "$prepare" = refilled ]; then
        motion simpleA
        templates
        cat <<END
unfix bw
unfix bucket
run 4000
region again block 0 $length -.06 $right .13 .19 units box
fix ins all insert/pack seed 20000003 $fall region again volumefraction_region 0.25
run 1
unfix ins
run 4800
END
        level b
        echo "run 2400"
    fi
    [ -z "$rock" ] || printf 'unfix rw\nunfix rock\n'
    echo "write_restart bed.rst"
}

# The trajectories of config/scenes/rig.yaml: phases of so many steps at the plain pace, velocities or a turn about the pin.
motion() { # TRAJECTORY
    case $1 in
    simpleA) start=".08329371406 .1719333244 -15" phases="L 9600 .02515 -.04356107781
L 32000 .0463 0
L 6400 0 .0915" ;;
    simpleB) start=".135 .1629422863 -30" phases="L 14400 .02956559819 -.04069355482
R 40000 20.05 .1616090384 .126318087" ;;
    actual) start=".09 .1629422863 -30" phases="L 12800 .02956559819 -.04069355482
R 17600 17.93 .1136524786 .1303874425
L 35200 .0463 0
R 32000 20.05 .2155124786 .1303874425
L 11200 0 .0915" ;;
    esac
    echo "$start" | { read -r x z theta
        echo "fix bucket all mesh/surface/stress file bucket.stl type 4 rotate axis 0 -1 0 angle $theta move $x 0 $z reference_point $x 0 $z"; }
    # All meshes are one wall.
    [ -z "$rock" ] || echo "fix rock all mesh/surface file rock.stl type 1"
    cat <<END
fix bw all wall/gran model $law mesh $([ "$rock" ] && echo n_meshes 2 meshes bucket rock || echo n_meshes 1 meshes bucket)
thermo 16000
run 0
reset_timestep 0
fix out all ave/time 1 80 80 f_bucket[1] f_bucket[2] f_bucket[3] f_bucket[4] f_bucket[5] f_bucket[6] f_bucket[7] f_bucket[9] file $1.txt
END
    echo "$phases" | while read -r way steps a b c; do
        if [ "$way" = L ]; then
            echo "fix mv all move/mesh mesh bucket linear $(awk "BEGIN { printf \"%.10g 0 %.10g\", $a * $pace, $b * $pace }")"
        else
            echo "fix mv all move/mesh mesh bucket rotate origin $b 0 $c axis 0 -1 0 period $(awk "BEGIN { printf \"%.10g\", 360 / ($a * $pace) }")"
        fi
        [ -z "$wiggle" ] || echo "fix shake all move/mesh mesh bucket wiggle amplitude 0 .0005 0 period .05"
        echo "run $((steps / pace))"
        [ -z "$wiggle" ] || echo "unfix shake"
        echo "unfix mv"
    done
    echo "unfix out"
}

recording() { # TRAJECTORY
    echo "# LIGGGHTS-PUBLIC 3.8, gravel $gravel, seed $seed: tests/data/liggghts_judge/make.sh"
    echo "t_s,pin_x_m,pin_z_m,theta_deg,Fx_N,Fy_N,Fz_N,Mx_Nm,My_Nm,Mz_Nm"
    awk -v name="$1" -v pace="$pace" 'function past(from, seconds) { return s < from ? 0 : s < from + seconds ? s - from : seconds }
    !/^#/ {
        t = ($1 - 79 / 2) * .005 / 80
        s = t * pace
        theta = -15
        if (name == "simpleB") theta = -30 + 20.05 * past(.9, 2.5)
        if (name == "actual") theta = -30 + 17.93 * past(.8, 1.1) + 20.05 * past(4.1, 2)
        printf "%.6f,%.6f,%.6f,%.4f,%.5g,%.5g,%.5g,%.5g,%.5g,%.5g\n", t, $8, $9, theta, $2, $3, $4, $5, $6, $7 }' "$1.txt"
}

run() { # NAME
    liggghts -in "in.$1" > "$1.log" || { tail -20 "$1.log" >&2; exit 1; }
}

# A bed is poured once for all that is dug in it, and with BEDS=FOLDER, kept there, for all kinds that are poured alike.
key=$(echo "$seed $numbers $radii $shares $column $length $right $restitution $pull $gravity" | cksum | tr ' ' _)
if [ "${BEDS:-}" ] && [ -e "$BEDS/$key" ]; then
    cp "$BEDS/$key" poured.rst
else
    pour > in.pour
    run pour
    [ -z "${BEDS:-}" ] || cp poured.rst "$BEDS/$key"
fi
bed > in.bed
run bed
for trajectory in $trajectories; do
    { head bed.rst; motion "$trajectory"; } > "in.$trajectory"
    run "$trajectory"
    recording "$trajectory" > "$out/${gravel}_seed${seed}__$trajectory.csv"
done
