// The front of a machine as the blind bench sees it: cylinder lengths from joint angles, with
// complex numbers, and everything else by differences of them. It shares no code with the
// estimator or digrig.

#ifndef DIG_TESTS_BLIND_FRONT_H
#define DIG_TESTS_BLIND_FRONT_H

#include "core/machine.h"
#include "core/recording.h"

/// Length of one drive's cylinder, m, pin to pin.
double blind_length_m(const struct dig_machine *machine, enum dig_joint joint,
                      const double angle_rad[DIG_JOINTS]);

/// dL/dq of the drive on its own joint, m/rad.
double blind_lever_m(const struct dig_machine *machine, enum dig_joint joint,
                     const double angle_rad[DIG_JOINTS]);

/// Place of a point of the bucket, given in its frame, against the boom foot.
struct dig_vec2 blind_bucket_point(const struct dig_machine *machine,
                                   const double angle_rad[DIG_JOINTS], struct dig_vec2 point);

/// Push of a drive's rods, N, from its pressures; and the pressures that make a push, with the
/// return side at back_Pa.
double blind_push_N(const struct dig_cylinder *cylinder, double head_Pa, double rod_Pa);
void   blind_pressures(const struct dig_cylinder *cylinder, double push_N, double *head_Pa,
                       double *rod_Pa);

#endif // DIG_TESTS_BLIND_FRONT_H
