#include "closed_loop/fit/same_bed.h"

#include <assert.h>
#include <math.h>

// Of a normal distribution, exceeded once in a million.
static const double sigmas = 4.75;

// Chi-squared of so many degrees that is undercut once in a million (Wilson and Hilferty 1931).
static double least_chi2(const double degrees)
{
    const double spread = 2.0 / (9.0 * degrees);
    return degrees * pow(fmax(1.0 - spread - sigmas * sqrt(spread), 0.0), 3.0);
}

static bool are_one(const struct dig_whitened_digs *const     batch,
                    const struct dig_whitened_digs_dig *const a,
                    const struct dig_whitened_digs_dig *const b)
{
    const size_t features = batch->group[a->group].features;
    double       apart2   = 0.0;
    for (size_t k = 0; k < features; k++) {
        apart2 += pow(a->y[k] - b->y[k], 2.0);
    }
    return a->group == b->group && 0.5 * apart2 < least_chi2((double)features);
}

size_t dig_same_bed_count(const struct dig_whitened_digs *const batch, const size_t group)
{
    assert(batch != NULL && group < batch->groups);
    size_t beds = 0;
    for (size_t i = 0; i < batch->digs; i++) {
        bool is_new = batch->dig[i].group == group;
        for (size_t j = 0; j < i; j++) {
            is_new = is_new && !are_one(batch, &batch->dig[i], &batch->dig[j]);
        }
        beds += is_new ? 1 : 0;
    }
    return beds;
}
