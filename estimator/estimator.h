// The estimator: samples in, soil moment, dig phase, match and prediction out. Pure C: no I/O, no
// clock, no allocation after init; the caller owns every struct. A sample walks
//
//   sample -> wrench -> phase -> (window of the dig) -> match -> prediction
//
// dig_estimator_step() is what the real-time tick calls. All that takes long is asked for by
// another thread: the tick hands out a finished dig as it was recorded (lend, take_raw); that
// thread makes an observation of it (dig_recorded_dig_observe), matches it (dig_match_nearest,
// dig_fit_refine), computes what every trajectory will resist with (dig_forecast_make), and hands
// that back (give_forecast). Who has no second thread lends nothing, and uses take_dig and
// give_match instead.

#ifndef DIG_ESTIMATOR_ESTIMATOR_H
#define DIG_ESTIMATOR_ESTIMATOR_H

#include "core/approach.h"
#include "core/curve.h"
#include "core/machine.h"
#include "core/sample.h"
#include "core/status.h"
#include "estimator/match/gravel_match.h"
#include "estimator/predict/forecast.h"
#include "estimator/predict/prediction.h"
#include "estimator/track/estimate.h"
#include "estimator/track/observation.h"
#include "estimator/track/settings.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct dig_estimator; // defined in estimator/estimator_state.h; about 1 MB, fixed size

size_t dig_estimator_size(void);

/// lambda = machine's tooth length / table's. The machine and the set must outlive it; the settings
/// are copied. DIG_EINVAL for a machine, set or setting that fails its check; DIG_EUNREACHABLE for
/// a bucket linkage that does not close over its range. Then nothing is written. About a
/// millisecond.
DIG_MUST_CHECK enum dig_status dig_estimator_init(struct dig_estimator                *estimator,
                                                  const struct dig_machine            *machine,
                                                  const struct dig_curve_set          *set,
                                                  const struct dig_estimator_settings *settings);

struct dig_correction; // estimator/wrench/correction.h
struct dig_corrected_machine;

/// While idle, from now on the machine is taken as corrected, and its links' inertia is taken off
/// with rates from the angles of the last quarter second. The machine's geometry, weights and
/// inertias are the corrected ones; a delay puts the pose back to the time of the pressures. NULL:
/// as its file says, without inertia. DIG_EINVAL, DIG_EUNREACHABLE as dig_correction_check(); then
/// nothing changes. Between ticks; about a millisecond.
DIG_MUST_CHECK enum dig_status
dig_estimator_set_correction(struct dig_estimator        *estimator,
                             const struct dig_correction *correction);

/// The same with a machine made before, of the one it was initialised with: a copy of two
/// kilobytes. Where it is another than before, what was learnt of the moment in free air is
/// forgotten; where it is the same, nothing changes.
void dig_estimator_set_machine(struct dig_estimator               *estimator,
                               const struct dig_corrected_machine *corrected);

/// One tick. DIG_ESTALE: a sample without a moment or one not younger than the last; DIG_EINVAL: a
/// number that is not finite. Then the state is kept and *estimate is untouched. Constant time but
/// for the tick in which a dig ends while nothing is lent (one to two milliseconds: alignment,
/// resampling).
DIG_MUST_CHECK enum dig_status dig_estimator_step(struct dig_estimator    *estimator,
                                                  const struct dig_sample *sample,
                                                  struct dig_estimate     *estimate);

/// True while no dig goes on.
bool dig_estimator_is_idle(const struct dig_estimator *estimator);

/// True while a dig goes on that is farther than path_limit_m from each of the table's, or of which
/// the forecast given says so.
bool dig_estimator_is_off_table(const struct dig_estimator *estimator);

/// Exchanges the table while idle; what was forecast is forgotten. The set must be one that an
/// estimator of this machine was initialised with, and outlive this one. Constant time but for a
/// look at what set->approaches holds: a microsecond for hundreds.
void dig_estimator_set_table(struct dig_estimator *estimator, const struct dig_curve_set *set);

struct dig_recorded_dig; // estimator/track/recorded_dig.h

/// From now on a dig that ends is handed out raw, and spare (zeroed, or one taken before) keeps the
/// samples of the next. A dig that ends while none is lent, or while the one before was not taken,
/// is lost and counted. Constant time. It must outlive the estimator or be taken back.
void dig_estimator_lend(struct dig_estimator *estimator, struct dig_recorded_dig *spare);

/// True when a dig can be lent.
bool dig_estimator_wants_spare(const struct dig_estimator *estimator);

/// The finished dig, the caller's until it is lent again; NULL: none. Constant time.
struct dig_recorded_dig *dig_estimator_take_recording(struct dig_estimator *estimator);

/// Digs that were lost since init.
uint32_t dig_estimator_lost_digs(const struct dig_estimator *estimator);

/// True once after every finished dig that followed a known trajectory, while nothing is lent:
/// copies it out.
bool dig_estimator_take_observation(struct dig_estimator   *estimator,
                                    struct dig_observation *observation);

/// What predictions are made from, from now on; NULL ends them. The forecast must stay as it is
/// until another is given. Constant time.
void dig_estimator_set_forecast(struct dig_estimator      *estimator,
                                const struct dig_forecast *forecast);

/// Makes the forecast of a match in the estimator's own memory and gives it: as long.
void dig_estimator_give_match(struct dig_estimator *estimator, const struct dig_match *match);

/// Prediction for the dig going on, from the current progress to its end; valid = false when no
/// match was given or the trajectory is not known. Constant time.
void dig_estimator_predict(const struct dig_estimator *estimator,
                           struct dig_prediction      *prediction);

/// Prediction for a dig that has not begun, whole, along the trajectory of that index; valid =
/// false when no match was given or the set has no such trajectory. Constant time.
void dig_estimator_predict_trajectory(const struct dig_estimator *estimator, int trajectory,
                                      struct dig_prediction *prediction);

#endif // DIG_ESTIMATOR_ESTIMATOR_H
