#!/bin/sh
# Runs the decks of this folder with LIGGGHTS-PUBLIC 3.8 (Debian's package liggghts) and writes the
# CSV files test_liggghts.c compares with. Five minutes. Usage: ./make.sh
set -eu
cd "$(dirname "$0")"
here=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# One line a step: step and the columns of the one atom asked for.
series() { # DUMP ID
    awk -v id="$2" '/ITEM: TIMESTEP/ { getline step; next } /ITEM: ATOMS/ { rows = 1; next }
        rows && $1 == id { $1 = step; gsub(" ", ","); sub(/,$/, ""); print } /ITEM: / { rows = 0 }' "$1"
}
columns=step,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps,wx_radps,wy_radps,wz_radps,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm

# A plate of two triangles.
cat > plate.stl <<EOF
solid plate
 facet normal 0 0 1
  outer loop
   vertex -.03 -.02 -.0038
   vertex .03 -.02 -.0038
   vertex .03 .02 -.0038
  endloop
 endfacet
 facet normal 0 0 1
  outer loop
   vertex -.03 -.02 -.0038
   vertex .03 .02 -.0038
   vertex -.03 .02 -.0038
  endloop
 endfacet
endsolid plate
EOF

for deck in pair wall slide plate; do
    liggghts -in "$here/in.$deck" > $deck.log
    { echo $columns; series $deck.dump 1; } > "$here/$deck.csv"
done

# Laws beside the plain one; at walls without EPSD2 (README.md).
laws() { # NAME pair|wall LAW
    liggghts -var law "$3" -in "$here/in.laws_$2" > laws.log
    { echo $columns; series "laws_$2.dump" 1; } > "$here/$1.csv"
}
laws pair_unlike pair "hooke tangential history rolling_friction epsd2"
laws pair_hertz pair "hertz tangential history rolling_friction epsd2"
laws pair_cdt pair "hooke tangential history rolling_friction cdt"
laws pair_sjkr pair "hooke tangential history cohesion sjkr rolling_friction epsd2"
laws pair_hertz_cdt_sjkr pair "hertz tangential history cohesion sjkr rolling_friction cdt"
laws wall_hertz wall "hertz tangential history"
laws wall_cdt wall "hooke tangential history rolling_friction cdt"
laws wall_sjkr wall "hooke tangential history cohesion sjkr"

# Grains of a CSV (x_m,y_m,z_m) as a data file for read_data.
data() { # CSV HIGH_X HIGH_Y
    awk -F, -v hx="$2" -v hy="$3" 'NR > 1 { line[n++] = $0 } END {
        printf "grains\n\n%d atoms\n\n1 atom types\n\n-0.01 %s xlo xhi\n-0.01 %s ylo yhi\n-0.01 0.3 zlo zhi\n\nAtoms\n\n", n, hx, hy
        for (k = 0; k < n; k++) { split(line[k], v, ","); print k + 1, 1, 0.0075, 2500, v[1], v[2], v[3] } }' "$1"
}
last() { # DUMP STEP: x,y,z of every atom at that step
    awk -v want="$2" '/ITEM: TIMESTEP/ { getline step; rows = 0; next } /ITEM: ATOMS/ { rows = 1; next }
        /ITEM: / { rows = 0 } rows && step == want { print $2 "," $3 "," $4 }' "$1"
}

data "$here/cluster_start.csv" 0.06 0.06 > cluster.data
liggghts -in "$here/in.cluster" > cluster.log
{ echo step,x_m,y_m,z_m
  for step in 20 40 60 80 100 200 400; do last cluster.dump $step | sed "s/^/$step,/"; done
} > "$here/cluster.csv"

# Sizes in turn: types 1, 2, 3.
sed -e 's/^1 atom types/3 atom types/' cluster.data | awk '!rows { print } /^Atoms/ { rows = 1; next }
    rows && NF { t = (NR % 3) + 1; print $1, t, (t == 1 ? 0.006 : t == 2 ? 0.0068 : 0.0075), $4, $5, $6, $7 } rows && !NF { print }' > cluster_laws.data
liggghts -in "$here/in.cluster_laws" > cluster_laws.log
{ echo step,x_m,y_m,z_m
  for step in 40 80 120 160 200 400 800; do last cluster_laws.dump $step | sed "s/^/$step,/"; done
} > "$here/cluster_laws.csv"

# Clumps: every sphere, two of a clump one after the other.
clumps() { # NAME ROLLING
    liggghts -var rolling "$2" -in "$here/in.clumps" > clumps.log
    { echo step,x_m,y_m,z_m
      for step in 0 1000 2000 4000 6000 8000; do last clumps.dump $step | sed "s/^/$step,/"; done
    } > "$here/$1.csv"
}
clumps clumps 0
clumps clumps_rolling 0.5

seed=0
for prime in 15485867 67867967 86028121; do # LIGGGHTS takes primes only
    seed=$((seed + 1))
    liggghts -var seed $prime -in "$here/in.column" > column.log
    { echo x_m,y_m,z_m; last column.dump 0; } > "$here/column_start_$seed.csv"
    { echo x_m,y_m,z_m; last column.dump 12000; } > "$here/column_end_$seed.csv"
done

# Columns that slump at three rolling frictions: where they stood, all of it, and the profile after.
seed=0
for prime in 15485867 67867967 86028121; do
    seed=$((seed + 1))
    for rolling in 0.0 0.3 0.9; do
        liggghts -var rolling $rolling -var seed $prime -in "$here/in.slump" > slump.log
        { echo x_m,y_m,z_m; last slump.dump 0; } > "$here/slump_start_${rolling}_$seed.csv"
        { echo x_m,z_m; last slump.dump 20000 | awk -F, '{ printf "%.5g,%.5g\n", $1, $3 }'; } \
            > "$here/slump_end_${rolling}_$seed.csv"
    done
done

# A column at rest, every tenth grain.
data "$here/slump_start_0.0_1.csv" 0.09 0.05 | sed 's/ 0.3 zlo/ 0.6 zlo/' > rest.data
liggghts -in "$here/in.rest" > rest.log
{ echo step,grain,x_m,y_m,z_m
  for step in 4 8 20; do last rest.dump $step | awk -v s=$step 'NR % 10 == 1 { print s "," NR - 1 "," $0 }'; done
} > "$here/rest.csv"
