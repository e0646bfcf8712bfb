#include "estimator/match/depth.h"

#include "estimator/approach/approach_route.h"
#include "estimator/approach/approach_slots.h"
#include "estimator/approach/approached.h"
#include "estimator/approach/approaches.h"
#include "estimator/approach/laid.h"
#include "estimator/match/likelihood.h"
#include "estimator/match/match.h"
#include "estimator/match/pool.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

enum { LOOKS = 9 };

// Approaches whose distances from what was dug differ by less, in bucket lengths, are as near.
static const double as_near = 1e-6;

// One depth that is looked at.
struct look {
    struct dig_approach approach; // the nearest to it in the hull
    double              away_m;
    double              evidence; // -infinity: others are nearer to the hull
};

size_t dig_depth_fit_size(const struct dig_curve_set *const set)
{
    return dig_approach_varies_any(set) ? dig_approached_size(set, 1) : 0;
}

static double evidence_at(const struct dig_curve_set *const       set,
                          const struct dig_approach_error         error[],
                          const struct dig_approached_slot *const slot, void *const memory,
                          const struct dig_pool_sums *const sums)
{
    return dig_likelihood_evidence(dig_approached_make(set, 1, slot, error, memory),
                                   &sums->group[0]);
}

static void look_at_all(const struct dig_curve_set *const set,
                        const struct dig_approach_error error[], void *const memory,
                        const struct dig_observation *const dig, struct look look[const LOOKS])
{
    const size_t            t       = (size_t)dig->trajectory;
    const struct dig_depths range   = dig_approach_depths(set, t);
    double                  least_m = INFINITY;
    for (size_t i = 0; i < LOOKS; i++) {
        const double              share = (double)i / (LOOKS - 1);
        const struct dig_approach a     = { range.least + share * (range.most - range.least),
                                            dig->approach.attack_rad };
        look[i].away_m                  = dig_approach_clamp(set, t, &a, &look[i].approach);
        least_m                         = fmin(least_m, look[i].away_m);
    }
    struct dig_observation alone = *dig;
    struct dig_pool_sums   sums;
    alone.trajectory = 0;
    dig_pool_sum(1, &alone, &sums);
    for (size_t i = 0; i < LOOKS; i++) {
        const struct dig_approached_slot slot = { t, look[i].approach, dig->approach.depth, NULL };
        look[i].evidence                      = look[i].away_m <= least_m + as_near * set->tooth_m
                                                    ? evidence_at(set, error, &slot, memory, &sums)
                                                    : -(double)INFINITY;
    }
}

// How far from the middle of three equally far apart, in their spacing, a parabola has its top.
static double top_of(const double before, const double at, const double behind)
{
    const double bend = before - 2.0 * at + behind;
    return isfinite(bend) && bend < 0.0 ? 0.5 * (before - behind) / bend : 0.0;
}

// The likeliest depth, and whether nothing farther was looked at on one side: -1, 1, or 0.
struct told {
    double depth;
    int    end;
};

static struct told tell(const struct look look[const LOOKS])
{
    size_t best = 0;
    for (size_t i = 1; i < LOOKS; i++) {
        best = look[i].evidence > look[best].evidence ? i : best;
    }
    const bool   first = best == 0 || !isfinite(look[best - 1].evidence);
    const bool   last  = best + 1 == LOOKS || !isfinite(look[best + 1].evidence);
    const double at    = look[best].approach.depth;
    if (first || last) {
        return (struct told){ at, first && last ? 0 : first ? -1 : 1 };
    }
    return (struct told){ at + (look[best + 1].approach.depth - at) *
                                   top_of(look[best - 1].evidence, look[best].evidence,
                                          look[best + 1].evidence),
                          0 };
}

enum dig_status dig_depth_fit(const struct dig_curve_set *const set,
                              const struct dig_approach_error error[], const double limit_m,
                              void *const memory, struct dig_observation *const dig)
{
    assert(set != NULL && dig != NULL && (memory != NULL || dig_depth_fit_size(set) == 0));
    if (dig_observations_check(set, 1, dig) != DIG_OK) {
        return DIG_EINVAL;
    }
    const size_t t = (size_t)dig->trajectory;
    if (!dig_approach_varies(set, t)) {
        return DIG_OK;
    }
    struct look look[LOOKS];
    look_at_all(set, error, memory, dig, look);
    const struct told told  = tell(look);
    const double      rough = dig->made.depth;
    const bool beyond = told.end < 0 ? rough < told.depth : told.end > 0 && rough > told.depth;
    struct dig_approach made = { beyond ? rough : told.depth, dig->made.attack_rad };
    struct dig_approach matched;
    const double        off_m = hypot(dig->off_path_m, dig_approach_clamp(set, t, &made, &matched));
    if (!(off_m <= limit_m)) {
        return DIG_ENOMATCH;
    }
    dig_laid_observation(set, matched.depth, dig);
    dig->approach   = matched;
    dig->made       = made;
    dig->off_path_m = off_m;
    return DIG_OK;
}
