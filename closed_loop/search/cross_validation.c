#include "closed_loop/search/cross_validation.h"

#include <assert.h>

static bool is_possible(const struct dig_whitened_digs *const batch,
                        const struct dig_hypothesis *const    hypothesis)
{
    bool possible = true;
    for (size_t e = 0; e < hypothesis->effects; e++) {
        possible = possible && dig_hypothesis_possible(batch, hypothesis->effect[e]);
    }
    return possible;
}

// How far one dig of a batch is from what a hypothesis makes of it, fitted to others.
static double miss2(const struct dig_whitened_digs *const batch,
                    const struct dig_whitened_digs *const others, const size_t dig,
                    const struct dig_fitted *const from)
{
    const struct dig_whitened_digs_dig *const   left  = &batch->dig[dig];
    const struct dig_whitened_digs_group *const group = &batch->group[left->group];
    struct dig_fitted                           fitted;
    double                                      y[DIG_FEATURES];
    dig_hypothesis_fit(others, &from->hypothesis, from->number, DIG_FIT_BARE, &fitted);
    dig_fitted_whitened(batch, &fitted, left->group, &batch->measured[left->measured], y);
    dig_steps_add(batch, fitted.z, left->group, y);
    double sum = 0.0;
    for (size_t k = 0; k < group->features; k++) {
        sum += (left->y[k] - y[k]) * (left->y[k] - y[k]);
    }
    return sum;
}

double dig_cross_validation_gain(const struct dig_whitened_digs *const batch,
                                 const struct dig_fitted *const        plain,
                                 const struct dig_fitted *const        chosen)
{
    assert(batch != NULL && plain != NULL && chosen != NULL);
    struct dig_whitened_digs others;
    double                   sum = 0.0;
    for (size_t i = 0; i < batch->digs && batch->digs > 1; i++) {
        dig_whitened_digs_leave_out(batch, i, &others);
        if (is_possible(&others, &chosen->hypothesis)) {
            sum += miss2(batch, &others, i, plain) - miss2(batch, &others, i, chosen);
        }
    }
    return sum;
}
