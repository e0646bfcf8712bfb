// The runs of a table's plain digs along one trajectory, for programs that leave out one at a time.

#ifndef DIG_TESTS_BENCH_TABLE_RUNS_H
#define DIG_TESTS_BENCH_TABLE_RUNS_H

#include "core/error.h"
#include "estimator/track/observation.h"
#include "tables/derive.h"
#include "tables/load.h"
#include "tables/store.h"

#include <string.h>

enum { TABLE_RUNS_MAX = 400 };

struct table_run {
    size_t entry;
    double value[DIG_CHANNELS][DIG_CURVE_POINTS];
};

struct table_runs {
    struct dig_curve_set *set;
    size_t                trajectory, runs;
    struct table_run      run[TABLE_RUNS_MAX];
};

static inline enum dig_status table_runs_take(void *const context, const struct dig_run *const run,
                                              struct dig_error *const error)
{
    struct table_runs *const all = context;
    if (run->origin.trajectory != all->trajectory || run->origin.effect[0] != '\0' ||
        !dig_approach_is_plain(&run->origin.approach)) {
        return DIG_OK;
    }
    if (all->runs == TABLE_RUNS_MAX) {
        return dig_error_set(error, DIG_EINVAL, "more than %d runs", TABLE_RUNS_MAX);
    }
    struct table_run *const one = &all->run[all->runs++];
    for (size_t e = 0; e < all->set->entries; e++) {
        if (memcmp(&all->set->gravel[e], &run->origin.gravel, sizeof run->origin.gravel) == 0) {
            one->entry = e;
        }
    }
    return dig_derive_run(&all->set->trajectory[all->trajectory], all->set->tooth_m,
                          all->set->smooth_half_s, run->windows, run->first_s, run->step_s,
                          run->value, one->value);
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

/// Loads a table and its runs. Free set with dig_curve_set_destroy(), after a failure too.
static inline enum dig_status table_runs_read(const char *const path, const char *const trajectory,
                                              struct table_runs *const all,
                                              struct dig_error *const  error)
{
    struct dig_store *store  = NULL;
    enum dig_status   status = dig_table_load(path, &all->set, error);
    if (status == DIG_OK) {
        all->trajectory = table_runs_trajectory(all->set, trajectory);
        status          = all->trajectory < all->set->trajectories
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

/// The run as a whole dig was observed, without noise; by its moment alone unless forces is set.
static inline struct dig_observation table_run_observed(const struct table_runs *const all,
                                                        const struct table_run *const  run)
{
    struct dig_observation dig = { .dig_count  = 1,
                                   .trajectory = (int)all->trajectory,
                                   .last       = 1.0 };
    memcpy(dig.moment_Nm, run->value[0], sizeof dig.moment_Nm);
    memcpy(dig.force_N, run->value[1], sizeof dig.force_N);
    return dig;
}

#endif // DIG_TESTS_BENCH_TABLE_RUNS_H
