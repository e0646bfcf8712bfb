#!/bin/bash
# A pipe that nobody writes to, a folder, a device without an end: each in place of every file that a program reads. It is
# refused at once, by name, and nothing is made.
. tests/system/check.bash
table=tests/data/formats/table.sqlite
machine=config/machines/zx200_trench.yaml
scene=tests/data/formats/scene.yaml
recording=tests/data/formats/force_recording.csv
out=$work/out
mkfifo "$work/pipe"
mkdir "$work/folder"

# PROGRAM with WORDS, in which FILE stands for what is no file.
refused() { # NAME PROGRAM WORDS…
    local what code words=("${@:3}")
    for what in "$work/pipe" "$work/folder" /dev/zero; do
        timeout 20 "$BIN/$2" "${words[@]/FILE/$what}" >"$work/said" 2>"$work/err" </dev/null
        code=$?
        check "$1: $(basename "$what") is refused" \
            eval 'within $code 1 2 && grep -qF "$what" "$work/err" && [ ! -s "$work/said" ] && [ -z "$(find "$work" -name "out*")" ]'
    done
}

refused "generate's scene" digtable generate FILE tests/data/formats/grid.yaml -o "$out"
refused "generate's grid" digtable generate $scene FILE -o "$out"
refused "generate's table" digtable generate $scene tests/data/formats/grid.yaml -o FILE
refused "dig's scene" digtable dig FILE --trajectory scrape --friction .5 --rolling .5 --density 2500 -o "$out"
refused "dig's bed" digtable dig $scene --trajectory scrape --friction .5 --rolling .5 --density 2500 --bed FILE -o "$out"
for command in list check export; do refused "$command" digtable $command FILE; done
refused "show" digtable show FILE 1
refused "merge" digtable merge "$out" tests/data/formats/table.sqlite FILE
refused "import's curves" digtable import FILE --map tests/data/formats/curve_map.yaml -o "$out"
refused "import's map" digtable import tests/data/formats/curves.csv --map FILE -o "$out"
refused "import's table" digtable import tests/data/formats/curves.csv --map tests/data/formats/curve_map.yaml -o FILE
refused "identify's table" digloop identify FILE $recording
refused "identify's recording" digloop identify $table FILE
refused "identify's machine" digloop identify $table $recording --machine FILE
refused "identify's model" digloop identify $table $recording --model FILE
refused "predict's identity" digloop predict $table --identified FILE --trajectory actual
refused "predict's recording" digloop predict tables/reference_rig.sqlite --identified tests/data/formats/identity.json --trajectory actual --measured FILE
refused "trace's table" digloop trace FILE tests/data/formats/campaign
refused "trace's effects" digloop trace $table tests/data/formats/campaign --effects FILE
refused "design's table" digloop design FILE
refused "digreport's table" digreport --table FILE --machine $machine --html "$out" x=tests/data/formats/daemon.lcm
refused "digreport's machine" digreport --table $table --machine FILE --html "$out" x=tests/data/formats/daemon.lcm
refused "digreport's log" digreport --table $table --machine $machine --html "$out" x=FILE
refused "shift's log" digreport shift --table $table --machine $machine FILE
refused "digwatch's log" digwatch --log FILE
refused "digrig's recording" digrig record FILE --machine $machine -o "$out"
refused "digrig's machine" digrig record $recording --machine FILE -o "$out"
refused "digrig's scene" digrig record $recording --machine $machine --scene FILE -o "$out"
refused "digsightd's configuration" digsightd -c FILE --check

# What a file names.
named() { # NAME: $work/YAML, in which FILE stands for what is no file, made $work/named by sed
    local what
    for what in "$work/pipe" "$work/folder" /dev/zero; do
        sed "s|FILE|$what|" "$work/yaml" >"$work/named.yaml"
        timeout 20 "$BIN/digsightd" -c "$work/named.yaml" --check >"$work/said" 2>"$work/err" </dev/null
        code=$?
        check "digsightd's $1: $(basename "$what") is refused" eval '[ $code = 2 ] && grep -qF "$what" "$work/err"'
    done
}
configure() { # TABLE MACHINE INPUT [MORE]
    printf 'table: %s\nmachine: %s\ninput: %s\nlcm: {url: "udpm://239.255.76.67:7667?ttl=0"}\n%s\n' "$1" "$2" "$3" "${4-}" >"$work/yaml"
}
replay="{kind: replay, replay: {file: $PWD/tests/data/formats/machine_recording.csv}}"
configure FILE "$PWD/$machine" "$replay" && named table
configure "$PWD/$table" FILE "$replay" && named machine
configure "$PWD/$table" "$PWD/$machine" "{kind: replay, replay: {file: FILE}}" && named recording
configure "$PWD/$table" "$PWD/$machine" "{kind: modbus-tcp, modbus: {address: \"127.0.0.1:502\", map: FILE}}" && named "signal map"
configure "$PWD/$table" "$PWD/$machine" "{kind: can, can: {interface: vcan0, dbc: FILE, map: $PWD/config/signals/zx200_can.yaml}}" && named DBC
configure "$PWD/$table" "$PWD/$machine" "$replay" "model: FILE" && named model

for what in "$work/pipe" "$work/folder" /dev/zero; do
    mkdir -p "$work/campaign"
    cp tests/data/formats/campaign/* "$work/campaign"
    sed -i "0,/file: [^,}]*/s||file: $what|" "$work/campaign/campaign.yaml"
    timeout 20 "$BIN/digloop" trace $table "$work/campaign" >"$work/said" 2>"$work/err" </dev/null
    code=$?
    check "a campaign's recording: $(basename "$what") is refused" eval '[ $code = 2 ] && grep -qF "$what" "$work/err"'
    rm "$work/campaign/campaign.yaml"
    ln -s "$what" "$work/campaign/campaign.yaml"
    timeout 20 "$BIN/digloop" trace $table "$work/campaign" >"$work/said" 2>"$work/err" </dev/null
    code=$?
    check "campaign.yaml: a link to $(basename "$what") is refused" eval '[ $code = 2 ] && grep -q "campaign.yaml" "$work/err"'
    rm -r "$work/campaign"
done
finish
