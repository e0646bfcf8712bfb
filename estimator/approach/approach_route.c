#include "estimator/approach/approach_route.h"

#include "core/entry_set.h"
#include "estimator/approach/approach_response.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

// Behind the first leg the moment is a mean over this share of the path.
static const double behind = 0.05;

// Of that moment, where the soil counts as resisting.
static const double level[] = { 0.25, 0.5 };

enum { LEVELS = sizeof level / sizeof level[0] };

struct dig_route dig_approach_route(const struct dig_curve_set *const set, const size_t trajectory)
{
    assert(set != NULL && trajectory < set->trajectories);
    const struct dig_entry_set *const other = set->approaches;
    struct dig_route route = dig_route_make(&set->trajectory[trajectory], set->tooth_m);
    for (size_t i = 0; other != NULL && i < other->entries; i++) {
        if (other->packings[i * other->trajectories + trajectory] > 0) {
            const double turn_m = set->tooth_m * other->entry[i].approach.attack_rad;
            route.turn_least_m  = fmin(route.turn_least_m, turn_m);
            route.turn_most_m   = fmax(route.turn_most_m, turn_m);
        }
    }
    return route;
}

struct dig_route dig_approach_route_deep(const struct dig_curve_set *const set,
                                         const size_t trajectory, const double depth)
{
    const struct dig_approach   deep  = { .depth = depth };
    const struct dig_trajectory dug   = dig_response_trajectory(set, trajectory, &deep);
    const struct dig_route      plain = dig_approach_route(set, trajectory);
    struct dig_route            route = dig_route_make(&dug, set->tooth_m);
    const struct dig_path_point by    = dig_path_point_sub(plain.corner[1], route.corner[1]);
    route.turn_least_m                = plain.turn_least_m;
    route.turn_most_m                 = plain.turn_most_m;
    // A trajectory goes deeper in the same time; a dig goes down at its own pace, however deep.
    const double longer_s = plain.at_s[1] * (route.at_m[1] / plain.at_m[1] - 1.0);
    for (size_t i = 0; i < route.corners; i++) {
        route.corner[i] = dig_path_point_add_scaled(route.corner[i], 1.0, by);
        route.at_s[i] += i > 0 ? longer_s : 0.0;
    }
    return route;
}

struct dig_depths dig_approach_depths(const struct dig_curve_set *const set,
                                      const size_t                      trajectory)
{
    assert(set != NULL && trajectory < set->trajectories);
    const struct dig_entry_set *const other  = set->approaches;
    struct dig_depths                 depths = { 1.0, 1.0 };
    for (size_t i = 0; other != NULL && i < other->entries; i++) {
        if (other->packings[i * other->trajectories + trajectory] > 0) {
            depths.least = fmin(depths.least, other->entry[i].approach.depth);
            depths.most  = fmax(depths.most, other->entry[i].approach.depth);
        }
    }
    return depths;
}

// Path length from where the moment reaches the levels to the end of the first leg, m, at most that
// leg; NaN when it does not, or the curve is not measured there.
static double ramp_m(const double moment_Nm[const DIG_CURVE_POINTS], const double first,
                     const double last, const struct dig_route *const route)
{
    const double whole_m = route->at_m[route->corners - 1];
    const double corner  = route->at_m[1] / whole_m;
    const double step    = 1.0 / (DIG_CURVE_POINTS - 1);
    const size_t at      = (size_t)ceil(corner / step);
    const size_t to      = (size_t)floor(fmin(corner + behind, 1.0) / step);
    if (last < (double)to * step || to <= at) {
        return (double)NAN;
    }
    double full_Nm = 0.0;
    for (size_t k = at; k <= to; k++) {
        full_Nm += moment_Nm[k] / (double)(to - at + 1);
    }
    double sum_m = 0.0;
    for (size_t l = 0; l < LEVELS; l++) {
        // From the corner back to where it was last below the level.
        size_t k = at;
        while (k > 0 && moment_Nm[k] > level[l] * full_Nm && (double)k * step > first) {
            k--;
        }
        const bool above = moment_Nm[k] > level[l] * full_Nm;
        if (!(full_Nm > 0.0) || k == at || (above && first > step)) {
            return (double)NAN;
        }
        // It resists from the very start: at least so far.
        const double f =
            above ? 0.0 : (level[l] * full_Nm - moment_Nm[k]) / (moment_Nm[k + 1] - moment_Nm[k]);
        sum_m += (corner - ((double)k + f) * step) * whole_m / LEVELS;
    }
    return sum_m;
}

// The same of the table's curves at one approach, a mean over its gravels.
static double table_ramp_m(const struct dig_curve_set *const set, const size_t trajectory,
                           const struct dig_approach *const approach)
{
    const struct dig_entry_set *const other = set->approaches;
    const struct dig_route route = dig_approach_route_deep(set, trajectory, approach->depth);
    const bool             plain = dig_approach_is_plain(approach);
    const size_t           n     = plain ? set->entries : other->entries;
    double                 sum_m = 0.0;
    double                 count = 0.0;
    for (size_t i = 0; i < n; i++) {
        const size_t slot = i * set->trajectories + trajectory;
        if ((plain ? set->packings[slot] : other->packings[slot]) <= 0 ||
            (!plain && !dig_approach_is_same(&other->entry[i].approach, approach))) {
            continue;
        }
        const struct dig_curve *const curve = plain ? &set->curve[slot] : &other->curve[slot];
        double                        moment_Nm[DIG_CURVE_POINTS];
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            moment_Nm[k] = (double)curve->mean[DIG_CHANNEL_MY_Nm][k];
        }
        const double one_m = ramp_m(moment_Nm, 0.0, 1.0, &route);
        if (isfinite(one_m)) {
            sum_m += one_m;
            count += 1.0;
        }
    }
    return count > 0.0 ? sum_m / count : (double)NAN;
}

// A line through ramps over depth or attack, least squares over those that are known.
struct line {
    double n, x, ramp_m, xx, xr;
};

static void add(struct line *const line, const double x, const double ramp_m)
{
    if (isfinite(ramp_m)) {
        line->n += 1.0;
        line->x += x;
        line->ramp_m += ramp_m;
        line->xx += x * x;
        line->xr += x * ramp_m;
    }
}

// Its slope; 0 of fewer than two points.
static double slope_of(const struct line *const line)
{
    const double spread = line->n * line->xx - line->x * line->x;
    return line->n >= 2.0 && spread > 0.0 ? (line->n * line->xr - line->x * line->ramp_m) / spread
                                          : 0.0;
}

// The ramps over depth at attack 0, or over attack at depth 1.
static struct line line_of(const struct dig_curve_set *const set, const size_t trajectory,
                           const bool attack)
{
    const struct dig_entry_set *const other = set->approaches;
    const struct dig_approach         plain = dig_approach_plain();
    struct line                       line  = { .n = 0.0 };
    add(&line, attack ? 0.0 : 1.0, table_ramp_m(set, trajectory, &plain));
    for (size_t i = 0; i < other->entries; i++) {
        const struct dig_approach *const at     = &other->entry[i].approach;
        const struct dig_approach        deep   = { .depth = at->depth };
        const struct dig_approach        turned = { .attack_rad = at->attack_rad };

        bool new = dig_approach_is_same(at, attack ? &turned : &deep) &&
                   other->packings[i * other->trajectories + trajectory] > 0;
        for (size_t k = 0; new &&k < i; k++) {
            new = !dig_approach_is_same(at, &other->entry[k].approach);
        }
        if (new) {
            add(&line, attack ? at->attack_rad : at->depth, table_ramp_m(set, trajectory, at));
        }
    }
    return line;
}

double dig_approach_depth(const struct dig_curve_set *const set, const size_t trajectory,
                          const double deepest, const double attack_rad, const double first,
                          const double last, const double moment_Nm[const DIG_CURVE_POINTS])
{
    assert(set != NULL && trajectory < set->trajectories && moment_Nm != NULL);
    if (set->approaches == NULL) {
        return 1.0;
    }
    const struct line      deep   = line_of(set, trajectory, false);
    const struct line      turned = line_of(set, trajectory, true);
    const struct dig_route route  = dig_approach_route_deep(set, trajectory, deepest);
    const double           slope  = slope_of(&deep);
    const double own_m = ramp_m(moment_Nm, first, last, &route) - slope_of(&turned) * attack_rad;
    if (!(slope > 0.0) || !isfinite(own_m)) {
        return 1.0;
    }
    const double depth = (deep.x + (deep.n * own_m - deep.ramp_m) / slope) / deep.n;
    return fmin(fmax(depth, DIG_APPROACH_DEPTH_LEAST), DIG_APPROACH_DEPTH_MOST);
}
