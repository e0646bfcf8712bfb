// The estimator: samples in; soil wrench, phase, trajectory and finished digs out. Pure C: no I/O,
// no clock, no allocation; the caller owns every struct. A sample walks
//
//   sample -> wrench -> phase -> track -> window of the dig -> observation
//
// This header serves whoever steps an estimator. estimator_tick.h adds what the real-time tick
// exchanges with the matching thread; matching and forecasting stand in match/ and predict/.

#ifndef DIG_ESTIMATOR_ESTIMATOR_H
#define DIG_ESTIMATOR_ESTIMATOR_H

#include "core/curve.h"
#include "core/machine.h"
#include "core/observation.h"
#include "core/sample.h"
#include "core/status.h"
#include "estimator/track/estimate.h"
#include "estimator/track/settings.h"

#include <stdbool.h>
#include <stddef.h>

struct dig_estimator; // estimator/estimator_state.h: fixed size

/// Size of the struct, about 2 MB: for allocating one.
size_t dig_estimator_size(void);

/// Initialises; lambda is the machine's tooth length over the table's. The machine and the set must
/// outlive the estimator; the settings are copied. DIG_EINVAL: machine, set or a setting fails its
/// check. DIG_EUNREACHABLE: the bucket linkage does not close over its range. Nothing is written
/// then. About a millisecond.
DIG_MUST_CHECK enum dig_status dig_estimator_init(struct dig_estimator                *estimator,
                                                  const struct dig_machine            *machine,
                                                  const struct dig_curve_set          *set,
                                                  const struct dig_estimator_settings *settings);

/// One tick. DIG_ESTALE: a sample without a moment, or not younger than the last. DIG_EINVAL: a
/// number that is not finite. State and *estimate are unchanged then. Constant time, but for the
/// tick that ends a dig while no memory was lent: it observes the dig, one to two milliseconds.
DIG_MUST_CHECK enum dig_status dig_estimator_step(struct dig_estimator    *estimator,
                                                  const struct dig_sample *sample,
                                                  struct dig_estimate     *estimate);

/// True once after every finished dig along a trajectory of the table, while no memory was lent:
/// copies its observation out.
bool dig_estimator_take_observation(struct dig_estimator   *estimator,
                                    struct dig_observation *observation);

#endif // DIG_ESTIMATOR_ESTIMATOR_H
