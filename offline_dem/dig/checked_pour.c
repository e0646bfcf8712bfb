#include "offline_dem/dig/checked_pour.h"

#include "offline_dem/dig/input_checks.h"
#include "offline_dem/dig/setup.h"

#include <assert.h>
#include <math.h>

#define SAMPLE_STEPS 5    // odd: samples both phases of a flip-flop
#define REST_ENERGY  1e-3 // largest kinetic energy of a grain at rest, m g r (docs/numerics/dem.md)
#define CHECK_s      0.1  // a bed poured at this step has drifted already
#define CHECK_FILE_s 0.3  // a bed poured at a shorter one begins at rest

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

// The step derived for these grains, whatever the scene asks for.
static double derived_s(const struct dig_scene *const scene, const struct dig_gravel *const gravel,
                        const struct dig_grain_types *const types)
{
    struct dig_scene free_scene = *scene;
    free_scene.time_step_s      = 0.0;
    return dig_grain_types_time_step_s(&free_scene, gravel, types);
}

static enum dig_status check_bed(const struct dig_scene *const  scene,
                                 const struct dig_gravel *const gravel,
                                 const struct dig_bed *const bed, const double check_s,
                                 struct dig_error *const error)
{
    struct dig_grain_types types;
    struct dig_world       world;
    enum dig_status        status = dig_setup_world(scene, gravel, bed, 0.0, &types, &world, error);
    if (status != DIG_OK) {
        return status;
    }
    const double safe_s = derived_s(scene, gravel, &types);
    const double step_s = world.dt_s;
    bool         drifts = false;
    status              = dig_input_checks_outside(&world, error);
    status              = status == DIG_OK ? dig_input_checks_overlap(&world, error) : status;
    if (status == DIG_OK && step_s > safe_s && !scene->may_tremble) {
        status = dig_energy_drift_detect(&world, (size_t)(check_s / step_s), &drifts);
        status = status == DIG_OK ? status : dig_setup_explain(status, error);
    }
    dig_setup_finish(&world);
    if (status != DIG_OK) {
        return status;
    }
    return drifts
               ? dig_error_set(error, DIG_EINVAL,
                               "time_step_s: %g keeps a resting bed moving, expected at most %.3g "
                               "(or may_tremble: true)",
                               step_s, safe_s)
               : DIG_OK;
}

enum dig_status dig_bed_check(const struct dig_scene *const  scene,
                              const struct dig_gravel *const gravel,
                              const struct dig_bed *const bed, struct dig_error *const error)
{
    assert(scene != NULL && gravel != NULL && bed != NULL);
    const enum dig_status status = dig_setup_check(scene, gravel, error);
    return status == DIG_OK ? check_bed(scene, gravel, bed, CHECK_FILE_s, error) : status;
}

enum dig_status dig_bed_pour_checked(const struct dig_stepper *const stepper,
                                     const struct dig_scene *const   scene,
                                     const struct dig_gravel *const gravel, const uint64_t seed,
                                     const struct dig_progress *const progress,
                                     struct dig_bed *const bed, struct dig_error *const error)
{
    assert(scene != NULL && gravel != NULL && bed != NULL);
    struct dig_bed  poured = { 0 };
    enum dig_status status = dig_bed_pour(stepper, scene, gravel, seed, progress, &poured, error);
    if (status == DIG_OK && scene->time_step_s > 0.0 && !scene->may_tremble) {
        status = check_bed(scene, gravel, &poured, CHECK_s, error);
    }
    if (status != DIG_OK) {
        dig_bed_finish(&poured);
        return status;
    }
    *bed = poured;
    return DIG_OK;
}
