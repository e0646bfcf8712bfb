#include "estimator/wrench/sensed.h"

#include "estimator/wrench/cylinder.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

enum input { IN_FX, IN_FZ, IN_MY, IN_PHI, IN_PIN_X, IN_PIN_Z, IN_TURN, INPUTS };

// The quantities with errors: the sensor's readings, the bucket's angle and the accelerations.
struct inputs {
    double value[INPUTS], sigma[INPUTS], slow[INPUTS];
};

struct parts {
    double of[DIG_PARTS]; // of the soil, rig axes
};

static struct parts solve(const struct dig_machine *const machine, const double in[const INPUTS],
                          const double turn_radps, const struct dig_vec2 gravity)
{
    const struct dig_link *const         bucket = &machine->link[DIG_JOINT_BUCKET];
    const struct dig_force_sensor *const sensor = &machine->sensor;
    const double                         phi    = in[IN_PHI];

    // From the pin to the sensor and to the centre of mass.
    const struct dig_vec2 to_sensor = dig_vec2_turned(sensor->place_m, phi);
    const struct dig_vec2 to_com    = dig_vec2_turned(bucket->com_m, phi);
    const struct dig_vec2 across    = { -to_com.y, to_com.x };
    struct dig_vec2       com_mps2  = { in[IN_PIN_X], in[IN_PIN_Z] };
    com_mps2                        = dig_vec2_add_scaled(com_mps2, in[IN_TURN], across);
    com_mps2 = dig_vec2_add_scaled(com_mps2, -turn_radps * turn_radps, to_com);

    // Weight and inertia on the sensor; the rest is the soil's.
    const struct dig_vec2 felt   = dig_vec2_sub(gravity, com_mps2);
    const struct dig_vec2 mass_N = { bucket->mass_kg * felt.x, bucket->mass_kg * felt.y };
    const struct dig_vec2 read_N =
        dig_vec2_turned((struct dig_vec2){ in[IN_FX], in[IN_FZ] }, phi + sensor->turn_rad);
    const struct dig_vec2 soil_N = dig_vec2_sub(read_N, mass_N);

    const double soil_Nm = in[IN_MY] + dig_vec2_cross(to_sensor, read_N) -
                           dig_vec2_cross(to_com, mass_N) + bucket->inertia_kgm2 * in[IN_TURN];

    // The rig's x is the machine's -X.
    return (struct parts){
        .of = { [DIG_PART_FX] = -soil_N.x, [DIG_PART_FZ] = soil_N.y, [DIG_PART_MY] = soil_Nm }
    };
}

static enum dig_status take(const struct dig_machine *const       machine,
                            const struct dig_sample *const        sample,
                            const struct dig_sensed_motion *const motion,
                            struct inputs *const                  inputs)
{
    if (!dig_sample_has_moment(sample) ||
        dig_signals_sensing(sample->valid) != DIG_SENSING_SENSOR) {
        return DIG_ESTALE;
    }
    const struct dig_force_sensor *const s         = &machine->sensor;
    const double                         angle_rad = machine->angle_step_rad;
    const double                         noise_rad = machine->angle_sigma_rad;
    const double                         force_N   = dig_reading_sigma(s->step_N, s->sigma_N);
    const double                         slow_N    = dig_reading_slow(s->step_N, s->sigma_N);

    const struct inputs in = {
        .value = { [IN_FX]    = sample->value[DIG_SIGNAL_SENSOR_FX_N],
                   [IN_FZ]    = sample->value[DIG_SIGNAL_SENSOR_FZ_N],
                   [IN_MY]    = sample->value[DIG_SIGNAL_SENSOR_MY_Nm],
                   [IN_PHI]   = sample->value[DIG_SIGNAL_BUCKET_rad],
                   [IN_PIN_X] = motion->pin_mps2.x,
                   [IN_PIN_Z] = motion->pin_mps2.y,
                   [IN_TURN]  = motion->turn_radps2 },
        .sigma = { [IN_FX]    = force_N,
                   [IN_FZ]    = force_N,
                   [IN_MY]    = dig_reading_sigma(s->step_Nm, s->sigma_Nm),
                   [IN_PHI]   = dig_reading_sigma(angle_rad, noise_rad),
                   [IN_PIN_X] = motion->pin_sigma_mps2,
                   [IN_PIN_Z] = motion->pin_sigma_mps2,
                   [IN_TURN]  = motion->turn_sigma_radps2 },
        .slow  = { [IN_FX]  = slow_N,
                   [IN_FZ]  = slow_N,
                   [IN_MY]  = dig_reading_slow(s->step_Nm, s->sigma_Nm),
                   [IN_PHI] = dig_reading_slow(angle_rad, noise_rad) },
    };
    bool finite = isfinite(motion->turn_radps) && isfinite(sample->value[DIG_SIGNAL_PIN_X_m]) &&
                  isfinite(sample->value[DIG_SIGNAL_PIN_Z_m]);
    for (int i = 0; i < INPUTS; i++) {
        finite = finite && isfinite(in.value[i]);
    }
    if (!finite) {
        return DIG_EINVAL;
    }
    *inputs = in;
    return DIG_OK;
}

// Adds the variance of the parts by one length or mass of `near` with this error.
static void add_off(struct dig_machine *const near, double *const number, const double by,
                    const struct inputs *const in, const struct dig_vec2 gravity,
                    const struct parts *const parts, double variance[const DIG_PARTS])
{
    const double kept = *number;
    *number += by;
    const struct parts other = solve(near, in->value, 0.0, gravity);
    *number                  = kept;
    for (int p = 0; p < DIG_PARTS; p++) {
        variance[p] += pow(other.of[p] - parts->of[p], 2.0);
    }
}

// Variance of the parts by the tolerances of the bucket and of the sensor's position.
static void tolerate(const struct dig_machine *const machine, const struct inputs *const in,
                     const struct dig_vec2 gravity, double variance[const DIG_PARTS])
{
    const struct dig_tolerance *const tolerance = &machine->tolerance;
    struct dig_machine                near      = *machine;
    struct dig_link *const            bucket    = &near.link[DIG_JOINT_BUCKET];
    const struct parts                parts     = solve(&near, in->value, 0.0, gravity);
    const double                      com_m     = tolerance->com_share * bucket->length_m;
    const double                      mass_kg   = tolerance->mass_share * bucket->mass_kg;
    add_off(&near, &near.sensor.place_m.x, tolerance->pin_m, in, gravity, &parts, variance);
    add_off(&near, &near.sensor.place_m.y, tolerance->pin_m, in, gravity, &parts, variance);
    add_off(&near, &bucket->com_m.x, com_m, in, gravity, &parts, variance);
    add_off(&near, &bucket->com_m.y, com_m, in, gravity, &parts, variance);
    add_off(&near, &bucket->mass_kg, mass_kg, in, gravity, &parts, variance);
}

static bool is_within(const double value, const double limit, const double step, const double sigma)
{
    return fabs(value) < limit - 0.5 * step - 3.0 * sigma;
}

static bool is_trusted(const struct dig_force_sensor *const s, const struct inputs *const in)
{
    return is_within(in->value[IN_FX], s->limit_N, s->step_N, s->sigma_N) &&
           is_within(in->value[IN_FZ], s->limit_N, s->step_N, s->sigma_N) &&
           is_within(in->value[IN_MY], s->limit_Nm, s->step_Nm, s->sigma_Nm);
}

static struct dig_wrench make_wrench(const struct dig_machine *const machine,
                                     const struct inputs *const in, const double turn_radps,
                                     const struct dig_vec2 gravity)
{
    const struct parts parts               = solve(machine, in->value, turn_radps, gravity);
    double             variance[DIG_PARTS] = { 0.0 };
    double             slow[DIG_PARTS]     = { 0.0 };
    for (int i = 0; i < INPUTS; i++) {
        struct inputs more = *in;
        struct inputs less = *in;
        const double  h    = fmax(in->sigma[i], 1e-6);
        more.value[i] += h;
        less.value[i] -= h;
        const struct parts high = solve(machine, more.value, turn_radps, gravity);
        const struct parts low  = solve(machine, less.value, turn_radps, gravity);
        for (int p = 0; p < DIG_PARTS; p++) {
            const double by = (high.of[p] - low.of[p]) / (2.0 * h);
            variance[p] += by * by * in->sigma[i] * in->sigma[i];
            slow[p] += by * by * in->slow[i] * in->slow[i];
        }
    }
    double geometry[DIG_PARTS] = { 0.0 };
    tolerate(machine, in, gravity, geometry);
    return dig_wrench_of_parts(parts.of, variance, slow, geometry, true, true);
}

struct dig_sensed_motion dig_sensed_move(struct dig_rates_filter *const  filter,
                                         const struct dig_machine *const machine,
                                         const struct dig_sample *const  sample)
{
    assert(filter != NULL && machine != NULL && sample != NULL);
    const double place[DIG_JOINTS] = { sample->value[DIG_SIGNAL_PIN_X_m],
                                       sample->value[DIG_SIGNAL_PIN_Z_m],
                                       sample->value[DIG_SIGNAL_BUCKET_rad] };

    // Three coordinates in place of three joints, each with its own noise.
    const struct dig_rates rates = dig_rates_step(filter, sample->time_ns, place, 1.0);
    const double turn_rad = dig_reading_sigma(machine->angle_step_rad, machine->angle_sigma_rad);
    return (struct dig_sensed_motion){
        .pin_mps2          = { rates.acceleration_radps2[0], rates.acceleration_radps2[1] },
        .turn_radps        = rates.velocity_radps[2],
        .turn_radps2       = rates.acceleration_radps2[2],
        .pin_sigma_mps2    = rates.acceleration_sigma * machine->sensor.path_sigma_m,
        .turn_sigma_radps2 = rates.acceleration_sigma * turn_rad,
    };
}

enum dig_status dig_sensed_solve(const struct dig_machine *const       machine,
                                 const struct dig_sample *const        sample,
                                 const struct dig_sensed_motion *const motion,
                                 struct dig_wrench *const wrench, struct dig_front *const front)
{
    assert(machine != NULL && machine->sensor.fitted && sample != NULL && motion != NULL);
    assert(wrench != NULL && front != NULL);
    struct inputs   inputs;
    enum dig_status status = take(machine, sample, motion, &inputs);
    const double    pitch_rad =
        sample->valid[DIG_SIGNAL_PITCH_rad] ? sample->value[DIG_SIGNAL_PITCH_rad] : 0.0;
    if (status == DIG_OK && !isfinite(pitch_rad)) {
        status = DIG_EINVAL;
    }
    if (status != DIG_OK) {
        return status;
    }
    const struct dig_vec2 gravity = dig_statics_gravity_mps2(pitch_rad);

    const struct dig_vec2 pin    = { sample->value[DIG_SIGNAL_PIN_X_m],
                                     sample->value[DIG_SIGNAL_PIN_Z_m] };
    const double          phi    = inputs.value[IN_PHI];
    struct dig_front      placed = { .attitude_rad = { 0.0 } };

    placed.attitude_rad[DIG_JOINT_BUCKET] = phi;
    placed.pin_m[DIG_JOINT_BUCKET]        = pin;
    placed.com_m[DIG_JOINT_BUCKET] =
        dig_vec2_add_scaled(pin, 1.0, dig_vec2_turned(machine->link[DIG_JOINT_BUCKET].com_m, phi));

    *wrench = is_trusted(&machine->sensor, &inputs)
                  ? make_wrench(machine, &inputs, motion->turn_radps, gravity)
                  : (struct dig_wrench){ .moment_valid = false };
    *front  = placed;
    return DIG_OK;
}
