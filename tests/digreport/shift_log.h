// Logs of a shift, written by LCM's own library, for the tests of digreport shift.

#ifndef DIG_TESTS_DIGREPORT_SHIFT_LOG_H
#define DIG_TESTS_DIGREPORT_SHIFT_LOG_H

#include "tests/blank_messages.h"
#include "tests/logged.h"
#include "tests/scratch.h"
#include "tools/digreport/shift.h"

LOG_TYPE(estimate)
LOG_TYPE(match)
LOG_TYPE(prediction)
LOG_TYPE(health)

#define START_us INT64_C(1700000000000000) // 2023-11-14 22:13:20 UTC
#define MINUTE   INT64_C(60000000)

static char actual[]  = "actual";
static char running[] = "running";
static char hostile[] = "\033[2J<script>alert('x')<img src=x>\"&\xff /home/somebody/run.csv";

static struct digreport_shift shift;

static inline int fresh(void **state)
{
    (void)state;
    digreport_shift_finish(&shift);
    digreport_shift_begin(&shift, 10.0);
    return 0;
}

static inline void read_log(const char *const name)
{
    struct dig_error error = { "" };
    assert_ok(digreport_shift_log(&shift, scratch_path(name), &error), error);
}

static inline lcm_eventlog_t *begin(const char *const name)
{
    lcm_eventlog_t *const log = lcm_eventlog_create(scratch_path(name), "w");
    assert_non_null(log);
    return log;
}

static inline digsight_match_t a_match(const int64_t time_us, const double friction,
                                       const bool valid, char *const text)
{
    digsight_match_t m   = blank_match();
    m.time_ns            = time_us; // any that differs
    m.valid              = valid ? 1 : 0;
    m.friction           = friction;
    m.friction_low       = friction - 0.1;
    m.friction_high      = friction + 0.1;
    m.rolling            = 0.5;
    m.rolling_low        = 0.3;
    m.rolling_high       = 0.8;
    m.density_kgpm3      = 2500.0;
    m.density_low_kgpm3  = 2000.0;
    m.density_high_kgpm3 = 3000.0;
    m.digs               = 1;
    m.wanted             = text;
    m.untold             = text;
    return m;
}

static inline void put_match(lcm_eventlog_t *const log, const int64_t time_us,
                             const double friction, const bool valid, char *const text)
{
    const digsight_match_t m = a_match(time_us, friction, valid, text);
    log_match(log, "DIGSIGHT_MATCH", time_us, &m);
}

static inline digsight_health_t healthy(void)
{
    digsight_health_t h = blank_health();
    h.state             = running;
    return h;
}

// A dig of one second at this moment, where 10 kNm +- 1 kNm and 20 kJ +- 2 kJ were predicted.
static inline void put_dig(lcm_eventlog_t *const log, const int64_t time_us, const int32_t digs,
                           const double moment_Nm)
{
    double                moment[DIG_PREDICTED_POINTS];
    double                sigma[DIG_PREDICTED_POINTS];
    digsight_prediction_t p = blank_prediction(actual, 10000.0, 10000.0, 1000.0, moment, sigma);
    p.peak_Nm               = 10000.0;
    p.peak_sigma_Nm         = 1000.0;
    p.energy_J              = 20000.0;
    p.energy_sigma_J        = 2000.0;
    for (int i = 0; i <= 11; i++) {
        digsight_estimate_t e = blank_estimate();
        e.time_ns             = 1000 * (time_us + 100000 * i);
        e.moment_valid        = 1;
        e.force_valid         = 1;
        e.moment_Nm           = moment_Nm;
        e.phase               = i <= 10 ? 2 : 3;
        e.dig_count           = i <= 10 ? digs : digs + 1;
        e.trajectory          = actual;
        e.progress            = 0.1 * i;
        log_estimate(log, "DIGSIGHT_ESTIMATE", time_us + 100000 * i, &e);
        if (i == 0) {
            log_prediction(log, "DIGSIGHT_PREDICTION", time_us, &p);
        }
    }
}

// Two gravels, two digs, timeouts in two bursts; the oracle is worked out by hand.
static inline void make_day(void)
{
    lcm_eventlog_t *const log = begin("day.lcm");
    digsight_health_t     h   = healthy();
    h.timeouts                = 100; // from before we listened
    log_health(log, "DIGSIGHT_HEALTH", START_us, &h);
    put_match(log, START_us + MINUTE, 0.4, true, no_text);
    put_match(log, START_us + MINUTE, 0.4, true, no_text); // said again
    put_dig(log, START_us + 2 * MINUTE, 4, 8000.0);        // off by 2 of 8: 25 %
    h.timeouts   = 103;
    h.digs_whole = 1;
    log_health(log, "DIGSIGHT_HEALTH", START_us + 3 * MINUTE, &h);
    h.timeouts = 110;
    log_health(log, "DIGSIGHT_HEALTH", START_us + 3 * MINUTE + 30000000, &h);
    put_match(log, START_us + 4 * MINUTE, 0.6, true, no_text);
    put_dig(log, START_us + 5 * MINUTE, 5, 12500.0); // off by 2.5 of 12.5: 20 %
    h.timeouts     = 111;
    h.digs_aborted = 1;
    h.digs_whole   = 1;
    log_health(log, "DIGSIGHT_HEALTH", START_us + 8 * MINUTE, &h);
    lcm_eventlog_destroy(log);
}

#endif // DIG_TESTS_DIGREPORT_SHIFT_LOG_H
