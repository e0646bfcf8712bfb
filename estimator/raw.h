// A dig as it is recorded: its samples and its path, in rig scale, not yet laid along any
// trajectory.

#ifndef DIG_ESTIMATOR_RAW_H
#define DIG_ESTIMATOR_RAW_H

#include "core/curve.h"
#include "estimator/estimator.h"
#include "estimator/followed.h"
#include "estimator/path.h"
#include "estimator/window.h"

/// Zeroed: empty.
struct dig_raw {
    uint32_t            dig_count;
    struct dig_followed followed;
    struct dig_path     path;
    struct dig_window   window;
};

/// Forgets what was recorded and waits for contact.
void dig_raw_forget(struct dig_raw *raw, const struct dig_curve_set *set);

/// Contact at a point: opens the window, and lays out the path of the samples before. Constant
/// time; some microseconds.
void dig_raw_touch(struct dig_raw *raw, const struct dig_path_point *point);

/// Bucket pin and absolute direction pin -> tooth of a machine lambda times the rig's size, in the
/// rig's scale and axes: x = -X, theta = -pi/2 - phi.
struct dig_path_point dig_raw_point(const struct dig_curve_set *set, double lambda, double pin_X_m,
                                    double pin_Z_m, double phi_rad);

/// One wrench of the machine, rig scale and rig time, into the window.
void dig_raw_add(struct dig_raw *raw, double lambda, int64_t time_ns,
                 const struct dig_wrench *wrench, double bias_Nm,
                 const struct dig_path_point *point);

#endif // DIG_ESTIMATOR_RAW_H
