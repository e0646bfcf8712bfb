#!/bin/bash
# scripts/release_check.py: a figure that is quoted as it is printed is right; one that differs, is not printed, or has no
# command is told and fails.
. tests/system/check.bash

figure() { # QUOTED COMMAND PRINTED [MORE]
    printf "[[figure]]\ndoc = '%s'\nquoted = '%s'\ncommand = '%s'\nprinted = '%s'\n%s\n" "$work/doc.md" "$1" "$2" "$3" "${4-}" \
        >>"$work/figures.toml"
}
judged() { # EXIT
    python3 scripts/release_check.py --list "$work/figures.toml" --rows-of "$work/doc.md" --logs "$work/logs" \
        --page "$work/page.md" "${@:2}" >"$work/out" 2>"$work/err"
    [ $? = "$1" ]
}
doc() { printf '| claim | figure |\n|---|---|\n| error | 0.13 |\n| size | 3 to 5 m |\n%s' "${1-}" >"$work/doc.md"; }

doc
figure 'error \| (\S+)' 'echo error 0.1341' 'error (\S+)'
figure 'size \| (\S+) to (\S+) m' 'echo 3.2 4.9 4.1 | tr " " "\n"' '^(\S+)$' 'range = true'
check "figures as they are printed hold" judged 0
check "the page shows both" [ "$(grep -c '| ok |' "$work/page.md")" = 2 ]
sed -i 's/0.1341/0.1361/' "$work/figures.toml"
check "one that rounds to another number does not" judged 1
check "... and is told" grep -q '| 0.13 | 0.1361 | differs |' "$work/page.md"
sed -i 's/error 0.1361/nothing/' "$work/figures.toml"
check "nor does one that is not printed" eval 'judged 1 && grep -q "not printed" "$work/page.md"'
sed -i 's/nothing/error 0.1341/' "$work/figures.toml"
doc '| peak | 7 N |
'
check "a row without a command fails" eval 'judged 1 && grep -q "^| peak | 7 N |" "$work/page.md"'
figure 'peak \| 7 N' 'echo as said' 'as said' 'cost = "long"'
check "a long one is left out unless asked for" eval 'judged 0 && grep -q "not run" "$work/page.md"'
check "... and held where its words are printed" eval 'judged 0 --all && [ "$(grep -c "| ok |" "$work/page.md")" = 3 ]'
check "without running, a document and its figures agree" eval 'rm -f "$work/page.md"; judged 0 --ties && [ ! -e "$work/page.md" ]'
doc '| peak | 8 N |
'
check "... and do not, and that is told" eval 'judged 1 --ties && grep -q "peak .*not in the document" "$work/out" && grep -q "^| peak | 8 N |" "$work/out"'
doc '| peak | 7 N |
| | 9 N |
'
sed -i 's#peak .| 7 N#peak [|] 7 N [|]\\n[|] [|] 9 N#' "$work/figures.toml"
check "a figure of two rows is one for both" judged 0 --ties
check "what was printed is kept, and read again" eval 'sed -i "s/as said/otherwise/" "$work"/logs/*.log && judged 1 --all --from "$work/logs"'
figure 'x' 'true' '('
check "a wrong expression is named, with its figure and key" eval 'judged 2 && grep -q "figure 4: key .printed." "$work/err"'
finish
