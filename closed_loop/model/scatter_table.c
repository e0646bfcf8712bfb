// The scatter of a table's digs, out of its runs.

#include "closed_loop/model/scatter.h"

#include "tables/derive.h"
#include "tables/store.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

enum { PACKINGS_MAX = 64 };

// The runs of one entry as they come, and the residuals of all entries before.
struct gathering {
    const struct dig_response_surface *surface;
    struct dig_run_origin              origin; // of the entry's runs
    size_t                             entries;
    size_t                             packings;
    double                             feature[PACKINGS_MAX][DIG_FEATURES];
    size_t                             residuals;
    struct dig_scatter_residual       *residual;
};

static bool is_same_entry(const struct dig_run_origin *const a,
                          const struct dig_run_origin *const b)
{
    bool same = a->trajectory == b->trajectory;
    for (int i = 0; i < DIG_AXES; i++) {
        same = same && fabs(a->gravel.value[i] - b->gravel.value[i]) <= 0.0;
    }
    return same;
}

// Turns the runs of the entry that is complete into residuals about their mean.
static enum dig_status finish_entry(struct gathering *const g)
{
    if (g->packings == 0) {
        return DIG_OK;
    }
    struct dig_scatter_residual *const grown =
        realloc(g->residual, (g->residuals + g->packings) * sizeof *grown);
    if (grown == NULL) {
        return DIG_ENOMEM;
    }
    g->residual               = grown;
    double mean[DIG_FEATURES] = { 0.0 };
    double amplitude[DIG_FORCE_CHANNELS];
    for (size_t p = 0; p < g->packings; p++) {
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            mean[f] += g->feature[p][f] / (double)g->packings;
        }
    }
    dig_features_amplitude(mean, NULL, amplitude);
    for (size_t p = 0; p < g->packings; p++) {
        struct dig_scatter_residual *const r = &g->residual[g->residuals++];
        r->trajectory                        = g->origin.trajectory;
        r->entry                             = g->entries;
        r->packings                          = g->packings;
        dig_response_surface_place(g->surface, &g->origin.gravel, r->place);
        r->strength =
            log(amplitude[DIG_CHANNEL_MY_Nm] / g->origin.gravel.value[DIG_AXIS_DENSITY_kgpm3]);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            r->value[f] = (g->feature[p][f] - mean[f]) / amplitude[f / DIG_FEATURE_BINS];
        }
    }
    g->entries++;
    g->packings = 0;
    return DIG_OK;
}

static enum dig_status gather(void *const context, const struct dig_run *const run,
                              struct dig_error *const error)
{
    struct gathering *const           g   = context;
    const struct dig_curve_set *const set = g->surface->set;
    if (run->origin.effect[0] != '\0' || !dig_approach_is_plain(&run->origin.approach) ||
        run->origin.trajectory >= set->trajectories) {
        return DIG_OK;
    }
    enum dig_status status = DIG_OK;
    if (g->packings > 0 && !is_same_entry(&g->origin, &run->origin)) {
        status = finish_entry(g);
    }
    if (status == DIG_OK && g->packings < PACKINGS_MAX) {
        double curve[DIG_CHANNELS][DIG_CURVE_POINTS];
        status = dig_derive_run(&set->trajectory[run->origin.trajectory], set->tooth_m,
                                set->smooth_half_s, run->windows, run->first_s, run->step_s,
                                run->value, curve);
        dig_features_of((const double(*)[DIG_CURVE_POINTS])curve, g->feature[g->packings]);
        g->packings++;
        g->origin = run->origin;
    }
    return status == DIG_OK ? status : dig_error_set(error, status, "%s", dig_status_str(status));
}

enum dig_status dig_scatter_measure(const char *const                        path,
                                    const struct dig_response_surface *const surface,
                                    struct dig_scatter **const               scatter,
                                    struct dig_error *const                  error)
{
    assert(path != NULL && surface != NULL && scatter != NULL);
    struct dig_store *store  = NULL;
    struct gathering  g      = { .surface = surface };
    enum dig_status   status = dig_store_open(path, &store, error);
    if (status == DIG_OK) {
        const struct dig_run_visitor visitor = { gather, &g };
        status                               = dig_store_walk(store, &visitor, error);
    }
    if (status == DIG_OK) {
        status = finish_entry(&g);
    }
    if (status == DIG_OK) {
        status = dig_scatter_pool(surface, g.residuals, g.residual, scatter);
    }
    if (status == DIG_ENOMEM) {
        (void)dig_error_set(error, status, "%s: no memory", path);
    }
    dig_store_close(store);
    free(g.residual);
    return status;
}
