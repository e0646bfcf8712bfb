// The wrench of a sample, by the machine as it is corrected or by a rig's force sensor.

#include "estimator/estimator_state.h"
#include "estimator/wrench/cylinder.h"
#include "estimator/wrench/dynamics.h"
#include "estimator/wrench/sensed.h"
#include "estimator/wrench/wrench.h"

#include <assert.h>
#include <math.h>

// The wrench by a rig's force sensor, inertia subtracted. The first solution checks the sample: a
// number that is not finite must not enter the filter.
static enum dig_status solve_sensed(struct dig_estimator *const    e,
                                    const struct dig_sample *const sample,
                                    struct dig_wrench *const wrench, struct dig_front *const front)
{
    const struct dig_sensed_motion still = { .turn_radps = 0.0 };
    const enum dig_status status = dig_sensed_solve(e->machine, sample, &still, wrench, front);
    if (status != DIG_OK) {
        return status;
    }
    const struct dig_sensed_motion motion = dig_sensed_move(&e->rates, e->machine, sample);
    return dig_sensed_solve(e->machine, sample, &motion, wrench, front);
}

// What the links' masses may add to the bucket's moment by moving, 1 sigma: as the rates of the
// last quarter second have it, less their noise. It comes late, so that it is a doubt and no
// correction.
static double inertia_Nm(const struct dig_machine *const machine,
                         const struct dig_rates *const rates, const struct dig_front *const front)
{
    double weight[DIG_JOINTS];
    double moving[DIG_JOINTS];
    double by[DIG_JOINTS][DIG_JOINTS];
    double noise2 = 0.0;
    dig_statics_weight_Nm(machine, front, 0.0, weight);
    dig_dynamics_Nm(machine, front, rates, 0.0, moving);
    dig_dynamics_inertia_kgm2(machine, front, by);
    for (int k = 0; k < DIG_JOINTS; k++) {
        noise2 += pow(by[DIG_JOINT_BUCKET][k] * rates->acceleration_sigma, 2.0);
    }
    const double adds_Nm = moving[DIG_JOINT_BUCKET] - weight[DIG_JOINT_BUCKET];
    return sqrt(fmax(adds_Nm * adds_Nm - noise2, 0.0));
}

static struct dig_rates step_rates(struct dig_estimator *const    e,
                                   const struct dig_sample *const sample)
{
    return dig_rates_step(
        &e->rates, sample->time_ns, &sample->value[DIG_SIGNAL_BOOM_rad],
        dig_reading_sigma(e->machine->angle_step_rad, e->machine->angle_sigma_rad));
}

// By the machine as a model corrects it.
static enum dig_status solve_corrected(struct dig_estimator *const    e,
                                       const struct dig_sample *const sample,
                                       struct dig_rates *const now, struct dig_wrench *const wrench,
                                       struct dig_front *const front)
{
    const double *const now_rad = &sample->value[DIG_SIGNAL_BOOM_rad];
    if (!dig_sample_has_moment(sample)) {
        return DIG_ESTALE;
    }
    if (!isfinite(now_rad[0]) || !isfinite(now_rad[1]) || !isfinite(now_rad[2])) {
        return DIG_EINVAL;
    }
    *now = step_rates(e, sample);
    // A delay: the parabola through the last angles, evaluated at the time of the pressures.
    struct dig_sample at      = *sample;
    struct dig_rates  rates   = *now;
    const double      delay_s = e->corrected.correction.delay_s;
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double back_rad =
            delay_s * (rates.velocity_radps[j] - 0.5 * delay_s * rates.acceleration_radps2[j]);
        at.value[DIG_SIGNAL_BOOM_rad + j] -= back_rad;
        rates.velocity_radps[j] -= delay_s * rates.acceleration_radps2[j];
    }
    return dig_wrench_correct(&e->corrected.machine, &e->corrected.correction, &at, &rates,
                              DIG_WITH_SIGMA, wrench, front);
}

enum dig_status dig_estimator_solve(struct dig_estimator *const    e,
                                    const struct dig_sample *const sample,
                                    struct dig_wrench *const wrench, struct dig_front *const front)
{
    if (e->machine->sensor.fitted) {
        return solve_sensed(e, sample, wrench, front);
    }
    struct dig_rates      rates;
    const bool            corrects = e->corrected.corrects;
    const enum dig_status status   = corrects ? solve_corrected(e, sample, &rates, wrench, front)
                                              : dig_wrench_solve(e->machine, sample, wrench, front);
    if (status == DIG_OK) {
        rates         = corrects ? rates : step_rates(e, sample);
        e->inertia_Nm = inertia_Nm(e->machine, &rates, front);
    }
    return status;
}
