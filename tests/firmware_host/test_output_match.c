// Tests for firmware_host/publish/output_lcm.c: matches and predictions

#include "firmware_host/publish/output.h"

#include "files/lcm/lcm_log.h"
#include "tests/firmware_host/lcm_read_back.h"
#include "tests/scratch.h"

TEST(a_match_names_gravel_interval_and_table)
{
    struct dig_output *const    output = begin("match.lcm");
    const struct dig_fit_result result = {
        .track.any        = true,
        .track.valid      = true,
        .track.expires_ns = 77,
        .track.drift      = 1.5,
        .track.restored   = true,
        .track.trajectory = "simpleA",
        .track.table      = "abc123",
        .track.wanted     = "a simple dig",
        .track.ending     = DIG_ENDING_ABORTED,
        .track.made       = { 1.25, 0.02 },
        .track.matched    = { 1.2, 0.01 },
        .track.nearest    = { { 0.6, 0.2, 2500 } },
        .track.weighted   = { { 0.7, 0.3, 2600 } },
        .hint_trajectory  = "actual",
        .hint_J_per_kg    = 12.5,
        .track.match      = { .valid            = true,
                              .dig_count        = 3,
                              .nearest          = 1,
                              .nearest_distance = 0.2,
                              .gravel           = { { 0.5, 0.15, 2000 } },
                              .distance         = 0.1,
                              .low              = { { 0.4, 0.1, 1800 } },
                              .high             = { { 0.55, 0.2, 2400 } },
                              .noise_floor      = 0.05,
                              .outside          = true,
                              .forces           = true,
                              .samples          = 2,
                              .untold           = { false, true, true },
                              .weighted         = 4,

                              .weighted_distance = 1.25,
                              .sample            = { { { 0.4, 0.1, 1900 } }, { { 0.5, 0.2, 2100 } } } },
    };
    assert_int_equal(dig_output_match(output, &result), DIG_OK);
    dig_output_destroy(output);
    const struct seen seen = read_back("match.lcm");
    assert_int_equal(seen.matches, 1);
    assert_close(seen.match.depth, 1.25, 0.0);
    assert_close(seen.match.attack_rad, 0.02, 0.0);
    assert_close(seen.match.matched_depth, 1.2, 0.0);
    assert_close(seen.match.matched_attack_rad, 0.01, 0.0);
    assert_string_equal(seen.trajectory[1], "simpleA");
    assert_string_equal(seen.trajectory[3], "abc123");
    assert_int_equal(seen.match.outside, 1);
    assert_int_equal(seen.match.forces, 1);
    assert_close(seen.match.nearest_friction, 0.6, 0.0);
    assert_close(seen.match.nearest_density_kgpm3, 2500, 0.0);
    assert_int_equal(seen.match.weighted_entry, 4);
    assert_close(seen.match.weighted_friction, 0.7, 0.0);
    assert_close(seen.match.weighted_rolling, 0.3, 0.0);
    assert_close(seen.match.weighted_density_kgpm3, 2600, 0.0);
    assert_close(seen.match.weighted_distance, 1.25, 0.0);
    assert_close(seen.match.friction, 0.5, 0.0);
    assert_close(seen.match.friction_low, 0.4, 0.0);
    assert_close(seen.match.rolling_high, 0.2, 0.0);
    assert_close(seen.match.density_kgpm3, 2000, 0.0);
    assert_close(seen.match.density_low_kgpm3, 1800, 0.0);
    assert_close(seen.match.noise_floor, 0.05, 0.0);
    assert_true(seen.match.expires_ns == 77 && seen.match.restored == 1);
    assert_close(seen.match.drift, 1.5, 0.0);
    assert_int_equal(seen.match.samples, 2);
    assert_int_equal(seen.match.family, 1);
    assert_int_equal(seen.match.ending, 2);
    assert_string_equal(seen.untold, "rolling, density_kgpm3");
    assert_close(seen.match.hint_J_per_kg, 12.5, 0.0);
    assert_string_equal(seen.text[0], "a simple dig");
    assert_string_equal(seen.text[1], "actual");
    assert_string_equal(seen.text[2], DIG_ADVICE);
    assert_close(seen.sample[0], 0.4, 0.0);
    assert_close(seen.sample[1], 2100, 0.0);
}

// A table dug in one way alone does not tell how a dig was made; it was matched with the plain one.
TEST(a_depth_that_was_not_told_is_not_a_number)
{
    struct dig_output *const    output = begin("plain.lcm");
    const struct dig_fit_result result = { .track.any = true };
    assert_int_equal(dig_output_match(output, &result), DIG_OK);
    dig_output_destroy(output);
    const struct seen seen = read_back("plain.lcm");
    assert_true(isnan(seen.match.depth) && isnan(seen.match.attack_rad));
    assert_int_equal(seen.match.family, 0);
    assert_string_equal(seen.untold, "");
    assert_close(seen.match.matched_depth, 1.0, 0.0);
    assert_close(seen.match.matched_attack_rad, 0.0, 0.0);
}

TEST(a_prediction_carries_its_points_and_an_invalid_one_none)
{
    struct dig_output *const            output      = begin("predictions.lcm");
    static struct dig_prediction_record predictions = { .time_ns    = 5,
                                                        .expires_ns = 9,
                                                        .dig_count  = 3 };
    predictions.prediction.valid                    = true;
    predictions.prediction.trajectory               = 1;
    predictions.prediction.from_progress            = 0.25;
    predictions.prediction.to_progress              = 1.0;
    predictions.prediction.peak_Nm                  = 64.0;
    predictions.prediction.peak_sigma_Nm            = 6.5;
    predictions.prediction.energy_J                 = 32.0;
    predictions.prediction.energy_sigma_J           = 3.25;
    predictions.prediction.approach                 = (struct dig_approach){ 1.15, -0.03 };
    for (int i = 0; i < DIG_PREDICTION_POINTS; i++) {
        predictions.prediction.moment_Nm[i]  = i;
        predictions.prediction.sigma_Nm[i]   = -i;
        predictions.prediction.sigma_Fx_N[i] = 100.0 + i;
        predictions.prediction.sigma_Fz_N[i] = 200.0 + i;
    }
    assert_int_equal(dig_output_prediction(output, set(), &predictions), DIG_OK);
    dig_output_destroy(output);
    struct seen seen = read_back("predictions.lcm");
    assert_int_equal(seen.prediction.valid, 1);
    assert_string_equal(seen.trajectory[2], "actual");
    assert_int_equal(seen.prediction.points, DIG_PREDICTION_POINTS);
    assert_close(seen.moment_Nm[63], 63.0, 0.0);
    assert_close(seen.sigma_Nm[63], -63.0, 0.0);
    assert_true(seen.prediction.expires_ns == 9);
    assert_close(seen.prediction.from_progress, 0.25, 0.0);
    assert_close(seen.prediction.peak_Nm, 64.0, 0.0);
    assert_close(seen.prediction.peak_sigma_Nm, 6.5, 0.0);
    assert_close(seen.prediction.energy_J, 32.0, 0.0);
    assert_close(seen.prediction.energy_sigma_J, 3.25, 0.0);
    assert_close(seen.sigma_force_x_N[63], 163.0, 0.0);
    assert_close(seen.sigma_force_z_N[63], 263.0, 0.0);
    assert_close(seen.prediction.depth, 1.15, 0.0);
    assert_close(seen.prediction.attack_rad, -0.03, 0.0);

    struct dig_output *const again = begin("predictions.lcm");
    predictions.prediction.valid   = false;
    predictions.state              = DIG_PREDICTION_OFF_TABLE;
    predictions.outside            = true;
    assert_int_equal(dig_output_prediction(again, set(), &predictions), DIG_OK);
    dig_output_destroy(again);
    seen = read_back("predictions.lcm");
    assert_int_equal(seen.prediction.valid, 0);
    assert_int_equal(seen.prediction.points, 0);
    assert_true(isnan(seen.prediction.depth) && isnan(seen.prediction.attack_rad));
    assert_string_equal(seen.text[0], "off the table");
    assert_int_equal(seen.prediction.outside, 1);
    assert_string_equal(seen.trajectory[2], "");
}

TESTS_WITH(scratch_setup, scratch_teardown)
