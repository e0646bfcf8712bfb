// The recording of a dig: samples and path, rig scale, before any trajectory is assigned.

#ifndef DIG_ESTIMATOR_TRACK_RECORDED_DIG_H
#define DIG_ESTIMATOR_TRACK_RECORDED_DIG_H

#include "core/curve.h"
#include "estimator/track/path.h"
#include "estimator/track/window.h"
#include "estimator/wrench/soil_wrench.h"

/// Zeroed: empty.
struct dig_recorded_dig {
    uint32_t          dig_count;
    int64_t           last_ns;           // time of the newest sample
    double            newest_s;          // the same, rig time
    double            contact_s, soil_s; // of the first in the soil and of the newest there
    bool              missing; // samples of the dig were missing for too long: the path has a hole
    double            pitch_rad; // of the machine, summed over the samples since contact
    double            pitched;   // how many
    struct dig_path   path;
    struct dig_window window;
};

/// Drops the recording and waits for contact.
void dig_recorded_dig_clear(struct dig_recorded_dig *recording, const struct dig_curve_set *set);

/// Contact at a point: opens the window, and starts the path with the samples before. Some
/// microseconds.
void dig_recorded_dig_contact(struct dig_recorded_dig     *recording,
                              const struct dig_path_point *point);

/// Adds a point of the newest sample to the path.
void dig_recorded_dig_follow(struct dig_recorded_dig *recording, const struct dig_path_point *point,
                             bool in_soil);

/// Smooths noise and steps of the angles off the poses (steady.h), and lays the path along what is
/// left. Uses the window's arrays, and sorts: not in the tick.
void dig_recorded_dig_steady(struct dig_recorded_dig *recording, const struct dig_curve_set *set);

/// Bucket pin and absolute direction pin -> tooth of a machine lambda times the rig's size, in the
/// rig's scale and axes: x = -X, theta = -pi/2 - phi.
struct dig_path_point dig_recorded_dig_point(const struct dig_curve_set *set, double lambda,
                                             double pin_X_m, double pin_Z_m, double phi_rad);

/// Adds one wrench of the machine, pitched by so much, to the window, in rig scale and rig time.
void dig_recorded_dig_add(struct dig_recorded_dig *recording, const struct dig_curve_set *set,
                          double lambda, int64_t time_ns, const struct dig_wrench *wrench,
                          double bias_Nm, double pitch_rad, const struct dig_path_point *point,
                          const double joint_rad[DIG_JOINTS]);

/// How the machine was pitched since contact, in the mean.
double dig_recorded_dig_pitch_rad(const struct dig_recorded_dig *recording);

/// Turns path, poses and forces into the world's frame (frame.h), of a machine pitched by so much.
void dig_recorded_dig_turn(struct dig_recorded_dig *recording, const struct dig_curve_set *set,
                           double pitch_rad);

/// Size of the struct, about 3 MB: for allocating one.
size_t dig_recorded_dig_size(void);

#endif // DIG_ESTIMATOR_TRACK_RECORDED_DIG_H
