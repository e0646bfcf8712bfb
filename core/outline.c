#include "core/outline.h"

#include <assert.h>
#include <math.h>

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

static void pool_spread(const struct dig_curve_set *const set, const size_t trajectory,
                        double relative2[const DIG_COVARIANCE_NUMBERS])
{
    double entries = 0.0;
    for (size_t e = 0; e < set->entries; e++) {
        entries += set->packings[e * set->trajectories + trajectory] > 0 ? 1.0 : 0.0;
    }
    for (size_t n = 0; n < DIG_COVARIANCE_NUMBERS; n++) {
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

static void draw(const float of[const DIG_CURVE_POINTS], struct dig_outline *const outline)
{
    for (size_t b = 0; b < DIG_OUTLINE_BLOCKS; b++) {
        double sum = 0.0;
        for (size_t i = 0; i < DIG_OUTLINE_POINTS; i++) {
            sum += (double)of[b * DIG_OUTLINE_POINTS + i];
        }
        outline->block[b] = (float)(sum / DIG_OUTLINE_POINTS);
    }
}

void dig_outlines_draw(struct dig_curve_set *const set)
{
    assert(set != NULL && set->outline != NULL);
    for (size_t slot = 0; slot < set->entries * set->trajectories; slot++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            draw(set->curve[slot].mean[c], &set->outline[dig_outline_place(set, c, slot)]);
        }
    }
    for (size_t t = 0; t < set->trajectories; t++) {
        pool_spread(set, t, set->relative2[t]);
    }
}
