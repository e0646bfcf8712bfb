#include "closed_loop/machine/machine_noise.h"

#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
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

// Rows are means over blocks of readings that are means over a kernel: noise of a variance of 1 in
// the mean of a block, and in two neighbours' product over how alike the noise is a block apart.
struct averaged {
    double alone, shared;
    double apart; // how alike noise is a block apart
};

static struct averaged average(const double lasts_s, const size_t points)
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
    const double    block_s = DIG_AIR_STEP_s * (double)points;
    struct averaged to      = { .apart = exp(-block_s / lasts_s) };
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

// The rows of one joint, in their order, and what they are told by.
struct joint {
    size_t  rows, columns;
    size_t *row;
    double *rest;    // N
    double *slope;   // [columns][rows], N
    double *white;   // both with noise taken off: [1 + columns][rows]
    double *h;       // [columns * columns]
    double  white_N; // rms of the rows' sigmas
};

static void joint_finish(struct joint *const of)
{
    free(of->row);
    free(of->rest);
    *of = (struct joint){ .rows = 0 };
}

static bool has_slope(const struct joint *const of, const double slope[])
{
    bool any = false;
    for (size_t i = 0; i < of->rows; i++) {
        any = any || fabs(slope[of->row[i]]) > 0.0;
    }
    return any;
}

// Which air is asked.
enum part { PART_ALL, PART_BEFORE, PART_AFTER };

static bool is_of(const struct dig_air *const air, const struct dig_air_row *const row,
                  const enum part part)
{
    return part == PART_ALL || air->segment[row->segment].after == (part == PART_AFTER);
}

// Takes the joint's rows and the columns that change them from the lines as last updated. what is
// left of the rows: rest[rows of the air], in their sigmas.
static enum dig_status joint_make(const struct dig_lines *const lines, const double rest[],
                                  const enum dig_joint which, const enum part part,
                                  struct joint *const of)
{
    const struct dig_air *const air = lines->air;
    const size_t                n   = lines->columns;
    *of = (struct joint){ .row = malloc((air->rows + 1) * sizeof *of->row) };
    for (size_t r = 0; r < air->rows && of->row != NULL; r++) {
        if (air->row[r].joint == which && is_of(air, &air->row[r], part)) {
            of->row[of->rows++] = r;
            of->white_N += pow(air->row[r].sigma_N, 2.0);
        }
    }
    of->rest = malloc(((2 * n + 2) * (of->rows + 1) + n * n) * sizeof *of->rest);
    if (of->row == NULL || of->rest == NULL) {
        joint_finish(of);
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

static struct link link_of(const struct dig_air *const air, const struct joint *const of,
                           const size_t i, const struct averaged *const mean, const double size2_N2,
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
                     const struct averaged *const mean, const double size2_N2)
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

// -2 log likelihood with noise of that size, effects integrated out; leaves what they leave of the
// white rests there.
static double misfit(const struct dig_air *const air, struct joint *const of,
                     const struct averaged *const mean, const double size2_N2)
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
                 const struct averaged mean[MEMORIES], struct told *const told)
{
    const double none = misfit(air, of, NULL, 0.0);
    for (size_t m = 0; m < MEMORIES; m++) {
        double size_N     = least_size * of->white_N / sqrt(mean[m].alone);
        double least      = none;
        double tried      = misfit(air, of, &mean[m], size_N * size_N);
        told->misfit[m]   = none;
        told->size2_N2[m] = 0.0;
        for (int i = 0; i < SIZES && tried < least; i++) {
            least = tried;
            if (least + log((double)of->rows) < told->misfit[m]) {
                told->misfit[m]   = least + log((double)of->rows);
                told->size2_N2[m] = size_N * size_N;
            }
            size_N *= size_step;
            tried = misfit(air, of, &mean[m], size_N * size_N);
        }
    }
}

static enum dig_status tell_all(struct dig_lines *const lines, struct joint of[DIG_JOINTS],
                                struct averaged mean[MEMORIES], size_t *const memory,
                                double size2_N2[DIG_JOINTS])
{
    const struct dig_air *const air              = lines->air;
    double                      all[MEMORIES]    = { 0.0 };
    struct told                 told[DIG_JOINTS] = { { .misfit = { 0.0 } } };
    enum dig_status             status           = DIG_OK;
    for (size_t m = 0; m < MEMORIES && air->rows > 0; m++) {
        mean[m] = average(memory_s[m], air->row[0].points);
    }
    for (int j = 0; j < DIG_JOINTS && status == DIG_OK; j++) {
        status = joint_make(lines, lines->work, (enum dig_joint)j, PART_ALL, &of[j]);
        if (status == DIG_OK && of[j].rows >= LEAST) {
            tell(air, &of[j], mean, &told[j]);
        }
        for (size_t m = 0; m < MEMORIES; m++) {
            all[m] += told[j].misfit[m];
        }
    }
    *memory = 0;
    for (size_t m = 1; m < MEMORIES; m++) {
        *memory = all[m] < all[*memory] ? m : *memory;
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        size2_N2[j] = told[j].size2_N2[*memory];
    }
    return status;
}

// Sizes of the joint's noise dig by dig: digs are louder and quieter, by what it leaves of their
// rows. Of those that are not asked, a mean.
static void write_sizes(const struct dig_air *const air, const struct joint *const of,
                        const enum dig_joint joint, const struct averaged *const mean,
                        const double size2_N2, struct dig_machine_noise *const noise)
{
    const double all   = dig_product(of->rows, of->white, of->white) / (double)of->rows;
    const double row_N = hypot(of->white_N, sqrt(size2_N2 * mean->alone));
    double       square[DIG_MEASURED_MAX] = { 0.0 };
    double       count[DIG_MEASURED_MAX]  = { 0.0 };
    for (size_t i = 0; i < of->rows; i++) {
        const size_t d = air->segment[air->row[of->row[i]].segment].dig;
        square[d] += of->white[i] * of->white[i];
        count[d] += 1.0;
    }
    for (size_t d = 0; d < DIG_MEASURED_MAX; d++) {
        const double row_N2 =
            count[d] > 0.0 ? row_N * row_N * square[d] / count[d] / all : row_N * row_N;
        const double lasting_N2  = (row_N2 - of->white_N * of->white_N) / mean->alone;
        noise->sigma_N[d][joint] = sqrt(fmax(lasting_N2, 0.0));
    }
}

// Whether noise of a joint is noise: nothing of it goes on, and the air before digs is likelier
// with it, and that after them.
static enum dig_status confirm(const struct dig_lines *const lines, struct joint *const of,
                               const enum dig_joint joint, const struct averaged *const mean,
                               const double size2_N2, bool *const is_noise)
{
    enum dig_status status = DIG_OK;
    (void)misfit(lines->air, of, mean, size2_N2);
    *is_noise = alike2(lines->air, of) <= LAGS + alike_sigmas * sqrt(2.0 * LAGS);
    for (int part = PART_BEFORE; part <= PART_AFTER && *is_noise && status == DIG_OK; part++) {
        struct joint some;
        status = joint_make(lines, lines->work, joint, (enum part)part, &some);
        if (status == DIG_OK && some.rows >= LEAST) {
            *is_noise =
                misfit(lines->air, &some, mean, size2_N2) < misfit(lines->air, &some, NULL, 0.0);
        }
        joint_finish(&some);
    }
    return status;
}

enum dig_status dig_machine_noise_tell(struct dig_lines *const lines, const double at[],
                                       struct dig_machine_noise *const noise)
{
    assert(lines != NULL && at != NULL && noise != NULL);
    double          stood[DIG_LINES_COLUMNS_MAX];
    struct joint    of[DIG_JOINTS]       = { { .rows = 0 } };
    struct averaged mean[MEMORIES]       = { { .alone = 1.0 } };
    double          size2_N2[DIG_JOINTS] = { 0.0 };
    size_t          m                    = 0;
    *noise                               = (struct dig_machine_noise){ .memory_s = 0.0 };
    memcpy(stood, lines->at, lines->columns * sizeof stood[0]);
    memcpy(lines->at, at, lines->columns * sizeof stood[0]);
    dig_lines_update(lines, DIG_MACHINE_ALL_EFFECTS | DIG_LINES_OF_FILE);
    memcpy(lines->at, stood, lines->columns * sizeof stood[0]);
    enum dig_status status = tell_all(lines, of, mean, &m, size2_N2);
    for (int j = 0; j < DIG_JOINTS && status == DIG_OK; j++) {
        bool is_noise = false;
        if (size2_N2[j] > 0.0) {
            status = confirm(lines, &of[j], (enum dig_joint)j, &mean[m], size2_N2[j], &is_noise);
        }
        if (is_noise) {
            (void)misfit(lines->air, &of[j], &mean[m], size2_N2[j]);
            write_sizes(lines->air, &of[j], (enum dig_joint)j, &mean[m], size2_N2[j], noise);
            noise->memory_s = memory_s[m];
            noise->alone    = mean[m].alone;
        }
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        joint_finish(&of[j]);
    }
    return status;
}

bool dig_machine_noise_widen(struct dig_lines *const lines, const double at[])
{
    assert(lines != NULL);
    struct dig_machine_noise noise;
    bool                     widened = false;
    if (dig_machine_noise_tell(lines, at, &noise) != DIG_OK) {
        return false;
    }
    for (size_t r = 0; r < lines->air->rows; r++) {
        struct dig_air_row *const row     = &lines->air->row[r];
        const double              block_s = DIG_AIR_STEP_s * (double)row->points;
        const double lasting_N = noise.sigma_N[lines->air->segment[row->segment].dig][row->joint];
        if (lasting_N > 0.0) {
            const double alone_N = hypot(row->sigma_N, lasting_N * sqrt(noise.alone));
            row->sigma_N = hypot(row->sigma_N, lasting_N * sqrt(2.0 * noise.memory_s / block_s));
            row->alone   = alone_N / row->sigma_N;
            widened      = true;
        }
    }
    return widened;
}
