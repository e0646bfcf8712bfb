// A dig as it is recorded: its samples and its path, in rig scale, not yet laid along any
// trajectory.

#ifndef DIG_ESTIMATOR_TRACK_RECORDED_DIG_H
#define DIG_ESTIMATOR_TRACK_RECORDED_DIG_H

#include "core/curve.h"
#include "estimator/track/followed.h"
#include "estimator/track/path.h"
#include "estimator/track/window.h"
#include "estimator/wrench/soil_wrench.h"

/// Zeroed: empty.
struct dig_recorded_dig {
    uint32_t            dig_count;
    struct dig_followed followed;
    struct dig_path     path;
    struct dig_window   window;
};

/// Forgets what was recorded and waits for contact.
void dig_recorded_dig_clear(struct dig_recorded_dig *recording, const struct dig_curve_set *set);

/// Contact at a point: opens the window, and lays out the path of the samples before. Constant
/// time; some microseconds.
void dig_recorded_dig_contact(struct dig_recorded_dig     *recording,
                              const struct dig_path_point *point);

/// Bucket pin and absolute direction pin -> tooth of a machine lambda times the rig's size, in the
/// rig's scale and axes: x = -X, theta = -pi/2 - phi.
struct dig_path_point dig_recorded_dig_point(const struct dig_curve_set *set, double lambda,
                                             double pin_X_m, double pin_Z_m, double phi_rad);

/// One wrench of the machine, rig scale and rig time, into the window.
void dig_recorded_dig_add(struct dig_recorded_dig *recording, double lambda, int64_t time_ns,
                          const struct dig_wrench *wrench, double bias_Nm,
                          const struct dig_path_point *point);
/// For who allocates one: about 2.5 MB.
size_t dig_recorded_dig_size(void);

#endif // DIG_ESTIMATOR_TRACK_RECORDED_DIG_H
