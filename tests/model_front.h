// An excavator front of the tests' own: the oracle for everything that turns pressures into forces.
// It knows no lever and no balance; forces follow from virtual work on lengths it finds by search.

#ifndef DIG_TESTS_MODEL_FRONT_H
#define DIG_TESTS_MODEL_FRONT_H

#include "core/machine.h"
#include "core/sample.h"

/// Soil on bucket at the bucket pin, machine frame: forward, up, counter-clockwise.
struct model_load {
    double FX_N, FZ_N, M_Nm;
};

/// About a 20 t excavator with a 0.9 m bucket. No noise, no quantisation.
struct dig_machine model_machine(void);

/// Length of a drive's cylinder at its joint's angle; the four-bar is closed by bisection of the
/// rocker's angle.
double model_cylinder_m(const struct dig_machine *machine, enum dig_joint joint, double angle_rad);

/// Central difference of the above.
double model_slope_m(const struct dig_machine *machine, enum dig_joint joint, double angle_rad);

/// Pushes of the whole drives that hold the front still under load and weight.
void model_pushes_N(const struct dig_machine *machine, const double joint_rad[DIG_JOINTS],
                    double pitch_rad, const struct model_load *load, double push_N[DIG_JOINTS]);

/// A complete sample with the chambers at those pushes; back_Pa is the return side's pressure.
struct dig_sample model_sample(const struct dig_machine *machine,
                               const double joint_rad[DIG_JOINTS], double pitch_rad,
                               const struct model_load *load, double back_Pa, int64_t time_ns);

/// Joint angles that put the bucket pin at X, Z with the tooth in direction phi.
void model_joints(const struct dig_machine *machine, double X_m, double Z_m, double phi_rad,
                  double joint_rad[DIG_JOINTS]);

/// What a sensor with this noise and this step reads. Noise and its seed are the tests' own.
double model_reading(double value, double sigma, double step, uint64_t *seed);
double model_normal(uint64_t *seed);
double model_uniform(uint64_t *seed); // 0 … 1

/// Readings of all signals with the machine's sigmas and steps.
void model_sense(const struct dig_machine *machine, struct dig_sample *sample, uint64_t *seed);

#endif // DIG_TESTS_MODEL_FRONT_H
