#include "closed_loop/search/cross_validation.h"

#include "closed_loop/search/search_work.h"

#include <assert.h>
#include <math.h>

static bool is_possible(const struct dig_batch *const      batch,
                        const struct dig_hypothesis *const hypothesis)
{
    bool possible = true;
    for (size_t e = 0; e < hypothesis->effects; e++) {
        possible = possible && dig_hypothesis_possible(batch, hypothesis->effect[e]);
    }
    return possible;
}

// What a hypothesis, fitted to others, makes of one dig of a batch. Returns its log evidence there.
static double predict(const struct dig_batch *const batch, const struct dig_batch *const others,
                      const size_t dig, const struct dig_fitted *const from, double y[DIG_FEATURES])
{
    const struct dig_batch_dig *const left = &batch->dig[dig];
    struct dig_fitted                 fitted;
    dig_hypothesis_fit(others, &from->hypothesis, from->number, DIG_FIT_BARE, &fitted);
    dig_fitted_whitened(batch, &fitted, left->group, &batch->measured[left->measured], y);
    dig_steps_add(batch, fitted.z, left->group, y);
    return -0.5 * fitted.misfit -
           dig_search_penalty(others, dig_hypothesis_free(&from->hypothesis));
}

// By how much what the others say of the effects comes nearer to one dig than none does. Where they
// say little the effects count little: any magnitude fits them.
static double gain_of(const struct dig_batch *const batch, const struct dig_batch *const others,
                      const size_t dig, const struct dig_fitted *const plain,
                      const struct dig_fitted *const chosen)
{
    const struct dig_batch_dig *const left = &batch->dig[dig];
    double                            without[DIG_FEATURES];
    double                            with[DIG_FEATURES];
    const double                      evidence =
        predict(batch, others, dig, chosen, with) - predict(batch, others, dig, plain, without);
    const double weight = 1.0 / (1.0 + exp(-evidence));
    double       gain   = 0.0;
    for (size_t k = 0; k < batch->group[left->group].features; k++) {
        const double off  = left->y[k] - without[k];
        const double less = weight * (with[k] - without[k]);
        gain += off * off - (off - less) * (off - less);
    }
    return gain;
}

double dig_cross_validation_gain(const struct dig_batch *const  batch,
                                 const struct dig_fitted *const plain,
                                 const struct dig_fitted *const chosen)
{
    assert(batch != NULL && plain != NULL && chosen != NULL);
    struct dig_batch others;
    double           sum = 0.0;
    for (size_t i = 0; i < batch->digs && batch->digs > 1; i++) {
        dig_batch_leave_out(batch, i, &others);
        if (is_possible(&others, &chosen->hypothesis)) {
            sum += gain_of(batch, &others, i, plain, chosen);
        }
    }
    return sum;
}
