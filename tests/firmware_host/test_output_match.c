// Tests for firmware_host/publish/output_lcm.c: matches and predictions

#include "firmware_host/publish/output.h"

#include "files/lcm/lcm_log.h"
#include "tests/firmware_host/lcm_read_back.h"
#include "tests/scratch.h"

LAST(match)
LAST(prediction)

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
    digsight_match_t *const m = last_match("match.lcm", 1);
    assert_close(m->depth, 1.25, 0.0);
    assert_close(m->attack_rad, 0.02, 0.0);
    assert_close(m->matched_depth, 1.2, 0.0);
    assert_close(m->matched_attack_rad, 0.01, 0.0);
    assert_string_equal(m->trajectory, "simpleA");
    assert_string_equal(m->table, "abc123");
    assert_int_equal(m->outside, 1);
    assert_int_equal(m->forces, 1);
    assert_close(m->nearest_friction, 0.6, 0.0);
    assert_close(m->nearest_density_kgpm3, 2500, 0.0);
    assert_int_equal(m->weighted_entry, 4);
    assert_close(m->weighted_friction, 0.7, 0.0);
    assert_close(m->weighted_rolling, 0.3, 0.0);
    assert_close(m->weighted_density_kgpm3, 2600, 0.0);
    assert_close(m->weighted_distance, 1.25, 0.0);
    assert_close(m->friction, 0.5, 0.0);
    assert_close(m->friction_low, 0.4, 0.0);
    assert_close(m->rolling_high, 0.2, 0.0);
    assert_close(m->density_kgpm3, 2000, 0.0);
    assert_close(m->density_low_kgpm3, 1800, 0.0);
    assert_close(m->noise_floor, 0.05, 0.0);
    assert_true(m->expires_ns == 77 && m->restored == 1);
    assert_close(m->drift, 1.5, 0.0);
    assert_int_equal(m->samples, 2);
    assert_int_equal(m->family, 1);
    assert_int_equal(m->ending, 2);
    assert_string_equal(m->untold, "rolling, density_kgpm3");
    assert_close(m->hint_J_per_kg, 12.5, 0.0);
    assert_string_equal(m->wanted, "a simple dig");
    assert_string_equal(m->hint_trajectory, "actual");
    assert_string_equal(m->advice, DIG_ADVICE);
    assert_close(m->sample_friction[0], 0.4, 0.0);
    assert_close(m->sample_density_kgpm3[1], 2100, 0.0);
    digsight_match_t_destroy(m);
}

// A table dug in one way alone does not tell how a dig was made; it was matched with the plain one.
TEST(a_depth_that_was_not_told_is_not_a_number)
{
    struct dig_output *const    output = begin("plain.lcm");
    const struct dig_fit_result result = { .track.any = true };
    assert_int_equal(dig_output_match(output, &result), DIG_OK);
    dig_output_destroy(output);
    digsight_match_t *const m = last_match("plain.lcm", 1);
    assert_true(isnan(m->depth) && isnan(m->attack_rad));
    assert_int_equal(m->family, 0);
    assert_string_equal(m->untold, "");
    assert_close(m->matched_depth, 1.0, 0.0);
    assert_close(m->matched_attack_rad, 0.0, 0.0);
    digsight_match_t_destroy(m);
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
    digsight_prediction_t *m = last_prediction("predictions.lcm", 1);
    assert_int_equal(m->valid, 1);
    assert_string_equal(m->trajectory, "actual");
    assert_int_equal(m->points, DIG_PREDICTION_POINTS);
    assert_close(m->moment_Nm[63], 63.0, 0.0);
    assert_close(m->sigma_Nm[63], -63.0, 0.0);
    assert_true(m->expires_ns == 9);
    assert_close(m->from_progress, 0.25, 0.0);
    assert_close(m->peak_Nm, 64.0, 0.0);
    assert_close(m->peak_sigma_Nm, 6.5, 0.0);
    assert_close(m->energy_J, 32.0, 0.0);
    assert_close(m->energy_sigma_J, 3.25, 0.0);
    assert_close(m->sigma_force_x_N[63], 163.0, 0.0);
    assert_close(m->sigma_force_z_N[63], 263.0, 0.0);
    assert_close(m->depth, 1.15, 0.0);
    assert_close(m->attack_rad, -0.03, 0.0);

    struct dig_output *const again = begin("predictions.lcm");
    predictions.prediction.valid   = false;
    predictions.state              = DIG_PREDICTION_OFF_TABLE;
    predictions.outside            = true;
    assert_int_equal(dig_output_prediction(again, set(), &predictions), DIG_OK);
    dig_output_destroy(again);
    digsight_prediction_t_destroy(m);
    m = last_prediction("predictions.lcm", 1);
    assert_int_equal(m->valid, 0);
    assert_int_equal(m->points, 0);
    assert_true(isnan(m->depth) && isnan(m->attack_rad));
    assert_string_equal(m->reason, "off the table");
    assert_int_equal(m->outside, 1);
    assert_string_equal(m->trajectory, "");
    digsight_prediction_t_destroy(m);
}

TESTS_WITH(scratch_setup, scratch_teardown)
