// Tests whether digs drift as by wear, by the same share from one to the next.
//
// The size of every dig over the gravel's without wear is f = <y, m> / <m, m>, with a variance of
// 1 / <m, m>. It is fitted by a line in the digs' order, by a parabola, and by sizes in no order,
// of any variance; each with a constant for every trajectory. A strength that grows and comes to
// rest, or steps once, is a drift, too, but of something else than a tooth, and a line through it
// overshoots the next dig. Where one dig is deeper, or of another gravel, a line leads digs that
// are all alike, but not sizes in no order.

#include "closed_loop/numeric/dense.h"
#include "closed_loop/search/search_work.h"

#include <assert.h>
#include <math.h>

enum { ORDER, SQUARE, SIZE, COLUMNS };

// By dig, each times the root of its weight.
struct columns {
    double weight[DIG_MEASURED_MAX]; // that root: what a constant is
    double of[COLUMNS][DIG_MEASURED_MAX];
};

// A larger dig than its group's mean one, whose scatter is 1, scatters more.
static void measure(const struct dig_batch *const batch, const struct dig_fitted *const fitted,
                    const size_t wear, struct columns *const columns)
{
    struct dig_fitted fresh                    = *fitted;
    double            mean[DIG_TRAJECTORY_MAX] = { 0.0 }; // how much larger, of a group
    double            larger[DIG_MEASURED_MAX];
    fresh.number[DIG_AT_U(wear)] = 0.0;
    for (size_t i = 0; i < batch->digs; i++) {
        const size_t g = batch->dig[i].group;
        larger[i]      = 1.0 + fitted->number[DIG_AT_U(wear)] *
                              (double)batch->measured[batch->dig[i].measured].order;
        mean[g] += larger[i] / (double)batch->group[g].digs;
    }
    for (size_t i = 0; i < batch->digs; i++) {
        const struct dig_batch_dig *const dig      = &batch->dig[i];
        const size_t                      features = batch->group[dig->group].features;
        const double                      order    = (double)batch->measured[dig->measured].order;
        double                            model[DIG_FEATURES];
        dig_fitted_whitened(batch, &fresh, dig->group, &batch->measured[dig->measured], model);
        const double own       = dig_product(features, model, model);
        const double weight    = sqrt(own) / (larger[i] / mean[dig->group]);
        columns->weight[i]     = weight;
        columns->of[ORDER][i]  = weight * order;
        columns->of[SQUARE][i] = weight * order * order;
        columns->of[SIZE][i]   = weight * dig_product(features, dig->y, model) / own;
    }
}

// Leaves of a column what is not in another; which may be nothing.
static void take_off(const size_t digs, const double other[], double column[])
{
    const double square = dig_product(digs, other, other);
    const double share  = square > 0.0 ? dig_product(digs, other, column) / square : 0.0;
    for (size_t i = 0; i < digs; i++) {
        column[i] -= share * other[i];
    }
}

// Leaves of all columns what is not a number of its own for every trajectory.
static void take_off_groups(const struct dig_batch *const batch, struct columns *const columns)
{
    for (size_t g = 0; g < batch->groups; g++) {
        double one[DIG_MEASURED_MAX];
        for (size_t i = 0; i < batch->digs; i++) {
            one[i] = batch->dig[i].group == g ? columns->weight[i] : 0.0;
        }
        for (size_t c = 0; c < COLUMNS; c++) {
            take_off(batch->digs, one, columns->of[c]);
        }
    }
}

// The log likelihood of n numbers with the variance that they have, but no less than 1.
static double of_no_order(const double n, const double squares)
{
    const double variance = fmax(squares / n, 1.0);
    return -0.5 * (squares / variance + n * log(variance));
}

struct dig_drift dig_drift_of(const struct dig_batch *const  batch,
                              const struct dig_fitted *const fitted, const double spread)
{
    assert(batch != NULL && fitted != NULL && spread > 0.0);
    const struct dig_hypothesis *const by    = &fitted->hypothesis;
    const size_t                       digs  = batch->digs;
    struct dig_drift                   drift = { .line = INFINITY, .parabola = -INFINITY };
    const size_t   wear = dig_effect_place(by->effects, by->effect, DIG_EFFECT_WEAR);
    struct columns columns;
    if (wear == by->effects || digs < batch->groups + 2) {
        return drift;
    }
    measure(batch, fitted, wear, &columns);
    take_off_groups(batch, &columns);
    double *const size   = columns.of[SIZE];
    double *const square = columns.of[SQUARE];
    const double  n      = (double)(digs - batch->groups);
    const double  half   = 0.5 * spread * spread;
    const double  none   = of_no_order(n, 2.0 * half * dig_product(digs, size, size));
    const double  whole  = dig_product(digs, square, square);
    take_off(digs, columns.of[ORDER], square);
    take_off(digs, columns.of[ORDER], size);
    drift.line = -half * dig_product(digs, size, size) - none;
    if (n > 2.0 && dig_product(digs, square, square) > 1e-9 * whole) {
        take_off(digs, square, size);
        drift.parabola = -half * dig_product(digs, size, size) - none;
    }
    return drift;
}
