// Whether the derived rows of a table still are what its runs say.

#include "tables/load.h"
#include "tables/store.h"
#include "tables/store_private.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

// Of the curve's largest value: another compiler may round the last bits otherwise.
#define AGREE_RELATIVE 1e-5

// a and b hold DIG_CHANNELS curves each.
static bool agree(const float a[], const float b[])
{
    for (size_t c = 0; c < DIG_CHANNELS; c++) {
        double most = 0.0, off = 0.0;
        for (size_t i = c * DIG_CURVE_POINTS; i < (c + 1) * DIG_CURVE_POINTS; i++) {
            most = fmax(most, fabs((double)b[i]));
            off  = fmax(off, fabs((double)a[i] - (double)b[i]));
        }
        if (!(off <= AGREE_RELATIVE * most)) {
            return false;
        }
    }
    return true;
}

static enum dig_status check_entry(struct dig_store *const           store,
                                   const struct dig_curve_set *const set, const size_t entry,
                                   const size_t trajectory, struct dig_error *const error)
{
    const size_t                   at       = entry * set->trajectories + trajectory;
    const struct dig_gravel *const gravel   = &set->gravel[entry];
    sqlite3_int64                  id       = 0;
    struct dig_ensemble *const     ensemble = calloc(1, sizeof *ensemble);
    struct dig_curve *const        curve    = calloc(1, sizeof *curve);
    enum dig_status                status   = ensemble != NULL && curve != NULL
                                                  ? dig_gravel_find(store, gravel, &id, error)
                                                  : dig_error_set(error, DIG_ENOMEM, "%s: no memory", store->path);
    if (status == DIG_OK) {
        status = dig_entry_derive(store, id, trajectory, ensemble, error);
    }
    if (status == DIG_OK) {
        dig_ensemble_curve(ensemble, curve);
        const struct dig_curve *const stored = &set->curve[at];
        const bool                    same   = (size_t)set->packings[at] == ensemble->packings &&
                          agree(&stored->mean[0][0], &curve->mean[0][0]) &&
                          (ensemble->packings == 1 || agree(&stored->sd[0][0], &curve->sd[0][0]));
        if (ensemble->packings > 0 && !same) {
            status =
                dig_error_set(error, DIG_EINVAL,
                              "%s: entry: friction %g, rolling %g, %g kg/m3 on %s: differs "
                              "from its %zu runs, expected their mean and spread",
                              store->path, gravel->value[0], gravel->value[1], gravel->value[2],
                              set->trajectory[trajectory].name, ensemble->packings);
        } else if (ensemble->packings == 0 && set->packings[at] > 0) {
            status =
                dig_error_set(error, DIG_EINVAL,
                              "%s: entry: friction %g, rolling %g, %g kg/m3 on %s: has no run, "
                              "expected %d",
                              store->path, gravel->value[0], gravel->value[1], gravel->value[2],
                              set->trajectory[trajectory].name, set->packings[at]);
        }
    }
    free(ensemble);
    free(curve);
    return status;
}

static struct dig_store_report count(const struct dig_curve_set *const set)
{
    struct dig_store_report report                   = { .points = set->entries };
    int                     most                     = 0;
    size_t                  cells                    = 1;
    bool                    used[DIG_TRAJECTORY_MAX] = { false };
    for (int a = 0; a < DIG_AXES; a++) {
        cells *= set->axis_count[a];
    }
    for (size_t i = 0; i < set->entries * set->trajectories; i++) {
        report.entries += set->packings[i] > 0;
        report.runs += (size_t)set->packings[i];
        most = set->packings[i] > most ? set->packings[i] : most;
        used[i % set->trajectories] |= set->packings[i] > 0;
    }
    // A trajectory no gravel was dug with is not missing: the grid did not ask for it.
    for (size_t i = 0; i < set->entries * set->trajectories; i++) {
        report.incomplete += used[i % set->trajectories] && set->packings[i] < most;
    }
    for (size_t i = 0; i < cells; i++) {
        report.holes += set->cell[i] < 0;
    }
    return report;
}

enum dig_status dig_store_check(struct dig_store *const        store,
                                struct dig_store_report *const report,
                                struct dig_error *const        error)
{
    assert(store != NULL && report != NULL);

    // One transaction: a writer may be adding runs.
    enum dig_status status = dig_sql_run(store->db, store->path, "BEGIN", error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_curve_set *set = NULL;
    status                    = dig_sql_load(store->db, store->path, &store->head, &set, error);
    for (size_t e = 0; status == DIG_OK && e < set->entries; e++) {
        for (size_t t = 0; status == DIG_OK && t < set->trajectories; t++) {
            status = check_entry(store, set, e, t, error);
        }
    }
    (void)sqlite3_exec(store->db, "ROLLBACK", NULL, NULL, NULL);
    if (status == DIG_OK) {
        *report = count(set);
    }
    dig_curve_set_destroy(set);
    return status;
}
