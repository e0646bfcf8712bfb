// The table may have a dig at another place than its own: what a gravel beside this one would dig,
// and what an effect would do at another gravel or magnitude. In 1 sigma of each, so that they are
// terms of a covariance.

#ifndef DIG_CLOSED_LOOP_FIT_SHIFTS_H
#define DIG_CLOSED_LOOP_FIT_SHIFTS_H

#include "closed_loop/fit/forward.h"

/// Of the gravel; of all effects together by the gravel, and of each by its magnitude.
#define DIG_SHIFTS_MAX (2 * DIG_AXES + DIG_HYPOTHESIS_EFFECTS)

struct dig_shifts {
    size_t shifts;
    double of[DIG_SHIFTS_MAX][DIG_FEATURES]; // units of the table
    // What the mean of so many beds and the surface differ by as other gravels do, beyond S.
    double as_gravels[DIG_AXES][DIG_FEATURES];
};

/// The shifts of a group's mean dig, each of a trajectory's own. plain: at number; added: what the
/// effects add there.
void dig_shifts_fill(const struct dig_whitened_digs *batch, size_t group,
                     const struct dig_hypothesis *hypothesis, const double number[],
                     const struct dig_plain *plain, const double added[DIG_FEATURES],
                     struct dig_shifts *shifts);

/// 1 sigma of what all trajectories share: beside an effect of the soil, of a gravel's place and of
/// the effects' u. A fit takes it for another gravel, so that nothing shows it.
void dig_shifts_common(const struct dig_whitened_digs *batch,
                       const struct dig_hypothesis *hypothesis, const double number[],
                       double sigma[DIG_HYPOTHESIS_NUMBERS]);

#endif // DIG_CLOSED_LOOP_FIT_SHIFTS_H
