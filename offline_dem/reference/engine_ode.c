#include "offline_dem/reference/engine_ode.h"

#include "offline_dem/reference/ode_bed.h"

#include <assert.h>

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

static enum dig_status step(struct dig_world *const w)
{
    struct dig_wrench     on_tool = { 0 };
    const enum dig_status status  = dig_ode_bed_step(w->stand_in_own, w->tool, &on_tool);
    dig_wrench_add(&on_tool, &w->sum_tool);
    w->steps++;
    return status;
}

// Nobody writes motions: nothing is dug before, and no grain is taken away.
static enum dig_status sync(struct dig_world *const w, const bool all)
{
    assert(!all);
    for (size_t i = 0; i < w->grains.n; i++) {
        w->grains.motion[i] = dig_ode_bed_motion(w->stand_in_own, i);
    }
    return DIG_OK;
}

static void destroy(struct dig_world *const w)
{
    dig_ode_bed_destroy(w->stand_in_own);
}

static enum dig_status take_over(struct dig_world *const w, struct dig_error *const error)
{
    (void)error;
    static const struct dig_stand_in stand_in = { step, sync, destroy };
    w->stand_in_own                           = dig_ode_bed_create(w);
    w->stand_in                               = w->stand_in_own != NULL ? &stand_in : NULL;
    return w->stand_in != NULL ? DIG_OK : DIG_ENOMEM;
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
