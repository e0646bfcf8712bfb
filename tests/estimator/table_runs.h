// The plain digs behind a table, one by one, for tests that judge by them what the table tells.

#ifndef DIG_TESTS_TABLE_RUNS_H
#define DIG_TESTS_TABLE_RUNS_H

#include "core/curve.h"
#include "tables/derive.h"
#include "tables/load.h"
#include "tables/store.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

enum { TABLE_RUNS_MAX = 800 };

struct table_run {
    size_t slot; // entry * trajectories + trajectory
    double value[DIG_CHANNELS][DIG_CURVE_POINTS];
};

struct table_runs {
    struct dig_curve_set *set;
    size_t                runs;
    struct table_run      run[TABLE_RUNS_MAX];
};

static enum dig_status table_runs_take(void *const context, const struct dig_run *const run,
                                       struct dig_error *const error)
{
    (void)error;
    struct table_runs *const    t   = context;
    const struct dig_curve_set *set = t->set;
    if (run->origin.effect[0] != '\0' || !dig_approach_is_plain(&run->origin.approach)) {
        return DIG_OK;
    }
    assert_true(t->runs < TABLE_RUNS_MAX);
    struct table_run *const one   = &t->run[t->runs++];
    size_t                  entry = 0;
    while (memcmp(&set->gravel[entry], &run->origin.gravel, sizeof run->origin.gravel) != 0) {
        entry++;
        assert_true(entry < set->entries);
    }
    one->slot = entry * set->trajectories + run->origin.trajectory;
    return dig_derive_run(&set->trajectory[run->origin.trajectory], set->tooth_m,
                          set->smooth_half_s, run->windows, run->first_s, run->step_s, run->value,
                          one->value);
}

/// Owned by the caller; table_runs_destroy().
static inline struct table_runs *table_runs_read(const char *const path)
{
    struct table_runs *const t     = calloc(1, sizeof *t);
    struct dig_store        *store = NULL;
    assert_non_null(t);
    assert_int_equal(dig_table_load(path, &t->set, NULL), DIG_OK);
    assert_int_equal(dig_store_open(path, &store, NULL), DIG_OK);
    const struct dig_run_visitor visitor = { table_runs_take, t };
    assert_int_equal(dig_store_walk(store, &visitor, NULL), DIG_OK);
    dig_store_close(store);
    return t;
}

static inline void table_runs_destroy(struct table_runs *const t)
{
    dig_curve_set_destroy(t->set);
    free(t);
}

/// What the table would hold had one of its runs not been dug.
static inline void table_runs_without(const struct table_runs *const t, const size_t left,
                                      struct dig_curve *const curve)
{
    static struct dig_ensemble ensemble;
    memset(&ensemble, 0, sizeof ensemble);
    for (size_t i = 0; i < t->runs; i++) {
        if (i != left && t->run[i].slot == t->run[left].slot) {
            dig_ensemble_add(&ensemble, (const double(*)[DIG_CURVE_POINTS])t->run[i].value);
        }
    }
    dig_ensemble_curve(&ensemble, curve);
}

#endif // DIG_TESTS_TABLE_RUNS_H
