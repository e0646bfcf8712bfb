#include "closed_loop/verdict/air_motion.h"

#include "closed_loop/air/machine_air.h"
#include "closed_loop/machine_digs/machine_dig.h"
#include "core/units.h"
#include "estimator/wrench/balance.h"
#include "estimator/wrench/dynamics.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

enum { SAMPLES = 2000, FAST = 5 };

static const double swing = 0.3; // of the joint's range

static const struct dig_correction none = { .delay_s = 0.0 };

// The joints' angles along the motion, sample by sample.
static void move(const struct dig_machine *const machine, const struct dig_motion *const motion,
                 struct dig_sample sample[SAMPLES])
{
    const double turns = motion->fast ? FAST : 1.0;
    for (size_t i = 0; i < SAMPLES; i++) {
        const double time_s = DIG_MOTION_s * (double)i / SAMPLES;
        sample[i]           = (struct dig_sample){ .time_ns = llround(1e9 * time_s) };
        for (size_t s = 0; s <= DIG_SIGNAL_PITCH_rad; s++) {
            sample[i].valid[s] = true;
        }
        for (size_t j = 0; j < DIG_JOINTS; j++) {
            const struct dig_link *const link = &machine->link[j];

            const double range_rad = link->max_rad - link->min_rad;
            const double phase_rad = 2.0 * DIG_PI * turns * time_s / DIG_MOTION_s;
            sample[i].value[DIG_SIGNAL_BOOM_rad + j] =
                0.5 * (link->min_rad + link->max_rad) +
                (j == (size_t)motion->joint ? swing * range_rad * sin(phase_rad) : 0.0);
        }
    }
}

// Puts into the chambers what holds the machine there, moving so; false where it cannot.
static bool push(const struct dig_machine *const machine, const struct dig_rates *const rates,
                 struct dig_sample *const sample)
{
    struct dig_readings readings;
    for (int j = 0; j < DIG_JOINTS; j++) {
        sample->value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j] = machine->cylinder[j].back_Pa;
        sample->value[DIG_SIGNAL_BOOM_ROD_Pa + 2 * j]  = machine->cylinder[j].back_Pa;
    }
    if (dig_readings_take(machine, &none, sample, rates, &readings) != DIG_OK) {
        return false;
    }
    const struct dig_front   front   = dig_front_place(machine, readings.joint_rad);
    const struct dig_balance balance = dig_balance_solve(machine, &readings, &front);
    for (int j = 0; j < DIG_JOINTS; j++) {
        const struct dig_cylinder *const cylinder = &machine->cylinder[j];
        if (!balance.lever_ok[j]) {
            return false;
        }
        const double more_N = -balance.rest_Nm[j] / balance.lever[j].arm_m / cylinder->count;
        if (more_N > 0.0) {
            sample->value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j] +=
                more_N / dig_cylinder_head_m2(cylinder);
        } else {
            sample->value[DIG_SIGNAL_BOOM_ROD_Pa + 2 * j] -= more_N / dig_cylinder_rod_m2(cylinder);
        }
    }
    return true;
}

// The motion as a recording of nothing but air.
static enum dig_status record(const struct dig_machine *const machine,
                              const struct dig_motion *const  motion,
                              struct dig_machine_dig *const   dig)
{
    struct dig_error             error     = { "" };
    struct dig_machine_recording recording = { .rows = SAMPLES,
                                               .row  = malloc(SAMPLES * sizeof *recording.row) };
    if (recording.row == NULL) {
        return DIG_ENOMEM;
    }
    move(machine, motion, recording.row);
    const enum dig_status status = dig_machine_dig_make_air(machine, &recording, dig, &error);
    dig_machine_recording_finish(&recording);
    for (size_t i = 0; status == DIG_OK && i < dig->samples; i++) {
        if (!push(machine, &dig->rates[i], &dig->sample[i])) {
            // A row that holds it tells nothing.
            dig->sample[i].valid[DIG_SIGNAL_BUCKET_HEAD_Pa] = false;
        }
    }
    return status;
}

// The motion's readings are not rounded: what rounding they would have is noise.
static struct dig_machine unrounded(const struct dig_machine *const machine)
{
    struct dig_machine even = *machine;
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        even.cylinder[j].pressure_sigma_Pa =
            dig_reading_sigma(machine->pressure_step_Pa, machine->cylinder[j].pressure_sigma_Pa);
    }
    even.pressure_step_Pa = 0.0;
    return even;
}

enum dig_status dig_motion_sigmas(const struct dig_machine *const    machine,
                                  const struct dig_motion *const     motion,
                                  const struct dig_correction *const a,
                                  const struct dig_correction *const b, double *const sigmas)
{
    assert(machine != NULL && motion != NULL && a != NULL && b != NULL && sigmas != NULL);
    const struct dig_machine even   = unrounded(machine);
    struct dig_machine_dig   dig    = { .samples = 0 };
    struct dig_air           air    = { .points = 0 };
    double                  *rest   = NULL;
    enum dig_status          status = record(&even, motion, &dig);
    if (status == DIG_OK) {
        status = dig_air_make(&even, 1, &dig, NULL, &air);
    }
    if (status == DIG_OK) {
        rest   = malloc((2 * air.rows + 1) * sizeof *rest);
        status = rest != NULL ? DIG_OK : DIG_ENOMEM;
    }
    if (status == DIG_OK) {
        double sum = 0.0;
        dig_air_rest(&air, a, false, rest);
        dig_air_rest(&air, b, false, rest + air.rows);
        for (size_t r = 0; r < air.rows; r++) {
            sum += pow(rest[r] - rest[air.rows + r], 2.0);
        }
        *sigmas = sqrt(sum);
    }
    free(rest);
    dig_air_finish(&air);
    dig_machine_dig_finish(&dig);
    return status;
}

enum dig_status dig_motion_best(const struct dig_machine *const    machine,
                                const struct dig_correction *const a,
                                const struct dig_correction *const b, struct dig_motion *const best,
                                double *const sigmas)
{
    assert(best != NULL && sigmas != NULL);
    static const double     clearly  = 1.05;
    const struct dig_motion motion[] = {
        { DIG_JOINT_BUCKET, false }, { DIG_JOINT_ARM, false }, { DIG_JOINT_BOOM, false },
        { DIG_JOINT_BUCKET, true },  { DIG_JOINT_ARM, true },  { DIG_JOINT_BOOM, true },
    };
    struct dig_motion found = motion[0];
    double            most  = 0.0;
    for (size_t i = 0; i < sizeof motion / sizeof motion[0]; i++) {
        double                one    = 0.0;
        const enum dig_status status = dig_motion_sigmas(machine, &motion[i], a, b, &one);
        if (status != DIG_OK) {
            return status;
        }
        if (one > clearly * most) {
            most  = one;
            found = motion[i];
        }
    }
    *best   = found;
    *sigmas = most;
    return DIG_OK;
}
