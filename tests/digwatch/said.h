// Messages as they come from the network, for the tests of digwatch: made from a struct, encoded,
// taken by a model.

#ifndef DIG_TESTS_DIGWATCH_SAID_H
#define DIG_TESTS_DIGWATCH_SAID_H

#include "tests/testlib.h"
#include "tools/digwatch/model.h"

#include <stdlib.h>

#define SAY(type, channel_name)                                                                    \
    static inline void say_##type(struct digwatch_model *const     model,                          \
                                  const digsight_##type##_t *const message)                        \
    {                                                                                              \
        const int      size  = digsight_##type##_t_encoded_size(message);                          \
        uint8_t *const bytes = malloc((size_t)size);                                               \
        assert_int_equal(digsight_##type##_t_encode(bytes, 0, size, message), size);               \
        const struct dig_lcm_event event = { .time_us = 1700000000000000,                          \
                                             .channel = channel_name,                              \
                                             .size    = (size_t)size,                              \
                                             .data    = bytes };                                      \
        digwatch_model_take(model, &event);                                                        \
        free(bytes);                                                                               \
    }

SAY(estimate, "DIGSIGHT_ESTIMATE")
SAY(match, "DIGSIGHT_MATCH")
SAY(prediction, "DIGSIGHT_PREDICTION")
SAY(health, "DIGSIGHT_HEALTH")

static char no_text[]       = "";
static char actual[]        = "actual";
static char running_state[] = "running";
static char can_input[]     = "can can0";

/// A dig of "actual" at this progress, measuring this.
static inline digsight_estimate_t estimate_at(const int64_t time_ns, const double progress,
                                              const double moment_Nm)
{
    return (digsight_estimate_t){ .time_ns                  = time_ns,
                                  .moment_valid             = 1,
                                  .moment_Nm                = moment_Nm,
                                  .sigma_moment_Nm          = 300.0,
                                  .geometry_sigma_moment_Nm = 400.0,
                                  .phase                    = 2,
                                  .motion                   = 3,
                                  .trajectory               = actual,
                                  .progress                 = progress,
                                  .missing                  = no_text,
                                  .advice                   = no_text };
}

/// Of "actual", from 0 to 1: rising from 0 to 10 kNm, sigma 1 kNm.
static inline void say_rising_prediction(struct digwatch_model *const model)
{
    double moment[DIG_PREDICTED_POINTS];
    double sigma[DIG_PREDICTED_POINTS];
    for (int i = 0; i < DIG_PREDICTED_POINTS; i++) {
        moment[i] = 10000.0 * i / (DIG_PREDICTED_POINTS - 1);
        sigma[i]  = 1000.0;
    }
    const digsight_prediction_t p = { .valid           = 1,
                                      .expires_ns      = 60000000000,
                                      .trajectory      = actual,
                                      .to_progress     = 1.0,
                                      .points          = DIG_PREDICTED_POINTS,
                                      .moment_Nm       = moment,
                                      .sigma_Nm        = sigma,
                                      .force_x_N       = moment,
                                      .force_z_N       = moment,
                                      .sigma_force_x_N = sigma,
                                      .sigma_force_z_N = sigma,
                                      .peak_Nm         = 10500.0,
                                      .peak_sigma_Nm   = 900.0,
                                      .energy_J        = 21000.0,
                                      .energy_sigma_J  = 1500.0,
                                      .reason          = no_text,
                                      .advice          = no_text };
    say_prediction(model, &p);
}

static inline digsight_match_t match_of(const double friction)
{
    return (digsight_match_t){ .valid              = 1,
                               .friction           = friction,
                               .friction_low       = 0.41,
                               .friction_high      = 0.61,
                               .rolling            = 0.5,
                               .rolling_low        = 0.32,
                               .rolling_high       = 0.82,
                               .density_kgpm3      = 2848.0,
                               .density_low_kgpm3  = 2435.0,
                               .density_high_kgpm3 = 3311.0,
                               .expires_ns         = 60000000000,
                               .digs               = 2,
                               .forces             = 1,
                               .trajectory         = no_text,
                               .table              = no_text,
                               .wanted             = no_text,
                               .hint_trajectory    = no_text,
                               .advice             = no_text,
                               .untold             = no_text };
}

static inline digsight_health_t health_at(const int64_t time_ns, char *const state)
{
    return (digsight_health_t){ .time_ns         = time_ns,
                                .state           = state,
                                .input           = can_input,
                                .note            = no_text,
                                .missing_signals = no_text,
                                .table           = no_text,
                                .advice          = no_text,
                                .realtime        = 1,
                                .memory_locked   = 1,
                                .digs            = 5,
                                .digs_aborted    = 1,
                                .matches         = 2 };
}

#endif // DIG_TESTS_DIGWATCH_SAID_H
