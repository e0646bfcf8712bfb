// One machine recording, laid along its trajectory: where in it the bucket was in the soil and
// where in free air, told by the path alone. The soil's moment is not asked: what is wrong with a
// machine must not decide where its air is.
//
//     air before          | dig along the trajectory |  lift, dump  | air after
//   before ....... before_end  contact ..... end          after ....... after_end
//
// Where the tooth is below the ground before or after, as in another dig, there is no air.
//
// A machine that says how it is pitched digs level ground, or ground that is pitched as it is: its
// path tells, in the world's frame or in the machine's. Forces are those of the same frame.

#ifndef DIG_CLOSED_LOOP_MACHINE_DIGS_MACHINE_DIG_H
#define DIG_CLOSED_LOOP_MACHINE_DIGS_MACHINE_DIG_H

#include "closed_loop/recordings/measured.h"
#include "core/curve.h"
#include "core/error.h"
#include "core/machine.h"
#include "core/recording.h"
#include "estimator/track/route.h"
#include "estimator/track/track.h"
#include "estimator/wrench/correction.h"
#include "estimator/wrench/rates.h"
#include "estimator/wrench/statics.h"

/// The samples of one recording that have all angles and the pressures of every drive that it tells
/// (the bucket at least), and what they say. Owned; free with dig_machine_dig_finish().
struct dig_machine_dig {
    size_t             samples;
    struct dig_sample *sample;
    double            *time_s; // machine time, 0 at the first
    struct dig_rates  *rates;  // centred
    int                trajectory;
    double             lambda;
    double             frame_rad; // by which path and forces are turned out of the machine's frame
    struct dig_track   track;     // where the route lies, rig scale
    size_t             before;    // first sample of the air before
    size_t             before_end, contact; // first samples not in the air before, in the soil
    size_t             end;                 // first sample past the trajectory
    double             pace;      // duration of the table's trajectory / of this dig, at rig scale
    size_t             after;     // first sample of the air after the dump; samples: there is none
    size_t             after_end; // first sample not in it
};

/// Lays a recording along its trajectory (-1: along any of the set's). DIG_ENOMATCH: it holds no
/// dig along it; DIG_EINVAL: fewer than 50 such samples, or a jump of an angle; DIG_ENOMEM. *error
/// names which.
DIG_MUST_CHECK enum dig_status dig_machine_dig_make(const struct dig_machine           *machine,
                                                    const struct dig_curve_set         *set,
                                                    const struct dig_machine_recording *recording,
                                                    int trajectory, struct dig_machine_dig *dig,
                                                    struct dig_error *error);

/// The same of a recording in which the bucket never touches the ground: all of it is air before a
/// dig that never comes, jumps and all. DIG_EINVAL: fewer than 50 such samples; DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status
dig_machine_dig_make_air(const struct dig_machine           *machine,
                         const struct dig_machine_recording *recording, struct dig_machine_dig *dig,
                         struct dig_error *error);

/// NULL and a zeroed struct are allowed.
void dig_machine_dig_finish(struct dig_machine_dig *dig);

/// The first sample at this time or after; samples: there is none.
size_t dig_machine_dig_sample_at(const struct dig_machine_dig *dig, double time_s);

/// The mean pitch of samples [from, to); false, and 0, where none of them tells it.
bool dig_machine_dig_pitch(const struct dig_machine_dig *dig, size_t from, size_t to, double *rad);

/// A time between a sample and the next: how far towards that, 0 … 1, the nearer end where it lies
/// outside.
struct dig_between {
    size_t sample;
    double fraction;
};

/// Where a time lies among two samples or more, looked for from one near it; the rates there,
/// straight between.
struct dig_between dig_machine_dig_between(const struct dig_machine_dig *dig, double time_s,
                                           size_t near);
struct dig_rates   dig_machine_dig_rates(const struct dig_machine_dig *dig, struct dig_between at);

/// The bucket of the machine standing so, in rig scale and the dig's frame.
struct dig_path_point dig_machine_dig_point(const struct dig_curve_set   *set,
                                            const struct dig_machine_dig *dig,
                                            const struct dig_front       *front);

/// The track of such points in order, as the estimator fits it along the dig's trajectory: so many
/// of them before contact, the rest of the dig.
struct dig_track dig_machine_dig_fit(const struct dig_curve_set   *set,
                                     const struct dig_machine_dig *dig, size_t before,
                                     size_t points, const struct dig_path_point point[]);

/// How curves are measured: with their sigma; without, which is 0, at half the work; or roughly,
/// from as many samples as a curve has points, for what is a difference of two such, as many times
/// less.
enum dig_measure { DIG_MEASURE_WITH_SIGMA, DIG_MEASURE_VALUES, DIG_MEASURE_ROUGHLY };

/// The curves that the machine, corrected (zeroed: as its file says), gives of the dig: trajectory,
/// pace, first, last, measured, value and sigma of *measured are written. A channel that fewer than
/// nine samples in ten tell counts as not measured. DIG_ENOMATCH: the moment is not among them.
DIG_MUST_CHECK enum dig_status
dig_machine_dig_measure(const struct dig_machine *machine, const struct dig_curve_set *set,
                        const struct dig_machine_dig *dig, const struct dig_correction *correction,
                        enum dig_measure how, struct dig_measured *measured);

#endif // DIG_CLOSED_LOOP_MACHINE_DIGS_MACHINE_DIG_H
