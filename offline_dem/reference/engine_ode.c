#include "offline_dem/reference/engine_ode.h"

#include "offline_dem/dig/setup.h"
#include "offline_dem/reference/ode_bed.h"

#include <math.h>
#include <stdlib.h>

// One dig under way.
struct run {
    const struct dig_trajectory *trajectory;
    const struct dig_world      *world; // grains as they were at the start
    struct dig_ode_bed          *bed;
    struct dig_tool              tool;
};

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

// One step with the bucket on the trajectory at time_s.
static enum dig_status step(struct run *const d, const double time_s,
                            struct dig_wrench *const on_tool)
{
    dig_setup_place_tool(d->trajectory, time_s, d->world, &d->tool);
    return dig_ode_bed_step(d->bed, &d->tool, on_tool);
}

static double carried_kg(const struct run *const d)
{
    const struct dig_grains *const grains = &d->world->grains;
    double                         sum_kg = 0.0;
    for (size_t i = 0; i < grains->n; i++) {
        const struct dig_motion motion = dig_ode_bed_motion(d->bed, i);
        if (dig_tool_contains(&d->tool, motion.x_m)) {
            sum_kg += grains->type[grains->type_of[i]].mass_kg;
        }
    }
    return sum_kg;
}

// Means over the steps first + 1 … first + window.
static enum dig_status record_window(struct run *const d, const size_t first, const size_t window,
                                     struct dig_force_row *const row)
{
    const double      dt_s = d->world->dt_s;
    struct dig_wrench sum  = { 0 };
    for (size_t s = 1; s <= window; s++) {
        struct dig_wrench     on_tool;
        const enum dig_status status = step(d, (double)(first + s) * dt_s, &on_tool);
        if (status != DIG_OK) {
            return status;
        }
        for (int k = 0; k < 3; k++) {
            sum.f_N[k] += on_tool.f_N[k] / (double)window;
            sum.t_Nm[k] += on_tool.t_Nm[k] / (double)window;
        }
    }
    *row = dig_setup_force_row(d->trajectory, first, window, dt_s, &sum, carried_kg(d));
    return DIG_OK;
}

static enum dig_status record(struct run *const d, const double output_s,
                              const struct dig_progress *const progress,
                              struct dig_recording *const      recording)
{
    const double duration_s = dig_trajectory_duration_s(d->trajectory);
    const double steps      = duration_s / d->world->dt_s;
    const size_t window     = (size_t)fmax(1.0, round(output_s / d->world->dt_s));
    const size_t rows       = (size_t)floor(steps / (double)window + 1e-6);
    recording->row          = calloc(rows + 1, sizeof *recording->row);
    if (recording->row == NULL) {
        return DIG_ENOMEM;
    }
    // The forces before the first step belong to no row: they give the half kick.
    struct dig_wrench on_tool;
    enum dig_status   status = step(d, 0.0, &on_tool);
    for (size_t r = 0; r < rows && status == DIG_OK; r++) {
        status = record_window(d, r * window, window, &recording->row[r]);
        if (status == DIG_OK && progress != NULL &&
            !progress->report(progress->context, recording->row[r].t_s, duration_s)) {
            status = DIG_ESTALE;
        }
    }
    recording->rows = rows;
    return status;
}

static enum dig_status dig(const struct dig_stepper *const none,
                           const struct dig_scene *const   scene,
                           const struct dig_gravel *const gravel, const struct dig_bed *const bed,
                           const struct dig_trajectory *const trajectory, const char *const vtk_dir,
                           const struct dig_progress *const progress,
                           struct dig_recording *const recording, struct dig_error *const error)
{
    (void)none; // ODE steps the grains
    enum dig_status status = dig_setup_check(scene, gravel, error);
    status                 = status == DIG_OK ? check(scene, vtk_dir, error) : status;
    status                 = status == DIG_OK ? dig_setup_check_phases(trajectory, error) : status;
    if (status != DIG_OK) {
        return status;
    }
    struct dig_world     world;
    struct dig_recording made = { 0 };
    status                    = dig_setup_world(scene, gravel, bed, 0.0, NULL, &world, error);
    if (status == DIG_OK) {
        struct run d = {
            .trajectory = trajectory,
            .world      = &world,
            .bed        = dig_ode_bed_create(&world),
            .tool       = dig_tool_make(&scene->bucket),
        };
        status = d.bed == NULL ? DIG_ENOMEM : record(&d, scene->output_s, progress, &made);
        status = status == DIG_OK ? status : dig_setup_explain(status, error);
        dig_ode_bed_destroy(d.bed);
        dig_setup_finish(&world);
    }
    if (status != DIG_OK) {
        dig_recording_finish(&made);
        return status;
    }
    *recording = made;
    return DIG_OK;
}

struct dig_engine dig_engine_ode(void)
{
    struct dig_engine engine = dig_engine_kernel();
    engine.name              = "ode";
    engine.dig               = dig;
    return engine;
}
