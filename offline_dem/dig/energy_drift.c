#include "offline_dem/dig/energy_drift.h"

#include <math.h>

#define SAMPLE_STEPS 5    // odd: samples both phases of a flip-flop
#define REST_ENERGY  1e-3 // largest kinetic energy of a grain at rest, m g r (docs/numerics/dem.md)

// Weight times radius, over all grains.
static double scale_J(const struct dig_world *const world)
{
    const double *const g      = world->gravity_mps2;
    const double        g_mps2 = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    double              sum_J  = 0.0;
    for (size_t i = 0; i < world->grains.n; i++) {
        const struct dig_grain_type *const type = &world->grains.type[world->grains.type_of[i]];
        sum_J += g_mps2 * type->mass_kg * type->radius_m;
    }
    return sum_J;
}

// Mean kinetic energy over so many steps.
static enum dig_status mean_kinetic(struct dig_world *const world, const size_t steps,
                                    double *const mean_J)
{
    double sum_J   = 0.0;
    size_t samples = 0;
    for (size_t s = 0; s < steps; s++) {
        enum dig_status status = dig_world_step(world);
        status = status == DIG_OK && s % SAMPLE_STEPS == 0 ? dig_world_sync_motion(world) : status;
        if (status != DIG_OK) {
            return status;
        }
        if (s % SAMPLE_STEPS == 0) {
            sum_J += dig_grains_kinetic_J(&world->grains);
            samples++;
        }
    }
    *mean_J = samples > 0 ? sum_J / (double)samples : 0.0;
    return DIG_OK;
}

enum dig_status dig_energy_drift_detect(struct dig_world *const world, const size_t steps,
                                        bool *const drifts)
{
    double          mean_J = 0.0;
    enum dig_status status = mean_kinetic(world, steps - steps / 3, &mean_J);
    if (status == DIG_OK) {
        status = mean_kinetic(world, steps / 3, &mean_J);
    }
    if (status != DIG_OK) {
        return status;
    }
    const double most_J = REST_ENERGY * scale_J(world);
    *drifts             = most_J > 0.0 && mean_J > most_J;
    return DIG_OK;
}
