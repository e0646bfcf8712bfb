// The covariance of digs of one gravel, from the runs of a table.

#include "tables/derive.h"
#include "tables/store_private.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

enum {
    BLOCKS  = DIG_COVARIANCE_BLOCKS,
    NUMBERS = DIG_COVARIANCE_NUMBERS,
    POINTS  = DIG_CURVE_POINTS / BLOCKS
};
_Static_assert(POINTS *BLOCKS == DIG_CURVE_POINTS, "blocks are equally long");

// Digs of one gravel along one trajectory: mean, and squares about it (Welford 1962).
struct gravel {
    struct dig_gravel gravel;
    size_t            trajectory;
    double            digs;
    double            mean[NUMBERS];
    double            squares[NUMBERS][NUMBERS];
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

// Runs under way, gravel by gravel and of each trajectory by trajectory.
struct pool {
    const char                  *path;
    const struct dig_table_head *head;
    struct gravel                of;
    struct dig_covariance       *covariance; // [trajectories]
};

static enum dig_status take_run(void *const context, const struct dig_run *const run,
                                struct dig_error *const error)
{
    struct pool *const                 p                                     = context;
    const struct dig_table_head *const head                                  = p->head;
    const struct dig_run_origin *const o                                     = &run->origin;
    double                             curve[DIG_CHANNELS][DIG_CURVE_POINTS] = { { 0.0 } };
    const enum dig_status              status =
        dig_derive_run(&head->trajectory[o->trajectory], head->tooth_m, head->smooth_half_s,
                       run->windows, run->first_s, run->step_s, run->value, curve);
    if (status != DIG_OK) {
        return dig_error_set(error, status, "%s: no memory", p->path);
    }
    if (!dig_gravel_is_same(&o->gravel, &p->of.gravel) || o->trajectory != p->of.trajectory) {
        close_gravel(&p->of, p->covariance);
        p->of = (struct gravel){ .gravel = o->gravel, .trajectory = o->trajectory };
    }
    take(&p->of, (const double(*)[DIG_CURVE_POINTS])curve);
    return DIG_OK;
}

void dig_sql_load_covariance(struct dig_db *const db, const struct dig_table_head *const head,
                             struct dig_curve_set *const set)
{
    assert(db != NULL && head != NULL && set != NULL && set->covariance == NULL);
    struct dig_covariance *const made = calloc(head->trajectories + 1, sizeof *made);
    if (made == NULL) {
        dig_db_fail(db, DIG_ENOMEM, "no memory for the table");
        return;
    }
    struct pool                  pool    = { .path = db->path, .head = head, .covariance = made };
    const struct dig_run_visitor visitor = { take_run, &pool };
    dig_sql_walk(db, head,
                 "WHERE effect = '' AND depth = 1 AND attack_rad = 0 "
                 "ORDER BY ground, trajectory, packing",
                 &visitor);
    close_gravel(&pool.of, made);
    for (size_t t = 0; t < head->trajectories; t++) {
        for (size_t i = 0; i < NUMBERS; i++) {
            for (size_t j = 0; j < NUMBERS; j++) {
                made[t].of[i][j] /= fmax(made[t].freedom, 1.0);
            }
        }
    }
    set->covariance = made;
}
