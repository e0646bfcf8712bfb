#include "estimator/match/prefilter.h"

#include <assert.h>
#include <math.h>

double dig_prefilter_relative2(const struct dig_curve_set *const set, const size_t trajectory,
                               const enum dig_channel channel)
{
    assert(set != NULL && trajectory < set->trajectories);
    double sum     = 0.0;
    double entries = 0.0;
    for (size_t e = 0; e < set->entries; e++) {
        const size_t slot = e * set->trajectories + trajectory;
        if (set->packings[slot] <= 0) {
            continue;
        }
        const struct dig_curve *const curve = &set->curve[slot];

        // Each entry counts alike, however hard it resists.
        const double mean2 = dig_curve_mean_square(curve->mean[channel]);
        if (mean2 > 0.0) {
            sum += dig_curve_mean_square(curve->sd[channel]) / mean2;
            entries += 1.0;
        }
    }
    return entries > 0.0 ? sum / entries : 0.0;
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
    return DIG_OUTLINE_LAYERS * set->entries * set->trajectories;
}

void dig_prefilter_make(const struct dig_curve_set *const set, struct dig_outline outline[],
                        struct dig_prefilter *const prefilter)
{
    assert(set != NULL && outline != NULL && prefilter != NULL);
    const size_t curves = set->entries * set->trajectories;
    for (size_t slot = 0; slot < curves; slot++) {
        for (size_t layer = 0; layer < DIG_OUTLINE_LAYERS; layer++) {
            struct dig_outline *const     to    = &outline[dig_outline_place(set, layer, slot)];
            const struct dig_curve *const curve = &set->curve[slot];
            if (set->packings[slot] > 0) {
                dig_outline_draw(layer % 2 == 0 ? curve->mean[layer / 2] : curve->sd[layer / 2],
                                 to);
            } else {
                draw_none(to);
            }
        }
    }
    *prefilter = (struct dig_prefilter){ .set = set, .outline = outline };
    for (size_t t = 0; t < set->trajectories; t++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            prefilter->relative2[t][c] = dig_prefilter_relative2(set, t, (enum dig_channel)c);
        }
    }
}
