#!/bin/bash
# digloop trace and design as a user meets them: nothing missing, bad campaigns, what they leave behind.
# A bad campaign gets a clear refusal or no claim; never a confident wrong one.
set -u
BIN=${BIN:-build/bin}
table=${TABLE:-$(ls tables/rig.sqlite tables/coarse.sqlite 2>/dev/null | head -n 1)}
reference=$PWD/tests/data/reference/mu0.5_mur0.5_rho2500
machine=$PWD/config/machines/zx200_trench.yaml
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

# A campaign of the reference gravel: ROLE lines "seed trajectory role", machine or not.
campaign() { # NAME [machine], lines on standard input
    local folder=$work/$1 n=0 seed trajectory role rest
    mkdir -p "$folder"
    { echo "scene: ${scene:-$PWD/config/scenes/rig.yaml}"
      [ "${2:-}" = machine ] && echo "machine: $machine"
      echo "recordings:"; } >"$folder/campaign.yaml"
    while read -r seed trajectory role rest; do
        n=$((n + 1))
        local from=${reference}_seed${seed}__$trajectory.csv
        [ "$seed" = 1 ] && from=${reference}__$trajectory.csv
        if [ "${2:-}" = machine ]; then
            # shellcheck disable=SC2086 # options of the machine
            "$BIN/digrig" record "$from" --machine "$machine" --seed "$n" ${rest:-} -o "$folder/d$n.csv" 2>/dev/null || return 1
        else
            cp "$from" "$folder/d$n.csv"
        fi
        echo "  - {file: d$n.csv, trajectory: $trajectory, role: $role}" >>"$folder/campaign.yaml"
    done
}

trace() { # NAME OPTIONS…
    "$BIN/digloop" trace "$table" "$work/$1" "${@:2}" --json "$work/$1.json" >"$work/$1.out" 2>"$work/$1.err"
}

# Refused with exit status 2 and every word, or traced without a claim.
claims_nothing() { # NAME WORDS…
    local word
    trace "$1"
    local rc=$?
    if [ $rc = 0 ]; then
        grep -q '"verdict": \["none"\]' "$work/$1.json" || { echo "      claimed: $(cat "$work/$1.json")"; return 1; }
        return 0
    fi
    [ $rc = 2 ] && [ ! -e "$work/$1.json" ] || { echo "      exit status $rc, $(cat "$work/$1.err")"; return 1; }
    for word in "${@:2}"; do
        grep -qF -- "$word" "$work/$1.err" || { echo "      no \"$word\" in: $(cat "$work/$1.err")"; return 1; }
    done
}

refuses() { # NAME WORDS…
    claims_nothing "$@" && [ ! -e "$work/$1.json" ]
}

campaign plain <<'END'
1 simpleA identify
2 simpleA fit
1 actual fit
3 actual fit
4 actual holdout
END
trace plain --html "$work/plain.html"
check "a campaign with nothing missing is traced" [ $? = 0 ]
check "and nothing is claimed" grep -q '"verdict": \["none"\]' "$work/plain.json"
check "with an error on the holdout dig, the same before and after" \
    eval '[ "$(grep -o "\"error_before\": .*[0-9]}" "$work/plain.json" | cut -d: -f2-)" = "$(grep -o "\"error_after\": .*[0-9]}" "$work/plain.json" | cut -d: -f2-)" ]'
check "the page is whole and stands alone" \
    eval 'tail -n 1 "$work/plain.html" | grep -q "</html>" && ! grep -o "https\?://[^\"]*" "$work/plain.html" | grep -qv www.w3.org'
trace plain
cp "$work/plain.json" "$work/first.json"
trace plain
check "the same campaign gives the same answer" cmp -s "$work/plain.json" "$work/first.json"

campaign one <<'END'
1 simpleA identify
END
check "one dig is too few" refuses one "expected"
campaign open <<'END'
1 simpleA identify
2 simpleA fit
1 actual fit
END
check "without a holdout dig nothing is confirmed" claims_nothing open
check "and its error is null" eval '[ ! -e "$work/open.json" ] || grep -q "\"error_after\": {\"holdout\": null" "$work/open.json"'
scene=$PWD/config/scenes/paper_basic.yaml
sed 's/width_m: 0.07/width_m: 0.12/; s/^name: rig/name: wide/' config/scenes/rig.yaml >"$work/wide.yaml"
scene=$work/wide.yaml campaign wide <<'END'
1 simpleA identify
2 simpleA fit
1 actual holdout
END
check "another scene is refused, both named" refuses wide wide rig
scene=
campaign gone <<'END'
1 simpleA identify
2 simpleA fit
1 actual holdout
END
rm "$work/gone/d2.csv"
check "a missing recording is refused by name" \
    eval '! trace gone && [ ! -e "$work/gone.json" ] && grep -q d2.csv "$work/gone.err"'
campaign swapped <<'END'
1 simpleA identify
2 simpleA fit
1 actual holdout
END
sed -i 's/d2.csv, trajectory: simpleA/d2.csv, trajectory: actual/' "$work/swapped/campaign.yaml"
check "a dig along another path than said is refused" refuses swapped d2.csv

campaign air machine <<'END'
1 simpleA identify
2 simpleA fit
1 actual fit
3 actual holdout
END
check "a machine with nothing missing claims nothing" claims_nothing air
campaign airless machine <<'END'
1 simpleA identify --no-air
2 simpleA fit --no-air
1 actual fit --no-air
3 actual holdout --no-air
END
check "without free air nothing of the machine is claimed" claims_nothing airless
mkdir "$work/clipped" && cp "$work/air"/* "$work/clipped"
for n in 1 2 3 4; do
    # Sensors that end at 3 MPa.
    awk -F, -v OFS=, '!/^#/ && $1 + 0 == $1 { for (i = 5; i <= 10; i++) if ($i > 3e6) $i = 3e6 } 1' \
        "$work/air/d$n.csv" >"$work/clipped/d$n.csv"
done
trace clipped
rc=$?
check "clipped pressures are refused or called unlisted, not given a name" \
    eval '[ $rc = 2 ] || grep -q "\"verdict\": \[\"\(none\|unlisted\)\"\]" "$work/clipped.json"'

"$BIN/digloop" design "$table" --json >"$work/design.json" 2>"$work/design.err"
check "digs are ranked" [ $? = 0 ]
check "one is recommended" grep -q '"recommended": "simple' "$work/design.json"
check "design takes no campaign" eval '! "$BIN/digloop" design "$table" "$work/plain" 2>"$work/err" && grep -q expected "$work/err"'

echo "$passed passed, $failed failed"
[ $failed = 0 ]
