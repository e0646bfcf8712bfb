#include "tools/rig/sensors.h"

#include "core/units.h"

#include <math.h>
#include <stddef.h>

static const double oil_degC = 45.0;

struct dig_rig_noise dig_rig_noise_init(const uint64_t seed)
{
    return (struct dig_rig_noise){ .state = seed };
}

// SplitMix64 (Steele, Lea, Flood 2014): a counter put through a mixer.
static uint64_t next(struct dig_rig_noise *const noise)
{
    noise->state += UINT64_C(0x9E3779B97F4A7C15);
    uint64_t z = noise->state;
    z          = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z          = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

// In (0, 1): 53 bits, never the ends.
static double uniform(struct dig_rig_noise *const noise)
{
    return ((double)(next(noise) >> 11) + 0.5) * 0x1p-53;
}

double dig_rig_noise_normal(struct dig_rig_noise *const noise)
{
    const double radius = sqrt(-2.0 * log(uniform(noise)));
    return radius * cos(2.0 * DIG_PI * uniform(noise));
}

struct dig_sample dig_rig_sense(const struct dig_machine *const machine,
                                const struct dig_rig_row *const row, const int64_t time_ns,
                                struct dig_rig_noise *const noise)
{
    struct dig_sample sample = { .time_ns = time_ns };
    for (int j = 0; j < DIG_JOINTS; j++) {
        sample.value[DIG_SIGNAL_BOOM_rad + j]             = row->joints.rad[j];
        sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j]     = row->pressures.head_Pa[j];
        sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j + 1] = row->pressures.rod_Pa[j];
    }
    if (noise != NULL) {
        for (int j = 0; j < DIG_JOINTS; j++) {
            const double sigma_Pa = machine->cylinder[j].pressure_sigma_Pa;
            sample.value[DIG_SIGNAL_BOOM_rad + j] +=
                machine->angle_sigma_rad * dig_rig_noise_normal(noise);
            sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j] += sigma_Pa * dig_rig_noise_normal(noise);
            sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j + 1] +=
                sigma_Pa * dig_rig_noise_normal(noise);
        }
    }
    sample.value[DIG_SIGNAL_TEMPERATURE_degC] = oil_degC;
    for (int s = 0; s < DIG_SIGNALS; s++) {
        sample.valid[s] = true;
    }
    return sample;
}

void dig_rig_quantise(const struct dig_machine *const machine, struct dig_sample *const sample)
{
    for (int s = DIG_SIGNAL_BOOM_rad; s <= DIG_SIGNAL_BUCKET_ROD_Pa; s++) {
        const double step =
            s < DIG_SIGNAL_BOOM_HEAD_Pa ? machine->angle_step_rad : machine->pressure_step_Pa;
        if (step > 0.0) {
            sample->value[s] = step * round(sample->value[s] / step);
        }
    }
}
