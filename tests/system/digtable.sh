#!/bin/bash
# digtable as an analyst uses it, with the real engine on a small scene: digs, a table made in pieces
# and in one go, killed and resumed, and everything that shows it.
. tests/system/digtable_lib.bash

dig=(--trajectory scrape --friction .5 --rolling .2 --density 2500)
grid=tests/data/formats/grid.yaml # 6 points x 2 packings x 1 trajectory
# Softer grains and a shorter dig: a tenth of a second each, of the eighty below.
sed -e 's/young_Pa: 5.0e+6/young_Pa: 1.25e+6/' -e 's/down, duration_s: 0.5, vx_mps: 0, vz_mps: -0.1/down, duration_s: 0.25, vx_mps: 0, vz_mps: -0.2/' \
    -e 's/pull, duration_s: 1,/pull, duration_s: 0.3,/' $scene >"$work/tub.yaml"
scene=$work/tub.yaml map=$work/map.yaml
sed 's/^scene: .*/scene: tub.yaml/' tests/data/formats/curve_map.yaml >"$map"

digtable dig $scene "${dig[@]}" --seed 3 --save-bed "$work/bed.csv" -o "$work/a.csv"
check "a dig writes a force recording" eval 'is $code 0 && head -1 $work/a.csv | grep -q "^t_s,pin_x_m,pin_z_m,theta_deg,Fx_N,Fy_N,Fz_N,Mx_Nm,My_Nm,Mz_Nm,carried_kg$"'
check "it tells progress to stderr and nothing to stdout" eval '[ -s $work/err ] && [ ! -s $work/out ]'
digtable dig $scene "${dig[@]}" --seed 3 -o "$work/b.csv"
check "the same command gives the same bytes" cmp "$work/a.csv" "$work/b.csv"
digtable dig $scene "${dig[@]}" --seed 4 -o "$work/c.csv"
check "another seed gives another dig" eval '! cmp -s $work/a.csv $work/c.csv'
digtable dig $scene "${dig[@]}" --bed "$work/bed.csv" -o "$work/d.csv"
check "the bed saved, dug again, gives the dig it was saved from" cmp "$work/a.csv" "$work/d.csv"
ore='materials: [{name: ore, friction: 0.9, rolling: 0.8, density_kgpm3: 4000, restitution: 0.3}]'
pear='clump: [{centre: [-0.25, 0, 0], radius: 0.5}, {centre: [0.25, 0, 0], radius: 0.4}]'
for kind in "$ore, layers: [{material: ore, z_m: [0.1, 0.4]}]" "$pear"; do
    sed "\$a bed: {$kind}" $scene >"$work/kind.yaml"
    digtable dig "$work/kind.yaml" "${dig[@]}" --seed 3 --save-bed "$work/kind_bed.csv" -o "$work/k.csv"
    digtable dig "$work/kind.yaml" "${dig[@]}" --bed "$work/kind_bed.csv" -o "$work/l.csv"
    check "and so does a bed of ${kind%%:*}" eval 'is $code 0 && cmp $work/k.csv $work/l.csv && ! cmp -s $work/k.csv $work/a.csv'
done
digtable dig $scene "${dig[@]}" --seed 3 --young 2e7 -o "$work/e.csv"
check "stiffer grains give another dig" eval 'is $code 0 && ! cmp -s $work/a.csv $work/e.csv'
digtable dig $scene "${dig[@]}" --seed 3 --threads 3 -o "$work/three.csv"
check "more threads give the same dig" eval 'is $code 0 && cmp $work/a.csv $work/three.csv'
digtable dig $scene "${dig[@]}" --seed 3 --engine kernel -o "$work/double.csv"
check "double precision gives another" eval 'is $code 0 && ! cmp -s $work/a.csv $work/double.csv'
digtable dig $scene "${dig[@]}" --seed 3 --vtk "$work/pictures" -o "$work/f.csv"
check "--vtk makes its folder, and pictures change nothing" eval 'is $code 0 && cmp $work/a.csv $work/f.csv && ls $work/pictures | grep -q "\.vt"'
digtable dig $scene "${dig[@]}" --seed 3 --vtk "$work/no/such" -o "$work/g.csv"
check "or says that it cannot" eval 'is $code 1 && grep -q "no/such: No such file" $work/err && [ ! -e $work/g.csv ]'
digtable dig $scene "${dig[@]}" --seed 3 -o /dev/stdout
check "-o /dev/stdout writes to stdout" cmp "$work/a.csv" "$work/out"

digtable generate $scene $grid -o "$work/whole.sqlite" -j 2
check "generate fills a table" eval 'is $code 0 && grep -q "12 of 12 digs" $work/err'
digtable check "$work/whole.sqlite" --complete
check "which is sound and complete" eval 'is $code 0 && grep -q "6 points, 6 entries, 12 runs; 0 holes" $work/out'
digtable check "$work/whole.sqlite" --json
check "check --json" eval 'is "$(cat $work/out)" "{\"points\": 6, \"entries\": 6, \"runs\": 12, \"holes\": 0, \"incomplete\": 0, \"effects\": 0, \"builds\": 1, \"approaches\": 0, \"trembles\": false, \"grains_across\": 3.33333, \"density_scales\": false, \"bucket\": null}"'
sed -e 's/^  young_Pa: .*/&\n  young_at_kgpm3: 2500/' -e '$a bed: {pairs: [{between: [gravel, bucket], friction: 0.4, rolling: 0.3, restitution: 0.2}]}' \
    $scene >"$work/steel.yaml"
digtable generate "$work/steel.yaml" $grid -o "$work/steel.sqlite" --time-limit 0
digtable check "$work/steel.sqlite"
check "the bucket's own friction is told" grep -q "which is of friction 0.4 and rolling friction 0.3; resistance goes with the density" "$work/out"
digtable check "$work/steel.sqlite" --json
check "also to programs" grep -q '"density_scales": true, "bucket": {"friction": 0.4, "rolling": 0.3}}' "$work/out"
digtable generate $scene $grid -o "$work/whole.sqlite"
check "a second time there is nothing to do" eval 'is $code 0 && grep -q "12 of 12 digs" $work/err'

# In pieces: one packing, a time limit, an interruption, and one worker instead of two.
digtable generate $scene $grid -o "$work/parts.sqlite" --packings 1 -j 1
check "--packings overrides the grid" eval 'is $code 0 && grep -q "6 of 6 digs" $work/err'
digtable generate $scene $grid -o "$work/parts.sqlite" --time-limit 0
check "--time-limit tells what is left" eval 'is $code 0 && grep -q "6 of 12 digs.*6 left (time limit)" $work/err'
digtable check "$work/parts.sqlite" --complete
check "an incomplete table fails --complete only when packings differ" is "$code" 0

"$BIN/digtable" generate $scene $grid -o "$work/parts.sqlite" -j 1 2>"$work/err" &
pid=$!
until [ "$(runs "$work/parts.sqlite")" -gt 6 ] || ! kill -0 $pid 2>/dev/null; do sleep 0.05; done
kill -INT $pid
wait $pid
code=$?
check "Ctrl-C ends it with 1, or 0 if it was done" eval '[ $code = 1 ] || [ $code = 0 ]'
digtable check "$work/parts.sqlite"
check "and leaves a sound table" is "$code" 0
digtable generate $scene $grid -o "$work/parts.sqlite" -j 2
check "the same command finishes the table" eval 'is $code 0 && grep -q "12 of 12 digs" $work/err'
digtable check "$work/parts.sqlite" --complete
check "which is sound and complete again" is "$code" 0
digtable export "$work/whole.sqlite" --runs -o "$work/whole.csv"
digtable export "$work/parts.sqlite" --runs -o "$work/parts.csv"
check "runs made in pieces equal those made in one go, byte by byte" cmp "$work/whole.csv" "$work/parts.csv"
digtable export "$work/whole.sqlite" -o "$work/whole.csv"
digtable export "$work/parts.sqlite"
check "and so do the curves, to a file as to stdout" cmp "$work/whole.csv" "$work/out"
check "a curve has 256 points" is "$(wc -l <"$work/whole.csv")" $((1 + 6 * 256))

digtable list "$work/whole.sqlite"
check "list shows every entry" eval 'is $code 0 && is "$(grep -c "2500" $work/out)" 6'
digtable list "$work/whole.sqlite" --json
check "list --json" eval 'is $code 0 && grep -q "\"trajectories\": \[\"scrape\"\]" $work/out && is "$(grep -c "\"entry\": " $work/out)" 6 && grep -q "\"packings\": {\"scrape\": 2}" $work/out'
digtable show "$work/whole.sqlite" 3
check "show draws a curve" eval 'is $code 0 && grep -q "friction 0.6, rolling 0.1, 2500 kg/m3; scrape, 2 packings" $work/out && grep -q "\*" $work/out'
cp "$work/out" "$work/by_number"
digtable show "$work/whole.sqlite" --friction .6 --rolling .1 --density 2500 --trajectory scrape --channel My
check "and finds it by its gravel" cmp "$work/out" "$work/by_number"
digtable show "$work/whole.sqlite" 3 --csv
check "show --csv" eval 'is $code 0 && is "$(wc -l <$work/out)" 257 && head -1 $work/out | grep -q "^progress,t_s,My_Nm,My_sd_Nm,"'
digtable show "$work/whole.sqlite" 3 --json
check "show --json" eval 'is $code 0 && grep -q "\"My_sd_Nm\": \[" $work/out'

# In shards, each its own file, merged in any order: once each, and the bytes do not tell how.
for i in 3 1 2; do
    digtable generate $scene $grid -o "$work/shard$i.sqlite" --shard $i/3
    check "shard $i of 3 holds a third" eval 'is $code 0 && grep -q "4 of 4 digs" $work/err'
done
digtable merge "$work/merged.sqlite" "$work"/shard{2,3,1}.sqlite
check "merge brings them together" eval 'is $code 0 && [ ! -s $work/out ] && [ ! -s $work/err ]'
digtable check "$work/merged.sqlite" --complete
check "into a table that is sound and complete" is "$code" 0
digtable export "$work/whole.sqlite" --runs -o "$work/whole_runs.csv"
digtable export "$work/merged.sqlite" --runs
check "with the runs of one go, byte by byte" cmp "$work/whole_runs.csv" "$work/out"
mkdir "$work/shards"
cp "$work"/shard{1,2,3}.sqlite "$work/shards"
echo "no table" >"$work/shards/notes.txt"
digtable merge "$work/folder.sqlite" "$work/shards"
check "a folder stands for its tables" eval 'is $code 0 && cmp $work/folder.sqlite $work/merged.sqlite'
rm "$work/shards/"*.sqlite
digtable merge "$work/none.sqlite" "$work/shards"
check "one without any is refused" eval 'is $code 2 && grep -q "shards: holds no table" $work/err && [ ! -e $work/none.sqlite ]'
digtable merge "$work/again.sqlite" "$work"/shard{1,2,3}.sqlite "$work/merged.sqlite"
check "in any order and with repetitions the file is the same" cmp "$work/merged.sqlite" "$work/again.sqlite"
digtable generate $scene $grid -o "$work/merged.sqlite"
check "generate finds nothing left to do in it" eval 'is $code 0 && grep -q "12 of 12 digs" $work/err'

# What another program wrote: here our own runs, as text.
cut -d, -f1-6,10-14 "$work/whole_runs.csv" >"$work/curves.csv"
digtable import "$work/curves.csv" --map $map -o "$work/imported.sqlite"
check "import makes a table of a CSV" eval 'is $code 0 && grep -q "12 digs of" $work/err'
digtable check "$work/imported.sqlite" --complete
check "that is sound and complete" is "$code" 0
digtable export "$work/imported.sqlite" --runs
check "with the samples of the CSV" cmp <(cut -d, -f1-5,11-14 "$work/whole_runs.csv") <(cut -d, -f1-5,11-14 "$work/out")
digtable import "$work/curves.csv" --map $map -o "$work/imported.sqlite"
check "a dig is imported once" eval 'is $code 2 && grep -q "curves.csv:2: .* is there already" $work/err'
cp "$work/whole.sqlite" "$work/kept.sqlite"
{ head -n 1 "$work/curves.csv"; sed -n '2,$s/^0.3,/0.4,/p' "$work/curves.csv"; grep '^0.3,' "$work/curves.csv"; } >"$work/half.csv"
digtable import "$work/half.csv" --map $map -o "$work/kept.sqlite"
check "a CSV whose last digs are refused adds none" eval 'is $code 2 && grep -q "is there already" $work/err'
digtable export "$work/kept.sqlite" --runs
check "and the table is as it was" cmp "$work/whole_runs.csv" "$work/out"

# The reference engine, on a bed of its own and a dig of a few steps.
sed -E "s/duration_s: [0-9.]+/duration_s: 0.011/" $scene >"$work/short.yaml"
digtable dig "$work/short.yaml" "${dig[@]}" --seed 3 --engine ode -o "$work/ode.csv"
check "--engine ode digs the same dig" eval 'is $code 0 && head -1 $work/ode.csv | grep -q "^t_s,pin_x_m"'

# Depth and attack angle as axes, on their own and on top of a table that had none.
approaches=tests/data/formats/grid_approaches.yaml # 2 points x 2 packings, 2 x 3 dug otherwise, 1 twice
digtable dig $scene "${dig[@]}" --seed 3 --depth 1 --attack-deg 0 -o "$work/plain.csv"
check "depth 1, attack 0 is the dig as the scene has it" cmp "$work/a.csv" "$work/plain.csv"
digtable dig $scene "${dig[@]}" --seed 3 --depth 1.2 --attack-deg 5 -o "$work/deep.csv"
check "deeper and turned is another, that starts turned" eval 'is $code 0 && awk -F, "NR == 3 { exit !(\$4 > -10.2 && \$4 < -9.8) }" $work/deep.csv'
digtable generate $scene $approaches -o "$work/approaches.sqlite" -j 2
check "generate digs a cross of depths and attacks" eval 'is $code 0 && grep -q "12 of 12 digs" $work/err'
digtable check "$work/approaches.sqlite" --complete
check "which is sound and complete" eval 'is $code 0 && grep -q "2 points, 9 entries, 12 runs; 0 holes.*; 7 points at another depth or attack" $work/out'
digtable list "$work/approaches.sqlite"
check "list tells them" eval 'is $code 0 && grep -qE "^ +5 .* 2  depth 1.2, attack 5 deg$" $work/out'
digtable list "$work/approaches.sqlite" --json
check "list --json too" grep -q '"entry": 5, .*"depth": 1.2, "attack_deg": 5, "packings": {"scrape": 2}' "$work/out"
digtable show "$work/approaches.sqlite" --friction .3 --rolling .2 --density 2500 --depth 1.2 --attack-deg 5
check "show finds one" grep -q "^entry 5: .*scrape, depth 1.2, attack 5 deg, 2 packings" "$work/out"
digtable export "$work/approaches.sqlite"
check "export has their curves behind the plain ones" eval 'is $code 0 && is $(wc -l <$work/out) $((1 + 9 * 256)) && is $(grep -c ",1.2,5$" $work/out) 256'
for i in 3 1 2; do
    digtable generate $scene $approaches -o "$work/approach$i.sqlite" --shard $i/3 -j 1
done
digtable merge "$work/approaches3.sqlite" "$work"/approach[123].sqlite
digtable export "$work/approaches.sqlite" --runs -o "$work/approaches.csv"
digtable export "$work/approaches3.sqlite" --runs
check "shards merged hold the same runs" cmp "$work/out" "$work/approaches.csv"
{ cat "$map"
  printf '  depth: {column: depth}\n  attack_deg: {column: attack_deg}\n'; } >"$work/ways.yaml"
digtable import "$work/approaches.csv" --map "$work/ways.yaml" -o "$work/approaches_in.sqlite"
check "import takes digs at their depth and attack" eval 'is $code 0 && grep -q "12 digs of" $work/err'
digtable check "$work/approaches_in.sqlite" --complete
check "and puts them where they belong" eval 'is $code 0 && grep -q "2 points, 9 entries, 12 runs; 0 holes.*; 7 points at another depth or attack" $work/out'
digtable export "$work/approaches_in.sqlite" --runs
check "with their samples" cmp <(cut -d, -f1-5,11-14,17- "$work/approaches.csv") <(cut -d, -f1-5,11-14,17- "$work/out")

# What SQLite's own tool sees, for those who look with it.
check "sqlite3 finds the table intact" is "$(sqlite3 "$work/whole.sqlite" 'PRAGMA integrity_check')" ok
check "and every run's origin" is "$(sqlite3 "$work/whole.sqlite" "SELECT count(*) FROM run WHERE engine = 'single' AND version GLOB '[0-9]*.[0-9]*.[0-9]*+[0-9a-f]*' AND grains > 0 AND wall_s > 0 AND made_utc LIKE '20__-__-__T__:__:__Z'")" 12
check "no file is left beside a table" eval '! ls $work | grep -E "journal$|wal$|\.part$"'
finish
