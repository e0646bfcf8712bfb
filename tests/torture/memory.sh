#!/bin/bash
# Allocations that fail, one or all from one on: each program says so or does all as ever; none crashes, none
# leaves half a file.
. tests/system/daemon_lib.bash
. tests/torture/torture.bash
. tests/torture/programs.bash

fail=$(realpath "$BIN/../tests/torture/fail_malloc.so")
programs_prepare
programs_undisturbed

declare -A allocations
for program in $programs; do
    run_program "$program" env LD_PRELOAD="$fail" FAIL_COUNT="$work/count"
    allocations[$program]=$(cat "$work/count")
done

runs=0 refusals=0
while going; do
    for program in $programs; do
        at=$((1 + (RANDOM * 32768 + RANDOM) % allocations[$program]))
        more=()
        [ $((RANDOM % 2)) = 0 ] || more=(FAIL_ON=1)
        run_program "$program" timeout 60 env LD_PRELOAD="$fail" FAIL_AT=$at "${more[@]}"
        judge_program "$program" "allocation $at of ${allocations[$program]} ${more[*]}"
        runs=$((runs + 1))
        [ "$code" = 0 ] || refusals=$((refusals + 1))
    done
done
told $runs "programs with an allocation that failed ($refusals refused, the others did all as ever)"
# The same as the kernel does it: no more than so much address space.
limited=0
for MiB in 8 12 16 20 24 28 32 40 48 64 80 96 128; do
    for program in $programs; do
        run_program "$program" prlimit --as=$((MiB << 20)) --
        # The linker and GLib end a program that is out of memory; both say so.
        # Without memory GLib, below LCM, aborts, or formats the message that it has none, for which it has none, until
        # its stack ends.
        [ "$program $code" = "daemon_run 139" ] ||
            grep -qE "error while loading shared libraries|GLib.*allocate" "$work/err" || judge_program "$program" "$MiB MiB of memory"
        limited=$((limited + 1))
    done
done
told $limited "programs under a limit of their memory (8 to 128 MiB)"
check "a program that is out of memory says so, or does all as ever" [ $wrong = 0 ]
finish
