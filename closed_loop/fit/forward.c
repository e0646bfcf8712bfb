#include "closed_loop/fit/forward.h"

#include "estimator/effects/effect.h"

#include <math.h>
#include <string.h>

static const double least_pace  = 0.05; // range of log(pace) that can show a dependence
static const size_t least_order = 4;    // digs that can show a trend: two that differ are none

static bool is_late(const enum dig_effect_id effect)
{
    return effect == DIG_EFFECT_SENSOR_DELAY;
}

bool dig_hypothesis_differs(const struct dig_hypothesis *const hypothesis)
{
    bool differs = false;
    for (size_t e = 0; e < hypothesis->effects; e++) {
        differs = differs || dig_effect_is_by_dig(hypothesis->effect[e]) ||
                  is_late(hypothesis->effect[e]);
    }
    return differs;
}

size_t dig_hypothesis_free(const struct dig_hypothesis *const hypothesis)
{
    size_t numbers = 0;
    for (size_t e = 0; e < hypothesis->effects; e++) {
        const struct dig_effect *const effect = dig_effect_of(hypothesis->effect[e]);
        numbers += effect != NULL && effect->contrasted ? 2 : 1;
    }
    return numbers;
}

// Without rates, as a machine's, digs show nothing that is late.
static bool any_rate(const struct dig_batch *const batch)
{
    bool any = false;
    for (size_t i = 0; i < batch->digs; i++) {
        const double *const rate = batch->measured[batch->dig[i].measured].rate;
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            any = any || fabs(rate[f]) > 0.0;
        }
    }
    return any;
}

bool dig_hypothesis_possible(const struct dig_batch *const batch, const enum dig_effect_id effect)
{
    if (dig_effect_is_of_machine(effect)) {
        return is_late(effect) && any_rate(batch);
    }
    for (size_t g = 0; g < batch->groups; g++) {
        if (!dig_soil_knows(batch->soil, effect, batch->group[g].trajectory)) {
            return false;
        }
    }
    double least = INFINITY;
    double most  = -INFINITY;
    for (size_t i = 0; i < batch->digs; i++) {
        const double share = dig_soil_share(effect, &batch->measured[batch->dig[i].measured]);
        least              = fmin(least, share);
        most               = fmax(most, share);
    }
    const struct dig_effect *const known = dig_effect_of(effect);
    switch (known != NULL ? known->by : DIG_BY_NOTHING) {
    case DIG_BY_PACE: return most - least > least_pace;
    case DIG_BY_ORDER: return most - least > 0.5 && batch->digs >= least_order;
    // Ground dug before differs from the table's even where all digs are of the same pass.
    case DIG_BY_PASS: return most > 0.5;
    case DIG_BY_NOTHING: break;
    }
    return true;
}

struct dig_plain dig_plain_of(const struct dig_soil *const soil, const size_t trajectory,
                              const double number[])
{
    struct dig_plain plain;
    dig_response_surface_features(soil->surface, trajectory, number, plain.feature,
                                  plain.amplitude);
    return plain;
}

void dig_forward_add(const struct dig_soil *const soil, const struct dig_plain *const plain,
                     const struct dig_hypothesis *const hypothesis, const double number[],
                     const struct dig_measured *const dig, double feature[DIG_FEATURES],
                     double *const noise)
{
    memcpy(feature, plain->feature, sizeof plain->feature);
    if (noise != NULL) {
        *noise = 0.0;
    }
    for (size_t e = 0; e < hypothesis->effects; e++) {
        const double share = dig_soil_share(hypothesis->effect[e], dig);
        for (size_t f = 0; f < DIG_FEATURES && is_late(hypothesis->effect[e]); f++) {
            feature[f] -= number[DIG_AT_U(e)] * dig->rate[f];
        }
        dig_soil_add(soil, hypothesis->effect[e], (size_t)dig->trajectory, number,
                     number[DIG_AT_U(e)], number[DIG_AT_CONTRAST(e)], share, plain->feature,
                     plain->amplitude, feature, noise);
    }
}

double dig_forward_added(const struct dig_batch *const batch, const size_t group,
                         const struct dig_plain *const      plain,
                         const struct dig_hypothesis *const hypothesis, const double number[],
                         double added[DIG_FEATURES])
{
    const struct dig_measured *const first    = dig_batch_first(batch, group);
    const bool                       differs  = dig_hypothesis_differs(hypothesis);
    double                           variance = 0.0;
    memset(added, 0, DIG_FEATURES * sizeof added[0]);
    for (size_t i = 0; hypothesis->effects > 0 && i < batch->digs; i++) {
        const struct dig_measured *const dig = &batch->measured[batch->dig[i].measured];
        const double share = differs ? 1.0 / (double)batch->group[group].digs : 1.0;
        double       with[DIG_FEATURES];
        double       of_one;
        if (batch->dig[i].group != group || (!differs && dig != first)) {
            continue;
        }
        dig_forward_add(batch->soil, plain, hypothesis, number, dig, with, &of_one);
        variance += share * of_one;
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            added[f] += share * (with[f] - plain->feature[f]);
        }
    }
    return variance;
}
