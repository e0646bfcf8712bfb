// Messages as they come from the network, for the tests of digwatch: made from a struct, encoded,
// taken by a model.

#ifndef DIG_TESTS_DIGWATCH_SAID_H
#define DIG_TESTS_DIGWATCH_SAID_H

#include "tests/blank_messages.h"
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

static char actual[]        = "actual";
static char running_state[] = "running";
static char can_input[]     = "can can0";

/// A dig of "actual" at this progress, measuring this.
static inline digsight_estimate_t estimate_at(const int64_t time_ns, const double progress,
                                              const double moment_Nm)
{
    digsight_estimate_t e      = blank_estimate();
    e.time_ns                  = time_ns;
    e.moment_valid             = 1;
    e.moment_Nm                = moment_Nm;
    e.sigma_moment_Nm          = 300.0;
    e.geometry_sigma_moment_Nm = 400.0;
    e.phase                    = 2;
    e.motion                   = 3;
    e.trajectory               = actual;
    e.progress                 = progress;
    return e;
}

/// Of "actual", from 0 to 1: rising from 0 to 10 kNm, sigma 1 kNm.
static inline void say_rising_prediction(struct digwatch_model *const model)
{
    double                moment[DIG_PREDICTED_POINTS];
    double                sigma[DIG_PREDICTED_POINTS];
    digsight_prediction_t p = blank_prediction(actual, 0.0, 10000.0, 1000.0, moment, sigma);
    p.expires_ns            = 60000000000;
    p.peak_Nm               = 10500.0;
    p.peak_sigma_Nm         = 900.0;
    p.energy_J              = 21000.0;
    p.energy_sigma_J        = 1500.0;
    say_prediction(model, &p);
}

static inline digsight_match_t match_of(const double friction)
{
    digsight_match_t m   = blank_match();
    m.valid              = 1;
    m.friction           = friction;
    m.friction_low       = 0.41;
    m.friction_high      = 0.61;
    m.rolling            = 0.5;
    m.rolling_low        = 0.32;
    m.rolling_high       = 0.82;
    m.density_kgpm3      = 2848.0;
    m.density_low_kgpm3  = 2435.0;
    m.density_high_kgpm3 = 3311.0;
    m.expires_ns         = 60000000000;
    m.digs               = 2;
    m.forces             = 1;
    return m;
}

static inline digsight_health_t health_at(const int64_t time_ns, char *const state)
{
    digsight_health_t h = blank_health();
    h.time_ns           = time_ns;
    h.state             = state;
    h.input             = can_input;
    h.realtime          = 1;
    h.memory_locked     = 1;
    h.digs              = 5;
    h.digs_aborted      = 1;
    h.matches           = 2;
    return h;
}

#endif // DIG_TESTS_DIGWATCH_SAID_H
