// Digs as curves over the bucket's path: what a table holds and what a measurement is compared
// with.
//
// World frame of a scene (the rig): x drag direction, z up, y bucket width. Body frame: origin at
// the bucket pin; theta = 0 has the tooth straight below the pin, theta > 0 curls, so the tooth is
// at pin + L (sin theta, -cos theta). My is the y component of the moment of the soil on the bucket
// about the moving pin; My > 0 resists curling and dragging towards +x. Fx, Fz: force of the soil
// on the bucket.

#ifndef DIG_CORE_CURVE_H
#define DIG_CORE_CURVE_H

#include "core/status.h"

#include <stdbool.h>
#include <stddef.h>

#define DIG_CURVE_POINTS   256 // points of a curve on the path-progress grid 0 … 1
#define DIG_PHASES_MAX     8
#define DIG_NAME_SIZE      32
#define DIG_TRAJECTORY_MAX 8    // trajectories in one table
#define DIG_SMOOTH_HALF_s  0.16 // half width of the paper's moving average, in rig time

/// What the soil does to the bucket, and the mass of the grains in it. The carried mass is known to
/// a DEM alone: NaN throughout where it is not.
enum dig_channel {
    DIG_CHANNEL_MY_Nm,
    DIG_CHANNEL_FX_N,
    DIG_CHANNEL_FZ_N,
    DIG_FORCE_CHANNELS,
    DIG_CHANNEL_CARRIED_kg = DIG_FORCE_CHANNELS,
    DIG_CHANNELS
};

/// "My_Nm", "Fx_N", "Fz_N", "carried_kg".
const char *dig_channel_name(enum dig_channel channel);

/// The axes of a table, in this order wherever gravel is an array.
enum dig_axis { DIG_AXIS_FRICTION, DIG_AXIS_ROLLING, DIG_AXIS_DENSITY_kgpm3, DIG_AXES };

/// "friction", "rolling", "density_kgpm3".
const char *dig_axis_name(enum dig_axis axis);

/// A text of such names for people, in place: "rolling, density".
void dig_axes_without_units(char names[]);

struct dig_gravel {
    double value[DIG_AXES];
};

/// True where each axis has the same value in both.
bool dig_gravel_is_same(const struct dig_gravel *a, const struct dig_gravel *b);

struct dig_phase {
    char   name[DIG_NAME_SIZE];
    double duration_s;
    double vx_mps, vz_mps; // of the pin
    double omega_radps;    // of theta
};

/// A prescribed dig: the pin starts at start_pin and moves with constant rates, phase by phase.
struct dig_trajectory {
    char             name[DIG_NAME_SIZE];
    double           theta0_rad;
    double           start_x_m, start_z_m; // pin at t = 0
    size_t           phases;
    struct dig_phase phase[DIG_PHASES_MAX];
};

struct dig_pose {
    double x_m, z_m, theta_rad; // pin and bucket attitude, world frame
};

/// Whole duration, s.
double dig_trajectory_duration_s(const struct dig_trajectory *trajectory);

/// Pose at time_s, held at the ends outside [0, duration].
struct dig_pose dig_trajectory_pose(const struct dig_trajectory *trajectory, double time_s);

/// Length of the path travelled until time_s: the integral of |pin velocity| + tooth_m |omega|, m.
double dig_trajectory_path_m(const struct dig_trajectory *trajectory, double tooth_m,
                             double time_s);

/// Inverse of the above as a fraction: the time at which progress (0 … 1) of the path is done.
double dig_trajectory_time_s(const struct dig_trajectory *trajectory, double tooth_m,
                             double progress);

/// Index of the phase at time_s, in [0, phases).
size_t dig_trajectory_phase(const struct dig_trajectory *trajectory, double time_s);

/// Centred moving average of half width half_s over n samples at times t_s (ascending): the mean of
/// the piecewise-linear signal over the part of [t - half, t + half] the samples cover. y and out
/// may not overlap. O(n).
void dig_curve_smooth(size_t n, const double t_s[], const double y[], double half_s, double out[]);

/// What that leaves at sample i of the variance of white noise: the squares of the weights that it
/// gives the samples, within 5 %, as the samples next to the window's ends are weighed roughly. At
/// most 1. O(samples in reach).
double dig_curve_noise_left(size_t n, const double t_s[], size_t i, double half_s);

/// One point of the table: a gravel, and for each trajectory the mean curve over packings and the
/// standard deviation of ONE dig about it (n - 1; with a single packing it is NaN and the loader
/// replaces it by the pooled relative spread).
struct dig_curve {
    float mean[DIG_CHANNELS][DIG_CURVE_POINTS];
    float sd[DIG_CHANNELS][DIG_CURVE_POINTS];
    // What the mean errs by beyond the scatter of its packings, relative to its rms: of a curve
    // between depths or with an effect. It is in sd, too.
    float error[DIG_CHANNELS];
};

/// Mean of the squares over the points of one channel.
double dig_curve_mean_square(const float y[DIG_CURVE_POINTS]);

#define DIG_COVARIANCE_BLOCKS  8 // of a path, equally long
#define DIG_COVARIANCE_NUMBERS ((size_t)DIG_FORCE_CHANNELS * DIG_COVARIANCE_BLOCKS)

/// How digs of one gravel along one trajectory differ from their mean: covariance of the means over
/// the blocks of a curve, moment first, then the forces, each relative to the size of its channel's
/// curve, the root mean square of the gravel's own block means. Pooled over all gravels.
struct dig_covariance {
    double freedom; // degrees of freedom it was pooled from; 0: nothing is known
    double of[DIG_COVARIANCE_NUMBERS][DIG_COVARIANCE_NUMBERS];
};

/// The time step a table's digs were computed with: core/table_step.h.
struct dig_table_step {
    double taken_s;        // 0: derived for each gravel, or not known
    double derived_s;      // dig_contact_step_s() of the table's lightest gravel
    double lightest_kgpm3; // that gravel
};

struct dig_entry_set; // core/entry_set.h
struct dig_outline;   // core/outline.h

/// A whole table in memory, flat and read-only. curve[entry * trajectories + trajectory]; an entry
/// that lacks a trajectory has packings 0 there.
struct dig_curve_set {
    char                  scene_name[DIG_NAME_SIZE];
    char                  scene_hash[65]; // lower-case hex SHA-256 of the canonical scene
    double                tooth_m; // bucket pin to tooth: the length scale of Froude similarity
    double                bucket_width_m;
    double                young_Pa;
    double                smooth_half_s;   // smoothing already applied to the curves, rig time
    double                stiffness_power; // dig_contact_stiffness_power() of the scene
    struct dig_table_step step;
    size_t                copies; // entries that hold the same digs (tables/density_scale.h); 0: 1
    size_t                trajectories;
    struct dig_trajectory trajectory[DIG_TRAJECTORY_MAX];
    size_t                entries;
    struct dig_gravel    *gravel;   // [entries]
    int                  *packings; // [entries * trajectories]
    struct dig_curve     *curve;    // [entries * trajectories]
    // dig_outlines_draw(): of each channel of each curve, [DIG_FORCE_CHANNELS * entries *
    // trajectories]; and of each trajectory the mean squared scatter of one dig in each block of a
    // covariance, relative to the mean square of the curve, averaged over the entries; 0 when there
    // is none.
    struct dig_outline *outline;
    double              relative2[DIG_TRAJECTORY_MAX][DIG_COVARIANCE_NUMBERS];
    // The full grid behind the entries: axis values ascending; cell[i] is the entry at that grid
    // index (friction slowest, density fastest) or -1 where the table has a hole.
    size_t  axis_count[DIG_AXES];
    double *axis[DIG_AXES];
    int    *cell;
    // Of each trajectory, [trajectories]; NULL: not known of these curves.
    struct dig_covariance *covariance;
    // The same digs deeper or with the bucket turned; NULL: the table holds none.
    struct dig_entry_set *approaches;
};

/// The index of the trajectory of this name, -1 where the set has none.
int dig_curve_set_find(const struct dig_curve_set *set, const char *name);

#endif // DIG_CORE_CURVE_H
