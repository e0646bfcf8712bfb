// The estimator: samples in; soil wrench, phase, trajectory and finished digs out. Pure C: no I/O,
// no clock, no allocation; the caller owns every struct. A sample walks
//
//   sample -> wrench -> phase -> track -> recording of the dig
//
// Matching and forecasting stand in match/ and predict/.

#ifndef DIG_ESTIMATOR_ESTIMATOR_H
#define DIG_ESTIMATOR_ESTIMATOR_H

#include "core/curve.h"
#include "core/machine.h"
#include "core/sample.h"
#include "core/status.h"
#include "estimator/predict/forecast.h"
#include "estimator/predict/prediction.h"
#include "estimator/track/estimate.h"
#include "estimator/track/settings.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct dig_corrected_machine; // estimator/wrench/correction.h
struct dig_estimator;         // estimator/estimator_state.h: fixed size
struct dig_recorded_dig;      // estimator/track/recorded_dig.h

/// Size of the struct, about 4 MB: for allocating one.
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
/// number that is not finite. State and *estimate are unchanged then. Constant time.
DIG_MUST_CHECK enum dig_status dig_estimator_step(struct dig_estimator    *estimator,
                                                  const struct dig_sample *sample,
                                                  struct dig_estimate     *estimate);

// What the real-time tick exchanges with the matching thread: recordings of finished digs out, in
// memory that thread lends; tables, machines and forecasts in; and the predictions made of a
// forecast. Every call is constant time and does not allocate.

/// True while no dig is in progress.
bool dig_estimator_is_idle(const struct dig_estimator *estimator);

/// True while the dig in progress is farther than path_limit_m from every trajectory of the table,
/// or the forecast says that the table does not hold it.
bool dig_estimator_is_off_table(const struct dig_estimator *estimator);

/// Exchanges the table while idle; the forecast ends. An estimator of this machine must have been
/// initialised with the set, which must outlive this one. A look at set->approaches takes a
/// microsecond for hundreds.
void dig_estimator_set_table(struct dig_estimator *estimator, const struct dig_curve_set *set);

/// Exchanges the machine while idle by one that was corrected before: a copy of two kilobytes.
/// Geometry, weights and inertias are the corrected ones from then on. The links' inertia is
/// subtracted by rates of the last quarter second's angles; a delay moves the pose back to the time
/// of the pressures. A different correction drops the bias learnt in free air.
void dig_estimator_set_machine(struct dig_estimator               *estimator,
                               const struct dig_corrected_machine *corrected);

/// Lends memory (zeroed, or taken before) for the recording of the next dig. An estimator has some
/// for two at first. A dig that ends while there is none for the next, or before the last recording
/// was taken, is lost and counted. The memory must outlive the estimator or be taken back.
void dig_estimator_lend(struct dig_estimator *estimator, struct dig_recorded_dig *spare);

/// True when memory can be lent.
bool dig_estimator_wants_spare(const struct dig_estimator *estimator);

/// The recording of the finished dig, the caller's until it is lent again; NULL: none.
/// dig_recorded_dig_observe() (estimator/approach/observe_dig.h) tells which it was.
struct dig_recorded_dig *dig_estimator_take_recording(struct dig_estimator *estimator);

/// Digs lost since init.
uint32_t dig_estimator_lost_digs(const struct dig_estimator *estimator);

/// Sets what predictions are made from; NULL: nothing. The forecast must stay unchanged until the
/// next is set.
void dig_estimator_set_forecast(struct dig_estimator      *estimator,
                                const struct dig_forecast *forecast);

/// Predicts the dig in progress from its current progress to its end. valid = false without a
/// forecast, or while the trajectory is not known.
void dig_estimator_predict(const struct dig_estimator *estimator,
                           struct dig_prediction      *prediction);

/// Predicts a whole dig along a trajectory of the set. valid = false without a forecast, or where
/// the set lacks the trajectory.
void dig_estimator_predict_trajectory(const struct dig_estimator *estimator, int trajectory,
                                      struct dig_prediction *prediction);

#endif // DIG_ESTIMATOR_ESTIMATOR_H
