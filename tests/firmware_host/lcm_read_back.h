// What a daemon wrote into a log, for the tests of its output.

#ifndef DIG_TESTS_FIRMWARE_HOST_LCM_READ_BACK_H
#define DIG_TESTS_FIRMWARE_HOST_LCM_READ_BACK_H

#include "firmware_host/publish/output.h"

#include "files/lcm/lcm_log.h"
#include "tests/scratch.h"

static inline const struct dig_curve_set *set(void)
{
    static struct dig_gravel    gravel[2] = { { { 0.3, 0.1, 1500 } }, { { 0.6, 0.2, 2500 } } };
    static struct dig_curve_set s         = { .scene_hash   = "abc123",
                                              .trajectories = 2,
                                              .trajectory = { { .name = "simpleA" }, { .name = "actual" } },
                                              .entries    = 2,
                                              .gravel     = gravel };
    return &s;
}

static inline struct dig_output *begin(const char *const name)
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

static inline void keep(char to[32], const char *const text)
{
    (void)snprintf(to, 32, "%.31s", text);
}

static inline void on_estimate(void *const context, const int64_t time_us,
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

static inline void on_match(void *const context, const int64_t time_us,
                            const digsight_match_t *const m)
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

static inline void on_prediction(void *const context, const int64_t time_us,
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

static inline void on_health(void *const context, const int64_t time_us,
                             const digsight_health_t *const m)
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

static inline struct seen read_back(const char *const name)
{
    struct seen                 seen   = { 0 };
    const struct dig_lcm_reader reader = { &seen, on_estimate, on_match, on_prediction, on_health };
    assert_int_equal(dig_lcm_log_each(scratch_path(name), &reader, NULL), DIG_OK);
    return seen;
}

#endif // DIG_TESTS_FIRMWARE_HOST_LCM_READ_BACK_H
