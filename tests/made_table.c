#include "tests/made_table.h"

#include "core/outline.h"
#include "core/units.h"
#include "estimator/approach/observe_dig.h"
#include "tests/model_front.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static struct dig_phase phase(const double duration_s, const double vx_mps, const double vz_mps,
                              const double omega_degps)
{
    return (struct dig_phase){ "", duration_s, vx_mps, vz_mps, omega_degps * DIG_RAD_PER_DEG };
}

struct dig_trajectory made_trajectory(const enum made_trajectory which)
{
    const double vx = 0.029565598190311397, vz = -0.04069355481705986;
    switch (which) {
    case MADE_SIMPLE_A:
        return (struct dig_trajectory){
            .name       = "simpleA",
            .theta0_rad = -15 * DIG_RAD_PER_DEG,
            .start_x_m  = 0.08329371405922686,
            .start_z_m  = 0.17193332436601616,
            .phases     = 3,
            .phase      = { phase(0.6, 0.02515, -0.04356107781035726, 0), phase(2.0, 0.0463, 0, 0),
                            phase(0.4, 0, 0.0915, 0) },
        };
    case MADE_SIMPLE_B:
        return (struct dig_trajectory){
            .name       = "simpleB",
            .theta0_rad = -30 * DIG_RAD_PER_DEG,
            .start_x_m  = 0.135,
            .start_z_m  = 0.16294228634059948,
            .phases     = 2,
            .phase      = { phase(0.9, vx, vz, 0), phase(2.5, 0, 0, 20.05) },
        };
    case MADE_ACTUAL:
    case MADE_TRAJECTORIES:
    default:
        return (struct dig_trajectory){
            .name       = "actual",
            .theta0_rad = -30 * DIG_RAD_PER_DEG,
            .start_x_m  = 0.09,
            .start_z_m  = 0.16294228634059948,
            .phases     = 5,
            .phase = { phase(0.8, vx, vz, 0), phase(1.1, 0, 0, 17.93), phase(2.2, 0.0463, 0, 0),
                       phase(2.0, 0, 0, 20.05), phase(0.7, 0, 0.0915, 0) },
        };
    }
}

double made_moment_Nm(const struct dig_gravel *const gravel, const enum made_trajectory which,
                      const double progress, const double family)
{
    const double f      = gravel->value[DIG_AXIS_FRICTION];
    const double r      = gravel->value[DIG_AXIS_ROLLING];
    const double both   = 0.5 * (f + r);
    const double height = (1.0 - family) * f + family * both;
    const double hump   = (1.0 - family) * r + family * both;
    const double rise   = sin(DIG_PI * progress);
    const double late   = exp(-pow((progress - 0.7) / 0.12, 2.0));
    const double size   = which == MADE_ACTUAL ? 2.5 : 1.0;
    return size * gravel->value[DIG_AXIS_DENSITY_kgpm3] / 2500.0 *
           ((0.3 + height) * rise + 0.5 * hump * late * rise);
}

static void fill(struct dig_curve *const curve, const struct dig_gravel *const gravel,
                 const enum made_trajectory which, const struct made_options *const options)
{
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double progress         = (double)k / (DIG_CURVE_POINTS - 1);
        const double moment_Nm        = made_moment_Nm(gravel, which, progress, options->family);
        const double by[DIG_CHANNELS] = { 1.0, -8.0, 5.0, 0.2 };
        for (int c = 0; c < DIG_CHANNELS; c++) {
            curve->mean[c][k] = (float)(by[c] * moment_Nm);
            curve->sd[c][k]   = (float)(options->relative_sd * fabs(by[c] * moment_Nm));
        }
    }
}

struct dig_curve_set *made_table(const struct made_options *const options)
{
    enum { FRICTIONS = 4, ROLLINGS = 4, DENSITIES = 3 };
    static const double frictions[FRICTIONS] = { 0.3, 0.5, 0.7, 0.9 };
    static const double rollings[ROLLINGS]   = { 0.1, 0.4, 0.7, 1.0 };
    static const double densities[DENSITIES] = { 1500, 2500, 4000 };

    struct dig_curve_set *const set = calloc(1, sizeof *set);
    (void)snprintf(set->scene_name, sizeof set->scene_name, "made");
    set->tooth_m         = 0.09;
    set->bucket_width_m  = 0.07;
    set->young_Pa        = 5e6;
    set->smooth_half_s   = DIG_SMOOTH_HALF_s;
    set->stiffness_power = 1.0;
    set->trajectories    = MADE_TRAJECTORIES;
    for (int t = 0; t < MADE_TRAJECTORIES; t++) {
        set->trajectory[t] = made_trajectory((enum made_trajectory)t);
    }

    const size_t counts[DIG_AXES] = { FRICTIONS, ROLLINGS, options->one_density ? 1 : DENSITIES };
    const double *const from[DIG_AXES] = { frictions, rollings,
                                           options->one_density ? densities + 1 : densities };
    size_t              points         = 1;
    for (int a = 0; a < DIG_AXES; a++) {
        set->axis_count[a] = counts[a];
        set->axis[a]       = calloc(counts[a], sizeof *set->axis[a]);
        for (size_t i = 0; i < counts[a]; i++) {
            set->axis[a][i] = from[a][i];
        }
        points *= counts[a];
    }
    set->gravel   = calloc(points, sizeof *set->gravel);
    set->packings = calloc(points * MADE_TRAJECTORIES, sizeof *set->packings);
    set->curve    = calloc(points * MADE_TRAJECTORIES, sizeof *set->curve);
    set->outline  = calloc(DIG_FORCE_CHANNELS * points * MADE_TRAJECTORIES, sizeof *set->outline);
    set->cell     = calloc(points, sizeof *set->cell);
    for (size_t p = 0; p < points; p++) {
        const size_t density  = p % counts[2];
        const size_t rolling  = p / counts[2] % counts[1];
        const size_t friction = p / counts[2] / counts[1];
        set->cell[p]          = -1;
        if (options->hole && friction == 1 && rolling == 1 && density == 1) {
            continue;
        }
        const size_t e = set->entries++;
        set->cell[p]   = (int)e;
        set->gravel[e] =
            (struct dig_gravel){ { from[0][friction], from[1][rolling], from[2][density] } };
        for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
            set->packings[e * MADE_TRAJECTORIES + t] = options->packings;
            fill(&set->curve[e * MADE_TRAJECTORIES + t], &set->gravel[e], (enum made_trajectory)t,
                 options);
        }
    }
    dig_outlines_draw(set);
    return set;
}

void made_table_destroy(struct dig_curve_set *const set)
{
    if (set == NULL) {
        return;
    }
    for (int a = 0; a < DIG_AXES; a++) {
        free(set->axis[a]);
    }
    free(set->gravel);
    free(set->packings);
    free(set->curve);
    free(set->outline);
    free(set->cell);
    free(set);
}

struct dig_observation made_observation(const struct dig_gravel *const gravel,
                                        const enum made_trajectory which, const double family)
{
    struct dig_observation o = {
        .dig_count = 1, .trajectory = (int)which, .first = 0.0, .last = 1.0
    };
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        o.moment_Nm[k] = made_moment_Nm(gravel, which, (double)k / (DIG_CURVE_POINTS - 1), family);
    }
    return o;
}

void made_disturb(struct dig_observation *const observation, const double relative_sd,
                  uint64_t *const seed)
{
    const struct dig_trajectory t = made_trajectory((enum made_trajectory)observation->trajectory);
    const double whole_m          = dig_trajectory_path_m(&t, 0.09, dig_trajectory_duration_s(&t));

    // A running sum of white noise over the correlation's width: a triangular autocorrelation.
    enum { LONG = 2 * DIG_CURVE_POINTS };
    double       white[LONG];
    const size_t width = (size_t)(0.25 * 0.09 / whole_m * (DIG_CURVE_POINTS - 1));
    for (size_t i = 0; i < LONG; i++) {
        white[i] = model_normal(seed);
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        double sum = 0.0;
        for (size_t i = 0; i < width; i++) {
            sum += white[k + i];
        }
        observation->moment_Nm[k] *= 1.0 + relative_sd * sum / sqrt((double)width);
    }
}

bool made_observed(struct dig_estimator *const estimator, const struct dig_curve_set *const set,
                   struct dig_observation *const seen)
{
    const struct dig_estimator_settings settings  = dig_estimator_settings_default();
    struct dig_recorded_dig *const      recording = dig_estimator_take_recording(estimator);
    if (recording == NULL) {
        return false;
    }
    const bool any = dig_recorded_dig_observe(set, &settings, recording, seen) == DIG_OK;
    dig_estimator_lend(estimator, recording);
    return any;
}
