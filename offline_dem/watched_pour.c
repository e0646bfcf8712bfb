#include "offline_dem/watched_pour.h"

#include "offline_dem/heating.h"
#include "offline_dem/setup.h"

#include <assert.h>

#define WATCH_s 0.1

// The step that would be derived, were none asked for.
static double derived_s(const struct dig_scene *const scene, const struct dig_gravel *const gravel,
                        const struct dig_kinds *const kinds)
{
    struct dig_scene free_scene = *scene;
    free_scene.time_step_s      = 0.0;
    return dig_kinds_time_step_s(&free_scene, gravel, kinds);
}

static enum dig_status watch(const struct dig_scene *const  scene,
                             const struct dig_gravel *const gravel, struct dig_ode_scene *const ode,
                             const struct dig_bed *const bed, struct dig_error *const error)
{
    struct dig_kinds kinds;
    struct dig_world world;
    enum dig_status  status = dig_setup_world(scene, gravel, ode, bed, 0.0, &kinds, &world, error);
    if (status != DIG_OK) {
        return status;
    }
    const double safe_s = derived_s(scene, gravel, &kinds);
    bool         heats  = false;
    if (world.dt_s > safe_s) {
        status = dig_heating_watch(&world, (size_t)(WATCH_s / world.dt_s), &heats);
    }
    const double step_s = world.dt_s;
    dig_setup_finish(&world);
    if (status != DIG_OK) {
        return dig_setup_explain(status, error);
    }
    return heats
               ? dig_error_set(error, DIG_EINVAL,
                               "time_step_s: %g keeps a resting bed moving, expected at most %.3g "
                               "(or may_tremble: true)",
                               step_s, safe_s)
               : DIG_OK;
}

enum dig_status dig_bed_pour_watched_on(struct dig_device *const       device,
                                        const struct dig_scene *const  scene,
                                        const struct dig_gravel *const gravel, const uint64_t seed,
                                        const struct dig_progress *const progress,
                                        struct dig_bed *const bed, struct dig_error *const error)
{
    assert(scene != NULL && gravel != NULL && bed != NULL);
    struct dig_bed  poured = { 0 };
    enum dig_status status = dig_bed_pour_on(device, scene, gravel, seed, progress, &poured, error);
    if (status == DIG_OK && scene->time_step_s > 0.0 && !scene->may_tremble) {
        struct dig_ode_scene *const ode = dig_ode_scene_create(scene);
        status                          = ode == NULL ? dig_setup_explain(DIG_ENOMEM, error)
                                                      : watch(scene, gravel, ode, &poured, error);
        dig_ode_scene_destroy(ode);
    }
    if (status != DIG_OK) {
        dig_bed_finish(&poured);
        return status;
    }
    *bed = poured;
    return DIG_OK;
}

enum dig_status dig_bed_pour_watched(const struct dig_scene *const  scene,
                                     const struct dig_gravel *const gravel, const uint64_t seed,
                                     const struct dig_progress *const progress,
                                     struct dig_bed *const bed, struct dig_error *const error)
{
    return dig_bed_pour_watched_on(NULL, scene, gravel, seed, progress, bed, error);
}
