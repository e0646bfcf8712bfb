#!/bin/bash
# Every bad input is refused with exit 2, a message that says where and what was expected, and no output
# file left behind.
. tests/system/digtable_lib.bash

grid=tests/data/formats/grid.yaml
dig=(--trajectory scrape --friction .5 --rolling .2 --density 2500)
out=$work/output

# refused DESCRIPTION WORDS ARGUMENTS…: exit 2, the words on stderr, nothing on stdout, no output.
refused() {
    local what=$1 words=$2
    shift 2
    rm -rf "$out" "$out.part" "$out-journal"
    digtable "$@"
    check "$what" eval 'is $code 2 && grep -qE -- "$words" "$work/err" && [ ! -s "$work/out" ] && ! ls "$work" | grep -q "^output"'
}

# changed SED-SCRIPT FILE NAME: a changed copy.
changed() { sed -E "$1" "$2" >"$work/$3"; }

refused "no command" "expected a command"
refused "an unknown command" "frob: unknown command" frob
refused "an unknown option" "--frob: unknown option" dig $scene --frob
refused "an option without its value" "needs a value" dig $scene "${dig[@]}" -o
refused "an option of another command" "list takes no --seed" list x.sqlite --seed 1
refused "too many arguments" "one argument too many" list a b
refused "too few arguments" "expected SCENE.yaml GRID.yaml" generate $scene
refused "dig without -o" "-o CURVE.csv missing" dig $scene "${dig[@]}"
refused "dig without a density" "--density missing" dig $scene --trajectory scrape --friction .5 --rolling .5 -o "$out"
cp tests/data/formats/table.sqlite "$work/mine.sqlite"
refused "a table that would be written over by its export" "mine.sqlite: to be written, and named for something else" \
    export "$work/mine.sqlite" -o "$work/./mine.sqlite"
check "and it is as it was" cmp -s tests/data/formats/table.sqlite "$work/mine.sqlite"
refused "generate without -o" "-o TABLE.sqlite missing" generate $scene $grid
refused "a friction that is none" "--friction high: expected 0 to 3" dig $scene --friction high
refused "a friction that is nan" "--friction nan: expected 0 to 3" dig $scene --friction nan
refused "a density in g/cm3" "--density 2.5: expected 100 to 20000 kg/m3" dig $scene --density 2.5
refused "a negative seed" "--seed -1: expected a whole number" dig $scene --seed -1
refused "a seed that no table keeps" "--seed 9223372036854775808: expected a whole number below 2.63" dig $scene --seed 9223372036854775808
refused "no workers" "--jobs 0: expected 1 to" generate $scene $grid -j 0
refused "a shard of none" "--shard 4/3: expected I/N" generate $scene $grid --shard 4/3
refused "a shard that is no fraction" "--shard 3: expected I/N" generate $scene $grid --shard 3
refused "import without a map" "--map MAP.yaml missing" import x.csv -o "$out"
refused "import of a map that is not there" "absent.yaml: No such file" import x.csv --map "$work/absent.yaml" -o "$out"
printf 'friction,rolling,density_kgpm3,packing,t_s,My_Nm,Fx_N,Fz_N,carried_kg,depth,attack_deg\n.5,.5,2500,0,0,1,1,1,1,1,0\n.5,.5,2500,0,.005,1,1,one,1,1,0\n' >"$work/curves.csv"
digtable import tests/data/formats/curves.csv --map tests/data/formats/curve_map.yaml -o "$work/example.sqlite"
check "the example of curves is imported" eval 'is $code 0 && grep -q "2 digs" "$work/out" "$work/err"'
refused "import of a CSV with a text" 'curves.csv:3: column Fz_N: "one", expected a finite number' import "$work/curves.csv" --map tests/data/formats/curve_map.yaml -o "$out"
{ sed 's/^scene: .*/scene: low.yaml/' tests/data/formats/curve_map.yaml
  printf '  depth: {column: depth}\n  attack_deg: {column: attack_deg}\n'; } >"$work/map.yaml"
cp $scene "$work/low.yaml"
sed -i 's/one,1,1,0/1,1,3.2,0/' "$work/curves.csv"
refused "import of a dig too deep" 'curves.csv:3: column depth: 3.2, expected a factor of 0.2 to 3' import "$work/curves.csv" --map "$work/map.yaml" -o "$out"
refused "merge without inputs" "expected OUT.sqlite IN" merge "$out"
refused "an engine that is not built in" "--engine edem: expected single, kernel, ode or cuda" generate $scene $grid --engine edem -o "$out"
refused "threads of an engine without" "--threads: only --engine single and cuda have them" dig $scene --engine kernel --threads 2 -o "$out"
refused "a trajectory the scene lacks" "trajectories: no \"waltz\", expected one of: scrape" dig $scene --trajectory waltz --friction .5 --rolling .2 --density 2500 -o "$out"
refused "a scene that is not there" "absent.yaml: No such file" dig "$work/absent.yaml" "${dig[@]}" -o "$out"
refused "a grid that is not there" "absent.yaml: No such file" generate $scene "$work/absent.yaml" -o "$out"
refused "a scene that is a folder" "no regular file" dig "$work" "${dig[@]}" -o "$out"

# Scenes. What else is wrong in one is tried where it is read: tests/files/test_yaml.c and test_scene_yaml.c.
missing=0 told=0
for key in name bucket box_m packing material gravity_mps2 time_step_s output_s trajectories; do
    awk -v k="^$key:" '$0 ~ k { skip = 1; next } /^[a-z]/ { skip = 0 } !skip' $scene >"$work/short.yaml"
    digtable dig "$work/short.yaml" "${dig[@]}" -o "$out"
    missing=$((missing + 1))
    if [ $code = 2 ] && grep -qE "short.yaml:[0-9]+: $key: missing, expected" "$work/err" && [ ! -e "$out" ]; then told=$((told + 1)); else cat "$work/err"; fi
done
check "each of $missing missing keys is named" is $told $missing
changed 's/young_Pa: .*/young_Pa: stiff/' $scene s.yaml
refused "a text for a number" 's.yaml:22: material.young_Pa: "stiff", expected a number' dig "$work/s.yaml" "${dig[@]}" -o "$out"

# Grids.
changed 's/scrape/waltz/' $grid g.yaml
refused "a grid's trajectory the scene lacks" 'g.yaml:5: trajectories\[0\]: "waltz", expected one of the scene.s: scrape' generate $scene "$work/g.yaml" -o "$out"

changed 's/vz_mps: -0.1/vz_mps: -0.3/' $scene s.yaml
changed 's/^packings: 2/packings: 2\ndepth: [1, 2.5]/' $grid g.yaml
refused "a depth that leaves the box" 'grid, depth 2.5, attack 0 deg: trajectory scrape: at .* s the bucket is .* m outside box_m.z, expected a path' generate "$work/s.yaml" "$work/g.yaml" -o "$out"
changed 's/vz_mps: -0.1/vz_mps: -2/' $scene deep.yaml
refused "a trajectory that leaves the box, before a bed is poured" 'deep.yaml: trajectory scrape: at .* outside box_m.z, expected a path' generate "$work/deep.yaml" $grid -o "$out"
refused "the same by dig" 'deep.yaml: trajectory scrape: at .* outside box_m.z' dig "$work/deep.yaml" "${dig[@]}" -o "$out"
changed 's/start_pin_m: .*/start_pin_m: [0.3, 0.525]/' $scene low.yaml
changed 's/^packings: 2/packings: 2\nattack_deg: [0, 45]/' $grid g.yaml
refused "an attack that starts in the bed" 'grid, depth 1, attack 45 deg: trajectory scrape.*: the bucket starts .* m in the ground, expected it clear' generate "$work/low.yaml" "$work/g.yaml" -o "$out"
sed -i 's/3.2,0/1,45/; s/1,0$/1,45/' "$work/curves.csv"
refused "import of a dig that cannot begin" 'curves.csv:2: trajectory scrape, depth 1, attack 45 deg: the bucket starts .* m in the ground' import "$work/curves.csv" --map "$work/map.yaml" -o "$out"
refused "a dig that leaves the box" 's.yaml: trajectory scrape: at .* outside box_m.z' dig "$work/s.yaml" "${dig[@]}" --depth 2.5 -o "$out"
refused "a depth out of range" '[-]-depth 9: expected 0.2 to 3' dig $scene "${dig[@]}" --depth 9 -o "$out"

# What no memory holds, no step resolves and no row records.
changed 's/x: .0, 1.0./x: [0, 1.0e+25]/' $scene huge.yaml
refused "a box without bounds" 'huge.yaml: box_m: room for more than 2147483648 grains of material.diameter_m' dig "$work/huge.yaml" "${dig[@]}" -o "$out"
changed 's/^time_step_s: .*/time_step_s: 1.0e-300/' $scene s.yaml
refused "a step of nothing" 's.yaml: time_step_s: 1e-300, expected at least 1e-12' dig "$work/s.yaml" "${dig[@]}" -o "$out"
digtable generate "$work/s.yaml" $grid -o "$work/never.sqlite"
check "so it is of a grid, the scene named" eval 'is $code 1 && grep -q "/s.yaml: friction 0.3, .*packing 0: time_step_s: 1e-300, expected at least" $work/err'
changed 's/duration_s: [0-9.]*/duration_s: 1.0e-9/' $scene s.yaml
refused "a dig without a row" 's.yaml: trajectories: scrape gives 0 rows of output_s, expected 2 or more' dig "$work/s.yaml" "${dig[@]}" -o "$out"

# Beds.
printf 'x_m,y_m,z_m\n0,0,0\n' >"$work/bed.csv"
refused "a bed without radii" 'bed.csv:1: column radius_m: missing, expected' dig $scene "${dig[@]}" --bed "$work/bed.csv" -o "$out"
printf 'x_m,y_m,z_m,radius_m\n0.5,0,0.03,0.03\n5.5,0,0.03,0.03\n' >"$work/bed.csv"
for engine in kernel ode; do
    refused "a grain beside the box ($engine)" 'bed: grain 1 at .5.5, 0, 0.03. m is 4.53 m behind a wall of box_m' \
        dig $scene "${dig[@]}" --bed "$work/bed.csv" --engine $engine -o "$out"
done
printf 'x_m,y_m,z_m,radius_m\n0.8,0,0.03,0.03\n' >"$work/bed.csv"
changed 's/x: .0, 1.0./x: [0, 1.0e+25]/; $a bed: {earlier_digs: 1}' $scene huge.yaml
digtable dig "$work/huge.yaml" "${dig[@]}" --bed "$work/bed.csv" -o "$out"
check "ground that no memory holds is not raked" eval 'is $code 1 && grep -q "huge.yaml: out of memory, expected a smaller box_m" $work/err && [ ! -e "$out" ]'
digtable dig $scene "${dig[@]}" --seed 3 --save-bed "$work/bed.csv" -o "$work/made.csv"
check "a bed is kept" is "$code" 0
changed 's/^time_step_s: .*/time_step_s: 5.0e-4/' $scene s.yaml
refused "a step that heats a kept bed" 'time_step_s: 0.0005 keeps a resting bed moving, expected at most' \
    dig "$work/s.yaml" "${dig[@]}" --bed "$work/bed.csv" -o "$out"
ore='materials: [{name: ore, friction: 0.9, rolling: 0.8, density_kgpm3: 4000, restitution: 0.3}]'
sed "\$a bed: {$ore, layers: [{material: ore, z_m: [0.1, 0.4]}]}" $scene >"$work/s.yaml"
refused "layers and a bed without materials" 'bed.csv:1: column material: missing, expected one' \
    dig "$work/s.yaml" "${dig[@]}" --bed tests/data/formats/bed.csv -o "$out"
rock='{shape: sphere, centre_m: [0.5, 0, 0.05], diameter_m: 0.08, movable: true, density_kgpm3: 2600}'
sed "\$a bed: {obstacles: [$rock]}" $scene >"$work/s.yaml"
refused "a rock that may move, and a bed to keep" 'bed.obstacles.0..movable: a bed file does not hold' \
    dig "$work/s.yaml" "${dig[@]}" --save-bed "$work/kept.csv" -o "$out"
refused "such a rock, and a kept bed" 'bed.obstacles.0..movable: a bed file does not hold' \
    dig "$work/s.yaml" "${dig[@]}" --bed tests/data/formats/bed.csv -o "$out"

# Tables. Each ground was compared with all others: minutes for these.
cp tables/reference_rig.sqlite "$work/many.sqlite"
sqlite3 "$work/many.sqlite" "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 30000)
    INSERT INTO ground (friction, rolling, density_kgpm3, effect, magnitude, depth, attack_rad) SELECT 0.001 + i * 1e-6, 0.3, 2400, '', 0, 1, 0 FROM n"
(ulimit -t 60 && exec "$BIN/digtable" check "$work/many.sqlite") >"$work/out" 2>"$work/err"
check "a table of 30,000 empty grounds is checked within a minute of a processor" eval 'is $? 0 && grep -q "sound; 30048 points, 144 entries" $work/out'
printf 'friction: [0.3]\nrolling: [0.1]\ndensity_kgpm3: [2500]\npackings: 2\n' >"$work/small.yaml"
digtable generate $scene "$work/small.yaml" -o "$work/good.sqlite"
check "a small good table is made" is "$code" 0
before=$(sha256sum <"$work/good.sqlite")
changed 's/young_Pa: .*/young_Pa: 6.0e+6/; s/^name: tub/name: stiffer/' $scene other.yaml
digtable generate "$work/other.yaml" "$work/small.yaml" -o "$work/good.sqlite"
check "a table of another scene is refused, both named" eval 'is $code 2 && grep -qE "holds \"tub\" \([0-9a-f]{12}.*not \"stiffer\" \([0-9a-f]{12}" $work/err'
check "and is left as it was" is "$(sha256sum <"$work/good.sqlite")" "$before"

# spoil SQL: a copy of the good table, spoiled.
spoil() {
    cp "$work/good.sqlite" "$work/bad.sqlite"
    sqlite3 "$work/bad.sqlite" "$1" >/dev/null
}
for command in list check show export "export --runs"; do
    arguments=($command "$work/bad.sqlite")
    [ "$command" = show ] && arguments+=(0)
    spoil 'PRAGMA user_version = 1'
    refused "$command: a table of another version" 'bad.sqlite: user_version: table format 1, expected 4' "${arguments[@]}"
    spoil 'PRAGMA application_id = 7'
    refused "$command: another program's database" 'bad.sqlite: not a digsight table .application_id 7, expected' "${arguments[@]}"
    spoil "UPDATE scene SET canonical = canonical || 'x'"
    refused "$command: a scene that was edited" 'bad.sqlite: scene.hash: [0-9a-f]{64}, expected [0-9a-f]{64}' "${arguments[@]}"
    head -c 9000 "$work/good.sqlite" >"$work/bad.sqlite"
    refused "$command: a table cut short" 'bad.sqlite: damaged: .*expected an intact table' "${arguments[@]}"
    echo "friction,rolling" >"$work/bad.sqlite"
    refused "$command: a text file" 'bad.sqlite: not a digsight table, expected a file made by digtable' "${arguments[@]}"
    rm "$work/bad.sqlite"
    refused "$command: no file" 'bad.sqlite: No such file' "${arguments[@]}"
done
spoil "UPDATE run SET wall_s = wall_s + 1"
refused "a run that is not what was stored" 'bad.sqlite: damaged: entry of ground [0-9]+ on trajectory 0, or one of its runs, is not what was stored' list "$work/bad.sqlite"
spoil "CREATE TRIGGER t AFTER INSERT ON run BEGIN DELETE FROM entry; END"
refused "a table with a trigger" 'bad.sqlite: schema: trigger "t" is not digtable.s, expected its tables alone' generate $scene "$work/small.yaml" -o "$work/bad.sqlite"
# What no seal keeps out: those who seal what they spoiled.
spoil_sealed() { spoil "DELETE FROM seal; $1" && /usr/bin/python3 scripts/table_seal.py "$work/bad.sqlite"; }
spoil_sealed "UPDATE entry SET mean = x'00'"
refused "a curve of the wrong size" 'bad.sqlite: entry.mean, entry.spread: expected 1024 finite float32 each' list "$work/bad.sqlite"
spoil_sealed "UPDATE entry SET spread = mean"
refused "an entry that is not its runs' spread" 'bad.sqlite: entry: .*differs from its 2 runs, expected' check "$work/bad.sqlite"
spoil_sealed "UPDATE run SET curve = CAST(substr(curve, 1, 100) AS BLOB)"
refused "a run of the wrong size" 'bad.sqlite: run.curve: 100 bytes for' export "$work/bad.sqlite" --runs -o "$out"
spoil 'PRAGMA user_version = 1'
refused "generate into a table of another version" 'user_version: table format 1, expected 4' generate $scene "$work/small.yaml" -o "$work/bad.sqlite"
spoil_sealed "UPDATE run SET seed = seed + 1"
refused "merge: runs that differ" 'bad.sqlite: run: packing [01] of friction 0.3, rolling 0.1, 2500 kg.m3 on scrape differs' merge "$out" "$work/good.sqlite" "$work/bad.sqlite"
refused "an entry there is not" '7: no such entry .*expected 0 to ' show "$work/good.sqlite" 7
refused "a gravel there is not" 'no such entry, .* of friction 0.3; rolling 0.1; density_kgpm3 2500' \
    show "$work/good.sqlite" --friction .4 --rolling .1 --density 2500
refused "a trajectory there is not" 'waltz: no such trajectory in this entry, expected one of: scrape' show "$work/good.sqlite" 0 --trajectory waltz

# Where the output cannot be written the work has failed: exit 1.
digtable dig $scene "${dig[@]}" -o "$work/no/such/folder/x.csv"
check "an output folder that is not there" eval 'is $code 1 && grep -q "No such file" $work/err'
digtable generate $scene $grid -o "$work/no/such/folder/x.sqlite"
check "a table's folder that is not there" eval 'is $code 1 && grep -q "No such file" $work/err'
digtable list "$work/good.sqlite"
check "and the good table is still good" is "$code" 0
finish
