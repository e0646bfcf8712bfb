#include "estimator/approach/approached.h"

#include "estimator/approach/approach_error.h"
#include "estimator/approach/approach_response.h"
#include "estimator/approach/approaches.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

// The parts of the memory, each aligned for its type.
struct layout {
    size_t packings, curve, whole;
};

static size_t up_to(const size_t offset, const size_t alignment)
{
    return (offset + alignment - 1) / alignment * alignment;
}

static struct layout lay_out(const struct dig_curve_set *const set, const size_t slots)
{
    const size_t  n = set->entries * slots;
    struct layout l = { .packings = up_to(sizeof(struct dig_curve_set), _Alignof(int)) };
    l.curve         = up_to(l.packings + n * sizeof(int), _Alignof(struct dig_curve));
    l.whole         = l.curve + n * sizeof(struct dig_curve);
    return l;
}

size_t dig_approached_size(const struct dig_curve_set *const set, const size_t slots)
{
    assert(set != NULL && slots >= 1 && slots <= DIG_TRAJECTORY_MAX);
    return lay_out(set, slots).whole;
}

// The error of the straight line through what the gravel was dug at, relative, squared.
static double bent2(const struct dig_curve_set *const set, const size_t entry,
                    const struct dig_approached_slot *const slot,
                    const struct dig_approach_error *const error, const int channel)
{
    struct dig_nodes nodes;
    double           low  = 0.0;
    double           high = 0.0;
    double           sum  = 0.0;
    dig_nodes_of(set, entry, slot->trajectory, &nodes);
    if (dig_approach_span(&nodes, false, slot->approach.depth, &low, &high)) {
        sum += error->bend_depth[channel] * (slot->approach.depth - low) *
               (high - slot->approach.depth);
    }
    if (dig_approach_span(&nodes, true, slot->approach.attack_rad, &low, &high)) {
        sum += error->bend_attack[channel] * (slot->approach.attack_rad - low) *
               (high - slot->approach.attack_rad);
    }
    return sum * sum;
}

// The error of a borrowed change, in proportion to it.
static double lent2(const struct dig_curve_set *const       set,
                    const struct dig_approached_slot *const slot,
                    const struct dig_approach_error *const error, const int channel)
{
    const struct dig_approach plain = dig_approach_plain();
    const double away_m = dig_approach_distance_m(set, slot->trajectory, &slot->approach, &plain);
    const double part =
        error->farthest_m > 0.0 ? error->borrowed[channel] * away_m / error->farthest_m : 0.0;
    return part * part;
}

// Mean, spread and packings of one entry, changed as the response says.
static int change(const struct dig_response *const response, const struct dig_curve *const plain,
                  const double error2[const DIG_CHANNELS], struct dig_curve *const curve)
{
    for (int c = 0; c < DIG_CHANNELS; c++) {
        double square = 0.0;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double mean = response->plain[c][k] + response->rms[c] * response->change[c][k];
            curve->mean[c][k] = (float)mean;
            square += mean * mean;
        }
        // One dig scatters as the plain one does, in proportion to what it meets.
        const double rms   = response->rms[c];
        const double grown = rms > 0.0 ? sqrt(square / DIG_CURVE_POINTS) / rms : 1.0;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double sd = (double)plain->sd[c][k] * grown;
            curve->sd[c][k] = (float)sqrt(sd * sd + error2[c] * rms * rms);
        }
    }
    const double packings = 1.0 / response->inverse_packings;
    return packings > 1.0 ? (int)packings : 1;
}

static void fill(const struct dig_curve_set *const       set,
                 const struct dig_approached_slot *const slot,
                 const struct dig_approach_error *const error, const size_t entry,
                 int *const packings, struct dig_curve *const curve)
{
    const struct dig_curve *const plain = &set->curve[entry * set->trajectories + slot->trajectory];
    struct dig_response           response;
    double                        error2[DIG_CHANNELS];
    *packings = set->packings[entry * set->trajectories + slot->trajectory];
    if (dig_approach_is_plain(&slot->approach)) {
        *curve = *plain;
        return;
    }
    const bool own =
        dig_response_own(set, entry, slot->trajectory, &slot->approach, &slot->approach, &response);
    if (!own && !dig_response_borrowed(set, entry, slot->trajectory, &slot->approach, &response)) {
        *packings = 0;
        *curve    = *plain;
        return;
    }
    for (int c = 0; c < DIG_CHANNELS; c++) {
        error2[c] = own ? bent2(set, entry, slot, error, c) : lent2(set, slot, error, c);
    }
    *packings = change(&response, plain, error2, curve);
}

const struct dig_curve_set *dig_approached_make(const struct dig_curve_set *const       set,
                                                const size_t                            slots,
                                                const struct dig_approached_slot *const slot,
                                                const struct dig_approach_error *const  error,
                                                void *const                             memory)
{
    assert(set != NULL && slot != NULL && memory != NULL && slots >= 1 &&
           slots <= DIG_TRAJECTORY_MAX);
    const struct layout         l    = lay_out(set, slots);
    struct dig_curve_set *const made = memory;
    *made                            = *set;
    made->approaches                 = NULL;
    made->covariance                 = NULL;
    made->trajectories               = slots;
    made->packings                   = (int *)(void *)((uint8_t *)memory + l.packings);
    made->curve                      = (struct dig_curve *)(void *)((uint8_t *)memory + l.curve);
    for (size_t s = 0; s < slots; s++) {
        assert(slot[s].trajectory < set->trajectories);
        struct dig_approached_slot wanted = slot[s];
        struct dig_approach_error  own    = { .farthest_m = 0.0 };
        wanted.approach                   = dig_approach_normalized(&wanted.approach);
        made->trajectory[s] = dig_response_trajectory(set, wanted.trajectory, &wanted.approach);
        if (error != NULL) {
            own = error[wanted.trajectory];
        } else if (!dig_approach_is_plain(&wanted.approach)) {
            dig_approach_error_measure(set, wanted.trajectory, &own);
        }
        for (size_t e = 0; e < set->entries; e++) {
            fill(set, &wanted, &own, e, &made->packings[e * slots + s],
                 &made->curve[e * slots + s]);
        }
    }
    return made;
}
