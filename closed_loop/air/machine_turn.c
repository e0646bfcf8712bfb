#include "closed_loop/air/machine_turn.h"

#include <assert.h>
#include <math.h>

static const double half_s = DIG_AIR_KERNEL_HALF_s;

// The harmonics left out are of a hundredth of a step.
enum { HARMONICS = 60 };

static double bessel2(const double x)
{
    if (x < 0.1) {
        return x * x / 15.0;
    }
    return (3.0 / (x * x) - 1.0) * sin(x) / x - 3.0 * cos(x) / (x * x);
}

// The sawtooth's part, at one speed.
static double stepped_variance(const double step_rad, const double sigma_rad,
                               const double speed_radps, const double block_s)
{
    double sum = 0.0;
    for (int k = 1; k <= HARMONICS && step_rad > 0.0 && fabs(speed_radps) > 0.0; k++) {
        const double wave_Hz = (double)k * fabs(speed_radps) / step_rad;
        const double y       = DIG_PI * wave_Hz * block_s;
        const double spread  = DIG_PI * (double)k * sigma_rad / step_rad;
        const double wave    = step_rad / (DIG_PI * (double)k) * exp(-2.0 * spread * spread);
        const double seen =
            15.0 * bessel2(2.0 * DIG_PI * wave_Hz * half_s) / (half_s * half_s) * sin(y) / y;
        sum += 0.5 * wave * wave * seen * seen;
    }
    return sum;
}

// How alike what white noise makes of the accelerations of two parabolas is, so far apart: these
// are weighted sums of the angles, weights (3 u^2 - 1) / 2 for u from -1 to 1.
static double likeness(const double apart_s)
{
    enum { STEPS = 200 };
    const double apart = apart_s / half_s;
    double       sum   = 0.0;
    for (int i = 0; i < STEPS && apart < 2.0; i++) {
        const double u = apart - 1.0 + (2.0 - apart) * ((double)i + 0.5) / STEPS;
        const double v = u - apart;
        sum += 0.25 * (3.0 * u * u - 1.0) * (3.0 * v * v - 1.0) * (2.0 - apart) / STEPS;
    }
    return sum / 0.4;
}

void dig_turn_variance(const struct dig_machine *const machine, const struct dig_air_point point[],
                       const size_t points, double variance[DIG_JOINTS])
{
    assert(machine != NULL && point != NULL && points > 0 && variance != NULL);
    const double n                   = (double)points;
    double       white               = 0.0;
    double       stepped[DIG_JOINTS] = { 0.0 };
    for (size_t apart = 0; apart < points; apart++) {
        const double alike = likeness((double)apart * DIG_AIR_STEP_s);
        for (size_t p = 0; p + apart < points; p++) {
            white += (apart == 0 ? 1.0 : 2.0) * alike * point[p].rates.acceleration_sigma *
                     point[p + apart].rates.acceleration_sigma / (n * n);
        }
    }
    for (size_t p = 0; p < points; p++) {
        for (size_t k = 0; k < DIG_JOINTS; k++) {
            stepped[k] += stepped_variance(machine->angle_step_rad, machine->angle_sigma_rad,
                                           point[p].rates.velocity_radps[k], n * DIG_AIR_STEP_s) /
                          n;
        }
    }
    for (size_t k = 0; k < DIG_JOINTS; k++) {
        variance[k] = fmax(white, 0.0) + stepped[k];
    }
}
