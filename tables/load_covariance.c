#include "tables/load_covariance.h"

#include "tables/derive.h"
#include "tables/store_private.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    BLOCKS  = DIG_COVARIANCE_BLOCKS,
    NUMBERS = DIG_COVARIANCE_NUMBERS,
    POINTS  = DIG_CURVE_POINTS / BLOCKS
};
_Static_assert(POINTS *BLOCKS == DIG_CURVE_POINTS, "blocks are equally long");

// Digs of one gravel along one trajectory: mean, and squares about it (Welford 1962).
struct gravel {
    sqlite3_int64 ground, trajectory;
    double        digs;
    double        mean[NUMBERS];
    double        squares[NUMBERS][NUMBERS];
};

static void take(struct gravel *const g, const double curve[DIG_CHANNELS][DIG_CURVE_POINTS])
{
    double before[NUMBERS];
    double after[NUMBERS];
    g->digs += 1.0;
    for (size_t n = 0; n < NUMBERS; n++) {
        const double *const from = &curve[n / BLOCKS][n % BLOCKS * POINTS];
        double              sum  = 0.0;
        for (size_t k = 0; k < POINTS; k++) {
            sum += from[k];
        }
        before[n] = sum / POINTS - g->mean[n];
        g->mean[n] += before[n] / g->digs;
        after[n] = sum / POINTS - g->mean[n];
    }
    for (size_t i = 0; i < NUMBERS; i++) {
        for (size_t j = 0; j < NUMBERS; j++) {
            g->squares[i][j] += before[i] * after[j];
        }
    }
}

// The size of each channel's curve; false where one is 0.
static bool sizes_of(const struct gravel *const g, double size[DIG_FORCE_CHANNELS])
{
    bool any = true;
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        double square = 0.0;
        for (size_t b = 0; b < BLOCKS; b++) {
            square += g->mean[c * BLOCKS + b] * g->mean[c * BLOCKS + b] / BLOCKS;
        }
        size[c] = sqrt(square);
        any     = any && size[c] > 0.0;
    }
    return any;
}

static void close_gravel(const struct gravel *const g, struct dig_covariance covariance[])
{
    double size[DIG_FORCE_CHANNELS];
    if (g->digs < 2.0 || !sizes_of(g, size)) {
        return;
    }
    struct dig_covariance *const to = &covariance[g->trajectory];
    to->freedom += g->digs - 1.0;
    for (size_t i = 0; i < NUMBERS; i++) {
        for (size_t j = 0; j < NUMBERS; j++) {
            to->of[i][j] += g->squares[i][j] / (size[i / BLOCKS] * size[j / BLOCKS]);
        }
    }
}

// The row a statement stands on, mapped to progress.
static enum dig_status read_run(sqlite3_stmt *const s, const char *const path,
                                const struct dig_table_head *const head,
                                double                  curve[DIG_CHANNELS][DIG_CURVE_POINTS],
                                struct dig_error *const error)
{
    const sqlite3_int64  trajectory = sqlite3_column_int64(s, 1);
    const sqlite3_int64  windows    = sqlite3_column_int64(s, 2);
    const double         first_s    = sqlite3_column_double(s, 3);
    const double         step_s     = sqlite3_column_double(s, 4);
    const uint8_t *const bytes      = sqlite3_column_blob(s, 5);
    if (trajectory < 0 || trajectory >= (sqlite3_int64)head->trajectories || windows < 2 ||
        windows > DIG_WINDOWS_MAX || bytes == NULL ||
        sqlite3_column_bytes(s, 5) != (int)windows * DIG_CHANNELS * 4 || !(step_s > 0.0) ||
        !isfinite(step_s) || !isfinite(first_s)) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: run: expected a trajectory of the table and %d float32 for each "
                             "of its windows",
                             path, DIG_CHANNELS);
    }
    const size_t numbers = (size_t)windows * DIG_CHANNELS;
    float *const value   = malloc(numbers * sizeof *value);
    if (value == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory", path);
    }
    dig_floats_unpack(numbers, bytes, value);
    enum dig_status status = DIG_EINVAL;
    if (dig_channels_sound((size_t)windows, value)) {
        status = dig_derive_run(&head->trajectory[trajectory], head->tooth_m, head->smooth_half_s,
                                (size_t)windows, first_s, step_s, value, curve);
        if (status != DIG_OK) {
            (void)dig_error_set(error, status, "%s: no memory", path);
        }
    } else {
        (void)dig_error_set(error, DIG_EINVAL,
                            "%s: run.curve: a number that is not finite, expected finite ones",
                            path);
    }
    free(value);
    return status;
}

static enum dig_status pool(sqlite3_stmt *const s, const char *const path,
                            const struct dig_table_head *const head,
                            struct dig_covariance covariance[], struct dig_error *const error)
{
    struct gravel   g      = { .ground = -1 };
    enum dig_status status = DIG_OK;
    while (dig_sql_row(s, path, &status, error)) {
        double              curve[DIG_CHANNELS][DIG_CURVE_POINTS] = { { 0.0 } };
        const sqlite3_int64 ground                                = sqlite3_column_int64(s, 0);
        const sqlite3_int64 trajectory                            = sqlite3_column_int64(s, 1);
        status = read_run(s, path, head, curve, error);
        if (status == DIG_OK && (ground != g.ground || trajectory != g.trajectory)) {
            close_gravel(&g, covariance);
            g = (struct gravel){ .ground = ground, .trajectory = trajectory };
        }
        if (status == DIG_OK) {
            take(&g, (const double(*)[DIG_CURVE_POINTS])curve);
        }
    }
    if (status == DIG_OK) {
        close_gravel(&g, covariance);
    }
    return status;
}

enum dig_status dig_sql_load_covariance(sqlite3 *const db, const char *const path,
                                        const struct dig_table_head *const head,
                                        struct dig_curve_set *const        set,
                                        struct dig_error *const            error)
{
    assert(db != NULL && head != NULL && set != NULL && set->covariance == NULL);
    struct dig_covariance *const made = calloc(head->trajectories + 1, sizeof *made);
    if (made == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory for the table", path);
    }
    sqlite3_stmt   *s = NULL;
    enum dig_status status =
        dig_sql_prepare(db, path,
                        "SELECT ground, trajectory, windows, first_s, step_s, curve "
                        "FROM run JOIN ground g ON g.id = run.ground "
                        "WHERE effect = '' AND depth = 1 AND attack_rad = 0 "
                        "ORDER BY ground, trajectory, packing",
                        &s, error);
    if (status == DIG_OK) {
        status = pool(s, path, head, made, error);
    }
    (void)sqlite3_finalize(s);
    if (status != DIG_OK) {
        free(made);
        return status;
    }
    for (size_t t = 0; t < head->trajectories; t++) {
        for (size_t i = 0; i < NUMBERS; i++) {
            for (size_t j = 0; j < NUMBERS; j++) {
                made[t].of[i][j] /= fmax(made[t].freedom, 1.0);
            }
        }
    }
    set->covariance = made;
    return DIG_OK;
}
