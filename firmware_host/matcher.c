#include "firmware_host/matcher.h"

#include <assert.h>
#include <stdlib.h>

void dig_matcher_take_up(struct dig_matcher *const matcher, const struct dig_curve_set *const set)
{
    assert(matcher != NULL && set != NULL);
    dig_matcher_finish(matcher);
    matcher->outline = calloc(dig_summary_outlines(set) + 1, sizeof *matcher->outline);
    if (matcher->outline != NULL) {
        dig_summary_make(set, matcher->outline, &matcher->summary);
    }
}

enum dig_status dig_matcher_nearest(const struct dig_matcher *const   matcher,
                                    const struct dig_curve_set *const set, const size_t digs,
                                    const struct dig_observation dig[], const double outside_floors,
                                    struct dig_match *const match)
{
    assert(matcher != NULL && (matcher->outline == NULL || matcher->summary.set == set));
    return matcher->outline != NULL
               ? dig_match_nearest_by(&matcher->summary, digs, dig, outside_floors, match)
               : dig_match_nearest_pool(set, digs, dig, outside_floors, match);
}

enum dig_status dig_matcher_refine(const struct dig_matcher *const   matcher,
                                   const struct dig_curve_set *const set, const size_t digs,
                                   const struct dig_observation dig[], const int max_evaluations,
                                   struct dig_match *const match)
{
    assert(matcher != NULL && (matcher->outline == NULL || matcher->summary.set == set));
    return matcher->outline != NULL
               ? dig_fit_refine_by(&matcher->summary, digs, dig, max_evaluations, match)
               : dig_fit_refine_pool(set, digs, dig, max_evaluations, match);
}

void dig_matcher_finish(struct dig_matcher *const matcher)
{
    if (matcher != NULL) {
        free(matcher->outline);
        *matcher = (struct dig_matcher){ .outline = NULL };
    }
}
