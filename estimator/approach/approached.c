#include "estimator/approach/approached.h"

#include "core/outline.h"
#include "estimator/approach/approach_error.h"
#include "estimator/approach/approach_response.h"
#include "estimator/approach/approaches.h"
#include "estimator/approach/interpolate.h"
#include "estimator/approach/laid.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

// The parts of the memory, each aligned for its type. The responses of the entries that were dug so
// serve one slot after the other.
struct layout {
    size_t packings, curve, outline, covariance, own, response, whole;
};

static size_t up_to(const size_t offset, const size_t alignment)
{
    return (offset + alignment - 1) / alignment * alignment;
}

// At most so many entries were dug at more than the plain approach.
static size_t dug_otherwise(const struct dig_curve_set *const set)
{
    const size_t ways = set->approaches != NULL ? set->approaches->entries : 0;
    return ways < set->entries ? ways : set->entries;
}

static struct layout lay_out(const struct dig_curve_set *const set, const size_t slots)
{
    const size_t  n = set->entries * slots;
    struct layout l = { .packings = up_to(sizeof(struct dig_curve_set), _Alignof(int)) };
    l.curve         = up_to(l.packings + n * sizeof(int), _Alignof(struct dig_curve));
    l.outline       = up_to(l.curve + n * sizeof(struct dig_curve), _Alignof(struct dig_outline));
    l.covariance    = up_to(l.outline + DIG_FORCE_CHANNELS * n * sizeof(struct dig_outline),
                            _Alignof(struct dig_covariance));
    l.own           = up_to(l.covariance + slots * sizeof(struct dig_covariance),
                            _Alignof(struct dig_response *));
    l.response =
        up_to(l.own + set->entries * sizeof(struct dig_response *), _Alignof(struct dig_response));
    l.whole = l.response + dug_otherwise(set) * sizeof(struct dig_response);
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
        curve->error[c] = grown > 0.0 ? (float)(sqrt(error2[c]) / grown) : 0.0F;
    }
    const double packings = 1.0 / response->inverse_packings;
    return packings > 1.0 ? (int)packings : 1;
}

// The responses of all entries that were dug so far; NULL of the others.
static void respond(const struct dig_curve_set *const       set,
                    const struct dig_approached_slot *const slot, struct dig_response response[],
                    const struct dig_response *own[])
{
    size_t next = 0;
    for (size_t e = 0; e < set->entries; e++) {
        struct dig_nodes nodes;
        dig_nodes_of(set, e, slot->trajectory, &nodes);
        own[e] = NULL;
        if (nodes.nodes > 1 && dig_response_own(set, e, slot->trajectory, &slot->approach,
                                                &slot->approach, &response[next])) {
            own[e] = &response[next++];
        }
    }
}

static void fill(const struct dig_curve_set *const       set,
                 const struct dig_approached_slot *const slot,
                 const struct dig_approach_error *const error, const size_t entry,
                 const struct dig_response *const own[], int *const packings,
                 struct dig_curve *const curve)
{
    const struct dig_curve *const plain = &set->curve[entry * set->trajectories + slot->trajectory];
    const struct dig_response    *response = own[entry];
    struct dig_response           borrowed;
    double                        error2[DIG_CHANNELS];
    if (response == NULL &&
        dig_response_borrowed(set, entry, slot->trajectory, &slot->approach, own, &borrowed)) {
        response = &borrowed;
    }
    if (response == NULL) {
        *packings = 0;
        *curve    = *plain;
        return;
    }
    for (int c = 0; c < DIG_CHANNELS; c++) {
        error2[c] =
            response == &borrowed ? lent2(set, slot, error, c) : bent2(set, entry, slot, error, c);
    }
    *packings = change(response, plain, error2, curve);
}

static void fill_plain(const struct dig_curve_set *const set, const size_t trajectory,
                       const size_t entry, int *const packings, struct dig_curve *const curve)
{
    const size_t at = entry * set->trajectories + trajectory;
    *packings       = set->packings[at];
    *curve          = set->curve[at];
}

static bool is_wanted(const struct dig_cell *const only, const struct dig_curve *const curve)
{
    bool wanted = only == NULL;
    for (size_t i = 0; !wanted && i < only->corners; i++) {
        wanted = only->curve[i] == curve;
    }
    return wanted;
}

// The curves of one slot, each the s-th of its entry.
static void fill_slot(const struct dig_curve_set *const       set,
                      const struct dig_approached_slot *const slot,
                      const struct dig_approach_error *const error, const size_t s,
                      struct dig_response response[], const struct dig_response *own[],
                      struct dig_curve_set *const made)
{
    const double over_depth = slot->over_depth > 0.0 ? slot->over_depth : slot->approach.depth;
    const struct dig_approach over  = { over_depth, slot->approach.attack_rad };
    const bool                plain = dig_approach_is_plain(&slot->approach);
    double                    place[DIG_CURVE_POINTS];
    made->trajectory[s] = dig_response_trajectory(set, slot->trajectory, &over);
    dig_laid_places(set, slot->trajectory, over_depth, slot->approach.depth, place);
    if (!plain) {
        respond(set, slot, response, own);
    }
    for (size_t e = 0; e < set->entries; e++) {
        const size_t                  at = e * made->trajectories + s;
        const struct dig_curve *const of = &set->curve[e * set->trajectories + slot->trajectory];
        if (!is_wanted(slot->only, of)) {
            made->packings[at] = 0;
            made->curve[at]    = *of;
            continue;
        }
        if (plain) {
            fill_plain(set, slot->trajectory, e, &made->packings[at], &made->curve[at]);
        } else {
            fill(set, slot, error, e, own, &made->packings[at], &made->curve[at]);
        }
        if (slot->over_depth > 0.0) {
            dig_laid_curve(place, &made->curve[at]);
        }
    }
}

const struct dig_curve_set *dig_approached_make(const struct dig_curve_set *const       set,
                                                const size_t                            slots,
                                                const struct dig_approached_slot *const slot,
                                                const struct dig_approach_error *const  error,
                                                void *const                             memory)
{
    assert(set != NULL && slot != NULL && memory != NULL && slots >= 1 &&
           slots <= DIG_TRAJECTORY_MAX);
    uint8_t *const              at             = memory;
    const struct layout         l              = lay_out(set, slots);
    struct dig_curve_set *const made           = memory;
    *made                                      = *set;
    made->approaches                           = NULL;
    made->trajectories                         = slots;
    made->packings                             = (int *)(void *)(at + l.packings);
    made->curve                                = (struct dig_curve *)(void *)(at + l.curve);
    made->outline                              = (struct dig_outline *)(void *)(at + l.outline);
    const struct dig_response **const own      = (const struct dig_response **)(void *)(at + l.own);
    struct dig_response *const        response = (struct dig_response *)(void *)(at + l.response);
    struct dig_covariance *const covariance = (struct dig_covariance *)(void *)(at + l.covariance);
    made->covariance                        = set->covariance != NULL ? covariance : NULL;
    for (size_t s = 0; s < slots; s++) {
        assert(slot[s].trajectory < set->trajectories);
        struct dig_approached_slot wanted   = slot[s];
        struct dig_approach_error  measured = { .farthest_m = 0.0 };
        wanted.approach                     = dig_approach_normalized(&wanted.approach);
        if (error != NULL) {
            measured = error[wanted.trajectory];
        } else if (!dig_approach_is_plain(&wanted.approach)) {
            dig_approach_error_measure(set, wanted.trajectory, &measured);
        }
        if (set->covariance != NULL) {
            covariance[s] = set->covariance[wanted.trajectory];
        }
        fill_slot(set, &wanted, &measured, s, response, own, made);
    }
    dig_outlines_draw(made);
    return made;
}
