#include "closed_loop/machine/joint_rows.h"

#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

struct dig_noise_mean dig_noise_mean_of(const double lasts_s, const size_t points)
{
    enum { FINE = 4, MOST = 64 * FINE };
    const double step_s       = DIG_AIR_STEP_s / FINE;
    const long   half         = lround(DIG_AIR_KERNEL_HALF_s / step_s);
    const size_t n            = (points - 1) * FINE + 2 * (size_t)half + 1;
    double       weight[MOST] = { 0.0 };
    double       sum          = 0.0;
    assert(n <= MOST);
    for (size_t p = 0; p < points; p++) {
        for (long k = -half; k <= half; k++) {
            const double u = (double)k / (double)half;
            const double w = (1.0 - u * u) * (1.0 - u * u);
            weight[p * FINE + (size_t)(k + half)] += w;
            sum += w;
        }
    }
    const double          block_s = DIG_AIR_STEP_s * (double)points;
    struct dig_noise_mean to      = { .apart = exp(-block_s / lasts_s) };
    for (size_t a = 0; a < n; a++) {
        for (size_t b = 0; b < n; b++) {
            const double by_s = step_s * ((double)a - (double)b);
            const double w    = weight[a] * weight[b] / (sum * sum);
            to.alone += w * exp(-fabs(by_s) / lasts_s);
            to.shared += w * exp(-fabs(by_s + block_s) / lasts_s);
        }
    }
    to.shared /= to.apart;
    return to;
}

void dig_joint_rows_finish(struct dig_joint_rows *const of)
{
    free(of->row);
    free(of->rest);
    *of = (struct dig_joint_rows){ .rows = 0 };
}

static bool has_slope(const struct dig_joint_rows *const of, const double slope[])
{
    bool any = false;
    for (size_t i = 0; i < of->rows; i++) {
        any = any || fabs(slope[of->row[i]]) > 0.0;
    }
    return any;
}

static bool is_of(const struct dig_air *const air, const struct dig_air_row *const row,
                  const enum dig_air_part part)
{
    return part == DIG_AIR_ALL || air->segment[row->segment].after == (part == DIG_AIR_AFTER);
}

enum dig_status dig_joint_rows_make(const struct dig_lines *const lines, const double rest[],
                                    const enum dig_joint which, const enum dig_air_part part,
                                    struct dig_joint_rows *const of)
{
    const struct dig_air *const air = lines->air;
    const size_t                n   = lines->columns;
    *of = (struct dig_joint_rows){ .row = malloc((air->rows + 1) * sizeof *of->row) };
    for (size_t r = 0; r < air->rows && of->row != NULL; r++) {
        if (air->row[r].joint == which && is_of(air, &air->row[r], part)) {
            of->row[of->rows++] = r;
            of->white_N += pow(air->row[r].sigma_N, 2.0);
        }
    }
    of->rest = malloc(((2 * n + 2) * (of->rows + 1) + n * n) * sizeof *of->rest);
    if (of->row == NULL || of->rest == NULL) {
        dig_joint_rows_finish(of);
        return DIG_ENOMEM;
    }
    of->white_N = sqrt(of->white_N / fmax((double)of->rows, 1.0));
    of->slope   = of->rest + of->rows;
    for (size_t i = 0; i < of->rows; i++) {
        of->rest[i] = rest[of->row[i]] * air->row[of->row[i]].sigma_N;
    }
    for (size_t c = 0; c < n; c++) {
        const double *const slope = dig_lines_slope(lines, c);
        if (dig_lines_is_bent(lines, c) || !has_slope(of, slope)) {
            continue;
        }
        for (size_t i = 0; i < of->rows; i++) {
            of->slope[of->columns * of->rows + i] =
                slope[of->row[i]] * air->row[of->row[i]].sigma_N;
        }
        of->columns++;
    }
    of->white = of->slope + of->columns * of->rows;
    of->h     = of->white + (1 + of->columns) * of->rows;
    return DIG_OK;
}

// One of a joint's rows as noise of a size has it: what it shares with the row before, and the
// factor of its covariance, which has one number beside the diagonal once that is taken off.
struct link {
    double shares, beside, root;
};

static struct link link_of(const struct dig_air *const air, const struct dig_joint_rows *const of,
                           const size_t i, const struct dig_noise_mean *const mean,
                           const double size2_N2, const double root_before)
{
    const struct dig_air_row *const row  = &air->row[of->row[i]];
    const struct dig_air_row *const last = i > 0 ? &air->row[of->row[i - 1]] : NULL;
    const bool   follows = last != NULL && last->segment == row->segment && mean != NULL;
    const double own_N2  = mean != NULL ? size2_N2 * (mean->alone - mean->shared) : 0.0;
    const double long_N2 = mean != NULL ? size2_N2 * mean->shared : 0.0;
    const double here_N2 = row->sigma_N * row->sigma_N + own_N2;
    if (!follows) {
        return (struct link){ 0.0, 0.0, sqrt(here_N2 + long_N2) };
    }
    const double blocks    = (double)(row->first - last->first) / (double)row->points;
    const double shares    = pow(mean->apart, blocks);
    const double before_N2 = last->sigma_N * last->sigma_N + own_N2;
    const double beside    = -shares * before_N2 / root_before;
    const double square =
        here_N2 + shares * shares * before_N2 + long_N2 * (1.0 - shares * shares) - beside * beside;
    return (struct link){ shares, beside, sqrt(fmax(square, 1e-3 * here_N2)) };
}

// Takes noise off rests and slopes, into white: they scatter by 1 then, each on its own. The log
// determinant of the noise.
static double whiten(const struct dig_air *const air, const struct dig_joint_rows *const of,
                     const struct dig_noise_mean *const mean, const double size2_N2)
{
    double log_det = 0.0;
    double root    = 1.0;
    for (size_t i = 0; i < of->rows; i++) {
        const struct link link = link_of(air, of, i, mean, size2_N2, root);
        for (size_t c = 0; c <= of->columns; c++) {
            const double *const from = &of->rest[c * of->rows];
            double *const       to   = &of->white[c * of->rows];
            const double before = i > 0 ? link.shares * from[i - 1] + link.beside * to[i - 1] : 0.0;
            to[i]               = (from[i] - before) / link.root;
        }
        root = link.root;
        log_det += 2.0 * log(link.root);
    }
    return log_det;
}

double dig_joint_rows_misfit(const struct dig_air *const air, struct dig_joint_rows *const of,
                             const struct dig_noise_mean *const mean, const double size2_N2)
{
    double        x[DIG_LINES_COLUMNS_MAX];
    const size_t  n       = of->columns;
    const double  log_det = whiten(air, of, mean, size2_N2);
    double *const rest    = of->white;
    double       *slope   = of->white + of->rows;
    double        sum     = dig_product(of->rows, rest, rest) + log_det;
    for (size_t a = 0; a < n; a++) {
        x[a] = dig_product(of->rows, slope + a * of->rows, rest);
        for (size_t b = 0; b <= a; b++) {
            of->h[a * n + b] = dig_product(of->rows, slope + a * of->rows, slope + b * of->rows);
        }
        of->h[a * n + a] += 1.0;
    }
    dig_cholesky_sure(n, of->h);
    dig_lower_solve(n, of->h, x);
    sum += dig_lower_log_det(n, of->h) - dig_product(n, x, x);
    for (size_t a = n; a-- > 0;) { // the transpose's turn
        for (size_t b = a + 1; b < n; b++) {
            x[a] -= of->h[b * n + a] * x[b];
        }
        x[a] /= of->h[a * n + a];
    }
    for (size_t a = 0; a < n; a++) {
        for (size_t i = 0; i < of->rows; i++) {
            rest[i] -= x[a] * slope[a * of->rows + i];
        }
    }
    return sum;
}
