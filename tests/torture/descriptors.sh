#!/bin/bash
# No file descriptors: each program says so or does all as ever.
. tests/system/daemon_lib.bash
. tests/torture/torture.bash
. tests/torture/programs.bash

programs_prepare
programs_undisturbed
runs=0 refusals=0
for ((limit = 3; limit <= 24; limit++)); do
    for program in $programs; do
        run_program "$program" timeout 60 prlimit --nofile=$limit --
        # Below that the dynamic linker finds no library: that is not ours to say.
        grep -q "error while loading shared libraries" "$work/err" && continue
        judge_program "$program" "$limit descriptors"
        runs=$((runs + 1))
        [ "$code" = 0 ] || refusals=$((refusals + 1))
    done
done
told $runs "programs with 3 to 24 descriptors ($refusals refused, the others did all as ever)"
check "a program without descriptors says so, or does all as ever" [ $wrong = 0 ]
finish
