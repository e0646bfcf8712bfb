#include "estimator/track/settings.h"

#include <assert.h>
#include <stddef.h>

struct dig_estimator_settings dig_estimator_settings_default(void)
{
    return (struct dig_estimator_settings){
        .tick_s         = 0.005,
        .contact_sigmas = 3.0,
        .contact_hold_s = 0.1,
        .exit_hold_s    = 1.0,
        .air_bias_s     = 0.0,
        .path_limit_m   = 0.008,
        .outside_floors = 2.5,
    };
}

static bool is_within(const double value, const double least, const double most)
{
    return value >= least && value <= most;
}

bool dig_estimator_settings_ok(const struct dig_estimator_settings *const s)
{
    assert(s != NULL);
    return s->tick_s > 0.0 && s->tick_s <= DIG_TICK_MOST_s &&
           is_within(s->contact_sigmas, 1.0, 100.0) && is_within(s->contact_hold_s, 0.0, 10.0) &&
           is_within(s->exit_hold_s, 0.0, 60.0) && is_within(s->air_bias_s, 0.0, 3600.0) &&
           s->path_limit_m > 0.0 && s->path_limit_m <= 1.0 &&
           is_within(s->outside_floors, 1.0, 100.0);
}
