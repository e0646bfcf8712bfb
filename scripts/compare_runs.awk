# Reads runs as `digtable export --runs` writes them, in two sets, and compares the moment of every gravel and trajectory
# that both have: its mean over the dig and over eight parts of it in time, the second set's over the first's, and how far
# that is from 1 in standard errors of the runs' own scatter.
#   -v first=NAME -v second=NAME   what a run is of: its engine, or, with files=1, its file, which is the first or second
#   -v entries=1                   a line for every gravel and trajectory, too
BEGIN { FS = "," }
FNR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; file++; next }
{
    key = $at["friction"] "," $at["rolling"] "," $at["density_kgpm3"] "," $at["effect"] "," $at["magnitude"] \
        "," $at["depth"] "," $at["attack_deg"] "," $at["trajectory"]
    run = file SUBSEP key SUBSEP $at["packing"]
    if (!(run in set)) {
        set[run] = files ? (file == 1 ? first : second) : $at["engine"]
        entry[run] = key
    }
    moment[run, rows[run]++] = $at["My_Nm"]
}
function ratio_of(k, p,    na, nb, ma, mb, about) {
    na = n[k, first]; nb = n[k, second]
    ma = s[k, first, p] / na; mb = s[k, second, p] / nb
    # Scatter about either mean, so that a difference of the sets is none.
    about = q[k, first, p] - na * ma * ma + q[k, second, p] - nb * mb * mb
    of_variance = about / (na + nb - 2) * (1 / na + 1 / nb)
    of_a = ma; of_b = mb
}
END {
    for (run in set) {
        e = set[run]; k = entry[run]
        if (e != first && e != second) continue
        n[k, e]++; seen[k] = 1
        for (i = 0; i < rows[run]; i++) {
            part = 1 + int(8 * i / rows[run])
            sum[run, part] += moment[run, i] / (rows[run] / 8)
            sum[run, 0] += moment[run, i] / rows[run]
        }
        for (p = 0; p <= 8; p++) { s[k, e, p] += sum[run, p]; q[k, e, p] += sum[run, p] ^ 2 }
    }
    for (k in seen) {
        if (n[k, first] < 1 || n[k, second] < 1 || n[k, first] + n[k, second] < 3) { delete seen[k]; continue }
        if (!entries) continue
        ratio_of(k, 0)
        printf "%-40s %2d %2d runs  mean %.3f %.3f Nm  ratio %.2f +- %.2f\n", k, n[k, first], n[k, second], of_a, of_b,
            of_b / of_a, sqrt(of_variance) / of_a | "sort -t, -k8,8 -k1,3"
    }
    close("sort -t, -k8,8 -k1,3")
    for (p = 0; p <= 8; p++) {
        found = runs_a = runs_b = a = b = variance = 0
        for (k in seen) {
            ratio_of(k, p)
            variance += of_variance; a += of_a; b += of_b
            found++; runs_a += n[k, first]; runs_b += n[k, second]
        }
        if (found == 0) { print "nothing has runs of both, three in all"; exit 1 }
        if (p == 0) printf "%d entries, %d runs of %s, %d of %s\n", found, runs_a, first, runs_b, second
        error = sqrt(variance) / a
        printf "%-12s ratio %.4f +- %.4f  %+.1f sigma\n", p == 0 ? "whole dig" : "part " p " of 8", b / a, error, (b / a - 1) / error
    }
}
