#include "closed_loop/fit/steps.h"

#include <assert.h>

void dig_steps_add(const struct dig_batch *const batch, const double z[], const size_t group,
                   double y[DIG_FEATURES])
{
    assert(batch != NULL && z != NULL && group < batch->groups);
    const struct dig_steps *const steps                 = batch->steps;
    double                        feature[DIG_FEATURES] = { 0.0 };
    double                        added[DIG_FEATURES];
    if (steps == NULL) {
        return;
    }
    for (size_t k = 0; k < steps->steps; k++) {
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            feature[f] += z[k] * steps->of[k][batch->group[group].trajectory][f];
        }
    }
    dig_batch_whiten(&batch->group[group], feature, added);
    for (size_t f = 0; f < batch->group[group].features; f++) {
        y[f] += added[f];
    }
}

void dig_steps_settle(struct dig_batch *const batch, const double z[])
{
    assert(batch != NULL && z != NULL);
    for (size_t g = 0; g < batch->groups; g++) {
        double added[DIG_FEATURES] = { 0.0 };
        dig_steps_add(batch, z, g, added);
        for (size_t i = 0; i < batch->digs; i++) {
            for (size_t f = 0; batch->dig[i].group == g && f < DIG_FEATURES; f++) {
                batch->dig[i].y[f] -= added[f];
            }
        }
    }
    if (batch->steps != NULL) {
        batch->steps = NULL;
        dig_batch_summarise(batch);
    }
}
