#!/bin/bash
# make without one of the libraries: the Debian package is named before anything is compiled, and what compiles
# nothing works all the same.
. tests/system/check.bash

# A pkg-config that finds everything but what $WITHOUT names.
mkdir "$work/pc"
for folder in $(pkg-config --variable pc_path pkg-config | tr : ' '); do
    for file in "$folder"/*.pc; do
        [ -e "$file" ] && [ ! -e "$work/pc/$(basename "$file")" ] && cp -L "$file" "$work/pc"
    done
done
without() { # NAME GOAL…: make's output in $work/err
    local name=$1 kept=$work/kept
    shift
    mv "$work/pc/$name.pc" "$kept" || return 1
    env -u MAKEFLAGS -u MAKELEVEL PKG_CONFIG_PATH= PKG_CONFIG_LIBDIR="$work/pc" make BUILD="$work/build" "$@" >"$work/err" 2>&1
    local status=$?
    mv "$kept" "$work/pc/$name.pc"
    return $status
}
named() { # PACKAGE: it alone, and nothing was built
    grep -q "These Debian packages are missing: $1\. " "$work/err" && [ ! -e "$work/build" ]
}

check "make refuses without GLib" eval '! without glib-2.0 all'
check "which lcm needs, and which is named" named libglib2.0-dev
check "make refuses without SQLite" eval '! without sqlite3'
check "by the name of its package" named libsqlite3-dev
check "tests are refused without cmocka" eval '! without cmocka check-unit'
check "by the name of its package" named libcmocka-dev
check "which programs do not need" without cmocka -n all
check "help needs no library" without sqlite3 help
check "nor does clean" without sqlite3 clean
finish
