// Free air of several machine recordings as equations: the residual of each joint's balance, in
// newtons at its drive's rod, averaged over blocks of time. 0 but for noise if the machine is
// modelled right.
//
// Accelerations from angles are means over a kernel (1 - u^2)^2 of +-0.12 s; pressures and angles
// are averaged over the same kernel first, so that inertia and drive are of one time.

#ifndef DIG_CLOSED_LOOP_AIR_MACHINE_AIR_H
#define DIG_CLOSED_LOOP_AIR_MACHINE_AIR_H

#include "closed_loop/machine_digs/machine_dig.h"
#include "core/machine.h"
#include "core/sample.h"
#include "core/units.h"
#include "estimator/wrench/balance.h"
#include "estimator/wrench/correction.h"
#include "estimator/wrench/rates.h"

#include <stdbool.h>
#include <stddef.h>

/// Half width of the kernel, which is that of the rates; distance of the points of the air.
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
    double         sigma_N;       // 1 sigma of the sensors; row_sigma.h, machine_noise.h
    double         alone;         // of that what it scatters by; less than 1 where noise lasts
};

/// Errors of a machine's file within its tolerance, true less file, a number each: the machine's
/// pitch, and of each link mass and first moment as in struct dig_added_mass.
enum dig_file_error {
    DIG_FILE_LEVEL_rad,
    DIG_FILE_LINKS, // kg, x and y in kgm; the boom's, the arm's, the bucket's
    DIG_FILE_ERRORS = DIG_FILE_LINKS + 3 * DIG_JOINTS
};

/// What is wrong then, for people: "the machine's pitch".
const char *dig_file_error_text(enum dig_file_error error);

/// 1 sigma of the pitch of a machine that records none.
#define DIG_FILE_LEVEL_SIGMA_rad (0.5 * DIG_RAD_PER_DEG)

/// Adds errors of the file to a correction.
void dig_file_correct(const double file[DIG_FILE_ERRORS], struct dig_correction *correction);

/// The air before or after one dig.
struct dig_air_segment {
    size_t dig; // its place among those given
    bool   after;
    size_t first_point, points; // those beside the air give angles alone
    size_t first_row, rows;
    double mean_Pa[DIG_JOINTS * DIG_CHAMBERS];

    // How its points were last asked about: their balances are kept.
    struct dig_correction asked;
    bool                  known, calm, held;
};

/// A point's balance as last worked out; a column of the equations changes a part of it.
struct dig_air_balance {
    struct dig_rates    rates;
    struct dig_readings readings;
    bool                read;
    bool                lever_ok[DIG_JOINTS];
    double              arm_m[DIG_JOINTS];
    double              mass_Nm[DIG_JOINTS]; // of weight and inertia about the pins
    double              rest_N[DIG_JOINTS], taken_N[DIG_JOINTS]; // without friction, by friction
    double              left_N[DIG_JOINTS];                      // by both
};

/// Free with dig_air_finish().
struct dig_air {
    struct dig_machine      machine;
    size_t                  points, rows, segments;
    struct dig_air_point   *point;
    struct dig_air_row     *row;
    struct dig_air_segment *segment;
    struct dig_air_balance *balance; // [points]
};

/// Takes the air of the digs for which used[] is true (NULL: of all). Samples with a pressure at
/// relief, a drive at its stop or a linkage at its toggle make no row of that joint. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_air_make(const struct dig_machine *machine, size_t digs,
                                            const struct dig_machine_dig dig[], const bool used[],
                                            struct dig_air *air);

void dig_air_finish(struct dig_air *air);

/// Fills calm_Pa: of a drive's chambers the one with the lower pressure counts as the return side
/// and gets its mean, the other the pressure that makes the corrected balance zero. The slope of a
/// gain or a lever is proportional to pressure; taken from noisy pressures it would explain their
/// noise.
void dig_air_calm(struct dig_air *air, const struct dig_correction correction[]);

/// Push of the drives, and the push that balances the corrected machine, N at the rods:
/// drive_N[3 * point + joint] and load_N alike; NaN where a pressure or a lever is missing.
void dig_air_forces(const struct dig_air *air, const struct dig_correction correction[],
                    double drive_N[], double load_N[]);

/// Residual of every row of the corrected machine, in its sigmas: rest[rows], correction[segments].
/// calm: with the calm pressures, as slopes are taken. Asked again with a correction that differs
/// in a part, it costs that part. Uses air's scratch.
void dig_air_rest(const struct dig_air *air, const struct dig_correction correction[], bool calm,
                  double rest[]);

/// By how much friction may differ from the correction's, either way, in every row whose drive
/// stands or creeps: held[rows], in the rows' sigmas. At a standstill it is all dry friction, as a
/// rod that stopped may be held by that force or by less; where it moves it is 0. Uses air's
/// scratch.
void dig_air_held(const struct dig_air *air, const struct dig_correction correction[],
                  double held[]);

#endif // DIG_CLOSED_LOOP_AIR_MACHINE_AIR_H
