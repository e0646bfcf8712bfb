#!/bin/bash
# digloop and digreport as a user meets them: LIGGGHTS digs against the table that ships, and bad input.
set -u
BIN=${BIN:-build/bin}
table=${TABLE:-tables/rig.sqlite}
reference=tests/data/reference/mu0.5_mur0.5_rho2500
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0 failed=0

check() { # SENTENCE COMMAND…
    if "${@:2}"; then
        passed=$((passed + 1))
        echo "ok    $1"
    else
        failed=$((failed + 1))
        echo "FAIL  $1"
    fi
}

# Exit status 2, a message that holds every word, and no output file.
refuses() { # WORDS… -- COMMAND…
    local words=() word
    while [ "$1" != -- ]; do words+=("$1"); shift; done
    shift
    "$@" >"$work/out" 2>"$work/err"
    local rc=$?
    [ "$rc" = 2 ] || { echo "      exit status $rc of: $*"; return 1; }
    for word in "${words[@]}"; do
        grep -qF -- "$word" "$work/err" || { echo "      no \"$word\" in: $(cat "$work/err")"; return 1; }
    done
    [ ! -e "$work/never" ]
}

"$BIN/digloop" identify "$table" "$reference"__simpleA.csv "$reference"_seed{2,3,4,5}__simpleA.csv --json \
    >"$work/id.json" 2>"$work/err"
check "digs of LIGGGHTS are identified" [ $? = 0 ]
check "as gravel of the table" grep -q '"outside": false' "$work/id.json"
check "pooled" grep -q '"digs": 5' "$work/id.json"
"$BIN/digloop" predict "$table" --identified "$work/id.json" --trajectory actual -o "$work/next.csv" >"$work/out"
check "another dig is predicted" [ $? = 0 ]
check "as a force recording that can be read again" \
    eval '[ "$(head -n 1 "$work/next.csv")" = "$(grep -v "^#" '"$reference"'__actual.csv | head -n 1)" ]'
"$BIN/digloop" identify "$table" "$work/next.csv" >"$work/out" 2>&1
check "the predicted dig is a dig of the table" [ $? = 0 ]

check "digloop without arguments is bad usage" refuses "expected a command" -- "$BIN/digloop"
check "an unknown command is named" refuses "frobnicate" -- "$BIN/digloop" frobnicate "$table"
check "a table that is none is named" refuses README.md -- "$BIN/digloop" identify README.md "$reference"__simpleA.csv
check "a missing recording is named" \
    eval '! "$BIN/digloop" identify "$table" "$work/none.csv" 2>"$work/err" && grep -q none.csv "$work/err"'
sed '3s/[^,]*$/x/' "$reference"__simpleA.csv >"$work/bad.csv"
check "a bad number is named by file, line and column" \
    refuses "bad.csv:3" "Mz_Nm" "expected" -- "$BIN/digloop" identify "$table" "$work/bad.csv"
check "recordings of two trajectories are not pooled" \
    refuses "different trajectories" -- "$BIN/digloop" identify "$table" "$reference"__simpleA.csv "$reference"__actual.csv
awk -F, -v OFS=, 'NR > 1 { $2 = 0.1; $3 = 0.1 + $1 } 1' "$reference"__simpleA.csv >"$work/lift.csv"
check "a path that is none of the table's is refused with its distance" \
    refuses "lift.csv" "bucket lengths away" -- "$BIN/digloop" identify "$table" "$work/lift.csv"
check "an unknown trajectory is named" refuses "nowhere" -- \
    "$BIN/digloop" predict "$table" --identified "$work/id.json" --trajectory nowhere -o "$work/never"
sed 's/"scene_hash": "./"scene_hash": "x/' "$work/id.json" >"$work/other.json"
check "an identity of another scene is refused, both named" refuses "other.json" "rig.sqlite" "expected one scene" -- \
    "$BIN/digloop" predict "$table" --identified "$work/other.json" --trajectory actual -o "$work/never"
sed 's/"digs": 5/"digs": many/' "$work/id.json" >"$work/broken.json"
check "a broken identity is named by file, line and key" refuses "broken.json:2" "digs" "expected" -- \
    "$BIN/digloop" predict "$table" --identified "$work/broken.json" --trajectory actual -o "$work/never"

check "digreport without a log is bad usage" refuses "NAME=LOG.lcm" -- "$BIN/digreport" --table "$table" --machine config/machines/zx200_trench.yaml
check "a truth that is no gravel is named" refuses "--truth" "expected FRICTION" -- \
    "$BIN/digreport" --table "$table" --machine config/machines/zx200_trench.yaml --truth 1,2 "a=b"
check "a log that is none is named" refuses README.md -- \
    "$BIN/digreport" --table "$table" --machine config/machines/zx200_trench.yaml --html "$work/never" "a=README.md"
for tool in digloop digreport digtable digrig digsightd; do
    check "$tool has --help with examples" eval '"$BIN/'$tool'" --help | grep -qi example'
    check "$tool has --version" eval '"$BIN/'$tool'" --version | grep -q "0\.1\.0"'
done

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
