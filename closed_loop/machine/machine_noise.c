#include "closed_loop/machine/machine_noise.h"

#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// How long noise may last, and its sizes over the white noise of a row's mean, each 1.5 of the one
// before.
static const double memory_s[] = { 0.05, 0.1, 0.2, 0.4 };
enum { MEMORIES = sizeof memory_s / sizeof memory_s[0], SIZES = 16 };
static const double least_size = 0.25;
static const double size_step  = 1.5;

// Rests that are alike over so many blocks by more sigmas of chi-squared go on: a ripple of
// seconds.
enum { LAGS = 8 };
static const double alike_sigmas = 10.0;

// Fewer rows of a joint tell nothing.
enum { LEAST = 16 };

// Rows are means over blocks of readings that are means over a kernel. Of noise of variance 1:
// variance of a block's mean, and covariance of two neighbours over the correlation a block apart.
struct mean {
    double alone, shared;
    double apart; // correlation of the noise a block apart
};

// The rows of one joint, in their order, and the columns that change them, in the lines' room.
struct joint {
    size_t  rows, columns;
    size_t *row;
    double *rest;    // N
    double *slope;   // [columns][rows], N
    double *white;   // both whitened: [1 + columns][rows]
    double *h;       // [columns * columns]
    double  white_N; // rms of the rows' sigmas
};

// Which air counts.
enum part { ALL, BEFORE, AFTER };

// Of noise with the correlation time lasts_s, in blocks of so many points.
static struct mean mean_of(const double lasts_s, const size_t points)
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
    const double block_s = DIG_AIR_STEP_s * (double)points;
    struct mean  to      = { .apart = exp(-block_s / lasts_s) };
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

static bool has_slope(const struct joint *const of, const double slope[])
{
    bool any = false;
    for (size_t i = 0; i < of->rows; i++) {
        any = any || fabs(slope[of->row[i]]) > 0.0;
    }
    return any;
}

static bool is_of(const struct dig_air *const air, const struct dig_air_row *const row,
                  const enum part part)
{
    return part == ALL || air->segment[row->segment].after == (part == AFTER);
}

// Takes the joint's rows and the columns that change them from the lines as last updated.
static struct joint take_joint(const struct dig_lines *const lines, const enum dig_joint which,
                               const enum part part)
{
    const struct dig_air *const air = lines->air;
    struct joint                of  = { .row = lines->joint_row, .rest = lines->joint };
    for (size_t r = 0; r < air->rows; r++) {
        if (air->row[r].joint == which && is_of(air, &air->row[r], part)) {
            of.rest[of.rows]  = lines->work[r] * air->row[r].sigma_N;
            of.row[of.rows++] = r;
            of.white_N += pow(air->row[r].sigma_N, 2.0);
        }
    }
    of.white_N = sqrt(of.white_N / fmax((double)of.rows, 1.0));
    of.slope   = of.rest + of.rows;
    for (size_t c = 0; c < lines->columns; c++) {
        const double *const slope = dig_lines_slope(lines, c);
        if (dig_lines_is_bent(lines, c) || !has_slope(&of, slope)) {
            continue;
        }
        for (size_t i = 0; i < of.rows; i++) {
            of.slope[of.columns * of.rows + i] = slope[of.row[i]] * air->row[of.row[i]].sigma_N;
        }
        of.columns++;
    }
    of.white = of.slope + of.columns * of.rows;
    of.h     = of.white + (1 + of.columns) * of.rows;
    return of;
}

// One of a joint's rows as noise of a size has it: what it shares with the row before, and the
// factor of its covariance, which has one number beside the diagonal once that is taken off.
struct link {
    double shares, beside, root;
};

static struct link link_of(const struct dig_air *const air, const struct joint *const of,
                           const size_t i, const struct mean *const mean, const double size2_N2,
                           const double root_before)
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
static double whiten(const struct dig_air *const air, const struct joint *const of,
                     const struct mean *const mean, const double size2_N2)
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

// -2 log likelihood with noise of variance size2_N2, effects integrated out; mean NULL: without
// noise. Leaves the residuals after effects in the first row of white. O(rows columns^2).
static double misfit_of(const struct dig_air *const air, struct joint *const of,
                        const struct mean *const mean, const double size2_N2)
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

// How alike white rests of blocks up to so many apart are: chi-squared of as many degrees of
// freedom where they are not.
static double alike2(const struct dig_air *const air, const struct joint *const of)
{
    const double variance = dig_product(of->rows, of->white, of->white) / (double)of->rows;
    double       sum      = 0.0;
    for (size_t apart = 1; apart <= LAGS; apart++) {
        double product = 0.0;
        double pairs   = 0.0;
        for (size_t i = apart; i < of->rows; i++) {
            const struct dig_air_row *const a = &air->row[of->row[i - apart]];
            const struct dig_air_row *const b = &air->row[of->row[i]];
            if (a->segment == b->segment && b->first == a->first + apart * b->points) {
                product += of->white[i] * of->white[i - apart] / variance;
                pairs += 1.0;
            }
        }
        sum += product * product / fmax(pairs, 1.0);
    }
    return sum;
}

// What a joint is likeliest by, for each memory.
struct told {
    double misfit[MEMORIES], size2_N2[MEMORIES];
};

// Sizes are tried from the least on while the rows grow likelier.
static void tell(const struct dig_air *const air, struct joint *const of,
                 const struct mean mean[MEMORIES], struct told *const told)
{
    const double none = misfit_of(air, of, NULL, 0.0);
    for (size_t m = 0; m < MEMORIES; m++) {
        double size_N     = least_size * of->white_N / sqrt(mean[m].alone);
        double least      = none;
        double tried      = misfit_of(air, of, &mean[m], size_N * size_N);
        told->misfit[m]   = none;
        told->size2_N2[m] = 0.0;
        for (int i = 0; i < SIZES && tried < least; i++) {
            least = tried;
            if (least + log((double)of->rows) < told->misfit[m]) {
                told->misfit[m]   = least + log((double)of->rows);
                told->size2_N2[m] = size_N * size_N;
            }
            size_N *= size_step;
            tried = misfit_of(air, of, &mean[m], size_N * size_N);
        }
    }
}

// Sizes of the joint's noise dig by dig: digs are louder and quieter, by what it leaves of their
// rows. Of those that are not asked, a mean.
static void write_sizes(const struct dig_lines *const lines, const enum dig_joint which,
                        const struct mean *const mean, const double size2_N2,
                        struct dig_machine_noise *const noise)
{
    const struct dig_air *const air = lines->air;
    struct joint                of  = take_joint(lines, which, ALL);
    (void)misfit_of(air, &of, mean, size2_N2);
    const double all   = dig_product(of.rows, of.white, of.white) / (double)of.rows;
    const double row_N = hypot(of.white_N, sqrt(size2_N2 * mean->alone));
    double       square[DIG_MEASURED_MAX] = { 0.0 };
    double       count[DIG_MEASURED_MAX]  = { 0.0 };
    for (size_t i = 0; i < of.rows; i++) {
        const size_t d = air->segment[air->row[of.row[i]].segment].dig;
        square[d] += of.white[i] * of.white[i];
        count[d] += 1.0;
    }
    for (size_t d = 0; d < DIG_MEASURED_MAX; d++) {
        const double row_N2 =
            count[d] > 0.0 ? row_N * row_N * square[d] / count[d] / all : row_N * row_N;
        const double lasting_N2  = (row_N2 - of.white_N * of.white_N) / mean->alone;
        noise->sigma_N[d][which] = sqrt(fmax(lasting_N2, 0.0));
    }
}

// Whether noise of a joint is noise: nothing of it goes on, and the air before digs is likelier
// with it, and that after them.
static bool is_noise(const struct dig_lines *const lines, const enum dig_joint which,
                     const struct mean *const mean, const double size2_N2)
{
    struct joint of = take_joint(lines, which, ALL);
    (void)misfit_of(lines->air, &of, mean, size2_N2);
    bool is = alike2(lines->air, &of) <= LAGS + alike_sigmas * sqrt(2.0 * LAGS);
    for (int part = BEFORE; part <= AFTER && is; part++) {
        of = take_joint(lines, which, (enum part)part);
        is = of.rows < LEAST ||
             misfit_of(lines->air, &of, mean, size2_N2) < misfit_of(lines->air, &of, NULL, 0.0);
    }
    return is;
}

void dig_machine_noise_tell(struct dig_lines *const lines, const double at[],
                            struct dig_machine_noise *const noise)
{
    assert(lines != NULL && at != NULL && noise != NULL);
    double      stood[DIG_LINES_COLUMNS_MAX];
    struct mean mean[MEMORIES]   = { { .alone = 1.0 } };
    struct told told[DIG_JOINTS] = { { .misfit = { 0.0 } } };
    double      all[MEMORIES]    = { 0.0 };
    size_t      m                = 0;
    *noise                       = (struct dig_machine_noise){ .memory_s = 0.0 };
    memcpy(stood, lines->at, lines->columns * sizeof stood[0]);
    memcpy(lines->at, at, lines->columns * sizeof stood[0]);
    dig_lines_update(lines, DIG_LINES_ALL);
    memcpy(lines->at, stood, lines->columns * sizeof stood[0]);
    for (size_t k = 0; k < MEMORIES && lines->air->rows > 0; k++) {
        mean[k] = mean_of(memory_s[k], lines->air->row[0].points);
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        struct joint of = take_joint(lines, (enum dig_joint)j, ALL);
        if (of.rows >= LEAST) {
            tell(lines->air, &of, mean, &told[j]);
        }
        for (size_t k = 0; k < MEMORIES; k++) {
            all[k] += told[j].misfit[k];
        }
    }
    for (size_t k = 1; k < MEMORIES; k++) {
        m = all[k] < all[m] ? k : m;
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double size2_N2 = told[j].size2_N2[m];
        if (size2_N2 > 0.0 && is_noise(lines, (enum dig_joint)j, &mean[m], size2_N2)) {
            write_sizes(lines, (enum dig_joint)j, &mean[m], size2_N2, noise);
            noise->memory_s = memory_s[m];
            noise->alone    = mean[m].alone;
        }
    }
}

bool dig_machine_noise_widen(const struct dig_machine_noise *const noise, struct dig_air *const air)
{
    assert(noise != NULL && air != NULL);
    bool widened = false;
    for (size_t r = 0; r < air->rows; r++) {
        struct dig_air_row *const row     = &air->row[r];
        const double              block_s = DIG_AIR_STEP_s * (double)row->points;
        const double lasting_N = noise->sigma_N[air->segment[row->segment].dig][row->joint];
        if (lasting_N > 0.0) {
            const double alone_N = hypot(row->sigma_N, lasting_N * sqrt(noise->alone));
            row->sigma_N = hypot(row->sigma_N, lasting_N * sqrt(2.0 * noise->memory_s / block_s));
            row->alone   = alone_N / row->sigma_N;
            widened      = true;
        }
    }
    return widened;
}
