#include "estimator/estimator.h"

#include "estimator/estimator_state.h"
#include "estimator/match.h"

#include <assert.h>
#include <math.h>
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

size_t dig_estimator_size(void)
{
    return sizeof(struct dig_estimator);
}

enum dig_status dig_estimator_init(struct dig_estimator *const                estimator,
                                   const struct dig_machine *const            machine,
                                   const struct dig_curve_set *const          set,
                                   const struct dig_estimator_settings *const settings)
{
    assert(estimator != NULL && machine != NULL && set != NULL && settings != NULL);
    *estimator = (struct dig_estimator){ .machine = machine, .set = set, .settings = *settings };
    return DIG_OK;
}

enum dig_status dig_estimator_step(struct dig_estimator *const    estimator,
                                   const struct dig_sample *const sample,
                                   struct dig_estimate *const     estimate)
{
    assert(estimator != NULL && sample != NULL && estimate != NULL);
    return DIG_ESTALE;
}

bool dig_estimator_take_dig(struct dig_estimator *const   estimator,
                            struct dig_observation *const observation)
{
    (void)estimator;
    (void)observation;
    return false;
}

void dig_estimator_give_match(struct dig_estimator *const   estimator,
                              const struct dig_match *const match)
{
    estimator->match = *match;
}

void dig_estimator_predict(const struct dig_estimator *const estimator,
                           struct dig_prediction *const      prediction)
{
    (void)estimator;
    *prediction = (struct dig_prediction){ .valid = false };
}

enum dig_status dig_match_interpolate(const struct dig_curve_set *const set,
                                      const struct dig_gravel *const    gravel,
                                      const size_t trajectory, struct dig_curve *const curve)
{
    (void)set;
    (void)gravel;
    (void)trajectory;
    (void)curve;
    return DIG_ENOMATCH;
}

enum dig_status dig_match_nearest(const struct dig_curve_set *const   set,
                                  const struct dig_observation *const observation,
                                  const double outside_floors, struct dig_match *const match)
{
    (void)set;
    (void)observation;
    (void)outside_floors;
    (void)match;
    return DIG_ENOMATCH;
}

enum dig_status dig_fit_refine(const struct dig_curve_set *const   set,
                               const struct dig_observation *const observation,
                               const int max_evaluations, struct dig_match *const match)
{
    (void)set;
    (void)observation;
    (void)max_evaluations;
    (void)match;
    return DIG_ENOMATCH;
}

enum dig_status dig_predict_curve(const struct dig_curve_set *const set,
                                  const struct dig_match *const match, const size_t trajectory,
                                  struct dig_curve *const curve)
{
    (void)set;
    (void)match;
    (void)trajectory;
    (void)curve;
    return DIG_ENOMATCH;
}
