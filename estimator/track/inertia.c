#include "estimator/track/inertia.h"

#include "estimator/wrench/balance.h"
#include "estimator/wrench/cylinder.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

// As the closed loop's rates of a recording are, and beyond it for rounding.
static const double reach_s = 0.12 + 1e-6;

// Of the links' weight: what a machine file's masses and the friction of pins leave unsure.
static const double unsure_share = 0.01;

// A seal bends so far before it slips, and stays bent where the rod stops.
static const double bend_m = 2e-4;

enum { NEAR_MAX = 512 };

// The samples near one, their times the machine's.
struct near {
    size_t samples, at; // at: which of them it is
    double time_s[NEAR_MAX];
    double joint_rad[NEAR_MAX * DIG_JOINTS];
};

// What motion adds to one sample's parts: by inertia, with the variance of that, and by 1 sigma of
// each drive's friction; against its rod's motion, and of a rod that stands against its last.
struct motion {
    double part[DIG_PARTS], variance[DIG_PARTS];
    double rubs[DIG_JOINTS][DIG_PARTS];
    double moves[DIG_JOINTS], stands[DIG_JOINTS]; // shares of it, -1 to 1
};

// How far the seals of each drive are bent.
struct seals {
    double time_s;
    double bent_m[DIG_JOINTS];
};

static void rubs_of(const struct dig_machine *const machine, const struct dig_friction stated[],
                    const struct dig_balance *const balance, const struct dig_rates *const rates,
                    const double step_s, struct seals *const seals, struct motion *const motion)
{
    for (size_t j = 0; j < DIG_JOINTS; j++) {
        const bool    known   = stated != NULL && fabs(stated[j].coulomb_N) > 0.0;
        const double  seal_N  = known ? 0.0 : dig_cylinder_seal_N(&machine->cylinder[j]);
        const double  arm_m   = balance->lever[j].arm_m;
        const double  rod_mps = arm_m * rates->velocity_radps[j];
        double *const bent_m  = &seals->bent_m[j];
        *bent_m               = fmin(fmax(*bent_m + step_s * rod_mps, -bend_m), bend_m);
        motion->moves[j]      = tanh(rod_mps / DIG_FRICTION_STILL_mps);
        motion->stands[j]     = (1.0 - fabs(motion->moves[j])) * *bent_m / bend_m;
        for (int p = 0; p < DIG_PARTS; p++) {
            motion->rubs[j][p] = balance->by_moment[p][j] * arm_m * seal_N;
        }
    }
}

static void motion_of(const struct dig_machine *const machine, const struct dig_friction stated[],
                      const struct near *const near, const double step_s, struct seals *const seals,
                      struct motion *const motion)
{
    const double sigma_rad = dig_reading_sigma(machine->angle_step_rad, machine->angle_sigma_rad);
    const struct dig_rates rates =
        dig_rates_at(near->at, near->samples, near->time_s, near->joint_rad, sigma_rad);
    struct dig_readings readings = { .pitch_rad = 0.0 };
    memcpy(readings.joint_rad, &near->joint_rad[DIG_JOINTS * near->at], sizeof readings.joint_rad);

    // Two balances without a push: what differs is what resting masses leave in.
    const struct dig_front   front   = dig_front_place(machine, readings.joint_rad);
    const struct dig_balance resting = dig_balance_solve(machine, &readings, &front);
    readings.rates                   = &rates;
    readings.inertia                 = true;
    const struct dig_balance moving  = dig_balance_solve(machine, &readings, &front);
    dig_balance_add_inertia_variance(machine, &front, &moving, rates.acceleration_sigma,
                                     motion->variance);
    for (int p = 0; p < DIG_PARTS; p++) {
        motion->part[p] = resting.part[p] - moving.part[p];
    }
    rubs_of(machine, stated, &moving, &rates, step_s, seals, motion);
}

// The samples from first on within reach of sample i, the nearest where there are too many.
static void look_near(const struct dig_window *const window, const size_t first, const size_t i,
                      const double scale, struct near *const near)
{
    const size_t from = i - first < NEAR_MAX / 2 ? first : i - NEAR_MAX / 2;
    near->samples     = 0;
    near->at          = i - from;
    for (size_t k = from; k < window->count && near->samples < NEAR_MAX; k++) {
        const struct dig_window_sample *const sample = &window->sample[k];
        if (scale * (sample->time_s - window->sample[i].time_s) > reach_s) {
            break;
        }
        near->time_s[near->samples] = scale * (sample->time_s - window->sample[i].time_s);
        memcpy(&near->joint_rad[DIG_JOINTS * near->samples], sample->joint_rad,
               sizeof sample->joint_rad);
        near->samples++;
    }
}

static double weight_N(const struct dig_machine *const machine)
{
    double mass_kg = 0.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        mass_kg += machine->link[j].mass_kg;
    }
    return mass_kg * -dig_statics_gravity_mps2(0.0).y;
}

static void add_sigma(const double more, float *const sigma)
{
    *sigma = (float)hypot((double)*sigma, more);
}

static void take_off(const struct dig_machine *const machine, const struct dig_friction stated[],
                     const double lambda, const struct near *const near, const double step_s,
                     struct seals *const seals, struct dig_window_sample *const sample)
{
    static const enum dig_part_of_wrench part_of[DIG_FORCE_CHANNELS] = {
        [DIG_CHANNEL_MY_Nm] = DIG_PART_MY,
        [DIG_CHANNEL_FX_N]  = DIG_PART_FX,
        [DIG_CHANNEL_FZ_N]  = DIG_PART_FZ,
    };
    struct motion motion   = { .part = { 0.0 } };
    const double  lambda3  = lambda * lambda * lambda;
    const double  unsure_N = unsure_share * weight_N(machine);
    if (near->samples >= DIG_RATES_LEAST) {
        motion_of(machine, stated, near, step_s, seals, &motion);
    }
    for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
        const bool   moment = c == DIG_CHANNEL_MY_Nm;
        const double scale  = moment ? lambda * lambda3 : lambda3;
        const int    p      = (int)part_of[c];
        sample->value[c] -= motion.part[p] / scale;
        add_sigma(sqrt(motion.variance[p]) / scale, &sample->sigma[c]);
        for (size_t j = 0; j < DIG_JOINTS; j++) { // how much holds a standing rod is not known
            const double rubs               = motion.rubs[j][p] / scale;
            sample->rubs[j][c]              = (float)(motion.moves[j] * rubs);
            sample->rubs[DIG_JOINTS + j][c] = (float)(motion.stands[j] * rubs);
        }
        add_sigma(moment ? 0.0 : unsure_N / scale, &sample->sigma[c]);
        add_sigma(moment ? 0.0 : unsure_N / scale, &sample->slow[c]);
    }
}

void dig_inertia_take_off(const struct dig_machine *const machine,
                          const struct dig_friction stated[], const double lambda,
                          struct dig_window *const window)
{
    assert(machine != NULL && lambda > 0.0 && window != NULL);
    if (machine->sensor.fitted) {
        return;
    }
    const double scale = sqrt(lambda); // the machine's time over the table's
    size_t       first = 0;
    struct seals seals = { .time_s = 0.0 };
    dig_window_sort(window);
    for (size_t i = 0; i < window->count; i++) {
        while (scale * (window->sample[i].time_s - window->sample[first].time_s) > reach_s) {
            first++;
        }
        struct near near;
        look_near(window, first, i, scale, &near);
        const double now_s  = scale * window->sample[i].time_s;
        const double step_s = i > 0 ? now_s - seals.time_s : 0.0;
        seals.time_s        = now_s;
        take_off(machine, stated, lambda, &near, step_s, &seals, &window->sample[i]);
    }
}
