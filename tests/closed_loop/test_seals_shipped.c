// Test of closed_loop/machine_digs/observe_machine.c and closed_loop/check/machine_check.c
// together, by the product's table: seals of which a machine's file says nothing change neither its
// check nor what its digs tell.

#include "closed_loop/machine_digs/observe_machine.h"

#include "tables/load.h"
#include "tests/broken_air.h"
#include "tests/estimator/fitted_match.h"
#include "tests/read.h"

// Friction, rolling friction, density of the gravel that LIGGGHTS dug.
static const struct dig_gravel truth = { { 0.4, 0.6, 3000.0 } };

static struct dig_curve_set *set;

static int build(void **state)
{
    (void)state;
    struct dig_error error = { "" };
    assert_ok(dig_table_load("tables/product.sqlite", &set, &error), error);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    dig_curve_set_destroy(set);
    return 0;
}

// What one dig of a machine with such seals tells.
static struct dig_match dug(const struct dig_machine *const machine, const double share)
{
    struct dig_recording digs = read_recording(
        "tests/data/liggghts_product/mu0.4_mur0.6_rho3000_bucket0.4_seed1__simpleA.csv");
    struct dig_rig_track_options how   = dig_rig_track_options_default();
    struct dig_error             error = { "" };
    struct dig_rig_track         track;
    struct dig_observed_digs     seen = { .digs = 0 };
    how.scene_tooth_m                 = set->tooth_m;
    how.placed                        = true;
    how.pin_X_m                       = 7.43;
    how.pin_Z_m                       = -0.62;
    assert_ok(dig_rig_track_build(machine, &how, 1, &digs, &track, &error), error);
    air_rub(machine, &track, share, true);
    struct dig_machine_recording r = air_record(machine, &track, NULL, 1);
    assert_ok(dig_observe_machine(machine, NULL, set, &r, &seen, &error), error);
    assert_int_equal(seen.digs, 1);
    const struct dig_match match = fit(set, 1, seen.dig, 400);
    dig_observed_digs_finish(&seen);
    dig_machine_recording_finish(&r);
    dig_rig_track_finish(&track);
    dig_recording_finish(&digs);
    return match;
}

static enum dig_check_verdict checked(const char *const name, const double share)
{
    struct dig_machine           machine;
    struct dig_rig_track         track;
    struct dig_error             error = { "" };
    struct dig_machine_air_check check;
    assert_true(air_move(name, &machine, &track, &error));
    air_rub(&machine, &track, share, true);
    struct dig_machine_recording r = air_record(&machine, &track, NULL, 1);
    assert_ok(dig_machine_air_check_run(&machine, &r, &check, &error), error);
    const enum dig_check_verdict verdict = check.verdict;
    dig_machine_air_check_finish(&check);
    dig_machine_recording_finish(&r);
    dig_rig_track_finish(&track);
    return verdict;
}

TEST(seals_that_the_check_allows_put_no_gravel_outside_the_table)
{
    static const double      share[] = { 0.0, 0.002, 0.005 };
    static const char *const name    = "zx200_trench";
    const struct dig_machine machine = read_machine(name);
    for (size_t i = 0; i < sizeof share / sizeof share[0]; i++) {
        const struct dig_match match = dug(&machine, share[i]);
        print_message("seals of %.1f %%: %.2f/%.2f/%.0f, distance %.3f, noise floor %.3f%s\n",
                      100.0 * share[i], match.gravel.value[0], match.gravel.value[1],
                      match.gravel.value[2], match.distance, match.noise_floor,
                      match.outside ? ", outside" : "");
        assert_int_equal(checked(name, share[i]), DIG_CHECK_OK);
        assert_false(match.outside);
        for (int a = 0; a < DIG_AXES; a++) {
            assert_true(match.low.value[a] <= truth.value[a]);
            assert_true(match.high.value[a] >= truth.value[a]);
        }
    }
}

TESTS_WITH(build, tear_down)
