// Free air of several machine recordings as equations: what is left of each joint's balance, in
// newtons at its drive's rod, averaged over blocks of time. 0 but for noise when the machine is as
// it is taken to be.
//
// Accelerations from angles are means over a kernel (1 - u^2)^2 of +-0.12 s; pressures and angles
// are averaged over the same kernel first, so that inertia and drive are of one time.

#ifndef DIG_CLOSED_LOOP_AIR_MACHINE_AIR_H
#define DIG_CLOSED_LOOP_AIR_MACHINE_AIR_H

#include "closed_loop/machine_digs/machine_dig.h"
#include "core/machine.h"
#include "core/sample.h"
#include "core/units.h"
#include "estimator/wrench/correction.h"
#include "estimator/wrench/rates.h"

#include <stdbool.h>
#include <stddef.h>

/// The kernel's half is the rates'; points of the air are so far apart.
#define DIG_AIR_KERNEL_HALF_s 0.12
#define DIG_AIR_STEP_s        0.025

/// An instant of the air: readings averaged over the kernel, and rates. calm_Pa: what the chambers
/// would read without noise, see dig_air_calm().
struct dig_air_point {
    struct dig_sample sample;
    struct dig_rates  rates;
    double            calm_Pa[DIG_JOINTS * DIG_CHAMBERS];
};

/// One block of one joint.
struct dig_air_row {
    size_t         segment;
    enum dig_joint joint;
    size_t         first, points; // its points
    double         sigma_N;       // 1 sigma of the sensors; machine_stand.h, machine_noise.h
    double         alone;         // of that what it scatters by; less than 1 where noise lasts
};

/// What a machine's file may have wrong within its tolerance, a number each: by how much more the
/// machine is pitched than it says, and of each link mass and moment as in struct dig_added_mass.
enum dig_file_error {
    DIG_FILE_LEVEL_rad,
    DIG_FILE_LINKS, // kg, x and y in kgm; the boom's, the arm's, the bucket's
    DIG_FILE_ERRORS = DIG_FILE_LINKS + 3 * DIG_JOINTS
};

/// 1 sigma of the level: a machine that does not say how it is pitched stands so level.
#define DIG_FILE_LEVEL_SIGMA_rad (0.5 * DIG_RAD_PER_DEG)

/// Adds such numbers to a correction.
void dig_file_correct(const double file[DIG_FILE_ERRORS], struct dig_correction *correction);

/// The air before or after one dig.
struct dig_air_segment {
    size_t dig; // its place among those given
    bool   after;
    size_t first_point, points; // those beside the air tell angles alone
    size_t first_row, rows;
    double mean_Pa[DIG_JOINTS * DIG_CHAMBERS];

    // What the poses of its points were last asked about with.
    struct dig_correction posed;
};

/// What of a point's balance pressures and friction have no part in.
struct dig_air_pose {
    bool   known;
    bool   lever_ok[DIG_JOINTS];
    double arm_m[DIG_JOINTS];
    double mass_Nm[DIG_JOINTS]; // of weight and inertia about the pins
};

/// Free with dig_air_finish().
struct dig_air {
    struct dig_machine      machine;
    size_t                  points, rows, segments;
    struct dig_air_point   *point;
    struct dig_air_row     *row;
    struct dig_air_segment *segment;
    double                 *scratch; // [6 * points]
    struct dig_air_pose    *pose;    // [points]
};

/// Takes the air of the digs for which used[] is true (NULL: of all). Samples with a pressure at
/// relief, a drive at its stop or a linkage at its toggle make no row of that joint. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_air_make(const struct dig_machine *machine, size_t digs,
                                            const struct dig_machine_dig dig[], const bool used[],
                                            struct dig_air *air);

void dig_air_finish(struct dig_air *air);

/// Calms the pressures: the chamber of a drive that reads less counts as its return side and reads
/// its mean, the other what makes the corrected balance nothing. What a gain or a lever does is
/// proportional to the pressure; taken from a noisy one it would explain that noise.
void dig_air_calm(struct dig_air *air, const struct dig_correction correction[]);

/// What the drives push and what they would have to when the machine is corrected, N at the rods:
/// drive_N[3 * point + joint] and load_N alike; NaN where a pressure or a lever is missing.
void dig_air_forces(const struct dig_air *air, const struct dig_correction correction[],
                    double drive_N[], double load_N[]);

/// What is left of every row in its sigmas when the machine is corrected. correction[segment].
/// calm: of the calm pressures, as slopes are to be taken. Uses air's scratch.
void dig_air_rest(const struct dig_air *air, const struct dig_correction correction[], bool calm,
                  double rest[]);

/// How much more than what the correction says, either way, friction may take of every row whose
/// drive stands or creeps, in its sigmas: all that is dry in it at a standstill, as a rod that
/// rubbed and stopped may be held by that force or by less; nothing where it moves. Uses air's
/// scratch.
void dig_air_held(const struct dig_air *air, const struct dig_correction correction[],
                  double held[]);

#endif // DIG_CLOSED_LOOP_AIR_MACHINE_AIR_H
