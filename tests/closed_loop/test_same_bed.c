// Tests for closed_loop/fit/batch.c, and what a batch and a hypothesis make of it: the made
// table's digs, some recorded again with noise of sensors.

#include "closed_loop/fit/batch.h"

#include "closed_loop/fit/hypothesis.h"
#include "tests/closed_loop/world_fixture.h"
#include "tests/model_front.h"

#include <string.h>

enum { DIGS = 8 };

static const struct dig_gravel gravel = { { 0.6, 0.55, 2500 } };

static struct dig_measured measured[DIGS];
static struct dig_batch    batch;

// Each bed is dug and recorded so many times, every time with noise of this share of the moment.
static void make_batch(const size_t times, const double noise, uint64_t seed)
{
    for (size_t i = 0; i < DIGS; i++) {
        if (i % times == 0) {
            measured[i] = made_dig(&gravel, MADE_ACTUAL, 0, NULL, NULL, &seed);
            continue;
        }
        measured[i] = measured[i - 1];
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                measured[i].value[c][k] *= 1.0 + noise * model_normal(&seed);
            }
        }
    }
    batch_digs(DIGS, measured, &gravel, &batch);
}

TEST(recordings_of_one_bed_count_once)
{
    for (uint64_t seed = 1; seed <= 20; seed++) {
        for (size_t times = 1; times <= DIGS; times *= 2) {
            const size_t beds = DIGS / times;
            make_batch(times, 0.03, seed);
            assert_int_equal(dig_same_bed_count(&batch, 0), beds);
            assert_close(1.0 / DIGS + batch.group[0].repeats, 1.0 / (double)beds, 1e-12);
        }
    }
}

TEST(without_a_dig_its_bed_counts_as_long_as_another_has_it)
{
    static struct dig_batch others;
    make_batch(2, 0.03, 5);
    dig_batch_leave_out(&batch, 0, &others);
    assert_close(others.group[0].repeats, 1.0 / 4 - 1.0 / 7, 1e-12);
    batch = others;
    dig_batch_leave_out(&batch, 0, &others);
    assert_close(others.group[0].repeats, 1.0 / 3 - 1.0 / 6, 1e-12);
}

// What the mean of digs is off by is what the mean of their beds is: over many campaigns, the
// squares that a plain gravel leaves come to as much with one bed recorded eight times as with
// eight beds.
TEST(the_mean_of_one_bed_is_no_nearer_to_its_gravel)
{
    enum { CAMPAIGNS = 60 };
    double mean[2] = { 0.0 };
    for (uint64_t seed = 1; seed <= CAMPAIGNS; seed++) {
        for (int once = 0; once < 2; once++) {
            make_batch(once ? 1 : DIGS, 0.03, 100 * seed);
            const struct dig_fitted fitted = fit_plain(&batch);
            mean[once] += (fitted.squares - batch.group[0].about) / CAMPAIGNS;
        }
    }
    print_message("squares of the mean: %.1f of one bed, %.1f of %d\n", mean[0], mean[1], DIGS);
    assert_true(mean[0] > 0.7 * mean[1] && mean[0] < 2.0 * mean[1]);
}

TESTS_WITH(world_setup, world_teardown)
