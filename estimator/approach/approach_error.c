#include "estimator/approach/approach_error.h"

#include "estimator/approach/approach_response.h"
#include "estimator/approach/approaches.h"

#include <assert.h>
#include <math.h>

// A mean of squares minus the part of their scatter.
struct mean {
    double sum[DIG_CHANNELS];
    double count;
};

static void add(struct mean *const mean, const int channel, const double square)
{
    mean->sum[channel] += square;
    mean->count += channel == 0 ? 1.0 : 0.0;
}

static void finish(const struct mean *const mean, double root[const DIG_CHANNELS])
{
    for (int c = 0; c < DIG_CHANNELS; c++) {
        const double square = mean->count > 0.0 ? mean->sum[c] / mean->count : 0.0;
        root[c]             = square > 0.0 ? sqrt(square) : 0.0; // a mass not known: NaN, no error
    }
}

static double mean_square(const double a[const DIG_CURVE_POINTS],
                          const double b[const DIG_CURVE_POINTS])
{
    double sum = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    }
    return sum / DIG_CURVE_POINTS;
}

// A table without the i-th node of one gravel, which is then predicted from the rest.
static struct dig_nodes without(const struct dig_nodes *const nodes, const size_t i)
{
    struct dig_nodes rest = *nodes;
    rest.nodes--;
    for (size_t k = i; k < rest.nodes; k++) {
        rest.approach[k] = nodes->approach[k + 1];
        rest.packings[k] = nodes->packings[k + 1];
        rest.curve[k]    = nodes->curve[k + 1];
    }
    return rest;
}

// Mean square of the scatter of one node's mean, relative to the plain curve.
static double scatter_of(const struct dig_nodes *const    nodes,
                         const struct dig_approach *const approach, const int channel)
{
    size_t i = 0;
    while (i + 1 < nodes->nodes && !dig_approach_is_same(&nodes->approach[i], approach)) {
        i++;
    }
    double scatter2 = 0.0;
    double whole2   = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double sd   = (double)nodes->curve[i]->sd[channel][k];
        const double mean = (double)nodes->curve[0]->mean[channel][k];
        scatter2 += sd * sd / (double)nodes->packings[i];
        whole2 += mean * mean;
    }
    return whole2 > 0.0 ? scatter2 / whole2 : 0.0;
}

// Leaves one node of an axis out and interpolates it: curvature = (c - interpolated) / (h1 h2).
static void leave_out(const struct dig_curve_set *const set, const size_t entry,
                      const size_t trajectory, const struct dig_nodes *const nodes, const size_t i,
                      const bool attack, struct mean *const bend)
{
    const struct dig_nodes    rest  = without(nodes, i);
    const struct dig_approach at    = nodes->approach[i];
    const double              value = dig_approach_on_axis(&at, attack);
    double                    low   = 0.0;
    double                    high  = 0.0;
    if (!dig_approach_span(&rest, attack, value, &low, &high) || !(high > low)) {
        return;
    }
    const struct dig_approach plain = dig_approach_plain();
    struct dig_approach       below = plain;
    struct dig_approach       above = plain;
    if (attack) {
        below.attack_rad = low;
        above.attack_rad = high;
    } else {
        below.depth = low;
        above.depth = high;
    }
    struct dig_response here;
    struct dig_response one;
    struct dig_response two;
    if (!dig_response_own(set, entry, trajectory, &at, &plain, &here) ||
        !dig_response_own(set, entry, trajectory, &below, &plain, &one) ||
        !dig_response_own(set, entry, trajectory, &above, &plain, &two)) {
        return;
    }
    const double f     = (value - low) / (high - low);
    const double steps = (value - low) * (high - value);
    for (int c = 0; c < DIG_CHANNELS; c++) {
        double interpolated[DIG_CURVE_POINTS];
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            interpolated[k] = (1.0 - f) * one.change[c][k] + f * two.change[c][k];
        }
        const double scatter2 = scatter_of(nodes, &at, c) +
                                (1.0 - f) * (1.0 - f) * scatter_of(nodes, &below, c) +
                                f * f * scatter_of(nodes, &above, c);
        add(bend, c, (mean_square(here.change[c], interpolated) - scatter2) / (steps * steps));
    }
}

// The whole change on an axis whose curvature is not known.
static void take_all(const struct dig_curve_set *const set, const size_t entry,
                     const size_t trajectory, const struct dig_nodes *const nodes, const size_t i,
                     const bool attack, struct mean *const bend)
{
    static const double       nothing[DIG_CURVE_POINTS];
    const struct dig_approach plain = dig_approach_plain();
    struct dig_response       here;
    const double              step =
        dig_approach_on_axis(&nodes->approach[i], attack) - dig_approach_on_axis(&plain, attack);
    if (fabs(step) > 0.0 &&
        dig_response_own(set, entry, trajectory, &nodes->approach[i], &plain, &here)) {
        for (int c = 0; c < DIG_CHANNELS; c++) {
            add(bend, c,
                (mean_square(here.change[c], nothing) - here.scatter2[c]) / pow(step, 4.0));
        }
    }
}

static bool is_on_axis(const struct dig_approach *const approach, const bool attack)
{
    const struct dig_approach plain = dig_approach_plain();
    return fabs(dig_approach_on_axis(approach, !attack) - dig_approach_on_axis(&plain, !attack)) <
           1e-9;
}

static void measure_axis(const struct dig_curve_set *const set, const size_t trajectory,
                         const bool attack, double bend[const DIG_CHANNELS])
{
    struct mean left_out = { .count = 0.0 };
    struct mean whole    = { .count = 0.0 };
    for (size_t e = 0; e < set->entries; e++) {
        struct dig_nodes nodes;
        dig_nodes_of(set, e, trajectory, &nodes);
        for (size_t i = 0; nodes.nodes > 1 && i < nodes.nodes; i++) {
            if (is_on_axis(&nodes.approach[i], attack)) {
                leave_out(set, e, trajectory, &nodes, i, attack, &left_out);
                take_all(set, e, trajectory, &nodes, i, attack, &whole);
            }
        }
    }
    finish(left_out.count > 0.0 ? &left_out : &whole, bend);
}

static void measure_borrowed(const struct dig_curve_set *const set, const size_t trajectory,
                             struct dig_approach_error *const error)
{
    static const double       nothing[DIG_CURVE_POINTS];
    const struct dig_approach plain    = dig_approach_plain();
    struct mean               left_out = { .count = 0.0 };
    struct mean               whole    = { .count = 0.0 };
    for (size_t e = 0; e < set->entries; e++) {
        struct dig_nodes nodes;
        dig_nodes_of(set, e, trajectory, &nodes);
        for (size_t i = 1; i < nodes.nodes; i++) {
            struct dig_response own;
            struct dig_response others;
            error->farthest_m =
                fmax(error->farthest_m,
                     dig_approach_distance_m(set, trajectory, &nodes.approach[i], &plain));
            if (!dig_response_own(set, e, trajectory, &nodes.approach[i], &nodes.approach[i],
                                  &own)) {
                continue;
            }
            const bool any =
                dig_response_borrowed(set, e, trajectory, &nodes.approach[i], NULL, &others);
            for (int c = 0; c < DIG_CHANNELS; c++) {
                add(&whole, c, mean_square(own.change[c], nothing) - own.scatter2[c]);
                if (any) {
                    add(&left_out, c,
                        mean_square(own.change[c], others.change[c]) - own.scatter2[c] -
                            others.scatter2[c]);
                }
            }
        }
    }
    finish(left_out.count > 0.0 ? &left_out : &whole, error->borrowed);
}

void dig_approach_error_measure(const struct dig_curve_set *const set, const size_t trajectory,
                                struct dig_approach_error *const error)
{
    assert(set != NULL && trajectory < set->trajectories && error != NULL);
    struct dig_approach_error made = { .farthest_m = 0.0 };
    measure_axis(set, trajectory, false, made.bend_depth);
    measure_axis(set, trajectory, true, made.bend_attack);
    measure_borrowed(set, trajectory, &made);
    *error = made;
}
