// Geometry, masses and hydraulics of one excavator front: plain data, read-only after the check.
//
//   side view, machine facing +X, Z up, angles and moments counter-clockwise positive
//
//            arm pin o----___
//                  /  arm     ----o bucket pin
//           boom  /              / \        bucket frame: origin bucket pin, +x to the tooth
//                /              /___\       arm frame:    origin arm pin,    +x to the bucket pin
//     boom foot o                tooth      boom frame:   origin boom foot,  +x to the arm pin
//     (machine frame: origin at the boom foot, +X forward, +Z up)
//
// In every link frame +y is +x turned by +90 degrees. boom_rad is the boom's +x against machine X,
// arm_rad the arm's against the boom's, bucket_rad the bucket's against the arm's.
//
// A laboratory rig has none of that but the bucket: an arm carries it along a path and says where
// it is, a force sensor between the two says what it feels. Its machine frame is its own, with X
// against the drag direction and Z up, and bucket_rad is the bucket's +x against X itself.

#ifndef DIG_CORE_MACHINE_H
#define DIG_CORE_MACHINE_H

#include "core/error.h"
#include "core/status.h"
#include "core/vec2.h"

#include <stdbool.h>

enum dig_joint { DIG_JOINT_BOOM, DIG_JOINT_ARM, DIG_JOINT_BUCKET, DIG_JOINTS };

/// "boom", "arm", "bucket".
const char *dig_joint_name(enum dig_joint joint);

struct dig_link {
    double          length_m;     // pin to pin; for the bucket pin to tooth
    double          mass_kg;      // the cylinders' masses are counted into the links they hang on
    struct dig_vec2 com_m;        // centre of mass in the link's own frame
    double          inertia_kgm2; // about the centre of mass
    double          min_rad;      // range of the joint's angle
    double          max_rad;
};

/// One drive: `count` equal cylinders in parallel. The rod pushes with
/// count * (head_Pa * head area - rod_Pa * annulus area).
struct dig_cylinder {
    double          count;
    double          bore_m;
    double          rod_m;
    double          relief_Pa;         // beyond it the valve opens and the pressure says nothing
    double          back_Pa;           // pressure of the return side while moving
    double          min_length_m;      // pin to pin, retracted
    double          max_length_m;      // pin to pin, extended
    struct dig_vec2 base_m;            // boom: machine frame; arm: boom frame; bucket: arm frame
    struct dig_vec2 eye_m;             // boom: boom frame; arm: arm frame; bucket: unused (linkage)
    double          pressure_sigma_Pa; // 1 sigma of one chamber's sensor, quantisation not included
};

/// The four-bar between bucket cylinder and bucket, in the arm frame: rocker N-M, link M-K, and the
/// bucket's ear Q-K, where Q is the bucket pin at (arm length, 0). M lies on the cylinder's side of
/// N-K.
struct dig_four_bar {
    struct dig_vec2 rocker_pin_m; // N, in the arm frame
    double          rocker_m;     // |NM|
    double          link_m;       // |MK|
    struct dig_vec2 ear_m;        // K in the bucket frame
};

/// A sensor of force and moment that carries the bucket, turns with it, and reads what the bucket
/// (with all that hangs on the sensor) puts on it: forces along its own x and z, the moment about
/// its origin. Its z is its x turned by +90 degrees, moments are counter-clockwise.
struct dig_force_sensor {
    bool            fitted; // false: the machine has cylinders; true: it has nothing but the bucket
    struct dig_vec2 place_m;  // its origin in the bucket frame
    double          turn_rad; // its +x against the bucket's +x
    double          limit_N;  // beyond either limit it says nothing
    double          limit_Nm;
    double          step_N, step_Nm;   // quantisation of the readings as they arrive; 0: none
    double          sigma_N, sigma_Nm; // 1 sigma of one reading, quantisation not included
    double          path_sigma_m; // 1 sigma of the pin's place along each axis, as it is measured
};

/// By how much the machine may differ from its file, 1 sigma each, independent. The same in every
/// sample of a run: what it makes wrong does not average down. All 0: not at all.
struct dig_tolerance {
    double pin_m; // each coordinate of a base, eye, rocker pin, ear and sensor; rocker and link
    double mass_share; // of a link's mass
    double com_share;  // each coordinate of a centre of mass, of the link's length
};

struct dig_machine {
    char                    name[64];
    struct dig_link         link[DIG_JOINTS];     // with a force sensor: the bucket's alone
    struct dig_cylinder     cylinder[DIG_JOINTS]; // without a force sensor, and so on down …
    struct dig_four_bar     four_bar;             // … to here
    struct dig_force_sensor sensor;
    struct dig_tolerance    tolerance;
    double                  bucket_width_m;
    double pressure_step_Pa; // quantisation of the pressures as they arrive; 0: none
    double angle_step_rad;   // quantisation of the angles as they arrive; 0: none
    double angle_sigma_rad;  // 1 sigma of one angle sensor, quantisation not included
    // With cylinders only. What keeps the machine on the ground: the soil may not lift it off its
    // tracks.
    double weight_N;      // machine without the front links above
    double weight_X_m;    // its centre of mass, from the boom foot along machine X
    double tip_front_X_m; // front tipping edge of the tracks
    double tip_rear_X_m;  // rear tipping edge
    double boom_foot_Z_m; // boom foot above the ground the tracks stand on
};

/// Refuses what cannot be: non-positive lengths, areas or masses, a rod thicker than its bore,
/// empty angle ranges, a force sensor without a range or farther from the bucket's pin than ten
/// bucket lengths, non-finite numbers. *error names the key and what was expected. Whether
/// the parts fit each other and the drives move is asked by dig_geometry_check().
DIG_MUST_CHECK enum dig_status dig_machine_check(const struct dig_machine *machine,
                                                 struct dig_error         *error);

/// Piston and annulus area of one cylinder of the drive, m2.
double dig_cylinder_head_m2(const struct dig_cylinder *cylinder);
double dig_cylinder_rod_m2(const struct dig_cylinder *cylinder);

#endif // DIG_CORE_MACHINE_H
