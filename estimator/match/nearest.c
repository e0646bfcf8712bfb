#include "estimator/match/nearest.h"

#include "core/outline.h"

#include <assert.h>
#include <float.h>
#include <math.h>

// A first pass compares every so many entries, for a good bound to start with. A prime, so that it
// varies along every axis of the table's grid.
enum { FIRST_LOOK = 17 };

// Sums of a few hundred squares are this far off at most, relative to themselves.
static const double sum_slack = 1e-12;

// Slack for the rounding of outlines to float and of the sums, relative to the norm of the
// measurement.
static const double outline_slack = 1e-6;

// What was measured along one trajectory, block by block.
struct measured {
    size_t trajectory;
    double weight[DIG_OUTLINE_BLOCKS]; // 0: not all of its points were measured
    double mean_Nm[DIG_OUTLINE_BLOCKS];
};

struct search {
    const struct dig_curve_set *set;
    const struct dig_pool_sums *sums;
    struct measured             group[DIG_TRAJECTORY_MAX];
    double                      scatter_Nm2, norm2_Nm2;
    int                         nearest; // -1: none yet
    double                      distance;
    double                      limit_Nm2; // a miss above is certainly farther
    double                      reach_Nm2; // an outline that misses by more belongs to one
};

static struct measured measure(const struct dig_pooled *const group)
{
    struct measured m = { .trajectory = group->trajectory };
    for (size_t b = 0; b < DIG_OUTLINE_BLOCKS; b++) {
        const size_t first = b * DIG_OUTLINE_POINTS;
        double       least = group->count[first];
        double       sum   = 0.0;
        for (size_t k = first; k < first + DIG_OUTLINE_POINTS; k++) {
            least = fmin(least, group->count[k]);
            sum += group->mean[DIG_CHANNEL_MY_Nm][k];
        }
        m.weight[b]  = least * DIG_OUTLINE_POINTS;
        m.mean_Nm[b] = sum / DIG_OUTLINE_POINTS;
    }
    return m;
}

// Never above the squared miss of the curve, but for rounding; NaN for a curve that is none.
static double bound_Nm2(const struct search *const s, const size_t entry)
{
    const size_t trajectories = s->set->trajectories;

    double sum[4] = { 0.0 }; // four at a time: a chain of additions waits for each
    for (size_t g = 0; g < s->sums->groups; g++) {
        const struct measured *const m = &s->group[g];
        const float *const           moment_Nm =
            dig_outline_mean(s->set, DIG_CHANNEL_MY_Nm, entry * trajectories + m->trajectory);
        for (size_t b = 0; b < DIG_OUTLINE_BLOCKS; b += 4) {
            for (size_t i = 0; i < 4; i++) {
                const double miss = m->mean_Nm[b + i] - (double)moment_Nm[b + i];
                sum[i] += m->weight[b + i] * miss * miss;
            }
        }
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

// The sum that dig_cell_misfit() makes of an entry, to the last bit; infinite once it is above the
// limit, and for an entry that lacks a trajectory.
static double miss_Nm2(const struct search *const s, const size_t entry)
{
    const struct dig_curve_set *const set = s->set;

    double all = 0.0;
    for (size_t g = 0; g < s->sums->groups; g++) {
        const struct dig_pooled *const group = &s->sums->group[g];
        const size_t                   slot  = entry * set->trajectories + group->trajectory;
        if (set->packings[slot] <= 0) {
            return INFINITY;
        }
        const float *const mean_Nm = set->curve[slot].mean[DIG_CHANNEL_MY_Nm];
        double             sum     = 0.0;
        for (size_t b = 0; b < DIG_OUTLINE_BLOCKS; b++) {
            const size_t first = b * DIG_OUTLINE_POINTS;
            for (size_t k = first; k < first + DIG_OUTLINE_POINTS; k++) {
                const double miss = group->mean[DIG_CHANNEL_MY_Nm][k] - (double)mean_Nm[k];
                sum += group->count[k] * miss * miss;
            }
            if (all + (group->scatter_Nm2 + sum) > s->limit_Nm2) {
                return INFINITY;
            }
        }
        all += group->scatter_Nm2 + sum;
    }
    return all;
}

static void try_entry(struct search *const s, const size_t entry)
{
    const double miss2    = miss_Nm2(s, entry);
    const double distance = sqrt(miss2 / s->norm2_Nm2);
    const bool   first    = !(distance > s->distance) && (int)entry < s->nearest;
    if (!(distance < s->distance || first)) {
        return;
    }
    const double own = sqrt(fmax(miss2 - s->scatter_Nm2, 0.0));
    const double reach =
        own + outline_slack * (own + sqrt(s->norm2_Nm2)) + (double)FLT_MIN; // denormals' rounding
    s->nearest   = (int)entry;
    s->distance  = distance;
    s->limit_Nm2 = miss2 * (1.0 + sum_slack);
    s->reach_Nm2 = reach * reach;
}

// The least bound of a part of the entries: near the nearest, if not it.
static void begin(struct search *const s)
{
    int    at    = -1;
    double least = INFINITY;
    for (size_t e = 0; e < s->set->entries; e += FIRST_LOOK) {
        const double bound = bound_Nm2(s, e);
        if (bound < least) {
            least = bound;
            at    = (int)e;
        }
    }
    if (at >= 0) {
        try_entry(s, (size_t)at);
    }
}

int dig_nearest_find(const struct dig_curve_set *const set, const struct dig_pool_sums *const sums)
{
    assert(set != NULL && set->outline != NULL && sums != NULL);
    struct search s = {
        .set       = set,
        .sums      = sums,
        .nearest   = -1,
        .distance  = INFINITY,
        .limit_Nm2 = INFINITY,
        .reach_Nm2 = INFINITY,
    };
    for (size_t g = 0; g < sums->groups; g++) {
        s.group[g] = measure(&sums->group[g]);
        s.scatter_Nm2 += sums->group[g].scatter_Nm2;
        s.norm2_Nm2 += sums->group[g].norm2_Nm2;
    }
    begin(&s);
    for (size_t e = 0; e < set->entries; e++) {
        if (!(bound_Nm2(&s, e) > s.reach_Nm2)) {
            try_entry(&s, e);
        }
    }
    return s.nearest;
}
