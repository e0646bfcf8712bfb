// How well a gravel's digs at another approach are told from what other gravels do there, in the
// table that ships: the share that closed_loop/fit/common_error.h takes them to be off by.

#include "closed_loop/fit/common_error.h"
#include "closed_loop/model/approach_change.h"
#include "tests/closed_loop/shipped_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DENSITY 2500.0 // the one that was dug

static int setup(void **state)
{
    (void)state;
    shipped_load(PRODUCT, NULL);
    return 0;
}

// The variance of one dig, mean over the features of a trajectory.
static double variance_of(const size_t t)
{
    double sum = 0.0;
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        sum += scatter->covariance[t][f][f] / DIG_FEATURES;
    }
    return sum;
}

// What an approach adds to a gravel, over its plain dig's size; noise: the variance of that.
static void added_in(const struct dig_curve_set *const in, const size_t t,
                     const struct dig_entry *const entry, double feature[DIG_FEATURES],
                     double *const noise)
{
    struct dig_added added;
    double           place[DIG_AXES];
    double           plain[DIG_FEATURES];
    double           amplitude[DIG_FORCE_CHANNELS];
    assert_int_equal(dig_approach_added(in, t, &entry->gravel, &entry->approach, NULL, &added),
                     DIG_OK);
    dig_response_surface_place(surface, &entry->gravel, place);
    dig_response_surface_features(surface, t, place, plain, amplitude);
    dig_features_of((const double(*)[DIG_CURVE_POINTS])added.value, feature);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        feature[f] /= amplitude[f / DIG_FEATURE_BINS];
    }
    *noise = added.noise * variance_of(t);
}

TEST(others_tell_a_change_but_for_the_share)
{
    const struct dig_entry_set *const all      = set->approaches;
    const size_t                      n        = all->entries * all->trajectories;
    int *const                        packings = malloc(n * sizeof *packings);
    double                            off2     = 0.0;
    double                            whole2   = 0.0;
    size_t                            compared = 0;
    struct dig_entry_set              others   = *all;
    struct dig_curve_set              less     = *set;
    less.approaches                            = &others;
    others.packings                            = packings;
    assert_non_null(packings);
    for (size_t i = 0; i < all->entries; i++) {
        const struct dig_entry *const entry = &all->entry[i];
        if (fabs(entry->gravel.value[DIG_AXIS_DENSITY_kgpm3] - DENSITY) > 0.0) {
            continue;
        }
        memcpy(packings, all->packings, n * sizeof *packings);
        for (size_t k = 0; k < n; k++) {
            const struct dig_gravel *const g = &all->entry[k / all->trajectories].gravel;
            // A gravel of another density is the same digs again.
            const bool same =
                !(fabs(g->value[DIG_AXIS_FRICTION] - entry->gravel.value[DIG_AXIS_FRICTION]) >
                  0.0) &&
                !(fabs(g->value[DIG_AXIS_ROLLING] - entry->gravel.value[DIG_AXIS_ROLLING]) > 0.0);
            packings[k] = same ? 0 : packings[k];
        }
        for (size_t t = 0; t < set->trajectories; t++) {
            double own[DIG_FEATURES];
            double lent[DIG_FEATURES];
            double own_noise;
            double lent_noise;
            if (all->packings[i * all->trajectories + t] == 0) {
                continue;
            }
            added_in(set, t, entry, own, &own_noise);
            added_in(&less, t, entry, lent, &lent_noise);
            assert_true(own_noise > 0.0 && lent_noise > 0.0);
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                // Two gravels lend it.
                off2 += pow(own[f] - lent[f], 2.0) - own_noise - 0.5 * lent_noise;
                whole2 += own[f] * own[f] - own_noise;
            }
            compared++;
        }
    }
    const double share = sqrt(fmax(off2, 0.0) / whole2);
    print_message("%zu digs: what others say is off by %.2f of it\n", compared, share);
    assert_true(compared >= 30);
    assert_close(share, DIG_APPROACH_ERROR, 0.1);
    free(packings);
}

TESTS_WITH(setup, shipped_teardown)
