#include "closed_loop/fit/batch.h"

#include "closed_loop/fit/hypothesis.h"

#include "tests/closed_loop/world_fixture.h"

#include <string.h>

enum { DIGS = 60 };

static const struct dig_gravel gravel = { { 0.6, 0.55, 2500 } };

static struct dig_measured measured[DIGS];
static struct dig_batch    batch;

static void make_batch(void)
{
    uint64_t seed = 3;
    dig_in_turn(DIGS, &gravel, 0, NULL, NULL, &seed, measured);
    batch_digs(DIGS, measured, &gravel, &batch);
}

// One dig scatters by 1 in every direction, in whatever channel and bin.
TEST(digs_of_one_gravel_scatter_by_one)
{
    make_batch();
    assert_int_equal(batch.groups, 2);
    for (size_t g = 0; g < batch.groups; g++) {
        const struct dig_group *const group = &batch.group[g];
        assert_int_equal(group->digs, DIGS / 2);
        assert_int_equal(group->features, DIG_FEATURES);
        const double freedom = (double)(group->features * (group->digs - 1));
        // Five sigma of chi square, and the floor that is in S but not in the digs.
        assert_close(group->about / freedom, 0.97, 5.0 * sqrt(2.0 / freedom) + 0.05);
    }
}

// The variance of a group's digs with such noise about their mean, which is 1 where it is known.
static double scatter_with_noise(const double share, const double memory_s, const size_t g)
{
    uint64_t seed = 9;
    make_batch();
    for (size_t i = 0; i < DIGS; i++) {
        dig_add_noise(share, memory_s, &seed, &measured[i]);
    }
    batch_digs(DIGS, measured, &gravel, &batch);
    const struct dig_group *const group = &batch.group[g];
    const double scatter = group->about / (double)(group->features * (group->digs - 1));
    print_message("%s: %.2f\n", world.set->trajectory[group->trajectory].name, scatter);
    return scatter;
}

// So they do where sensors are loud, at most: that their noise averages over a bin is not counted
// on, which makes it 1.4 to 2.5 times as large.
TEST(digs_with_noise_scatter_by_no_more_than_one)
{
    for (size_t g = 0; g < 2; g++) {
        const double scatter = scatter_with_noise(3.0, 0.0, g);
        assert_true(scatter > 1.0 / 2.7 && scatter < 1.0);
    }
}

// Noise that lasts is counted on as it is, how alike two bins are with it.
TEST(digs_with_noise_that_lasts_scatter_by_one)
{
    const double freedom = (double)DIG_FEATURES * (DIGS / 2 - 1);
    for (size_t g = 0; g < 2; g++) {
        assert_close(scatter_with_noise(0.5, 0.1, g), 1.0, 5.0 * sqrt(2.0 / freedom) + 0.05);
    }
}

TEST(what_the_machine_adds_is_taken_off)
{
    make_batch();
    const struct dig_batch plain = batch;
    for (size_t i = 0; i < DIGS; i++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            measured[i].value[0][k] += 1e-4;
            measured[i].machine[0][k] += 1e-4;
        }
    }
    batch_digs(DIGS, measured, &gravel, &batch);
    for (size_t k = 0; k < DIG_FEATURES; k++) {
        assert_close(batch.group[0].mean[k], plain.group[0].mean[k], 1e-3);
    }
}

// Two digs of thirty were rid of what an approach adds, which two beds know: the mean is off by a
// fifteenth of what that is off by, whatever the digs' number.
TEST(what_approaches_add_is_shared)
{
    make_batch();
    const struct dig_fitted without = fit_plain(&batch);
    assert_close(batch.group[0].added_noise, 0.0, 0.0);
    for (size_t i = 0; i < 4; i += 2) {
        measured[i].added.noise = 0.5;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            measured[i].added.error[0][k] = 0.3;
        }
    }
    batch_digs(DIGS, measured, &gravel, &batch);
    assert_close(batch.group[0].added_noise, 0.5 / 225.0, 1e-12);
    assert_close(batch.group[0].added_error[3], 0.3 / 15.0, 1e-12);
    assert_close(batch.group[0].added_error[DIG_FEATURE_BINS], 0.0, 0.0);
    const struct dig_fitted with       = fit_plain(&batch);
    const double            approaches = dig_common_error_of_approaches(&batch.group[0]);
    assert_close(with.noise[0] - approaches, without.noise[0], 0.02 * without.noise[0]);
    assert_close(dig_common_error_of_approaches(&batch.group[1]), 0.0, 0.0);
    assert_true(with.noise[0] > without.noise[0] + 1.5 * 0.5 / 225.0); // and the share of it
    assert_close(with.noise[1], without.noise[1], 0.01 * without.noise[1]);
}

// Where digs scatter more, what stands for a model shrinks as they do: a model that explained them
// still does.
TEST(digs_and_models_shrink_alike)
{
    make_batch();
    double       feature[DIG_FEATURES];
    double       model[2][DIG_FEATURES];
    double       y[2][DIG_FEATURES];
    const double about       = batch.group[1].about;
    batch.group[1].sensor[3] = 2.0;
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        feature[f] = 0.1 * (double)(f % 7);
    }
    for (int after = 0; after < 2; after++) {
        if (after) {
            dig_batch_spread(&batch, 1.5);
        }
        dig_batch_whiten(&batch.group[1], feature, model[after]);
        memcpy(y[after], batch.group[1].mean, sizeof y[after]);
    }
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        assert_close(1.5 * model[1][f], model[0][f], 1e-9);
        assert_close(1.5 * y[1][f], y[0][f], 1e-9);
    }
    assert_close(1.5 * 1.5 * batch.group[1].about, about, 1e-6);
    assert_close(batch.group[1].sensor[3], 1.5 * 2.0, 1e-12);
}

// Digs that were measured in part are compared in that part; of nothing there is no batch.
TEST(only_what_all_digs_have_is_compared)
{
    make_batch();
    bool take[DIGS];
    memset(take, true, sizeof take);
    measured[0].last        = 0.75;
    measured[2].measured[1] = false;
    batch_digs(DIGS, measured, NULL, &batch);
    assert_int_equal(batch.group[0].features, 2 * 7);
    assert_int_equal(batch.group[1].features, DIG_FEATURES);
    measured[0].last = 0.1;
    assert_int_equal(dig_batch_make(soil, world.scatter, DIGS, measured, take, NULL, &batch),
                     DIG_ENOMATCH);
    memset(take, false, sizeof take);
    assert_int_equal(dig_batch_make(soil, world.scatter, DIGS, measured, take, NULL, &batch),
                     DIG_ENOMATCH);
}

// Against the integral itself: squares of so many normal numbers whose variance is n / chi-squared
// of n, n numbers having told it, over the logarithm of the variance.
static double integrated(const double known, const double numbers, const double squares)
{
    enum { CELLS = 4000 };
    double most = -INFINITY;
    double log_density[CELLS];
    double sum = 0.0;
    for (int i = 0; i < CELLS; i++) {
        const double variance = exp(-6.0 + 12.0 * (i + 0.5) / CELLS);
        log_density[i] =
            -0.5 * (known + numbers) * log(variance) - 0.5 * (known + squares) / variance;
        most = fmax(most, log_density[i]);
    }
    for (int i = 0; i < CELLS; i++) {
        sum += exp(log_density[i] - most);
    }
    return -2.0 * (most + log(sum));
}

TEST(a_size_known_from_few_beds_is_integrated_out)
{
    make_batch();
    struct dig_scatter scatter = *world.scatter;
    batch.scatter              = &scatter;
    for (size_t t = 0; t < DIG_TRAJECTORY_MAX; t++) {
        scatter.freedom[t] = 3.0;
    }
    const double numbers = 60.0 * DIG_FEATURES;
    const double known   = 2.0 * 3.0 * DIG_FEATURES;
    for (double squares = 200.0; squares < 20000.0; squares *= 3.0) {
        assert_close(dig_batch_misfit(&batch, squares) - dig_batch_misfit(&batch, 100.0),
                     integrated(known, numbers, squares) - integrated(known, numbers, 100.0), 1e-6);
    }
    for (size_t t = 0; t < DIG_TRAJECTORY_MAX; t++) {
        scatter.freedom[t] = 0.0;
    }
    assert_close(dig_batch_misfit(&batch, 123.0), 123.0, 0.0);
}

TESTS_WITH(world_setup, world_teardown)
