#!/bin/bash
# How right a table is on digs of another code: every LIGGGHTS gravel of tests/data/reference, and
# every plain one of tests/data/liggghts_more (for the product scene: of tests/data/liggghts_product), is identified from its
# simpleA dig, its actual dig is predicted and compared. One line a case; then the
# packings of one gravel pooled, each of their actual digs predicted. All by moment and forces, and again
# by the moment alone, as where the bucket's cylinder only is measured. Behind the single digs stands how well the
# bands hold: the share of all their points in the 90 % band, and the digs whose peak and energy lie in theirs.
#   BIN=build/bin scripts/evaluate.sh [TABLE.sqlite]
set -eu
bin=${BIN:-build/bin} table=${1:-tables/reference_rig.sqlite}
case $("$bin/digtable" list "$table" --json | sed -nE 's/.*"name": "([^"]*)".*/\1/p' | head -n 1) in
product) data=tests/data/liggghts_product more=/dev/null ;;
*) data=tests/data/reference more=tests/data/liggghts_more ;;
esac
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
exec 2> >(awk '!said[$0]++' >&2) # what every dig's program says of the table, once

field() { # KEY AXIS: a number of one of the identity's gravels
    sed -nE "s/.*\"$1\": \{.*\"$2\": ([0-9.e+-]+).*/\1/p" "$work/id.json"
}
all() { sed -nE "s/.*\"$1\": \[([^]]*)\].*/\1/p" "$2" | tr -d , | head -n 1; }
one() { sed -nE "s/.*\"$1\": ([a-z0-9.e+-]+).*/\1/p" "$2" | head -n 1; }

# Identifies a gravel from the simple dig of each packing together, and predicts the actual dig of each:
# the mean of errors and noise floors. The line goes to standard output and to $work/lines.
judge() { # NAME PACKING…
    local name=$1 packing
    shift
    # shellcheck disable=SC2086 # options are words
    "$bin/digloop" identify "$table" "${@/%/__simpleA.csv}" $options --json >"$work/id.json"
    for packing in "$@"; do
        "$bin/digloop" predict "$table" --identified "$work/id.json" --trajectory actual \
            --measured "${packing}__actual.csv" --json >"$work/next.json"
        for number in inside_90 measured_peak_Nm measured_energy_J; do all "$number" "$work/next.json"; done |
            tr '\n' ' ' >>"$work/bands"
        for number in peak_Nm peak_sigma_Nm energy_J energy_sigma_J; do one "$number" "$work/next.json"; done |
            tr '\n' ' ' >>"$work/bands"
        all moment_Nm "$work/next.json" | tr ' ' '\n' | sort -g | tail -n 1 >>"$work/bands"
        echo "$(one error "$work/next.json") $(one noise_floor "$work/next.json")"
    done | awk '{ e += $1; f += $2 } END { printf "%.3f %.3f\n", e / NR, f / NR }' >"$work/errors"
    printf '%-30s %6.2f %6.2f %7.0f %8.1f %6.1f %6.0f %6.3f %6.3f %s\n' "$name" \
        "$(field gravel friction)" "$(field gravel rolling)" "$(field gravel density_kgpm3)" \
        "$(field nearest friction)" "$(field nearest rolling)" "$(field nearest density_kgpm3)" \
        $(cat "$work/errors") "$([ "$(one outside "$work/id.json")" = true ] && echo outside || true)" | tee -a "$work/lines"
}

for options in "" "--moment-alone"; do
    printf '%-30s %22s %22s %6s %6s\n' "$([ -z "$options" ] && echo moment and forces || echo moment alone)" \
        "identified" "nearest" error floor
    : >"$work/lines"
    : >"$work/bands"
    for simple in "$data"/*__simpleA.csv "$more"/mu*__simpleA.csv; do
        [ -e "$simple" ] || continue
        judge "$(basename "${simple%__simpleA.csv}")" "${simple%__simpleA.csv}"
    done
    sort -k8 -n "$work/lines" | awk '{ e[NR] = $8; f[NR] = $9; s += $8; r += ($8 / $9) ^ 2 } END {
        median = NR % 2 ? e[(NR + 1) / 2] : (e[NR / 2] + e[NR / 2 + 1]) / 2
        for (i = 1; i <= NR; i++) sum += f[i]
        printf "median error %.3f, mean %.3f, largest %.3f, mean noise floor %.3f, error / floor %.2f (rms) over %d digs\n",
            median, s / NR, e[NR], sum / NR, sqrt(r / NR), NR }'
    # moment Fx Fz, peak and energy as measured, peak and sigma, energy and sigma as told, peak of the mean
    awk 'function in_band(off, sigma) { return off <= 1.645 * sigma && off >= -1.645 * sigma }
        function median(v,    i, j, t) {
            for (i = 2; i <= NR; i++) for (j = i; j > 1 && v[j] < v[j - 1]; j--) { t = v[j]; v[j] = v[j - 1]; v[j - 1] = t }
            return NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2
        }
        { m += $1; x += $2; z += $3; peaks += in_band($4 - $6, $7); energies += in_band($5 - $8, $9)
          told[NR] = $6 / $4; mean[NR] = $10 / $4 }
        END { printf "in the 90 %% band: moment %.1f %%, Fx %.1f %%, Fz %.1f %% of the points; peak %d, energy %d of %d digs\n",
                100 * m / NR, 100 * x / NR, 100 * z / NR, peaks, energies, NR
            printf "peak told / recorded: median %.2f; that of the mean: %.2f\n", median(told), median(mean) }' "$work/bands"
    for second in "$data"/*_seed2__simpleA.csv; do
        [ -e "$second" ] || continue
        gravel=${second%_seed2__simpleA.csv}
        packings=("$gravel"_seed*__simpleA.csv)
        [ ! -e "$gravel"__simpleA.csv ] || packings=("$gravel"__simpleA.csv "${packings[@]}")
        judge "$(basename "$gravel"), ${#packings[@]} digs" "${packings[@]%__simpleA.csv}"
    done
done
