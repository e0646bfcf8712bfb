// A table that ships, with what a trace learns of it, for all the tests of a program:
//   TESTS_WITH(shipped_rig_setup, shipped_teardown)

#ifndef DIG_TESTS_SHIPPED_FIXTURE_H
#define DIG_TESTS_SHIPPED_FIXTURE_H

#include "closed_loop/model/soil.h"
#include "closed_loop/recordings/measured.h"
#include "tables/load.h"
#include "tests/testlib.h"

#include <stdlib.h>

#define RIG         "tables/reference_rig.sqlite"
#define RIG_EFFECTS "tables/reference_rig_effects.sqlite"
#define PRODUCT     "tables/product.sqlite"

static struct dig_curve_set        *set;
static struct dig_entry_set        *effects; // NULL: loaded without
static struct dig_response_surface *surface;
static struct dig_scatter          *scatter;
static struct dig_soil             *soil;

static inline int shipped_teardown(void **state)
{
    (void)state;
    free(soil);
    dig_scatter_destroy(scatter);
    free(surface);
    dig_entry_set_destroy(effects);
    dig_curve_set_destroy(set);
    return 0;
}

/// with: the table of its effects, or NULL.
static inline void shipped_load(const char *const table, const char *const with)
{
    struct dig_error error = { "" };
    surface                = calloc(1, sizeof *surface);
    effects                = NULL;
    assert_non_null(surface);
    assert_ok(dig_table_load(table, &set, &error), error);
    if (with != NULL) {
        assert_ok(dig_effects_load(with, set, &effects, &error), error);
    }
    assert_int_equal(dig_response_surface_fit(set, surface), DIG_OK);
    assert_ok(dig_scatter_measure(table, surface, &scatter, &error), error);
    assert_int_equal(dig_soil_create(surface, effects, scatter, &soil), DIG_OK);
}

static inline int shipped_rig_setup(void **state)
{
    (void)state;
    shipped_load(RIG, NULL);
    return 0;
}

static inline int shipped_rig_effects_setup(void **state)
{
    (void)state;
    shipped_load(RIG, RIG_EFFECTS);
    return 0;
}

/// The mean of beds along a trajectory, as one dig.
static inline struct dig_measured shipped_dig(const struct dig_curve *const of, const size_t t)
{
    struct dig_measured dig = {
        .trajectory = (int)t, .use = DIG_USE_FIT, .pass = 1, .pace = 1.0, .last = 1.0
    };
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        dig.measured[c] = true;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            dig.value[c][k] = (double)of->mean[c][k];
        }
    }
    return dig;
}

#endif // DIG_TESTS_SHIPPED_FIXTURE_H
