// Tests for firmware_host/output_lcm.c: what is published goes into a log by LCM's own file
// provider and is read back.

#include "firmware_host/output.h"

#include "files/lcm_log.h"
#include "tests/scratch.h"

static const struct dig_curve_set *set(void)
{
    static struct dig_gravel    gravel[2] = { { { 0.3, 0.1, 1500 } }, { { 0.6, 0.2, 2500 } } };
    static struct dig_curve_set s         = { .scene_hash   = "abc123",
                                              .trajectories = 2,
                                              .trajectory = { { .name = "simpleA" }, { .name = "actual" } },
                                              .entries    = 2,
                                              .gravel     = gravel };
    return &s;
}

static struct dig_output *begin(const char *const name)
{
    char url[600];
    (void)snprintf(url, sizeof url, "file://%s?mode=w", scratch_path(name));
    struct dig_output *output = NULL;
    struct dig_error   error  = { "" };
    if (dig_output_create(url, &output, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    return output;
}

struct seen {
    int                   estimates, matches, predictions, healths;
    digsight_estimate_t   estimate;
    digsight_match_t      match;
    digsight_health_t     health;
    char                  trajectory[4][32];
    int                   points;
    double                moment_Nm[DIG_PREDICTION_POINTS], sigma_Nm[DIG_PREDICTION_POINTS];
    digsight_prediction_t prediction;
};

static void keep(char to[32], const char *const text)
{
    (void)snprintf(to, 32, "%s", text);
}

static void on_estimate(void *const context, const int64_t time_us,
                        const digsight_estimate_t *const m)
{
    struct seen *const seen = context;
    (void)time_us;
    seen->estimates++;
    seen->estimate = *m;
    keep(seen->trajectory[0], m->trajectory);
}

static void on_match(void *const context, const int64_t time_us, const digsight_match_t *const m)
{
    struct seen *const seen = context;
    (void)time_us;
    seen->matches++;
    seen->match = *m;
    keep(seen->trajectory[1], m->trajectory);
    keep(seen->trajectory[3], m->table);
}

static void on_prediction(void *const context, const int64_t time_us,
                          const digsight_prediction_t *const m)
{
    struct seen *const seen = context;
    (void)time_us;
    seen->predictions++;
    seen->prediction = *m;
    keep(seen->trajectory[2], m->trajectory);
    for (int i = 0; i < m->points; i++) {
        seen->moment_Nm[i] = m->moment_Nm[i];
        seen->sigma_Nm[i]  = m->sigma_Nm[i];
    }
}

static void on_health(void *const context, const int64_t time_us, const digsight_health_t *const m)
{
    struct seen *const seen = context;
    (void)time_us;
    seen->healths++;
    seen->health = *m;
    assert_string_equal(m->state, "running");
    assert_string_equal(m->input, "can vcan0");
    assert_string_equal(m->note, "trouble");
}

static struct seen read_back(const char *const name)
{
    struct seen                     seen   = { 0 };
    const struct dig_lcm_log_reader reader = { &seen, on_estimate, on_match, on_prediction,
                                               on_health };
    assert_int_equal(dig_lcm_log_each(scratch_path(name), &reader, NULL), DIG_OK);
    return seen;
}

static void a_record_is_a_sample_and_its_estimate(void **state)
{
    (void)state;
    struct dig_output *const output          = begin("record.lcm");
    struct dig_record        record          = { .sample = { .time_ns = 100 } };
    record.sample.value[DIG_SIGNAL_BOOM_rad] = 0.25;
    record.sample.valid[DIG_SIGNAL_BOOM_rad] = true;
    assert_int_equal(dig_output_record(output, set(), &record), DIG_OK);

    record.sample.time_ns = 200;
    record.has_estimate   = true;
    record.estimate       = (struct dig_estimate){
              .time_ns    = 200,
              .wrench     = { 1.0, 2.0, 3.0, 0.1, 0.2, 0.3, false, true },
              .pin_X_m    = 4.0,
              .pin_Z_m    = 5.0,
              .phi_rad    = 6.0,
              .phase      = DIG_PHASE_DIG,
              .dig_count  = 7,
              .trajectory = 1,
              .progress   = 0.5,
              .off_path_m = 0.01,
    };
    assert_int_equal(dig_output_record(output, set(), &record), DIG_OK);
    record.sample.time_ns      = 300;
    record.estimate.trajectory = -1;
    record.estimate.progress   = NAN;
    assert_int_equal(dig_output_record(output, set(), &record), DIG_OK);
    dig_output_destroy(output);

    const struct seen seen = read_back("record.lcm");
    assert_int_equal(seen.estimates, 2);
    assert_string_equal(seen.trajectory[0], "");
    assert_true(isnan(seen.estimate.progress));
    assert_int_equal(seen.estimate.moment_valid, 1);
    assert_int_equal(seen.estimate.force_valid, 0);
    assert_close(seen.estimate.force_x_N, 1.0, 0.0);
    assert_close(seen.estimate.force_z_N, 2.0, 0.0);
    assert_close(seen.estimate.moment_Nm, 3.0, 0.0);
    assert_close(seen.estimate.sigma_force_x_N, 0.1, 0.0);
    assert_close(seen.estimate.sigma_moment_Nm, 0.3, 0.0);
    assert_close(seen.estimate.pin_X_m, 4.0, 0.0);
    assert_close(seen.estimate.pin_Z_m, 5.0, 0.0);
    assert_close(seen.estimate.bucket_phi_rad, 6.0, 0.0);
    assert_int_equal(seen.estimate.phase, 2);
    assert_int_equal(seen.estimate.dig_count, 7);

    struct dig_machine_recording samples;
    assert_int_equal(dig_lcm_log_read(scratch_path("record.lcm"), &samples, NULL), DIG_OK);
    assert_int_equal(samples.rows, 3);
    assert_close(samples.row[0].value[DIG_SIGNAL_BOOM_rad], 0.25, 0.0);
    assert_false(samples.row[0].valid[DIG_SIGNAL_ARM_rad]);
    dig_machine_recording_finish(&samples);
}

static void a_match_names_gravel_interval_and_table(void **state)
{
    (void)state;
    struct dig_output *const    output = begin("match.lcm");
    const struct dig_fit_result result = {
        .match      = { .valid            = true,
                        .dig_count        = 3,
                        .nearest          = 1,
                        .nearest_distance = 0.2,
                        .gravel           = { { 0.5, 0.15, 2000 } },
                        .distance         = 0.1,
                        .low              = { { 0.4, 0.1, 1800 } },
                        .high             = { { 0.55, 0.2, 2400 } },
                        .noise_floor      = 0.05,
                        .outside          = true },
        .trajectory = 0,
    };
    assert_int_equal(dig_output_match(output, set(), &result), DIG_OK);
    dig_output_destroy(output);
    const struct seen seen = read_back("match.lcm");
    assert_int_equal(seen.matches, 1);
    assert_string_equal(seen.trajectory[1], "simpleA");
    assert_string_equal(seen.trajectory[3], "abc123");
    assert_int_equal(seen.match.outside, 1);
    assert_close(seen.match.nearest_friction, 0.6, 0.0);
    assert_close(seen.match.nearest_density_kgpm3, 2500, 0.0);
    assert_close(seen.match.friction, 0.5, 0.0);
    assert_close(seen.match.friction_low, 0.4, 0.0);
    assert_close(seen.match.rolling_high, 0.2, 0.0);
    assert_close(seen.match.density_kgpm3, 2000, 0.0);
    assert_close(seen.match.density_low_kgpm3, 1800, 0.0);
    assert_close(seen.match.noise_floor, 0.05, 0.0);
}

static void a_prediction_carries_its_points_and_an_invalid_one_none(void **state)
{
    (void)state;
    struct dig_output *const  output  = begin("outlook.lcm");
    static struct dig_outlook outlook = { .time_ns = 5, .expires_ns = 9, .dig_count = 3 };
    outlook.prediction.valid          = true;
    outlook.prediction.trajectory     = 1;
    outlook.prediction.from_progress  = 0.25;
    outlook.prediction.to_progress    = 1.0;
    outlook.prediction.peak_Nm        = 64.0;
    for (int i = 0; i < DIG_PREDICTION_POINTS; i++) {
        outlook.prediction.moment_Nm[i] = i;
        outlook.prediction.sigma_Nm[i]  = -i;
    }
    assert_int_equal(dig_output_outlook(output, set(), &outlook), DIG_OK);
    dig_output_destroy(output);
    struct seen seen = read_back("outlook.lcm");
    assert_int_equal(seen.prediction.valid, 1);
    assert_string_equal(seen.trajectory[2], "actual");
    assert_int_equal(seen.prediction.points, DIG_PREDICTION_POINTS);
    assert_close(seen.moment_Nm[63], 63.0, 0.0);
    assert_close(seen.sigma_Nm[63], -63.0, 0.0);
    assert_true(seen.prediction.expires_ns == 9);
    assert_close(seen.prediction.from_progress, 0.25, 0.0);
    assert_close(seen.prediction.peak_Nm, 64.0, 0.0);

    struct dig_output *const again = begin("outlook.lcm");
    outlook.prediction.valid       = false;
    assert_int_equal(dig_output_outlook(again, set(), &outlook), DIG_OK);
    dig_output_destroy(again);
    seen = read_back("outlook.lcm");
    assert_int_equal(seen.prediction.valid, 0);
    assert_int_equal(seen.prediction.points, 0);
    assert_string_equal(seen.trajectory[2], "");
}

static void health_carries_every_counter(void **state)
{
    (void)state;
    struct dig_output *const output = begin("health.lcm");
    const struct dig_health  health = {
         .state      = "running",
         .input      = "can vcan0",
         .note       = "trouble",
         .rt         = { .realtime = true },
         .tick_s     = 0.005,
         .pulse      = { .ticks         = 1,
                         .overruns      = 2,
                         .missing       = 3,
                         .worst_tick_us = 4.5,
                         .drops = { .nan = 5, .not_available = 6, .out_of_range = 7, .frozen = 8 },
                         .digs  = 9 },
         .frames     = 10,
         .malformed  = 11,
         .reconnects = 12,
         .lost       = 13,
         .matches    = 14,
    };
    assert_int_equal(dig_output_health(output, &health), DIG_OK);
    dig_output_destroy(output);
    const digsight_health_t m = read_back("health.lcm").health;
    assert_true(m.realtime == 1 && m.memory_locked == 0);
    assert_true(m.ticks == 1 && m.overruns == 2 && m.missing == 3);
    assert_close(m.worst_tick_us, 4.5, 0.0);
    assert_true(m.dropped_nan == 5 && m.dropped_not_available == 6 && m.dropped_out_of_range == 7);
    assert_true(m.dropped_frozen == 8 && m.dropped_malformed == 11 && m.digs == 9);
    assert_true(m.frames == 10 && m.reconnects == 12 && m.lost == 13 && m.matches == 14);
}

static void a_network_that_cannot_be_is_refused(void **state)
{
    (void)state;
    struct dig_output *output = NULL;
    struct dig_error   error  = { "" };
    assert_int_equal(dig_output_create("nonsense://", &output, &error), DIG_EIO);
    assert_null(output);
    assert_non_null(strstr(error.text, "nonsense://"));
    dig_output_destroy(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_record_is_a_sample_and_its_estimate),
        cmocka_unit_test(a_match_names_gravel_interval_and_table),
        cmocka_unit_test(a_prediction_carries_its_points_and_an_invalid_one_none),
        cmocka_unit_test(health_carries_every_counter),
        cmocka_unit_test(a_network_that_cannot_be_is_refused),
    };
    return cmocka_run_group_tests_name("output_lcm", tests, scratch_setup, scratch_teardown);
}
