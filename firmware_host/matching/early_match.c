#include "firmware_host/matching/early_match.h"

#include "estimator/approach/approach_slots.h"

#include <assert.h>
#include <math.h>

// Progress until the next try, after an observation that failed or covered too little.
static const double retry_step = 0.02;

void dig_early_match_clear(struct dig_early_match *const     early,
                           const struct dig_curve_set *const set)
{
    assert(early != NULL && set != NULL);
    early->last                 = (struct dig_estimate){ .trajectory = -1 };
    early->next_progress        = 0.0;
    early->off_table_trajectory = -1;
    dig_live_recording_clear(&early->live, set);
}

bool dig_early_match_observe(struct dig_early_match *const     early,
                             const struct dig_curve_set *const set, const double lambda,
                             const struct dig_machine *const machine,
                             const struct dig_friction       stated[],
                             const struct dig_config *const  config,
                             struct dig_observation *const   dig)
{
    assert(early != NULL && set != NULL && config != NULL && dig != NULL);
    while (dig_ring_pop(early->estimates, &early->last)) {
        dig_live_recording_add(&early->live, set, lambda, &early->last);
    }
    if (!early->live.digging) {
        early->next_progress        = config->match_early_path;
        early->off_table_trajectory = -1;
        return false;
    }
    const struct dig_estimate *const e = &early->last;
    if (e->trajectory < 0 || (size_t)e->trajectory >= set->trajectories ||
        !(e->progress >= early->next_progress) || config->match_early_path >= 1.0 ||
        !(dig_config_identifies(config, set->trajectory[e->trajectory].name) ||
          dig_approach_varies(set, (size_t)e->trajectory))) {
        return false;
    }
    early->next_progress = e->progress + retry_step;

    struct dig_observation seen;
    const enum dig_status  status = dig_live_recording_observe(
         set, &config->estimator, machine, stated, &early->live, &early->scratch, &seen);
    early->off_table_trajectory = status == DIG_ENOMATCH &&
                                          e->progress >= config->match_early_path &&
                                          dig_approach_varies(set, (size_t)e->trajectory)
                                      ? e->trajectory
                                      : -1;
    if (status != DIG_OK || seen.trajectory != e->trajectory ||
        seen.last - seen.first < config->match_early_path) {
        return false;
    }
    early->next_progress = e->progress + DIG_EARLY_MATCH_STEP;
    *dig                 = seen;
    return true;
}
