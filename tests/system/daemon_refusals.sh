#!/bin/bash
# Every defect of a file: exit status 2, with file, line, key and what was expected.
. tests/system/daemon_lib.bash

make_digs
printf 't_s,boom_rad,arm_rad,bucket_rad,boom_head_Pa,boom_rod_Pa,arm_head_Pa,arm_rod_Pa,bucket_head_Pa,bucket_rod_Pa\n0,0,-1,0,1e6,1e6,1e6,1e6,1e6,1e6\n0.01,0,-1,0,1e6,1e6,1e6,1e6,1e6,1e6\n' >"$work/run.csv"
config good "{kind: replay, replay: {file: run.csv}}"
cp config/can/zx200.dbc config/signals/*.yaml "$work"
sed "s|^input:.*|input: {kind: can, can: {interface: vcan0, dbc: zx200.dbc, map: zx200_can.yaml}}|" \
    "$work/good.yaml" >"$work/can.yaml"

refuses() { # SENTENCE CONFIG PATTERN: exit status 2 and a message like that
    "$BIN/digsightd" -c "$work/$2" --check >"$work/out" 2>"$work/err"
    local rc=$?
    check "$1" eval '[ '$rc' = 2 ] && [ ! -s "$work/out" ] && grep -qE "$3" "$work/err" || { cat "$work/err"; false; }'
}
edit() { # FROM TO SED
    sed -E "$3" "$work/$1" >"$work/$2"
}

check "the good configuration passes --check" eval '"$BIN/digsightd" -c "$work/good.yaml" --check >/dev/null'
check "the CAN configuration passes --check without a bus" eval '"$BIN/digsightd" -c "$work/can.yaml" --check >/dev/null'
refuses "a configuration that is not there" none.yaml 'none.yaml'
edit good.yaml a.yaml 's/^table:/tabel:/'
refuses "an unknown key" a.yaml 'a.yaml:1: tabel: unknown key, expected one of'
edit good.yaml a.yaml '$ a tick_Hz: 50'
refuses "a tick below 100 Hz" a.yaml 'a.yaml:5: tick_Hz: 50, expected 100'
edit good.yaml a.yaml '$ a tick_Hz: fast'
refuses "text for a number" a.yaml 'a.yaml:5: tick_Hz: "fast", expected a number'
edit good.yaml a.yaml 's/kind: replay/kind: telepathy/'
refuses "an input that does not exist" a.yaml 'a.yaml:3: input.kind: .*expected'
edit good.yaml a.yaml 's/kind: replay/kind: modbus-tcp/'
refuses "an input without its settings" a.yaml 'a.yaml:3: input.modbus: missing'
edit good.yaml a.yaml 's/run.csv/gone.csv/'
refuses "a recording that is not there" a.yaml 'a.yaml:3: input.replay.file: .*gone.csv: No such file'
edit good.yaml a.yaml 's/^machine:.*/machine: gone.yaml/'
refuses "a machine that is not there" a.yaml 'a.yaml:2: machine: .*gone.yaml: No such file'
cp "$machine" "$work/machine.yaml"
edit good.yaml a.yaml 's/^machine:.*/machine: bad.yaml/'
edit machine.yaml bad.yaml 's/max_length_m: 3.23/max_length_m: 2.0/'
refuses "a cylinder with a stroke of 40 mm" a.yaml 'bad.yaml:[0-9]+: cylinders.boom.max_length_m: from [0-9.]+ to 2, expected to move the boom'
edit machine.yaml bad.yaml 's/eye_m: .2.55,/eye_m: [12,/'
refuses "an eye 12 m from its hinge" a.yaml 'bad.yaml:[0-9]+: cylinders.boom.max_length_m: from [0-9.]+ to 3.23, expected to move the boom'
edit machine.yaml bad.yaml 's/com_m: .2.6,/com_m: [26,/'
refuses "a boom whose centre of mass is 26 m away" a.yaml 'bad.yaml:[0-9]+: boom.com_m: 26 m .*expected at most the 7.06'
edit good.yaml a.yaml 's/table.sqlite/gone.sqlite/'
refuses "a table that is not there" a.yaml 'a.yaml:1: table: .*gone.sqlite: No such file'
check "and it is not made" [ ! -e "$work/gone.sqlite" ]
edit good.yaml a.yaml 's/table.sqlite/run.csv/'
refuses "a table that is no table" a.yaml 'run.csv'

cp "$work/table.sqlite" "$work/version.sqlite"
printf '\x7f\xff\xff\xff' | dd of="$work/version.sqlite" bs=1 seek=60 conv=notrunc status=none
edit good.yaml a.yaml 's/table.sqlite/version.sqlite/'
refuses "a table of another version, both named" a.yaml 'version.sqlite.*2147483647.*expected'
edit good.yaml a.yaml '$ a scene: quarry'
refuses "a table of another scene, both named" a.yaml 'a.yaml:5: scene: "quarry".*"rig"'
sed -E 's/^(bucket_width_m:).*/\1 0.9/' "$machine" >"$work/wide.yaml"
edit good.yaml a.yaml 's/^machine:.*/machine: wide.yaml/'
refuses "a bucket of another shape, both named" a.yaml 'scene "rig".*0\.778.*machine ".*1\.000'

edit can.yaml b.yaml 's/zx200.dbc/bad.dbc/'
edit zx200.dbc bad.dbc 's/0\|8@1\+/60|8@1+/'
refuses "a DBC signal outside its message" b.yaml 'bad.dbc:8: boom_cylinder_bottom_pressure: reaches bit 68'
edit zx200.dbc bad.dbc 's/ SG_ arm_cylinder_rod_pressure.*/ SG_ arm_cylinder_rod_pressure 24/'
refuses "a DBC line that cannot be read" b.yaml 'bad.dbc:11: .*expected SG_ NAME'
edit can.yaml b.yaml 's/zx200_can.yaml/bad.yaml/'
edit zx200_can.yaml bad.yaml 's/boom_relative_angle/boom_angle/'
refuses "a signal the DBC does not have" b.yaml 'bad.yaml:[0-9]+: signals\[0\].signal: "boom_angle", expected a signal of Front_Angle'
edit zx200_can.yaml bad.yaml 's/scale: 1e6/scale: 1/'
refuses "a scale that forgets the unit" b.yaml 'bad.yaml:[0-9]+: signals\[3\].scale: 1, expected 1e\+06'
edit zx200_can.yaml bad.yaml '/bucket_rad/d'
refuses "a needed signal without an entry" b.yaml 'bad.yaml:[0-9]+: signals: no entry bucket_rad'
edit can.yaml b.yaml 's/zx200_can.yaml/modbus_default.yaml/'
refuses "a map of the other bus" b.yaml 'modbus_default.yaml:3: kind: modbus, expected can'

"$BIN/digsightd" >"$work/out" 2>"$work/err"
check "no configuration at all is bad usage" [ $? = 2 ]
"$BIN/digsightd" --nonsense >"$work/out" 2>"$work/err"
check "so is an unknown option" [ $? = 2 ]
finish
