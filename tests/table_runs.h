// The runs of a table's plain digs, for tests and benches that leave out one at a time.

#ifndef DIG_TESTS_TABLE_RUNS_H
#define DIG_TESTS_TABLE_RUNS_H

#include "core/error.h"
#include "core/observation.h"
#include "core/outline.h"
#include "tables/derive.h"
#include "tables/load.h"
#include "tables/store.h"

#include <math.h>
#include <string.h>

enum { TABLE_RUNS_MAX = 800 };

struct table_run {
    size_t entry, trajectory;
    double value[DIG_CHANNELS][DIG_CURVE_POINTS];
};

struct table_runs {
    struct dig_curve_set *set;
    size_t                trajectory; // the one whose runs were read; their number: all
    size_t                runs;
    struct table_run      run[TABLE_RUNS_MAX];
};

static inline enum dig_status table_runs_take(void *const context, const struct dig_run *const run,
                                              struct dig_error *const error)
{
    struct table_runs *const          all = context;
    const struct dig_curve_set *const set = all->set;
    const size_t                      on  = run->origin.trajectory;
    if ((all->trajectory < set->trajectories && all->trajectory != on) ||
        run->origin.effect[0] != '\0' || !dig_approach_is_plain(&run->origin.approach)) {
        return DIG_OK;
    }
    if (all->runs == TABLE_RUNS_MAX) {
        return dig_error_set(error, DIG_EINVAL, "more than %d runs", TABLE_RUNS_MAX);
    }
    struct table_run *const one = &all->run[all->runs++];
    one->trajectory             = on;
    for (size_t e = 0; e < set->entries; e++) {
        if (memcmp(&set->gravel[e], &run->origin.gravel, sizeof run->origin.gravel) == 0) {
            one->entry = e;
        }
    }
    return dig_derive_run(&set->trajectory[on], set->tooth_m, set->smooth_half_s, run->windows,
                          run->first_s, run->step_s, run->value, one->value);
}

/// The index of the trajectory of that name; their number when there is none.
static inline size_t table_runs_trajectory(const struct dig_curve_set *const set,
                                           const char *const                 name)
{
    size_t t = 0;
    while (t < set->trajectories && strcmp(set->trajectory[t].name, name) != 0) {
        t++;
    }
    return t;
}

/// Loads a table and its runs along the trajectory of that name, or with NULL along all. Free set
/// with dig_curve_set_destroy(), after a failure too.
static inline enum dig_status table_runs_read(const char *const path, const char *const trajectory,
                                              struct table_runs *const all,
                                              struct dig_error *const  error)
{
    struct dig_store *store  = NULL;
    enum dig_status   status = dig_table_load(path, &all->set, error);
    if (status == DIG_OK) {
        all->trajectory = trajectory != NULL ? table_runs_trajectory(all->set, trajectory)
                                             : all->set->trajectories;
        status          = trajectory == NULL || all->trajectory < all->set->trajectories
                              ? dig_store_open(path, &store, error)
                              : dig_error_set(error, DIG_EINVAL, "no trajectory %s", trajectory);
    }
    if (status == DIG_OK) {
        const struct dig_run_visitor visitor = { table_runs_take, all };
        status                               = dig_store_walk(store, &visitor, error);
    }
    dig_store_close(store);
    return status;
}

/// The place of a run's entry in the table's curves and packings.
static inline size_t table_run_slot(const struct table_runs *const all,
                                    const struct table_run *const  run)
{
    return run->entry * all->set->trajectories + run->trajectory;
}

/// Makes *curve, the entry of a run, what it would be without the run; a single packing keeps the
/// entry's spread. Returns how many packings are left; with none *curve stays.
static inline size_t table_runs_without(const struct table_runs *const all, const size_t left,
                                        struct dig_curve *const curve)
{
    static struct dig_ensemble rest;
    const size_t               slot  = table_run_slot(all, &all->run[left]);
    const struct dig_curve     whole = *curve;
    memset(&rest, 0, sizeof rest);
    for (size_t i = 0; i < all->runs; i++) {
        if (i != left && table_run_slot(all, &all->run[i]) == slot) {
            dig_ensemble_add(&rest, (const double(*)[DIG_CURVE_POINTS])all->run[i].value);
        }
    }
    if (rest.packings > 0) {
        dig_ensemble_curve(&rest, curve);
    }
    if (rest.packings == 1) {
        memcpy(curve->sd, whole.sd, sizeof curve->sd);
    }
    return rest.packings;
}

/// Shows each run whose entry has others to visit(), while the entry is what it would be without
/// it.
static inline void table_runs_leave_out_each(struct table_runs *const all,
                                             void (*const visit)(void                   *context,
                                                                 const struct table_run *left),
                                             void *const context)
{
    for (size_t i = 0; i < all->runs; i++) {
        const size_t            slot  = table_run_slot(all, &all->run[i]);
        struct dig_curve *const curve = &all->set->curve[slot];
        const struct dig_curve  whole = *curve;
        if (table_runs_without(all, i, curve) > 0) {
            all->set->packings[slot]--;
            dig_outlines_draw(all->set);
            visit(context, &all->run[i]);
            all->set->packings[slot]++;
            *curve = whole;
        }
    }
}

/// How far a moment is off the truth's, relative.
static inline double table_runs_off(const struct dig_curve *const is,
                                    const struct dig_curve *const truth)
{
    double miss2 = 0.0, whole2 = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double t = (double)truth->mean[DIG_CHANNEL_MY_Nm][k];
        miss2 += pow((double)is->mean[DIG_CHANNEL_MY_Nm][k] - t, 2.0);
        whole2 += t * t;
    }
    return sqrt(miss2 / whole2);
}

/// The run as a whole dig was observed, without noise; by its moment alone unless forces is set.
static inline struct dig_observation table_run_observed(const struct table_run *const run)
{
    struct dig_observation dig = { .dig_count  = 1,
                                   .trajectory = (int)run->trajectory,
                                   .last       = 1.0 };
    memcpy(dig.moment_Nm, run->value[0], sizeof dig.moment_Nm);
    memcpy(dig.force_N, run->value[1], sizeof dig.force_N);
    return dig;
}

#endif // DIG_TESTS_TABLE_RUNS_H
