#include "firmware_host/matching/matcher.h"

#include "estimator/approach/approach_slots.h"
#include "estimator/match/depth.h"
#include "tables/load.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

void dig_matcher_exchange(struct dig_matcher *const matcher, struct dig_curve_set *const set,
                          const double lambda)
{
    assert(matcher != NULL && set != NULL && matcher->retiring == NULL);
    matcher->retiring = matcher->set;
    matcher->set      = set;
    matcher->lambda   = lambda;
    matcher->generation++;
    matcher->varies = false;
    for (size_t t = 0; t < set->trajectories; t++) {
        if (dig_approach_varies(set, t)) {
            dig_approach_error_measure(set, t, &matcher->error[t]);
            matcher->varies = true;
        }
    }
}

bool dig_matcher_is_of_tick(const struct dig_matcher *const matcher)
{
    assert(matcher != NULL);
    return atomic_load(matcher->tick_generation) == matcher->generation;
}

void dig_matcher_retire(struct dig_matcher *const matcher)
{
    assert(matcher != NULL);
    if (matcher->retiring != NULL && dig_matcher_is_of_tick(matcher) &&
        atomic_load(matcher->publisher_generation) == matcher->generation) {
        dig_curve_set_destroy(matcher->retiring);
        matcher->retiring = NULL;
    }
}

static bool make_room(struct dig_matcher *const matcher, const size_t bytes)
{
    if (bytes > matcher->bytes) {
        void *const grown = realloc(matcher->memory, bytes);
        if (grown == NULL) {
            return false;
        }
        matcher->memory = grown;
        matcher->bytes  = bytes;
    }
    return true;
}

enum dig_status dig_matcher_fit_depth(struct dig_matcher *const matcher, const double limit_m,
                                      struct dig_observation *const dig)
{
    assert(matcher != NULL && matcher->set != NULL && dig != NULL);
    return make_room(matcher, dig_depth_fit_size(matcher->set))
               ? dig_depth_fit(matcher->set, matcher->error, limit_m, matcher->memory, dig)
               : DIG_ENOMEM;
}

// The table at the depths and attacks of the digs; matcher->dig holds the digs along its
// trajectories. NULL without memory.
static const struct dig_curve_set *as_dug(struct dig_matcher *const matcher, const size_t digs,
                                          const struct dig_observation dig[])
{
    assert(digs >= 1 && digs <= DIG_POOL_MAX);
    _Static_assert(DIG_POOL_MAX <= DIG_TRAJECTORY_MAX, "each dig of a pool finds a slot");
    const struct dig_curve_set *const set   = matcher->set;
    struct dig_approach_slots         slots = { .slots = 0 };
    memcpy(matcher->dig, dig, digs * sizeof *dig);
    for (size_t d = 0; d < digs; d++) {
        matcher->dig[d].trajectory =
            dig_approach_slot(set, (size_t)dig[d].trajectory, &dig[d].approach, &slots);
    }
    return make_room(matcher, dig_approached_size(set, slots.slots))
               ? dig_approached_make(set, slots.slots, slots.slot, matcher->error, matcher->memory)
               : NULL;
}

enum dig_status dig_matcher_match(struct dig_matcher *const matcher, const size_t digs,
                                  const struct dig_observation dig[], const double outside_floors,
                                  const int max_evaluations, struct dig_match *const match,
                                  enum dig_status *const refined)
{
    assert(matcher != NULL && matcher->set != NULL && refined != NULL);
    const struct dig_curve_set *const set =
        matcher->varies ? as_dug(matcher, digs, dig) : matcher->set;
    const struct dig_observation *const as = matcher->varies ? matcher->dig : dig;
    if (set == NULL) {
        return DIG_ENOMEM;
    }
    const enum dig_status status = dig_match_nearest(set, digs, as, outside_floors, match);
    if (status == DIG_OK) {
        dig_match_find_weighted(set, digs, as, match);
        *refined = dig_fit_refine(set, digs, as, max_evaluations, match);
    }
    return status;
}

void dig_matcher_expect(struct dig_matcher *const matcher, const struct dig_match *const match,
                        const size_t trajectory, const struct dig_approach *const approach,
                        struct dig_expected *const expected)
{
    assert(matcher != NULL && matcher->set != NULL && expected != NULL);
    expected->valid     = false;
    expected->off_table = false;
    if (make_room(matcher, dig_approached_size(matcher->set, 1))) {
        dig_forecast_as_dug(matcher->set, matcher->lambda, match, trajectory, approach,
                            matcher->error, matcher->memory, expected);
    }
}

void dig_matcher_finish(struct dig_matcher *const matcher)
{
    assert(matcher != NULL);
    dig_curve_set_destroy(matcher->retiring);
    dig_curve_set_destroy(matcher->set);
    free(matcher->memory);
    *matcher = (struct dig_matcher){ .set = NULL };
}
