#include "tools/rig/sensors.h"

#include "core/chance.h"
#include "core/units.h"

#include <math.h>
#include <stddef.h>

static const double oil_degC = 45.0;

struct dig_rig_noise dig_rig_noise_init(const uint64_t seed)
{
    return (struct dig_rig_noise){ .state = seed };
}

// In (0, 1): the middle of each of 2^53 steps, never the ends.
static double uniform(struct dig_rig_noise *const noise)
{
    return dig_chance_uniform(&noise->state) + 0x1p-54;
}

double dig_rig_noise_normal(struct dig_rig_noise *const noise)
{
    const double radius = sqrt(-2.0 * log(uniform(noise)));
    return radius * cos(2.0 * DIG_PI * uniform(noise));
}

static double noisy(const double value, const double sigma, struct dig_rig_noise *const noise)
{
    return noise != NULL ? value + sigma * dig_rig_noise_normal(noise) : value;
}

// Of a bucket on a force sensor.
static struct dig_sample sense_load(const struct dig_machine *const machine,
                                    const struct dig_rig_row *const row, const int64_t time_ns,
                                    struct dig_rig_noise *const noise)
{
    const struct dig_force_sensor *const s = &machine->sensor;
    const struct {
        enum dig_signal signal;
        double          truth, sigma;
    } read[] = {
        { DIG_SIGNAL_BUCKET_rad, row->pose.phi_rad, machine->angle_sigma_rad },
        { DIG_SIGNAL_PIN_X_m, row->pose.X_m, s->path_sigma_m },
        { DIG_SIGNAL_PIN_Z_m, row->pose.Z_m, s->path_sigma_m },
        { DIG_SIGNAL_SENSOR_FX_N, row->load.Fx_N, s->sigma_N },
        { DIG_SIGNAL_SENSOR_FZ_N, row->load.Fz_N, s->sigma_N },
        { DIG_SIGNAL_SENSOR_MY_Nm, row->load.My_Nm, s->sigma_Nm },
        { DIG_SIGNAL_PITCH_rad, 0.0, 0.0 },
    };
    struct dig_sample sample = { .time_ns = time_ns };
    for (size_t i = 0; i < sizeof read / sizeof read[0]; i++) {
        sample.value[read[i].signal] = noisy(read[i].truth, read[i].sigma, noise);
        sample.valid[read[i].signal] = true;
    }
    return sample;
}

struct dig_sample dig_rig_sense(const struct dig_machine *const machine,
                                const struct dig_rig_row *const row, const int64_t time_ns,
                                struct dig_rig_noise *const noise)
{
    if (machine->sensor.fitted) {
        return sense_load(machine, row, time_ns, noise);
    }
    struct dig_sample sample = { .time_ns = time_ns };
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double  sigma_Pa = machine->cylinder[j].pressure_sigma_Pa;
        double *const Pa       = &sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j]; // head, rod
        sample.value[DIG_SIGNAL_BOOM_rad + j] =
            noisy(row->joints.rad[j], machine->angle_sigma_rad, noise);
        Pa[0] = noisy(row->pressures.head_Pa[j], sigma_Pa, noise);
        Pa[1] = noisy(row->pressures.rod_Pa[j], sigma_Pa, noise);
    }
    sample.value[DIG_SIGNAL_TEMPERATURE_degC] = oil_degC;
    for (int s = 0; s <= DIG_SIGNAL_TEMPERATURE_degC; s++) {
        sample.valid[s] = true;
    }
    return sample;
}

// Of the number a signal comes as; 0: none.
static double step_of(const struct dig_machine *const machine, const int signal)
{
    if (signal <= DIG_SIGNAL_BUCKET_rad) {
        return machine->angle_step_rad;
    }
    if (signal <= DIG_SIGNAL_BUCKET_ROD_Pa) {
        return machine->pressure_step_Pa;
    }
    if (signal < DIG_SIGNAL_SENSOR_FX_N) {
        return 0.0;
    }
    return signal == DIG_SIGNAL_SENSOR_MY_Nm ? machine->sensor.step_Nm : machine->sensor.step_N;
}

void dig_rig_quantise(const struct dig_machine *const machine, struct dig_sample *const sample)
{
    for (int s = 0; s < DIG_SIGNALS; s++) {
        const double step = step_of(machine, s);
        if (step > 0.0) {
            sample->value[s] = step * round(sample->value[s] / step);
        }
    }
}
