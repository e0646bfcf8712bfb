// The estimator: samples in, soil moment, dig phase, match and prediction out. Pure C: no I/O, no
// clock, no allocation after init; the caller owns every struct. A sample walks
//
//   sample -> wrench -> phase -> (window of the dig) -> match -> prediction
//
// dig_estimator_step() is what the real-time tick calls. All that takes long is asked for by
// another thread: the tick hands out a finished dig as it was recorded (lend, take_raw); that
// thread makes an observation of it (dig_raw_observe), matches it (dig_match_nearest,
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

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DIG_PREDICTION_POINTS 64
#define DIG_WINDOW_MAX        16384 // samples of one dig that are kept

struct dig_wrench {
    // Soil on bucket, in the RIG's axes (x towards the cab, z up, y such that My > 0 resists curl)
    // but at the machine's scale: N and Nm.
    double Fx_N, Fz_N, My_Nm;
    double sigma_Fx_N, sigma_Fz_N, sigma_My_Nm; // 1 sigma, from quantisation, sensor noise
    bool   force_valid, moment_valid;
    // The part of sigma_My that does not average down over many samples (quantisation of a signal
    // that stands still); included in sigma_My_Nm.
    double slow_sigma_My_Nm;
    double slow_sigma_Fx_N, slow_sigma_Fz_N; // the same of the forces
    // 1 sigma from the machine's tolerances, apart from the above and not in it: one error for the
    // whole run, which the digs of one machine share. Of the whole: the root of the sum of squares.
    double geometry_sigma_Fx_N, geometry_sigma_Fz_N, geometry_sigma_My_Nm;
};

enum dig_dig_phase { DIG_PHASE_AIR, DIG_PHASE_CONTACT, DIG_PHASE_DIG, DIG_PHASE_EXIT };

/// What the bucket does in the soil; NONE: it is not in it, or has not moved yet.
enum dig_motion {
    DIG_MOTION_NONE,
    DIG_MOTION_PENETRATION,
    DIG_MOTION_DRAG,
    DIG_MOTION_CURL,
    DIG_MOTION_LIFT
};

/// What a tick knows. Poses are of the bucket pin in machine axes; see docs/numerics.md.
struct dig_estimate {
    int64_t           time_ns;
    struct dig_wrench wrench;
    double            pin_X_m, pin_Z_m, phi_rad; // pin and absolute direction pin -> tooth, machine
    enum dig_dig_phase phase;
    uint32_t           dig_count;  // digs finished since start
    int                trajectory; // index into the curve set of the dig going on, -1: not known
    double             progress;   // 0 … 1 along it; NaN if not known
    double             off_path_m; // distance of the real path from it, rig scale; NaN if not known
    enum dig_motion    motion;     // what it does in contact and dig
};

/// How a dig ended, as far as it can be told (estimator/ending.h).
enum dig_ending {
    DIG_ENDING_OPEN,   // not told, or it goes on
    DIG_ENDING_WHOLE,  // dug to the end of its trajectory
    DIG_ENDING_ABORTED // the bucket left its trajectory before
};

/// A finished dig on the table's grid, in rig units: what is matched.
struct dig_observation {
    uint32_t            dig_count;
    int                 trajectory;
    double              off_path_m; // rms distance of path and trajectory, rig scale
    struct dig_approach made;       // how it was dug, as the dig itself tells; depth 0: not told,
                                    // the table was dug in one way alone
    struct dig_approach approach;   // the nearest to that the table knows, which it is laid along
                                    // and matched at; zeroed: the trajectory as it stands
    double first, last;             // progress range that was measured
    double moment_Nm[DIG_CURVE_POINTS]; // smoothed, rig scale; 0 outside [first, last]
    double sigma_Nm[DIG_CURVE_POINTS];  // 1 sigma of the measurement after smoothing
    bool   forces;                      // Fx and Fz were measured, too, as far as the moment
    double force_N[DIG_FORCE_CHANNELS - 1][DIG_CURVE_POINTS];
    double force_sigma_N[DIG_FORCE_CHANNELS - 1][DIG_CURVE_POINTS];

    enum dig_ending ending; // of a recording of forces: not told
};

#define DIG_MATCH_SAMPLES 32 // gravels that stand for the posterior

/// Which gravel. Distances are ||measured - table|| / ||measured|| over the points measured, of all
/// digs that were pooled.
struct dig_match {
    bool     valid;
    uint32_t dig_count; // of the observation it came from, the youngest of several
    size_t   digs;      // pooled
    int      nearest;   // entry of the table
    double   nearest_distance;
    int      weighted; // entry nearest by the noise-weighted distance (estimator/weighted.h)
    double   weighted_distance; // 1 is expected of digs of its gravel; -1 and NaN: not looked for
    struct dig_gravel gravel; // between the grid points: of the smallest distance, or, where forces
                              // were measured, the most probable
    double            distance;
    struct dig_gravel mean, low, high;  // posterior mean and 5 %, 95 % of each axis
    struct dig_gravel mode;             // where the posterior is highest
    bool              forces;           // the posterior is of moment and forces
    bool              untold[DIG_AXES]; // the digs do not tell where on that axis: any of them, and
                                        // what was found is a family of gravels (estimator/match.h)
    double            noise_floor;      // expected distance of another packing of the same gravel
    bool              outside;          // none of the table's gravels, by distance or by forces
    double            outside_floors;   // distance > this many noise floors is outside
    size_t            samples;          // 0 until refined
    struct dig_gravel sample[DIG_MATCH_SAMPLES]; // equally likely, in proportion to the posterior
};

/// What the real dig will resist, along one trajectory, machine scale, rig axes.
struct dig_prediction {
    bool                valid;
    int                 trajectory;
    struct dig_approach approach; // how that is dug; zeroed: as it stands
    double              progress_now;
    double from_progress, to_progress; // the points below are equally spaced over this range
    double moment_Nm[DIG_PREDICTION_POINTS];
    double sigma_Nm[DIG_PREDICTION_POINTS]; // 1 sigma of one dig about the prediction
    double Fx_N[DIG_PREDICTION_POINTS], Fz_N[DIG_PREDICTION_POINTS];
    double sigma_Fx_N[DIG_PREDICTION_POINTS], sigma_Fz_N[DIG_PREDICTION_POINTS];
    double peak_Nm, peak_sigma_Nm;   // of the whole dig: as it is to be expected, and 1 sigma of
    double energy_J, energy_sigma_J; // one dig about that (estimator/whole.h)
};

/// What a match predicts along each trajectory of a table, machine scale for the whole dig's
/// numbers, rig scale for the curves.
struct dig_forecast {
    struct dig_expected {
        bool                valid;
        bool                off_table; // the dig going on is: none valid
        struct dig_approach approach;  // of the dig expected; zeroed: as the trajectory stands
        struct dig_curve    curve;     // over the progress that a tick tells
        double              peak_Nm, peak_sigma_Nm;
        double              energy_J, energy_sigma_J;
    } along[DIG_TRAJECTORY_MAX];
};

struct dig_estimator_settings {
    // fixed at start
    double tick_s;         // nominal time between samples
    double contact_sigmas; // My above this many sigma, sustained, is contact (phase.h)
    double contact_hold_s; // how long it must last
    double exit_hold_s;    // how long it must be gone
    double air_bias_s;     // time constant of the bias of My learnt in free air; 0: off
    double path_limit_m;   // rig scale: farther than this off every trajectory: not known
    double outside_floors; // distance > this many noise floors: gravel outside the table
};

struct dig_estimator_settings dig_estimator_settings_default(void);
DIG_MUST_CHECK enum dig_status
dig_estimator_settings_check(const struct dig_estimator_settings *settings, const char **reason);

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

struct dig_correction; // estimator/correction.h
struct dig_taken;

/// While idle, from now on the machine is taken as corrected, and its links' inertia is taken off
/// with rates from the angles of the last quarter second. The machine's geometry, weights and
/// inertias are the corrected ones; a delay puts the pose back to the time of the pressures. NULL:
/// as its file says, without inertia. DIG_EINVAL, DIG_EUNREACHABLE as dig_correction_check(); then
/// nothing changes. Between ticks; about a millisecond.
DIG_MUST_CHECK enum dig_status dig_estimator_correct(struct dig_estimator        *estimator,
                                                     const struct dig_correction *correction);

/// The same with a machine made before, of the one it was initialised with: a copy of two
/// kilobytes. Where it is another than before, what was learnt of the moment in free air is
/// forgotten; where it is the same, nothing changes.
void dig_estimator_take(struct dig_estimator *estimator, const struct dig_taken *taken);

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
void dig_estimator_adopt(struct dig_estimator *estimator, const struct dig_curve_set *set);

/// A finished dig as it was recorded, not yet laid along any trajectory; about 2.5 MB.
struct dig_raw;
size_t dig_raw_size(void);

/// From now on a dig that ends is handed out raw, and spare (zeroed, or one taken before) keeps the
/// samples of the next. A dig that ends while none is lent, or while the one before was not taken,
/// is lost and counted. Constant time. It must outlive the estimator or be taken back.
void dig_estimator_lend(struct dig_estimator *estimator, struct dig_raw *spare);

/// True when a dig can be lent.
bool dig_estimator_wants_raw(const struct dig_estimator *estimator);

/// The finished dig, the caller's until it is lent again; NULL: none. Constant time.
struct dig_raw *dig_estimator_take_raw(struct dig_estimator *estimator);

/// Digs that were lost since init.
uint32_t dig_estimator_lost(const struct dig_estimator *estimator);

/// What was dug: fits the path to every trajectory of the set and reads the moment off along the
/// one it was. DIG_ENOMATCH: it was none of them, or too little of one. Sorts raw's samples; one to
/// two milliseconds.
DIG_MUST_CHECK enum dig_status dig_raw_observe(const struct dig_curve_set          *set,
                                               const struct dig_estimator_settings *settings,
                                               struct dig_raw                      *raw,
                                               struct dig_observation              *observation);

/// Of a dig of which dig_raw_observe() told nothing: true when it followed a trajectory of the set
/// and left it before its end, and then which, and where. Its moment is not told: the way out
/// belongs to its path. About a millisecond.
bool dig_raw_gave_up(const struct dig_curve_set *set, const struct dig_estimator_settings *settings,
                     const struct dig_raw *raw, int *trajectory, double *progress);

/// True once after every finished dig that followed a known trajectory, while nothing is lent:
/// copies it out.
bool dig_estimator_take_dig(struct dig_estimator *estimator, struct dig_observation *observation);

/// What a match predicts on a machine lambda times the table's size. Nothing is valid of a match
/// that is not. About four milliseconds a trajectory.
void dig_forecast_make(const struct dig_curve_set *set, double lambda,
                       const struct dig_match *match, struct dig_forecast *forecast);

struct dig_approach_error; // estimator/approach_error.h

/// What a match predicts of one dig along a trajectory, deeper or with the bucket turned; over the
/// path of the trajectory dug so, as an observation of such a dig has it. valid = false where the
/// table does not tell. Memory as dig_approached_size() of one slot; error as
/// dig_approached_make() takes it.
void dig_forecast_as_dug(const struct dig_curve_set *set, double lambda,
                         const struct dig_match *match, size_t trajectory,
                         const struct dig_approach       *approach,
                         const struct dig_approach_error *error, void *memory,
                         struct dig_expected *expected);

/// The same curve over the progress that a tick tells, which is along the plain trajectory: legs
/// behind the first lie where they lie, the first begins earlier or later.
void dig_forecast_along_plain(const struct dig_curve_set *set, size_t trajectory,
                              const struct dig_approach *approach, struct dig_expected *expected);

/// What predictions are made from, from now on; NULL ends them. The forecast must stay as it is
/// until another is given. Constant time.
void dig_estimator_give_forecast(struct dig_estimator      *estimator,
                                 const struct dig_forecast *forecast);

/// Makes the forecast of a match in the estimator's own memory and gives it: as long.
void dig_estimator_give_match(struct dig_estimator *estimator, const struct dig_match *match);

/// Prediction for the dig going on, from the current progress to its end; valid = false when no
/// match was given or the trajectory is not known. Constant time.
void dig_estimator_predict(const struct dig_estimator *estimator,
                           struct dig_prediction      *prediction);

/// Prediction for a dig that has not begun, whole, along the trajectory of that index; valid =
/// false when no match was given or the set has no such trajectory. Constant time.
void dig_estimator_predict_whole(const struct dig_estimator *estimator, int trajectory,
                                 struct dig_prediction *prediction);

#endif // DIG_ESTIMATOR_ESTIMATOR_H
