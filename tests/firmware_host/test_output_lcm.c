// Tests for firmware_host/publish/output_lcm.c: what is published goes into a log by LCM's own file
// provider and is read back.

#include "firmware_host/publish/output.h"

#include "files/lcm/lcm_log.h"
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
    double                sigma_force_x_N[DIG_PREDICTION_POINTS];
    double                sigma_force_z_N[DIG_PREDICTION_POINTS];
    digsight_prediction_t prediction;
    char                  text[3][64];
    double                sample[2];
    char                  untold[32];
    int64_t               late;
};

static void keep(char to[32], const char *const text)
{
    (void)snprintf(to, 32, "%.31s", text);
}

static void on_estimate(void *const context, const int64_t time_us,
                        const digsight_estimate_t *const m)
{
    struct seen *const seen = context;
    (void)time_us;
    seen->estimates++;
    seen->estimate = *m;
    keep(seen->trajectory[0], m->trajectory);
    keep(seen->text[0], m->missing);
    keep(seen->text[2], m->advice);
}

static void on_match(void *const context, const int64_t time_us, const digsight_match_t *const m)
{
    struct seen *const seen = context;
    (void)time_us;
    seen->matches++;
    seen->match = *m;
    keep(seen->trajectory[1], m->trajectory);
    keep(seen->trajectory[3], m->table);
    keep(seen->text[0], m->wanted);
    keep(seen->text[1], m->hint_trajectory);
    keep(seen->untold, m->untold);
    keep(seen->text[2], m->advice);
    seen->sample[0] = m->samples > 0 ? m->sample_friction[0] : 0.0;
    seen->sample[1] = m->samples > 1 ? m->sample_density_kgpm3[1] : 0.0;
}

static void on_prediction(void *const context, const int64_t time_us,
                          const digsight_prediction_t *const m)
{
    struct seen *const seen = context;
    (void)time_us;
    seen->predictions++;
    seen->prediction = *m;
    keep(seen->trajectory[2], m->trajectory);
    keep(seen->text[0], m->reason);
    keep(seen->text[2], m->advice);
    for (int i = 0; i < m->points; i++) {
        seen->moment_Nm[i]       = m->moment_Nm[i];
        seen->sigma_Nm[i]        = m->sigma_Nm[i];
        seen->sigma_force_x_N[i] = m->sigma_force_x_N[i];
        seen->sigma_force_z_N[i] = m->sigma_force_z_N[i];
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
    assert_string_equal(m->missing_signals, "arm_rod_Pa");
    keep(seen->text[0], m->table);
    keep(seen->text[2], m->advice);
    assert_int_equal(m->latency_bins, DIG_LATENCY_BINS);
    for (int i = 0; i < m->latency_bins; i++) {
        seen->late += m->latency_count[i];
        assert_true(i == 0 || m->latency_to_us[i] > m->latency_to_us[i - 1]);
    }
}

static struct seen read_back(const char *const name)
{
    struct seen                 seen   = { 0 };
    const struct dig_lcm_reader reader = { &seen, on_estimate, on_match, on_prediction, on_health };
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
    record.expires_ns     = 250;
    record.has_estimate   = true;
    record.estimate       = (struct dig_estimate){
              .time_ns    = 200,
              .wrench     = { 1.0, 2.0, 3.0, 0.1, 0.2, 0.3, false, true, .geometry_sigma_Fx_N = 0.4,
                              .geometry_sigma_Fz_N = 0.5, .geometry_sigma_My_Nm = 0.6 },
              .pin_X_m    = 4.0,
              .pin_Z_m    = 5.0,
              .phi_rad    = 6.0,
              .phase      = DIG_PHASE_DIG,
              .dig_count  = 7,
              .trajectory = 1,
              .progress   = 0.5,
              .off_path_m = 0.01,
              .motion     = DIG_MOTION_CURL,
    };
    assert_int_equal(dig_output_record(output, set(), &record), DIG_OK);
    record.sample.time_ns = 300;
    for (int i = 0; i < DIG_SIGNALS; i++) {
        record.sample.valid[i] = i != DIG_SIGNAL_BOOM_ROD_Pa && i != DIG_SIGNAL_ARM_rad;
    }
    record.estimate.trajectory = -1;
    record.estimate.progress   = NAN;
    assert_int_equal(dig_output_record(output, set(), &record), DIG_OK);
    dig_output_destroy(output);

    const struct seen seen = read_back("record.lcm");
    assert_int_equal(seen.estimates, 2);
    assert_string_equal(seen.trajectory[0], "");
    assert_string_equal(seen.text[0], "arm_rad, boom_rod_Pa");
    assert_true(isnan(seen.estimate.progress));
    assert_int_equal(seen.estimate.moment_valid, 1);
    assert_int_equal(seen.estimate.force_valid, 0);
    assert_close(seen.estimate.force_x_N, 1.0, 0.0);
    assert_close(seen.estimate.force_z_N, 2.0, 0.0);
    assert_close(seen.estimate.moment_Nm, 3.0, 0.0);
    assert_close(seen.estimate.sigma_force_x_N, 0.1, 0.0);
    assert_close(seen.estimate.sigma_moment_Nm, 0.3, 0.0);
    assert_close(seen.estimate.geometry_sigma_force_x_N, 0.4, 0.0);
    assert_close(seen.estimate.geometry_sigma_force_z_N, 0.5, 0.0);
    assert_close(seen.estimate.geometry_sigma_moment_Nm, 0.6, 0.0);
    assert_close(seen.estimate.pin_X_m, 4.0, 0.0);
    assert_close(seen.estimate.pin_Z_m, 5.0, 0.0);
    assert_close(seen.estimate.bucket_phi_rad, 6.0, 0.0);
    assert_int_equal(seen.estimate.phase, 2);
    assert_int_equal(seen.estimate.motion, 3);
    assert_int_equal(seen.estimate.dig_count, 7);
    assert_true(seen.estimate.expires_ns == 250);
    assert_string_equal(seen.text[2], DIG_ADVICE);

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
static void a_depth_that_was_not_told_is_not_a_number(void **state)
{
    (void)state;
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

static void a_prediction_carries_its_points_and_an_invalid_one_none(void **state)
{
    (void)state;
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

static void health_carries_every_counter(void **state)
{
    (void)state;
    struct dig_output *const output = begin("health.lcm");
    const struct dig_health  health = {
         .state           = "running",
         .input           = "can vcan0",
         .note            = "trouble",
         .rt              = { .realtime = true },
         .tick_s          = 0.005,
         .tick_status     = { .ticks             = 1,
                              .overruns          = 2,
                              .missing           = 3,
                              .worst_tick_us     = 4.5,
                              .worst_tick_cpu_us = 3.5,
                              .worst_late_us     = 2.5,
                              .drops             = { .nan           = 5,
                                                     .not_available = 6,
                                                     .out_of_range  = 7,
                                                     .frozen        = 8,
                                                     .jump          = 15,
                                                     .stuck         = 16,
                                                     .repeated      = 17,
                                                     .missed        = 18,
                                                     .without_force = 26 },
                              .digs              = 9 },
         .frames          = 10,
         .malformed       = 11,
         .reconnects      = 12,
         .lost            = 13,
         .matches         = 14,
         .whole           = 27,
         .aborted         = 28,
         .unknown         = 29,
         .checksum        = 19,
         .errors          = 20,
         .bus_offs        = 21,
         .timeouts        = 22,
         .unsent          = 23,
         .reloads         = 24,
         .reloads_refused = 25,
         .latency         = { .count = { [10] = 99, [20] = 1 }, .samples = 100 },
         .table           = "abc123",
         .missing         = "arm_rod_Pa",
    };
    assert_int_equal(dig_output_health(output, &health), DIG_OK);
    dig_output_destroy(output);
    const struct seen       seen = read_back("health.lcm");
    const digsight_health_t m    = seen.health;
    assert_true(m.dropped_jump == 15 && m.dropped_stuck == 16 && m.dropped_repeated == 17);
    assert_true(m.missed == 18 && m.dropped_checksum == 19 && m.error_frames == 20);
    assert_true(m.bus_offs == 21 && m.timeouts == 22 && m.unsent == 23);
    assert_true(m.reloads == 24 && m.reloads_refused == 25 && m.without_force == 26);
    assert_close(m.worst_tick_cpu_us, 3.5, 0.0);
    assert_close(m.latency_p99_us, 16.0 * pow(2.0, 2.5), 1e-9);
    assert_int_equal(seen.late, 100);
    assert_string_equal(seen.text[0], "abc123");
    assert_string_equal(seen.text[2], DIG_ADVICE);
    assert_true(m.realtime == 1 && m.memory_locked == 0);
    assert_true(m.ticks == 1 && m.overruns == 2 && m.missing == 3);
    assert_close(m.worst_tick_us, 4.5, 0.0);
    assert_close(m.worst_late_us, 2.5, 0.0);
    assert_true(m.dropped_nan == 5 && m.dropped_not_available == 6 && m.dropped_out_of_range == 7);
    assert_true(m.dropped_frozen == 8 && m.dropped_malformed == 11 && m.digs == 9);
    assert_true(m.digs_whole == 27 && m.digs_aborted == 28 && m.digs_unknown == 29);
    assert_true(m.frames == 10 && m.reconnects == 12 && m.lost == 13 && m.matches == 14);
}

static void latencies_are_counted_where_they_lie(void **state)
{
    (void)state;
    struct dig_latency l = { 0 };
    assert_close(dig_latency_quantile_us(&l, 0.99), 0.0, 0.0);
    const int64_t took_us[] = { -5, 0, 16, 17, 100, 1000, 2000, 1000000000 };
    for (size_t i = 0; i < 8; i++) {
        struct dig_latency one = { 0 };
        dig_latency_add(&one, took_us[i] * 1000);
        dig_latency_add(&l, took_us[i] * 1000);
        const double to_us = dig_latency_quantile_us(&one, 1.0);
        assert_true(to_us >= (double)took_us[i]);
        assert_true(i == 7 ? isinf(to_us) : to_us <= fmax(16.0, 1.19 * (double)took_us[i]));
    }
    assert_int_equal(l.samples, 8);
    assert_true(dig_latency_quantile_us(&l, 0.5) < 20.0);
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
        cmocka_unit_test(a_depth_that_was_not_told_is_not_a_number),
        cmocka_unit_test(a_prediction_carries_its_points_and_an_invalid_one_none),
        cmocka_unit_test(health_carries_every_counter),
        cmocka_unit_test(latencies_are_counted_where_they_lie),
        cmocka_unit_test(a_network_that_cannot_be_is_refused),
    };
    return cmocka_run_group_tests_name("output_lcm", tests, scratch_setup, scratch_teardown);
}
