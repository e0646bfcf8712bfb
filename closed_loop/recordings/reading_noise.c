#include "closed_loop/recordings/reading_noise.h"

#include "estimator/wrench/correction.h"
#include "estimator/wrench/cylinder.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Less than this is within what the file may round.
static const double least_more = 1.25;

// How far the middle of three readings is from the mean of both beside it.
static double off_line(const double y[3])
{
    return y[1] - 0.5 * (y[0] + y[2]);
}

// White noise puts a reading and the next off to either side, by its variance as a product.
double dig_reading_noise(const size_t rows, const double value[])
{
    assert(rows == 0 || value != NULL);
    double at[4]    = { 0.0 };
    double readings = 0.0;
    double products = 0.0;
    for (size_t i = 0; i < rows; i++) {
        // A row that repeats the one before is no reading of its own.
        if (i > 0 && fabs(value[i] - value[i - 1]) <= 0.0) {
            continue;
        }
        memmove(at, at + 1, 3 * sizeof at[0]);
        at[3] = value[i];
        readings += 1.0;
        products += readings >= 4.0 ? off_line(at) * off_line(at + 1) : 0.0;
    }
    return products < 0.0 ? sqrt(-products / (readings - 3.0) * (double)rows / readings) : 0.0;
}

// Sum of squares of a signal's differences from its neighbours' mean over what white noise of
// variance 1 makes of them, and how many.
struct seen {
    double square, count;
};

static struct seen look(const struct dig_machine_recording *const recording, const size_t signal)
{
    struct seen seen = { 0.0, 0.0 };
    for (size_t i = 1; i + 1 < recording->rows; i++) {
        const bool read = recording->row[i - 1].valid[signal] && recording->row[i].valid[signal] &&
                          recording->row[i + 1].valid[signal];
        const double off =
            recording->row[i].value[signal] -
            0.5 * (recording->row[i - 1].value[signal] + recording->row[i + 1].value[signal]);
        if (read && isfinite(off)) {
            seen.square += off * off / 1.5;
            seen.count += 1.0;
        }
    }
    return seen;
}

// The sigma that with the step's makes up what signals [first, first + signals) scatter by.
static double raised(const double step, const double sigma, const size_t digs,
                     const struct dig_machine_recording recording[], const size_t first,
                     const size_t signals)
{
    double most = sigma;
    for (size_t s = first; s < first + signals; s++) {
        struct seen all = { 0.0, 0.0 };
        for (size_t d = 0; d < digs; d++) {
            const struct seen one = look(&recording[d], s);
            all.square += one.square;
            all.count += one.count;
        }
        const double rms = all.count > 0.0 ? sqrt(all.square / all.count) : 0.0;
        if (rms > least_more * dig_reading_sigma(step, sigma)) {
            const double of_step = dig_reading_sigma(step, 0.0);
            most                 = fmax(most, sqrt(fmax(rms * rms - of_step * of_step, 0.0)));
        }
    }
    return most;
}

void dig_reading_noise_raise(struct dig_machine *const machine, const size_t digs,
                             const struct dig_machine_recording recording[])
{
    assert(machine != NULL && (digs == 0 || recording != NULL));
    machine->angle_sigma_rad = raised(machine->angle_step_rad, machine->angle_sigma_rad, digs,
                                      recording, DIG_SIGNAL_BOOM_rad, DIG_JOINTS);
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        struct dig_cylinder *const cylinder = &machine->cylinder[j];

        cylinder->pressure_sigma_Pa =
            raised(machine->pressure_step_Pa, cylinder->pressure_sigma_Pa, digs, recording,
                   (size_t)DIG_SIGNAL_BOOM_HEAD_Pa + DIG_CHAMBERS * j, DIG_CHAMBERS);
    }
}
