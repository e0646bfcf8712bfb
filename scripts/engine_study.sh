#!/bin/bash
# Do two engines dig alike? For every gravel and trajectory of a table that has runs of both, the moment's mean over
# the dig and over eight parts of it in time: the second engine's over the first's, and how far that is from 1 in
# standard errors of the runs' own scatter (docs/numerics/dem.md, "On a graphics card"). A minute.
#   BIN=build/bin scripts/engine_study.sh [TABLE.sqlite [FIRST [SECOND]]]
set -euo pipefail
bin=${BIN:-build/bin} table=${1:-tables/rig.sqlite} first=${2:-kernel} second=${3:-cuda}

"$bin/digtable" export "$table" --runs | awk -F, -v first="$first" -v second="$second" '
    NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
    { key = $at["friction"] "," $at["rolling"] "," $at["density_kgpm3"] "," $at["effect"] "," $at["magnitude"] \
          "," $at["depth"] "," $at["attack_deg"] "," $at["trajectory"]
      run = key SUBSEP $at["packing"]
      if (!(run in engine)) { engine[run] = $at["engine"]; entry[run] = key }
      moment[run, rows[run]++] = $at["My_Nm"] }
    END {
        for (run in engine) {
            e = engine[run]; k = entry[run]
            if (e != first && e != second) continue
            n[k, e]++; seen[k] = 1
            for (i = 0; i < rows[run]; i++) {
                part = 1 + int(8 * i / rows[run])
                sum[run, part] += moment[run, i] / (rows[run] / 8)
                sum[run, 0] += moment[run, i] / rows[run]
            }
            for (p = 0; p <= 8; p++) { s[k, e, p] += sum[run, p]; q[k, e, p] += sum[run, p] ^ 2 }
        }
        for (p = 0; p <= 8; p++) {
            entries = runs_a = runs_b = a = b = variance = 0
            for (k in seen) {
                na = n[k, first]; nb = n[k, second]
                if (na < 1 || nb < 1 || na + nb < 3) continue
                ma = s[k, first, p] / na; mb = s[k, second, p] / nb
                # Scatter about either mean, so that a difference of the engines is none.
                about = q[k, first, p] - na * ma * ma + q[k, second, p] - nb * mb * mb
                variance += about / (na + nb - 2) * (1 / na + 1 / nb)
                a += ma; b += mb; entries++; runs_a += na; runs_b += nb
            }
            if (entries == 0) { print "no entry has runs of both engines, three in all"; exit 1 }
            if (p == 0) printf "%d entries, %d runs of %s, %d of %s\n", entries, runs_a, first, runs_b, second
            error = sqrt(variance) / a
            printf "%-12s ratio %.4f +- %.4f  %+.1f sigma\n", p == 0 ? "whole dig" : "part " p " of 8", b / a, error, (b / a - 1) / error
        }
    }'
