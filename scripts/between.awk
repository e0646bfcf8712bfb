# awk -f scripts/between.awk PREDICTION.csv MEASURED.csv: the relative Euclidean norm of the difference of two
# recordings' moments after +-0.16 s.
BEGIN { FS = ","; half_s = .16 }
FNR == 1 { file++; n = 0 }
/^#/ { next }
/My_Nm/ { for (i = 1; i <= NF; i++) if ($i == "My_Nm") my = i; next }
{ t[n] = $1; y[file, n++] = $my }
function smoothed(f, i,    sum, k, j) {
    for (j = i; j >= 0 && t[i] - t[j] <= half_s; j--) { sum += y[f, j]; k++ }
    for (j = i + 1; j < n && t[j] - t[i] <= half_s; j++) { sum += y[f, j]; k++ }
    return sum / k
}
END {
    for (i = 0; i < n; i++) { a = smoothed(1, i); b = smoothed(2, i); d += (a - b) ^ 2; s += b * b }
    printf "%.3f\n", sqrt(d / s)
}
