// What the real-time tick exchanges with the matching thread through the estimator: recordings of
// finished digs out, in memory that thread lends; tables, machines and forecasts in; and the
// predictions made of a forecast. Every call is constant time and does not allocate.

#ifndef DIG_ESTIMATOR_ESTIMATOR_TICK_H
#define DIG_ESTIMATOR_ESTIMATOR_TICK_H

#include "estimator/estimator.h"
#include "estimator/predict/forecast.h"
#include "estimator/predict/prediction.h"

#include <stdint.h>

struct dig_corrected_machine; // estimator/wrench/correction.h
struct dig_recorded_dig;      // estimator/track/recorded_dig.h

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

/// Lends memory (zeroed, or taken before) for the recording of the next dig. From the first call
/// on, finished digs are handed out as recordings. A dig that ends while no memory is lent, or
/// before the last recording was taken, is lost and counted. The memory must outlive the estimator
/// or be taken back.
void dig_estimator_lend(struct dig_estimator *estimator, struct dig_recorded_dig *spare);

/// True when memory can be lent.
bool dig_estimator_wants_spare(const struct dig_estimator *estimator);

/// The recording of the finished dig, the caller's until it is lent again; NULL: none.
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

#endif // DIG_ESTIMATOR_ESTIMATOR_TICK_H
