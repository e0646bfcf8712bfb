#include "offline_dem/dig.h"

#include "core/units.h"
#include "offline_dem/packing.h"
#include "offline_dem/world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Steps between two calls of the progress function.
#define TELL_STEPS 400

static enum dig_status check(const struct dig_scene *const  scene,
                             const struct dig_gravel *const gravel, struct dig_error *const error)
{
    const enum dig_status status = dig_scene_check(scene, error);
    if (status != DIG_OK) {
        return status;
    }
    for (int a = 0; a < DIG_AXES; a++) {
        const double value = gravel->value[a];
        if (!isfinite(value) || value < 0.0 || (a == DIG_AXIS_DENSITY_kgpm3 && !(value > 0.0))) {
            return dig_error_set(error, DIG_EINVAL, "%s: %g, expected %s",
                                 dig_axis_name((enum dig_axis)a), value,
                                 a == DIG_AXIS_DENSITY_kgpm3 ? "> 0" : ">= 0");
        }
    }
    return DIG_OK;
}

static struct dig_law_material law_material(const struct dig_scene *const  scene,
                                            const struct dig_gravel *const gravel)
{
    return (struct dig_law_material){
        .young_Pa                    = scene->material.young_Pa,
        .poisson                     = scene->material.poisson,
        .restitution                 = scene->material.restitution,
        .characteristic_velocity_mps = scene->material.characteristic_velocity_mps,
        .friction                    = gravel->value[DIG_AXIS_FRICTION],
        .rolling                     = gravel->value[DIG_AXIS_ROLLING],
    };
}

double dig_time_step_s(const struct dig_scene *const scene, const double density_kgpm3)
{
    if (scene->time_step_s > 0.0) {
        return scene->time_step_s;
    }
    const struct dig_material *const m       = &scene->material;
    const double                     r_m     = 0.5 * m->diameter_m;
    const double                     mass_kg = density_kgpm3 * 4.0 / 3.0 * DIG_PI * r_m * r_m * r_m;
    // Rayleigh wave over half a circumference, and half a period of the contact of two grains.
    const double shear_Pa = m->young_Pa / (2.0 * (1.0 + m->poisson));
    const double rayleigh_s =
        DIG_PI * r_m * sqrt(density_kgpm3 / shear_Pa) / (0.1631 * m->poisson + 0.8766);
    const struct dig_law_material material = {
        .young_Pa                    = m->young_Pa,
        .poisson                     = m->poisson,
        .restitution                 = m->restitution,
        .characteristic_velocity_mps = m->characteristic_velocity_mps,
    };
    const struct dig_law law       = dig_law_pair(&material, r_m, r_m, mass_kg, mass_kg);
    const double         contact_s = DIG_PI * sqrt(0.5 * mass_kg / law.normal_Npm);
    return fmin(0.14 * rayleigh_s, contact_s / 25.0);
}

static void set_walls(const struct dig_box *const box, struct dig_world *const world)
{
    world->walls   = 5;
    world->wall[0] = (struct dig_wall){ { 1.0, 0.0, 0.0 }, box->x_min_m };
    world->wall[1] = (struct dig_wall){ { -1.0, 0.0, 0.0 }, -box->x_max_m };
    world->wall[2] = (struct dig_wall){ { 0.0, 1.0, 0.0 }, box->y_min_m };
    world->wall[3] = (struct dig_wall){ { 0.0, -1.0, 0.0 }, -box->y_max_m };
    world->wall[4] = (struct dig_wall){ { 0.0, 0.0, 1.0 }, box->z_min_m };
}

static struct dig_world make_world(const struct dig_scene *const  scene,
                                   const struct dig_gravel *const gravel,
                                   struct dig_grains *const       grains)
{
    struct dig_world world = {
        .dt_s         = dig_time_step_s(scene, gravel->value[DIG_AXIS_DENSITY_kgpm3]),
        .gravity_mps2 = { 0.0, 0.0, -scene->gravity_mps2 },
        .material     = law_material(scene, gravel),
        .isa          = dig_kernel_best(),
    };
    set_walls(&scene->box, &world);
    dig_world_init(&world, grains);
    return world;
}

static enum dig_status go(struct dig_world *const world, const double duration_s,
                          const double done_s, const double total_s,
                          const struct dig_progress *const progress)
{
    const size_t steps = (size_t)llround(duration_s / world->dt_s);
    for (size_t s = 0; s < steps; s++) {
        const enum dig_status status = dig_world_step(world);
        if (status != DIG_OK) {
            return status;
        }
        if (progress != NULL && s % TELL_STEPS == 0 &&
            !progress->tell(progress->context, done_s + (double)s * world->dt_s, total_s)) {
            return DIG_ESTALE;
        }
    }
    return DIG_OK;
}

static enum dig_status level(struct dig_world *const world, const double z_max_m)
{
    unsigned char *const drop = calloc(world->grains.n + 1, 1);
    if (drop == NULL) {
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < world->grains.n; i++) {
        const double radius_m = world->grains.kind[world->grains.of[i]].radius_m;
        drop[i]               = world->grains.motion[i].x_m[2] > z_max_m - radius_m;
    }
    const enum dig_status status = dig_world_drop(world, drop);
    free(drop);
    return status;
}

static enum dig_status copy_bed(const struct dig_grains *const grains, struct dig_bed *const bed)
{
    const size_t   n    = grains->n;
    struct dig_bed made = {
        .grains   = n,
        .x_m      = malloc((n + 1) * sizeof(double)),
        .y_m      = malloc((n + 1) * sizeof(double)),
        .z_m      = malloc((n + 1) * sizeof(double)),
        .radius_m = malloc((n + 1) * sizeof(double)),
    };
    if (made.x_m == NULL || made.y_m == NULL || made.z_m == NULL || made.radius_m == NULL) {
        dig_bed_finish(&made);
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        made.x_m[i]      = grains->motion[i].x_m[0];
        made.y_m[i]      = grains->motion[i].x_m[1];
        made.z_m[i]      = grains->motion[i].x_m[2];
        made.radius_m[i] = grains->kind[grains->of[i]].radius_m;
    }
    *bed = made;
    return DIG_OK;
}

static enum dig_status insert(const struct dig_scene *const scene, const double density_kgpm3,
                              const uint64_t seed, struct dig_grains *const grains)
{
    const size_t  n    = dig_packing_grains(scene);
    double *const work = malloc((4 * n + 1) * sizeof *work);
    if (work == NULL) {
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        work[3 * n + i] = 0.5 * scene->material.diameter_m;
    }
    enum dig_status status = dig_packing_insert(scene, seed, n, work, work + n, work + 2 * n);
    if (status == DIG_OK) {
        status =
            dig_grains_create(n, work, work + n, work + 2 * n, work + 3 * n, density_kgpm3, grains);
    }
    free(work);
    for (size_t i = 0; status == DIG_OK && i < n; i++) {
        grains->motion[i].v_mps[2] = -scene->packing.fall_mps;
    }
    return status;
}

static enum dig_status explain(struct dig_error *const error, const enum dig_status status)
{
    switch (status) {
    case DIG_EINVAL:
        return dig_error_set(
            error, status,
            "time_step_s: the grains' positions grew beyond all bounds, expected a "
            "shorter step");
    case DIG_EUNREACHABLE:
        return dig_error_set(error, status,
                             "packing.solid_fraction: the grains do not fit, expected less");
    case DIG_OK:
    case DIG_ENOMATCH:
    case DIG_ESTALE:
    case DIG_ESCHEMA:
    case DIG_ENOMEM:
    case DIG_EIO: break;
    }
    return dig_error_set(error, status, "%s", dig_status_str(status));
}

enum dig_status dig_bed_pour(const struct dig_scene *const  scene,
                             const struct dig_gravel *const gravel, const uint64_t seed,
                             const struct dig_progress *const progress, struct dig_bed *const bed,
                             struct dig_error *const error)
{
    enum dig_status status = check(scene, gravel, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_grains grains;
    status = insert(scene, gravel->value[DIG_AXIS_DENSITY_kgpm3], seed, &grains);
    if (status != DIG_OK) {
        return explain(error, status);
    }
    struct dig_world world   = make_world(scene, gravel, &grains);
    const double     total_s = scene->packing.settle_s + scene->packing.relax_s;
    status                   = go(&world, scene->packing.settle_s, 0.0, total_s, progress);
    if (status == DIG_OK) {
        status = level(&world, scene->box.z_max_m);
    }
    if (status == DIG_OK) {
        status = go(&world, scene->packing.relax_s, scene->packing.settle_s, total_s, progress);
    }
    if (status == DIG_OK) {
        status = copy_bed(&world.grains, bed);
    }
    dig_world_finish(&world);
    return status == DIG_OK ? status : explain(error, status);
}

void dig_bed_finish(struct dig_bed *const bed)
{
    if (bed == NULL) {
        return;
    }
    free(bed->x_m);
    free(bed->y_m);
    free(bed->z_m);
    free(bed->radius_m);
    *bed = (struct dig_bed){ 0 };
}

// Where the trajectory has the tool, and how fast: rates of the phase that ends at or after time_s.
static void place_tool(const struct dig_trajectory *const trajectory, const double time_s,
                       const double dt_s, struct dig_tool *const tool)
{
    const struct dig_pose         pose  = dig_trajectory_pose(trajectory, time_s);
    const size_t                  p     = dig_trajectory_phase(trajectory, time_s - 0.5 * dt_s);
    const struct dig_phase *const phase = &trajectory->phase[p];
    dig_tool_place(tool, pose, phase->vx_mps, phase->vz_mps, phase->omega_radps);
}

static enum dig_status drive(const struct dig_scene *const      scene,
                             const struct dig_trajectory *const trajectory,
                             const struct dig_progress *const   progress,
                             struct dig_world *const world, struct dig_tool *const tool,
                             struct dig_recording *const recording)
{
    const double dt_s       = world->dt_s;
    const double duration_s = dig_trajectory_duration_s(trajectory);
    const size_t window     = (size_t)fmax(1.0, round(scene->output_s / dt_s));
    const size_t rows       = (size_t)floor(duration_s / dt_s / (double)window + 1e-6);
    recording->row          = calloc(rows + 1, sizeof *recording->row);
    if (recording->row == NULL) {
        return DIG_ENOMEM;
    }
    // The forces before the first step belong to no window: they give the half kick.
    place_tool(trajectory, 0.0, dt_s, tool);
    dig_world_touched(world);
    enum dig_status status = dig_world_step(world);
    for (size_t r = 0; r < rows && status == DIG_OK; r++) {
        double sum[6] = { 0.0 };
        for (size_t s = 1; s <= window && status == DIG_OK; s++) {
            place_tool(trajectory, (double)(r * window + s) * dt_s, dt_s, tool);
            status = dig_world_step(world);
            for (int k = 0; k < 3; k++) {
                sum[k] += world->on_tool.f_N[k];
                sum[3 + k] += world->on_tool.t_Nm[k];
            }
        }
        const double          t_s   = ((double)(r * window) + 0.5 * (double)(window + 1)) * dt_s;
        const double          share = 1.0 / (double)window;
        const struct dig_pose pose  = dig_trajectory_pose(trajectory, t_s);
        recording->row[r]           = (struct dig_force_row){
                      .t_s       = t_s,
                      .pin_x_m   = pose.x_m,
                      .pin_z_m   = pose.z_m,
                      .theta_deg = pose.theta_rad / DIG_RAD_PER_DEG,
                      .Fx_N      = share * sum[0],
                      .Fy_N      = share * sum[1],
                      .Fz_N      = share * sum[2],
                      .Mx_Nm     = share * sum[3],
                      .My_Nm     = share * sum[4],
                      .Mz_Nm     = share * sum[5],
        };
        recording->rows = r + 1;
        if (status == DIG_OK && progress != NULL && r % 8 == 0 &&
            !progress->tell(progress->context, t_s, duration_s)) {
            status = DIG_ESTALE;
        }
    }
    return status;
}

enum dig_status dig_dig_run(const struct dig_scene *const  scene,
                            const struct dig_gravel *const gravel, const struct dig_bed *const bed,
                            const struct dig_trajectory *const trajectory,
                            const char *const vtk_dir, const struct dig_progress *const progress,
                            struct dig_recording *const recording, struct dig_error *const error)
{
    (void)vtk_dir;
    enum dig_status status = check(scene, gravel, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_grains grains;
    status = dig_grains_create(bed->grains, bed->x_m, bed->y_m, bed->z_m, bed->radius_m,
                               gravel->value[DIG_AXIS_DENSITY_kgpm3], &grains);
    if (status != DIG_OK) {
        return dig_error_set(error, status,
                             "bed: expected finite grains of at most %d different radii > 0",
                             DIG_KINDS_MAX);
    }
    struct dig_world     world = make_world(scene, gravel, &grains);
    struct dig_tool      tool  = dig_tool_make(&scene->bucket);
    struct dig_recording made  = { 0 };
    world.tool                 = &tool;
    status                     = drive(scene, trajectory, progress, &world, &tool, &made);
    dig_world_finish(&world);
    if (status != DIG_OK) {
        dig_recording_finish(&made);
        return explain(error, status);
    }
    *recording = made;
    return DIG_OK;
}
