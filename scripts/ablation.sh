#!/bin/bash
# scripts/ablation.sh N [RULE...]: what each rule and each chosen constant of the closed loop is worth. Builds digloop
# without it in a copy of the sources, traces the blind bench's campaigns for development (N without an effect, and
# those with one that follow from it) and prints one line a rule. The first line is the loop as it is.
#   N=20 takes some four minutes of a core a rule. `make bench-ablation`. Campaigns and noise are the same in every line.
# The same in steps, so that another machine may trace:
#   scripts/ablation.sh build DIR [RULE...]      a new folder DIR, in it one a rule with its programs
#   scripts/ablation.sh trace DIR N [RULE...]    JOBS rules at a time; what DIR holds already is not traced again
#   scripts/ablation.sh table DIR                of what is traced
set -euo pipefail
blind=build/tests/blind/blind
table=tables/reference_rig.sqlite
jobs=${JOBS:-$(nproc)}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# NAME|FILE|what sed does to it|lines of sources that would go
rules='
as it is|||0
what has no name does not compete|closed_loop/search/search_which.c|s/least_lead = 15.0/least_lead = -1e9/|10
no lead over what has no name (15: 0)|closed_loop/search/search_which.c|s/least_lead = 15.0/least_lead = 0.0/|4
an effect need not be enough|closed_loop/search/search_which.c|s/dig_search_evidence(c, &with, 0) - DIG/-1e9 - DIG/|6
any lead names (6: 0)|closed_loop/search/search_work.h|s/TOLD_APART 6.0/TOLD_APART 0.0/|0
any lead names a second effect|closed_loop/search/search_which.c|s/log((double)c->s->rivals \/ c->false_alarm)/0.0/|2
left-out digs do not confirm|closed_loop/search/search_which.c|s/c->s->confirmed < 0.0/false/|77
a drift may bend|closed_loop/search/search_which.c|s/by_a_bend = 0.5/by_a_bend = 1e9/|10
wear leads digs that are alike alone (3: none)|closed_loop/search/drift.c|s/ - none;/ - none + 1e9;/|140
no rock elsewhere|closed_loop/search/search_which.c|s/lead >= DIG_SEARCH_TOLD_APART/false \&\& lead >= DIG_SEARCH_TOLD_APART/|330
a rock need not explain half (.5: 0)|closed_loop/search/search_which.c|s/half = 0.5/half = 0.0/|3
no second effect|closed_loop/search/search_which.c|s/if (find_pair(c, &pair))/if (false \&\& find_pair(c, \&pair))/|90
no gravel outside the grid|closed_loop/search/search.c|s/search->outside = !search->is_rock/search->outside = false \&\& !search->is_rock/|25
what nothing explains is never chance|closed_loop/search/search.c|s/rarer = 0.01/rarer = 1e9/|8
digs do not widen their scatter|closed_loop/search/search.c|s/statistic->about) < c->false_alarm/statistic->about) < -1.0/|40
evidence is not tempered (.5: 1)|closed_loop/search/search.c|s/temper = 0.5/temper = 1.0/|0
size does not halve a probability|closed_loop/verdict/trace_work.h|s/UNCONFIRMED 0.5/UNCONFIRMED 1.0/|40
every correction is made|closed_loop/verdict/trace.c|s/most_chance_of_worse = 0.2/most_chance_of_worse = 1.0/|88
every trajectory is corrected|closed_loop/search/unlisted.c|s/!(gain_of(batch, left, by\[g\], g) > 0.0)/false/|35
what has no name is corrected whole|closed_loop/search/unlisted.c|s/by\[g\] = credible(batch, fitted, g)/by[g] = 1.0/|20
repeats count as beds|closed_loop/fit/batch.c|s/return beds;/return batch->group[group].digs;/|54
codes agree (.01: 0)|closed_loop/fit/likelihood.c|s/of_codes *= 0.01;/of_codes = 0.0;/|2
codes differ smoothly alone (.01: 0)|closed_loop/fit/likelihood.c|s/rough = 0.01/rough = 0.0/|1
what has no name changes slowly alone (.5: 0)|closed_loop/fit/likelihood.c|s/quick = 0.5/quick = 0.0/|3
the surface is at its place (.05: 0)|closed_loop/fit/shifts.c|s/of_place  *= 0.05/of_place = 0.0/|45
effects are of their gravel (.3: 0)|closed_loop/fit/shifts.c|s/of_effect_place = 0.3/of_effect_place = 0.0/|10
magnitudes are what they say (.1: 0)|closed_loop/fit/shifts.c|s/of_magnitude = 0.1/of_magnitude = 0.0/|10
nothing is off in all trajectories alike (.15, .1: 0)|closed_loop/fit/shifts.c|s/common_place  *= 0.15/common_place = 0.0/; s/common_magnitude = 0.1/common_magnitude = 0.0/|55
layers have no contrast|estimator/effects/layering.c|s/1.0, 0.25, 2.0/1.0, 1.0, 1.0/|60
templates have the right form (.1: 0)|closed_loop/fit/likelihood.c|s/of_templates = 0.1;/of_templates = 0.0;/|20
rocks are alike (.3: .1)|estimator/effects/obstacle.c|s/likeness *= 0.3/likeness = 0.1/|2
of several effects the first alone is weighed|closed_loop/fit/likelihood.c|s/return all > 0.0 ? sqrt(sum \/ all) : one;/return one;/|40
templates do not bend at magnitudes|closed_loop/model/soil_terms.c|s/knots > 2 ? knots : 0/0/|35
a higher floor of scatter (.002: .015)|closed_loop/model/scatter.h|s/SCATTER_FLOOR 0.002/SCATTER_FLOOR 0.015/|0
correlations are as the packings have them (.25: 0)|closed_loop/model/packings.c|s/towards_even *= 0.25/towards_even = 0.0/|45
left-out packings do not widen scatter|closed_loop/model/scatter.c|s/fmax(held_out.all, 1.0)/1.0/|10
beds do not scatter as gravels do|closed_loop/model/scatter.c|s/fmax(held_out.as_gravels .*;/0.0;/|110
the size of scatter is known|closed_loop/fit/batch.c|s/return isinf(known) ?/return true ?/|10
the surface is exact|closed_loop/model/response_surface.c|s/^    return sum;/    return 0.0;/|15
no cubic terms|closed_loop/model/response_surface.c|s/MOST_DEGREE = 3/MOST_DEGREE = 2/|20
cubic terms are free (5: 0)|closed_loop/model/response_surface.c|s/cubic_prior = 5.0/cubic_prior = 0.0/|4
readings have no noise of their own|closed_loop/recordings/observe.c|s/dig_reading_noise(held, c->raw)/0.0/|30
noise of forces never lasts|closed_loop/verdict/trace.c|s/status = dig_trace_tell_noise(w, &w->before)/status = DIG_OK/|110
noise of pressures never lasts|closed_loop/machine/machine_noise.c|s/if (size2_N2 > 0.0 \&\& /if (false \&\& /|280
forces are never late|closed_loop/fit/forward.c|s/return is_late(effect) && any_rate(batch)/return false/|110
free air begins three tenths above (.1: .3)|closed_loop/machine_digs/free_air.c|s/above_share = 0.1/above_share = 0.3/|0
a machine needs no lead over no name (6: 0)|closed_loop/verdict/machine_choice.c|s/unnamed_cost = DIG_SEARCH_TOLD_APART/unnamed_cost = 0.0/|2
answers of the machine are no set (5: 0)|closed_loop/verdict/machine_choice.c|s/tie = 5.0/tie = 0.0/|20
digs do not say what the machine is|closed_loop/verdict/machine_choice.c|s/answer.log_evidence + soil - choice->soil0/answer.log_evidence/|100
the machine stays as free air has it|closed_loop/verdict/machine_choice.c|s/answer, const bool open,/answer, bool open,/; s/^    struct dig_steps  *steps;/& open = false;/; s/^    leave_open(choice, w->open);//|300
all of a form may be wrong|closed_loop/machine/machine_trust.c|s/FORM_SHARES = 4/FORM_SHARES = 1/|22
a strange machine leaves the soil its name|closed_loop/verdict/trace_verdict.c|s/if (air->unexplained/if (false \&\& air->unexplained/|12
'

fail() { echo "ablation: $1" >&2; exit 1; }

wanted() { # NAME [RULE...]: the loop as it is always, and all where none is named
    local rule
    [ $# -gt 1 ] || return 0
    for rule in "as it is" "${@:2}"; do [ "$rule" != "$1" ] || return 0; done
    return 1
}

build() { # DIR [RULE...]
    local dir=$1 number=0 name file change lines copy=$work/sources
    shift
    mkdir "$dir" "$copy"
    cp -rL Makefile core files messages tables estimator firmware_host offline_dem closed_loop tools scripts "$copy/"
    rm -f "$copy"/tables/*.sqlite
    while IFS='|' read -r name file change lines; do
        if [ "$name" ] && wanted "$name" "$@"; then
            if [ "$file" ]; then
                cp "$copy/$file" "$work/kept"
                sed -i "$change" "$copy/$file"
                ! cmp -s "$copy/$file" "$work/kept" || fail "$file no longer holds what to change for: $name"
            fi
            make -s -C "$copy" -j "$jobs" build/bin/digloop build/bin/digrig CFLAGS="-O2 -w" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
            local to=$dir/$(printf %02d $number)
            mkdir -p "$to/bin"
            cp "$copy/build/bin/digloop" "$copy/build/bin/digrig" "$to/bin/"
            echo "$name|$lines" >"$to/rule"
            # Newer than what was built without the rule.
            [ ! "$file" ] || { mv "$work/kept" "$copy/$file" && touch "$copy/$file"; }
        fi
        number=$((number + 1))
    done <<<"${rules#$'\n'}"
}

folder_of() { # DIR NAME
    local rule name
    for rule in "$1"/*/rule; do
        IFS='|' read -r name _ <"$rule"
        [ "$name" != "$2" ] || { dirname "$rule" && return; }
    done
    fail "$1 has no rule: $2"
}

# A kind of campaigns at a time, so that all JOBS have work until the last. Rules in the order they are named in.
trace() { # DIR N [RULE...]
    local dir=$1 n=$2 rule kind
    shift 2
    [ "$(cat "$dir/n" 2>/dev/null || echo "$n")" = "$n" ] || fail "$dir was traced with N=$(cat "$dir/n")"
    echo "$n" >"$dir/n"
    mkdir -p build/blind
    if [ $# = 0 ]; then
        mapfile -t < <(cut -d'|' -f1 "$dir"/*/rule | sed 1d)
        set -- "${MAPFILE[@]}"
    fi
    for rule in "as it is" "$@"; do
        rule=$(folder_of "$dir" "$rule")
        for kind in none single pair outside; do
            [ -e "$rule/$kind.json" ] || printf '%s\0' "$rule" "$kind"
        done
    done | blind=$blind table=$table n=$n xargs -0 -r -n 2 -P "$jobs" bash -c '"$blind" --table "$table" --bin "$1/bin" \
        --split dev -n "$n" --only "$2" --json "$1/$2.part" >"$1/$2.log" 2>&1 && mv "$1/$2.part" "$1/$2.json" ||
        { cat "$1/$2.log"; exit 1; } >&2' trace
}

# From what the bench wrote, as it is and without: how many campaigns both traced, how many answers became right and
# wrong, false alarms, on how many holdout digs the error fell and rose by a hundredth of itself, and the mean error
# after over that of the loop as it is.
compare() { # AS_IS WITHOUT
    awk -F'"number": ' '
        function text(key) { return match($0, "\"" key "\": \"[^\"]*\"") ? substr($0, RSTART + length(key) + 5, RLENGTH - length(key) - 6) : "" }
        function value(key) { return match($0, "\"" key "\": [-0-9.e+]+") ? substr($0, RSTART + length(key) + 4, RLENGTH - length(key) - 4) : "" }
        function good(kind, answer) { return kind == "outside" ? answer != "wrong" : answer == "right" || answer == "in set" }
        NF < 2 || text("answer") == "" { next }
        { n = $2 + 0; is = good(text("kind"), text("answer")); after = value("after") }
        FILENAME == ARGV[1] { was[n] = is; error[n] = after; next }
        n in was { of++; right += is && !was[n]; wrong += !is && was[n]; alarms += text("kind") == "none" && !is
          if (after != "" && error[n] != "") { sum += after; sum0 += error[n]; fell += after < .99 * error[n]; rose += after > 1.01 * error[n] } }
        END { printf "%6d %6d %6d %6d %6d %6d %7.3f", of, right, wrong, alarms, fell, rose, (sum0 > 0 ? sum / sum0 : 1) }' "$1" "$2"
}

table() { # DIR
    local rule name lines
    printf '%-53s %6s %6s %6s %6s %6s %6s %7s %6s\n' without of right wrong alarms fell rose error lines
    for rule in "$1"/*/rule; do
        IFS='|' read -r name lines <"$rule"
        ! ls "${rule%rule}"*.json >/dev/null 2>&1 ||
            printf '%-53s %s %6s\n' "$name" "$(compare <(cat "$1"/00/*.json) <(cat "${rule%rule}"*.json))" "$lines"
    done
}

case ${1:?N, or build, trace or table} in
build) build "${@:2}" ;;
trace) trace "${@:2}" ;;
table) table "$2" ;;
*)
    build "$work/built" "${@:2}"
    trace "$work/built" "$@"
    table "$work/built"
    ;;
esac
