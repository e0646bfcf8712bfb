#include "offline_dem/dig/dig.h"

#include "core/units.h"
#include "offline_dem/dig/input_checks.h"
#include "offline_dem/dig/level.h"
#include "offline_dem/dig/setup.h"
#include "offline_dem/dig/vtk.h"
#include "offline_dem/world/bodies.h"
#include "offline_dem/world/ode_scene.h"

#include <math.h>
#include <stdlib.h>

// Rows of a curve between two pictures.
#define PICTURE_WINDOWS 20
// Steps between two progress reports of a dig that is not recorded.
#define PROGRESS_STEPS 640

// One dig under way.
struct run {
    const struct dig_scene      *scene;
    const struct dig_trajectory *trajectory;
    const char                  *vtk_dir;
    const struct dig_progress   *progress;
    struct dig_world             world;
    struct dig_tool              tool;
};

// Moves ODE's bucket along the trajectory to time_s, and reads the tool from there. The velocity is
// that of the phase that ends at or after time_s.
static void place_tool(struct run *const d, const double time_s)
{
    const size_t at = dig_trajectory_phase(d->trajectory, time_s - 0.5 * d->world.dt_s);
    const struct dig_phase *const phase = &d->trajectory->phase[at];
    dig_ode_scene_move(d->world.ode, dig_trajectory_pose(d->trajectory, time_s), phase->vx_mps,
                       phase->vz_mps, phase->omega_radps);
    dig_ode_scene_read(d->world.ode, &d->tool);
}

// Mass of the grains in the bucket. Motions must be synchronised.
static double carried_kg(const struct run *const d)
{
    const struct dig_grains *const grains = &d->world.grains;
    double                         sum_kg = 0.0;
    for (size_t i = 0; i < grains->n; i++) {
        if (dig_tool_contains(&d->tool, grains->motion[i].x_m)) {
            sum_kg += grains->type[grains->type_of[i]].mass_kg;
        }
    }
    return sum_kg;
}

// Means over the steps first + 1 … first + window. The wrench before them has been taken.
static enum dig_status record_window(struct run *const d, const size_t first, const size_t window,
                                     struct dig_force_row *const row)
{
    const double      dt_s   = d->world.dt_s;
    struct dig_wrench sum    = { 0 };
    enum dig_status   status = DIG_OK;
    for (size_t s = 1; s <= window && status == DIG_OK; s++) {
        place_tool(d, (double)(first + s) * dt_s);
        status = dig_world_step(&d->world);
    }
    status = status == DIG_OK ? dig_world_take_wrench(&d->world, &sum) : status;
    if (status != DIG_OK) {
        return status;
    }
    const double          share = 1.0 / (double)window;
    const double          t_s   = ((double)first + 0.5 * (double)(window + 1)) * dt_s;
    const struct dig_pose pose  = dig_trajectory_pose(d->trajectory, t_s);

    *row = (struct dig_force_row){
        .t_s        = t_s,
        .pin_x_m    = pose.x_m,
        .pin_z_m    = pose.z_m,
        .theta_deg  = pose.theta_rad / DIG_RAD_PER_DEG,
        .Fx_N       = share * sum.f_N[0],
        .Fy_N       = share * sum.f_N[1],
        .Fz_N       = share * sum.f_N[2],
        .Mx_Nm      = share * sum.t_Nm[0],
        .My_Nm      = share * sum.t_Nm[1],
        .Mz_Nm      = share * sum.t_Nm[2],
        .carried_kg = carried_kg(d),
    };
    return DIG_OK;
}

static enum dig_status run(struct run *const d, struct dig_recording *const recording)
{
    const double dt_s       = d->world.dt_s;
    const double duration_s = dig_trajectory_duration_s(d->trajectory);
    const size_t window     = (size_t)fmax(1.0, round(d->scene->output_s / dt_s));
    const size_t rows       = (size_t)floor(duration_s / dt_s / (double)window + 1e-6);
    recording->row          = calloc(rows + 1, sizeof *recording->row);
    if (recording->row == NULL) {
        return DIG_ENOMEM;
    }
    // The forces before the first step belong to no row: they give the half kick.
    place_tool(d, 0.0);
    enum dig_status   status = dig_world_step(&d->world);
    struct dig_wrench before;
    status = status == DIG_OK ? dig_world_take_wrench(&d->world, &before) : status;
    for (size_t r = 0; r < rows && status == DIG_OK; r++) {
        if (d->vtk_dir != NULL && r % PICTURE_WINDOWS == 0) {
            status = dig_world_sync_motion(&d->world);
        }
        if (status == DIG_OK && d->vtk_dir != NULL && r % PICTURE_WINDOWS == 0) {
            status = dig_vtk_write(d->vtk_dir, r / PICTURE_WINDOWS, &d->world, &d->tool);
        }
        if (status == DIG_OK) {
            status = record_window(d, r * window, window, &recording->row[r]);
        }
        if (status == DIG_OK && d->progress != NULL &&
            !d->progress->report(d->progress->context, recording->row[r].t_s, duration_s)) {
            status = DIG_ESTALE;
        }
    }
    recording->rows = rows;
    if (status == DIG_OK && d->vtk_dir != NULL && rows > 0) {
        status = dig_vtk_index(d->vtk_dir, (rows - 1) / PICTURE_WINDOWS + 1,
                               PICTURE_WINDOWS * (double)window * dt_s,
                               d->world.bodies != NULL && d->world.bodies->obstacles.rocks > 0);
    }
    return status;
}

// Steps without a tool until the grains that fell or were raked are at rest.
static enum dig_status settle(struct run *const d)
{
    d->world.tool = NULL;
    dig_world_mark_stale(&d->world);
    const size_t    steps  = (size_t)llround(d->scene->packing.settle_s / d->world.dt_s);
    enum dig_status status = DIG_OK;
    for (size_t s = 0; s < steps && status == DIG_OK; s++) {
        status = dig_world_step(&d->world);
    }
    return status;
}

static enum dig_status run_unrecorded(struct run *const d)
{
    const double duration_s = dig_trajectory_duration_s(d->trajectory);
    const size_t steps      = (size_t)floor(duration_s / d->world.dt_s);
    d->world.tool           = &d->tool;
    dig_world_mark_stale(&d->world);
    enum dig_status status = DIG_OK;
    for (size_t s = 0; s <= steps && status == DIG_OK; s++) {
        place_tool(d, (double)s * d->world.dt_s);
        status = dig_world_step(&d->world);
        if (status == DIG_OK && d->progress != NULL && s % PROGRESS_STEPS == 0 &&
            !d->progress->report(d->progress->context, 0.0, duration_s)) {
            status = DIG_ESTALE;
        }
    }
    return status;
}

// The earlier digs in this bed. The bucket is removed where it ends, and its load falls. Then the
// ground is raked level, unless the scene leaves it as dug.
static enum dig_status run_earlier_digs(struct run *const d)
{
    const struct dig_bed_plan *const   bed    = &d->scene->bed;
    const struct dig_trajectory *const own    = d->trajectory;
    enum dig_status                    status = DIG_OK;
    if (bed->earlier[0] != '\0') {
        d->trajectory = dig_scene_find(d->scene, bed->earlier);
    }
    for (size_t i = 0; i < bed->earlier_digs && status == DIG_OK; i++) {
        status = run_unrecorded(d);
        if (status == DIG_OK) {
            status = settle(d);
        }
        if (status == DIG_OK && !bed->earlier_as_dug) {
            status = dig_level_rake(d->scene, &d->world);
            status = status == DIG_OK ? settle(d) : status;
            status = status == DIG_OK ? dig_level_cut(d->scene, &d->world) : status;
        }
    }
    d->trajectory = own;
    return status;
}

static enum dig_status run_all(struct run *const d, struct dig_recording *const recording,
                               struct dig_error *const error)
{
    enum dig_status status = run_earlier_digs(d);
    if (status == DIG_OK) {
        d->world.tool = &d->tool;
        dig_world_mark_stale(&d->world);
        status = run(d, recording);
    }
    return status == DIG_OK ? status : dig_setup_explain(status, error);
}

enum dig_status dig_dig_run(const struct dig_stepper *const stepper,
                            const struct dig_scene *const   scene,
                            const struct dig_gravel *const gravel, const struct dig_bed *const bed,
                            const struct dig_trajectory *const trajectory,
                            const char *const vtk_dir, const struct dig_progress *const progress,
                            struct dig_recording *const recording, struct dig_error *const error)
{
    enum dig_status status = dig_setup_check(scene, gravel, error);
    if (status != DIG_OK) {
        return status;
    }
    if (trajectory->phases == 0 || trajectory->phases > DIG_PHASES_MAX) {
        return dig_error_set(error, DIG_EINVAL, "trajectory: %zu phases, expected 1 to %d",
                             trajectory->phases, DIG_PHASES_MAX);
    }
    status = dig_input_checks_path(scene, trajectory, error);
    if (status != DIG_OK) {
        return status;
    }
    struct run d = {
        .scene      = scene,
        .trajectory = trajectory,
        .vtk_dir    = vtk_dir,
        .progress   = progress,
        .tool       = dig_tool_make(&scene->bucket),
    };
    struct dig_recording made = { 0 };
    status                    = dig_setup_world(scene, gravel, bed, 0.0, NULL, &d.world, error);
    if (status == DIG_OK) {
        place_tool(&d, 0.0);
        status = dig_input_checks_outside(&d.world, error);
        status = status == DIG_OK ? dig_input_checks_overlap(&d.world, error) : status;
        status = status == DIG_OK ? dig_input_checks_start(&d.world, &d.tool, error) : status;
        if (status == DIG_OK && stepper != NULL) {
            status = dig_setup_stepper(stepper, &d.world, error);
        }
        status = status == DIG_OK ? run_all(&d, &made, error) : status;
        dig_setup_finish(&d.world);
    }
    if (status != DIG_OK) {
        dig_recording_finish(&made);
        return status;
    }
    *recording = made;
    return DIG_OK;
}
