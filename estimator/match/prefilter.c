#include "estimator/match/prefilter.h"

#include <assert.h>
#include <math.h>

enum { NUMBERS = DIG_COVARIANCE_NUMBERS };

// Adds those of one channel of a curve. Each entry counts alike, however hard it resists.
static void add_relative2(const struct dig_curve *const curve, const size_t channel,
                          const double share, double relative2[const DIG_COVARIANCE_BLOCKS])
{
    enum { WIDE = DIG_CURVE_POINTS / DIG_COVARIANCE_BLOCKS };
    const double mean2 = dig_curve_mean_square(curve->mean[channel]);
    const double error = (double)curve->error[channel];
    for (size_t b = 0; b < DIG_COVARIANCE_BLOCKS && mean2 > 0.0; b++) {
        double sum = 0.0;
        for (size_t k = b * WIDE; k < (b + 1) * WIDE; k++) {
            sum += (double)curve->sd[channel][k] * (double)curve->sd[channel][k];
        }
        relative2[b] += share * fmax(sum / WIDE / mean2 - error * error, 0.0);
    }
}

void dig_prefilter_relative2(const struct dig_curve_set *const set, const size_t trajectory,
                             double relative2[const NUMBERS])
{
    assert(set != NULL && trajectory < set->trajectories);
    double entries = 0.0;
    for (size_t e = 0; e < set->entries; e++) {
        entries += set->packings[e * set->trajectories + trajectory] > 0 ? 1.0 : 0.0;
    }
    for (size_t n = 0; n < NUMBERS; n++) {
        relative2[n] = 0.0;
    }
    for (size_t e = 0; e < set->entries; e++) {
        const size_t slot = e * set->trajectories + trajectory;
        for (size_t c = 0; c < DIG_FORCE_CHANNELS && set->packings[slot] > 0; c++) {
            add_relative2(&set->curve[slot], c, 1.0 / entries,
                          &relative2[c * DIG_COVARIANCE_BLOCKS]);
        }
    }
}

void dig_outline_draw(const float of[const DIG_CURVE_POINTS], struct dig_outline *const outline)
{
    assert(of != NULL && outline != NULL);
    for (size_t b = 0; b < DIG_OUTLINE_BLOCKS; b++) {
        double sum = 0.0;
        for (size_t i = 0; i < DIG_OUTLINE_POINTS; i++) {
            sum += (double)of[b * DIG_OUTLINE_POINTS + i];
        }
        outline->block[b] = (float)(sum / DIG_OUTLINE_POINTS);
    }
}

static void draw_none(struct dig_outline *const outline)
{
    for (size_t b = 0; b < DIG_OUTLINE_BLOCKS; b++) {
        outline->block[b] = NAN;
    }
}

size_t dig_prefilter_outlines(const struct dig_curve_set *const set)
{
    assert(set != NULL);
    return DIG_FORCE_CHANNELS * set->entries * set->trajectories;
}

void dig_prefilter_make(const struct dig_curve_set *const set, struct dig_outline outline[],
                        struct dig_prefilter *const prefilter)
{
    assert(set != NULL && outline != NULL && prefilter != NULL);
    const size_t curves = set->entries * set->trajectories;
    for (size_t slot = 0; slot < curves; slot++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            struct dig_outline *const to = &outline[dig_outline_place(set, c, slot)];
            if (set->packings[slot] > 0) {
                dig_outline_draw(set->curve[slot].mean[c], to);
            } else {
                draw_none(to);
            }
        }
    }
    *prefilter = (struct dig_prefilter){ .set = set, .outline = outline };
    for (size_t t = 0; t < set->trajectories; t++) {
        dig_prefilter_relative2(set, t, prefilter->relative2[t]);
    }
}
