// Tests for firmware_host/publish/output_lcm.c: what is published goes into a log by LCM's own file
// provider and is read back.

#include "firmware_host/publish/output.h"

#include "files/lcm/lcm_log.h"
#include "tests/firmware_host/lcm_read_back.h"
#include "tests/scratch.h"

TEST(a_record_is_a_sample_and_its_estimate)
{
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

TEST(health_carries_every_counter)
{
    struct dig_output *const      output = begin("health.lcm");
    const struct dig_input        input  = { .name       = "can vcan0",
                                             .frames     = 10,
                                             .malformed  = 11,
                                             .reconnects = 12,
                                             .checksum   = 19,
                                             .errors     = 20,
                                             .bus_offs   = 21,
                                             .timeouts   = 22 };
    const struct dig_fit_counters fit    = { .matches         = 14,
                                             .reloads         = 24,
                                             .reloads_refused = 25,
                                             .whole           = 27,
                                             .aborted         = 28,
                                             .unknown         = 29 };
    const struct dig_health       health = {
              .state       = "running",
              .note        = "trouble",
              .rt          = { .realtime = true },
              .tick_s      = 0.005,
              .tick_status = { .ticks             = 1,
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
              .input       = &input,
              .fit         = &fit,
              .lost        = 13,
              .unsent      = 23,
              .latency     = { .count = { [10] = 99, [20] = 1 }, .samples = 100 },
              .table       = "abc123",
              .missing     = "arm_rod_Pa",
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

TEST(latencies_are_counted_where_they_lie)
{
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

TEST(a_network_that_cannot_be_is_refused)
{
    struct dig_output *output = NULL;
    struct dig_error   error  = { "" };
    assert_int_equal(dig_output_create("nonsense://", &output, &error), DIG_EIO);
    assert_null(output);
    assert_non_null(strstr(error.text, "nonsense://"));
    dig_output_destroy(NULL);
}

TESTS_WITH(scratch_setup, scratch_teardown)
