#include "estimator/track/settings.h"

#include <assert.h>
#include <stdbool.h>
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

enum dig_status dig_estimator_settings_check(const struct dig_estimator_settings *const settings,
                                             const char **const                         reason)
{
    assert(settings != NULL && reason != NULL);
    const struct {
        bool        ok;
        const char *reason;
    } rules[] = {
        { settings->tick_s > 0.0 && settings->tick_s <= 0.1, "tick_s: expected > 0, at most 0.1" },
        { settings->contact_sigmas >= 1.0 && settings->contact_sigmas <= 100.0,
          "contact_sigmas: expected 1 to 100" },
        { settings->contact_hold_s >= 0.0 && settings->contact_hold_s <= 10.0,
          "contact_hold_s: expected 0 to 10" },
        { settings->exit_hold_s >= 0.0 && settings->exit_hold_s <= 60.0,
          "exit_hold_s: expected 0 to 60" },
        { settings->air_bias_s >= 0.0 && settings->air_bias_s <= 3600.0,
          "air_bias_s: expected 0 (off) to 3600" },
        { settings->path_limit_m > 0.0 && settings->path_limit_m <= 1.0,
          "path_limit_m: expected > 0, at most 1" },
        { settings->outside_floors >= 1.0 && settings->outside_floors <= 100.0,
          "outside_floors: expected 1 to 100" },
    };
    for (size_t i = 0; i < sizeof rules / sizeof rules[0]; i++) {
        if (!rules[i].ok) {
            *reason = rules[i].reason;
            return DIG_EINVAL;
        }
    }
    return DIG_OK;
}
