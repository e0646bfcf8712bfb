#include "offline_dem/reference/engine_ode.h"

#include "offline_dem/reference/ode_bed.h"

static enum dig_status reject(struct dig_error *const error, const char *const key)
{
    return dig_error_set(error, DIG_EINVAL, "%s: expected none with the ode engine", key);
}

static enum dig_status check(const struct dig_scene *const scene, const char *const vtk_dir,
                             struct dig_error *const error)
{
    const struct dig_bed_plan *const bed = &scene->bed;
    if (bed->clump.spheres > 0) {
        return reject(error, "clump");
    }
    if (bed->periodic_y) {
        return reject(error, "periodic_y");
    }
    if (bed->earlier_digs > 0) {
        return reject(error, "earlier_digs");
    }
    return vtk_dir != NULL ? reject(error, "pictures") : DIG_OK;
}

static enum dig_status take_over(struct dig_world *const world, struct dig_error *const error)
{
    (void)error;
    return dig_ode_bed_take_over(world);
}

static enum dig_status dig(const struct dig_stepper *const none,
                           const struct dig_scene *const   scene,
                           const struct dig_gravel *const gravel, const struct dig_bed *const bed,
                           const struct dig_trajectory *const trajectory, const char *const vtk_dir,
                           const struct dig_progress *const progress,
                           struct dig_recording *const recording, struct dig_error *const error)
{
    (void)none; // ODE steps the grains
    const struct dig_stepper stepper = { .take_over = take_over };
    const enum dig_status    status  = check(scene, vtk_dir, error);
    return status == DIG_OK ? dig_dig_run(&stepper, scene, gravel, bed, trajectory, NULL, progress,
                                          recording, error)
                            : status;
}

struct dig_engine dig_engine_ode(void)
{
    struct dig_engine engine = dig_engine_kernel();
    engine.name              = "ode";
    engine.dig               = dig;
    return engine;
}
