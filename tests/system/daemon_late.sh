#!/bin/bash
# What the system tests make of a machine that does not keep the bus's time: the same checks again, slower,
# as often as there is time for; and what a late rig is no excuse for fails at once.
set -u
. tests/system/check.bash
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# A test whose rig says how late it was, a number for each try, with a check of each kind that fails in as
# many tries as told.
cat >"$work/try.sh" <<'BASH'
#!/bin/bash
. tests/system/daemon_lib.bash
echo "$DIG_TRY" "$(slowed 4)" "$(longer 100)" >>"$TRIES"
set -- $LATE
echo "digrig: 9 ticks, the latest ${!DIG_TRY}.25 ms late" >"$work/rig.err"
check "plain" [ "$DIG_TRY" -gt "$PLAIN" ]
check_timed "timed" [ "$DIG_TRY" -gt "$TIMED" ]
check_wrong "wrong" [ "$DIG_TRY" -gt "$WRONG" ]
finish
BASH
chmod +x "$work/try.sh"

run() { # LATE PLAIN TIMED WRONG [VARIABLE=VALUE…]: its exit status, tries, and last line
    : >"$work/tries"
    env -u DIG_TRY -u DIG_NO_SKIP DIG_REST=0 "${@:5}" TRIES="$work/tries" LATE="$1" PLAIN="$2" TIMED="$3" WRONG="$4" \
        "$work/try.sh" >"$work/out" 2>&1
    echo "$? $(wc -l <"$work/tries") $(grep -E '^[0-9]+ passed' "$work/out" | tail -n 1)"
}
is() { [ "$1" = "$2" ] || { echo "      \"$1\" instead of \"$2\""; return 1; }; }

check "what is right passes, late or not" is "$(run "900 900 900" 0 0 0)" "0 1 3 passed, 0 failed"
check "what fails while the rig keeps time fails at once" is "$(run "20 20 20" 0 3 0)" "1 1 2 passed, 1 failed"
check "what fails while it is late is tried again" is "$(run "900 20 20" 0 1 0)" "0 2 3 passed, 0 failed"
check "and fails when the rig keeps time then" is "$(run "900 20 20" 0 3 0)" "1 2 2 passed, 1 failed"
check "at half the speed, with longer limits" \
    eval 'run "900 20" 0 1 0 >/dev/null; is "$(tr "\n" " " <"$work/tries")" "1 4 100 2 2 200 "'
check "what was late in both tries is skipped, aloud" \
    eval 'is "$(run "900 900 900" 0 3 0)" "0 2 2 passed, 0 failed, 1 skipped" && grep -q "^SKIP: 1 checks failed" "$work/out"'
check "where a bus may not be skipped, too" is "$(run "900 900 900" 0 3 0 DIG_NO_SKIP=1)" "0 2 2 passed, 0 failed, 1 skipped"
check "but fails where nothing may be" \
    is "$(run "900 900 900" 0 3 0 DIG_NO_SKIP=all)" "1 2 2 passed, 1 failed: the rig was late in each try, and nothing may be skipped"
check "and where nothing was late passes there" is "$(run "20 20 20" 0 0 0 DIG_NO_SKIP=all)" "0 1 3 passed, 0 failed"
check "what does not depend on time is not excused" is "$(run "900 900 900" 3 0 0)" "1 1 2 passed, 1 failed"
check "nor is it beside what is" is "$(run "900 900 900" 3 3 0)" "1 1 1 passed, 2 failed"
check "a wrong number is not excused by what excuses a late one" is "$(run "900 900 900" 0 0 3)" "1 1 2 passed, 1 failed"
check "but by a second and more" is "$(run "1100 20 20" 0 0 1)" "0 2 3 passed, 0 failed"
check "a rig that told no lateness excuses nothing" is "$(run "0 0 0" 0 3 0)" "1 1 2 passed, 1 failed"
check "where there is no time for another try there is none" is "$(run "900 900 900" 0 3 0 DIG_TEST_LIMIT_S=30)" "0 1 2 passed, 0 failed, 1 skipped"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
