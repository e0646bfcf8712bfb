#include "closed_loop/machine/machine_noise.h"

#include "closed_loop/machine/joint_rows.h"
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

// How alike white rests of blocks up to so many apart are: chi-squared of as many degrees of
// freedom where they are not.
static double alike2(const struct dig_air *const air, const struct dig_joint_rows *const of)
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
static void tell(const struct dig_air *const air, struct dig_joint_rows *const of,
                 const struct dig_noise_mean mean[MEMORIES], struct told *const told)
{
    const double none = dig_joint_rows_misfit(air, of, NULL, 0.0);
    for (size_t m = 0; m < MEMORIES; m++) {
        double size_N     = least_size * of->white_N / sqrt(mean[m].alone);
        double least      = none;
        double tried      = dig_joint_rows_misfit(air, of, &mean[m], size_N * size_N);
        told->misfit[m]   = none;
        told->size2_N2[m] = 0.0;
        for (int i = 0; i < SIZES && tried < least; i++) {
            least = tried;
            if (least + log((double)of->rows) < told->misfit[m]) {
                told->misfit[m]   = least + log((double)of->rows);
                told->size2_N2[m] = size_N * size_N;
            }
            size_N *= size_step;
            tried = dig_joint_rows_misfit(air, of, &mean[m], size_N * size_N);
        }
    }
}

static enum dig_status tell_all(struct dig_lines *const lines, struct dig_joint_rows of[DIG_JOINTS],
                                struct dig_noise_mean mean[MEMORIES], size_t *const memory,
                                double size2_N2[DIG_JOINTS])
{
    const struct dig_air *const air              = lines->air;
    double                      all[MEMORIES]    = { 0.0 };
    struct told                 told[DIG_JOINTS] = { { .misfit = { 0.0 } } };
    enum dig_status             status           = DIG_OK;
    for (size_t m = 0; m < MEMORIES && air->rows > 0; m++) {
        mean[m] = dig_noise_mean_of(memory_s[m], air->row[0].points);
    }
    for (int j = 0; j < DIG_JOINTS && status == DIG_OK; j++) {
        status = dig_joint_rows_make(lines, lines->work, (enum dig_joint)j, DIG_AIR_ALL, &of[j]);
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
static void write_sizes(const struct dig_air *const air, const struct dig_joint_rows *const of,
                        const enum dig_joint joint, const struct dig_noise_mean *const mean,
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
static enum dig_status confirm(const struct dig_lines *const lines, struct dig_joint_rows *const of,
                               const enum dig_joint joint, const struct dig_noise_mean *const mean,
                               const double size2_N2, bool *const is_noise)
{
    enum dig_status status = DIG_OK;
    (void)dig_joint_rows_misfit(lines->air, of, mean, size2_N2);
    *is_noise = alike2(lines->air, of) <= LAGS + alike_sigmas * sqrt(2.0 * LAGS);
    for (int part = DIG_AIR_BEFORE; part <= DIG_AIR_AFTER && *is_noise && status == DIG_OK;
         part++) {
        struct dig_joint_rows some;
        status = dig_joint_rows_make(lines, lines->work, joint, (enum dig_air_part)part, &some);
        if (status == DIG_OK && some.rows >= LEAST) {
            *is_noise = dig_joint_rows_misfit(lines->air, &some, mean, size2_N2) <
                        dig_joint_rows_misfit(lines->air, &some, NULL, 0.0);
        }
        dig_joint_rows_finish(&some);
    }
    return status;
}

enum dig_status dig_machine_noise_tell(struct dig_lines *const lines, const double at[],
                                       struct dig_machine_noise *const noise)
{
    assert(lines != NULL && at != NULL && noise != NULL);
    double                stood[DIG_LINES_COLUMNS_MAX];
    struct dig_joint_rows of[DIG_JOINTS]       = { { .rows = 0 } };
    struct dig_noise_mean mean[MEMORIES]       = { { .alone = 1.0 } };
    double                size2_N2[DIG_JOINTS] = { 0.0 };
    size_t                m                    = 0;
    *noise                                     = (struct dig_machine_noise){ .memory_s = 0.0 };
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
            (void)dig_joint_rows_misfit(lines->air, &of[j], &mean[m], size2_N2[j]);
            write_sizes(lines->air, &of[j], (enum dig_joint)j, &mean[m], size2_N2[j], noise);
            noise->memory_s = memory_s[m];
            noise->alone    = mean[m].alone;
        }
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        dig_joint_rows_finish(&of[j]);
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
