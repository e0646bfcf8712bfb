// Share of a dig's points that lies within the band of its prediction.

#ifndef DIG_CLOSED_LOOP_ACCURACY_COVERAGE_H
#define DIG_CLOSED_LOOP_ACCURACY_COVERAGE_H

#include "core/curve.h"
#include "core/observation.h"

/// Standard deviations to either side of 90 % of normal errors.
#define DIG_COVERAGE_SIGMAS 1.645

/// Over digs; zeroed: none. Forces only of digs that have them.
struct dig_coverage {
    size_t points[DIG_FORCE_CHANNELS];
    size_t inside[DIG_FORCE_CHANNELS];
};

/// Adds the points that were measured of one dig, equally spaced over its path. curve: what was
/// predicted, with 1 sigma of one dig; the measurement's own sigma is added in quadrature.
void dig_coverage_add(struct dig_coverage *coverage, const struct dig_observation *dig,
                      const struct dig_curve *curve);

/// Share of the points within the band; NaN when the channel was not measured.
double dig_coverage_share(const struct dig_coverage *coverage, enum dig_channel channel);

#endif // DIG_CLOSED_LOOP_ACCURACY_COVERAGE_H
