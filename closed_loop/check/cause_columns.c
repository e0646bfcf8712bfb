#include "closed_loop/check/cause_columns.h"

#include "closed_loop/check/drive_misfit.h"
#include "core/units.h"

#include <assert.h>
#include <math.h>

// Tolerances that a machine file does not state, 1 sigma: an angle sensor is set to half a degree,
// a transmitter is of class 0.5 of its valve's relief pressure, its span known to a hundredth; a
// gateway hands on what it has within ten milliseconds.
static const double zero_rad    = 0.5 * DIG_RAD_PER_DEG;
static const double span_share  = 0.01;
static const double class_share = 0.005;
static const double late_s      = 0.01;
// An inertia is known to a fifth.
static const double inertia_share = 0.2;

// 1 sigma of a cause that is wrong.
static const double wrong_rad    = 10.0 * DIG_RAD_PER_DEG;
static const double wrong_share  = 0.2;  // of a span
static const double wrong_weight = 0.45; // of a weight
static const double wrong_Pa     = 3e6;
static const double wrong_late_s = 0.1;

// The parameters of the effects, in the order of estimator/effects/.
enum { OF_A_SEAL = 4, COULOMB = 0, STRIBECK = 3, GAINS = 6, SEALS = 12 };

// A link's weight and where it lies are known together.
static double weight_tolerance_kg(const struct dig_machine *const machine, const size_t joint)
{
    const struct dig_link *const link = &machine->link[joint];

    const double lies_m = dig_vec2_norm(link->com_m);
    const double share =
        lies_m > 0.0 ? machine->tolerance.com_share * link->length_m / lies_m : 0.0;
    return link->mass_kg * hypot(machine->tolerance.mass_share, share);
}

static int at_joint(const enum dig_cause_kind kind, const size_t joint)
{
    return (int)((size_t)kind * DIG_JOINTS + joint);
}

struct dig_cause_column dig_cause_column_of(const struct dig_machine *const      machine,
                                            const struct dig_lines_column *const column)
{
    assert(machine != NULL && column != NULL);
    static const enum dig_joint drive[DIG_JOINTS] = { DIG_JOINT_BUCKET, DIG_JOINT_ARM,
                                                      DIG_JOINT_BOOM };
    const size_t                p                 = column->parameter;
    if (column->effect == DIG_EFFECT_UNLISTED && p >= DIG_FILE_LINKS) {
        const size_t j = (p - DIG_FILE_LINKS) / 3;
        return (struct dig_cause_column){ at_joint(DIG_CAUSE_WEIGHT, j),
                                          weight_tolerance_kg(machine, j),
                                          wrong_weight * machine->link[j].mass_kg };
    }
    if (column->effect == DIG_EFFECT_ANGLE_OFFSET) {
        return (struct dig_cause_column){ at_joint(DIG_CAUSE_ZERO, p), zero_rad, wrong_rad };
    }
    if (column->effect == DIG_EFFECT_PRESSURE_OFFSET) {
        const size_t j = p % GAINS / DIG_CHAMBERS;
        return p < GAINS ? (struct dig_cause_column){ at_joint(DIG_CAUSE_OFFSET, j),
                                                      class_share * machine->cylinder[j].relief_Pa,
                                                      wrong_Pa }
                         : (struct dig_cause_column){ at_joint(DIG_CAUSE_FACTOR, j), span_share,
                                                      wrong_share };
    }
    if (column->effect == DIG_EFFECT_SENSOR_DELAY) {
        return (struct dig_cause_column){ (int)DIG_CAUSE_DELAY, late_s, wrong_late_s };
    }
    double tolerance = 0.0; // a payload is the bucket's weight here
    if (column->effect == DIG_EFFECT_UNLISTED) {
        tolerance = DIG_FILE_LEVEL_SIGMA_rad;
    } else if (column->effect == DIG_EFFECT_LINKAGE_GEOMETRY) {
        tolerance = machine->tolerance.pin_m;
    } else if (column->effect == DIG_EFFECT_BUCKET_INERTIA) {
        tolerance = inertia_share * machine->link[DIG_JOINT_BUCKET].inertia_kgm2;
    } else if (column->effect == DIG_EFFECT_CYLINDER_FRICTION && p < SEALS) {
        tolerance = p % OF_A_SEAL == COULOMB
                        ? dig_drive_seal_N(&machine->cylinder[drive[p / OF_A_SEAL]])
                    : p % OF_A_SEAL == STRIBECK ? 0.0
                                                : column->scale;
    }
    return (struct dig_cause_column){ -1, tolerance, tolerance };
}
