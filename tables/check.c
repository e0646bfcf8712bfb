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
        double most = 0.0;
        double off  = 0.0;
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

// Room for one entry computed anew.
struct scratch {
    struct dig_ensemble ensemble;
    struct dig_curve    curve;
};

static enum dig_status check_entry(struct dig_store *const           store,
                                   const struct dig_curve_set *const set, const size_t entry,
                                   const size_t trajectory, struct scratch *const scratch,
                                   struct dig_error *const error)
{
    const size_t                   at     = entry * set->trajectories + trajectory;
    const struct dig_gravel *const gravel = &set->gravel[entry];
    sqlite3_int64                  id     = 0;
    enum dig_status                status = dig_gravel_find(store, gravel, &id, error);
    if (status == DIG_OK) {
        status = dig_entry_derive(store, id, trajectory, &scratch->ensemble, error);
    }
    if (status != DIG_OK) {
        return status;
    }
    const size_t runs = scratch->ensemble.packings;
    dig_ensemble_curve(&scratch->ensemble, &scratch->curve);
    const struct dig_curve *const stored = &set->curve[at];
    const struct dig_curve *const actual = &scratch->curve;
    const bool                    same   = (size_t)set->packings[at] == runs &&
                      (runs == 0 || agree(&stored->mean[0][0], &actual->mean[0][0])) &&
                      (runs < 2 || agree(&stored->sd[0][0], &actual->sd[0][0]));
    if (!same) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: entry: friction %g, rolling %g, %g kg/m3 on %s: of %d packings, "
                             "differs from its %zu runs, expected their mean and spread",
                             store->path, gravel->value[0], gravel->value[1], gravel->value[2],
                             set->trajectory[trajectory].name, set->packings[at], runs);
    }
    return DIG_OK;
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
    struct dig_curve_set *set     = NULL;
    struct scratch *const scratch = calloc(1, sizeof *scratch);
    if (scratch == NULL) {
        status = dig_error_set(error, DIG_ENOMEM, "%s: no memory", store->path);
    } else {
        status = dig_sql_load(store->db, store->path, &store->head, &set, error);
    }
    for (size_t e = 0; status == DIG_OK && set != NULL && e < set->entries; e++) {
        for (size_t t = 0; status == DIG_OK && t < set->trajectories; t++) {
            status = check_entry(store, set, e, t, scratch, error);
        }
    }
    free(scratch);
    (void)sqlite3_exec(store->db, "ROLLBACK", NULL, NULL, NULL);
    if (status == DIG_OK && set != NULL) {
        *report = count(set);
    }
    dig_curve_set_destroy(set);
    return status;
}
