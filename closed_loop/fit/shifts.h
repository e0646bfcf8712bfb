// Shifts: the table may have a dig at a neighbouring gravel's place, or an effect at another
// gravel's or magnitude. Each is 1 sigma, as a term of a covariance
// (closed_loop/fit/common_error.h).

#ifndef DIG_CLOSED_LOOP_FIT_SHIFTS_H
#define DIG_CLOSED_LOOP_FIT_SHIFTS_H

#include "closed_loop/fit/forward.h"

/// One for each axis of the gravel, one for each axis of the effects together, and one for each
/// effect's magnitude.
#define DIG_SHIFTS_MAX (2 * DIG_AXES + DIG_HYPOTHESIS_EFFECTS)

struct dig_shifts {
    size_t shifts;
    double of[DIG_SHIFTS_MAX][DIG_FEATURES]; // units of the table
    // 1 sigma, beyond S, of the beds' mean and of the surface in the direction of each axis.
    double as_gravels[DIG_AXES][DIG_FEATURES];
};

/// True where some effect has templates, which may be off.
bool dig_shifts_templated(const struct dig_hypothesis *hypothesis);

/// The shifts of a group's mean dig, each of a trajectory's own. plain: at number; added: what the
/// effects add there.
void dig_shifts_fill(const struct dig_whitened_digs *batch, size_t group,
                     const struct dig_hypothesis *hypothesis, const double number[],
                     const struct dig_plain *plain, const double added[DIG_FEATURES],
                     struct dig_shifts *shifts);

/// 1 sigma, beside an effect of the soil, of the error that all trajectories share: of the gravel's
/// place and of the effects' u. A fit takes it for another gravel, so no residual shows it.
void dig_shifts_common(const struct dig_whitened_digs *batch,
                       const struct dig_hypothesis *hypothesis, const double number[],
                       double sigma[DIG_HYPOTHESIS_NUMBERS]);

#endif // DIG_CLOSED_LOOP_FIT_SHIFTS_H
