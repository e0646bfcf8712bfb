#include "offline_dem/dig/variant.h"

#include "core/units.h"
#include "offline_dem/shapes/clump.h"

#include <math.h>
#include <string.h>

#define PATH_STEPS 1000 // points of the tooth's path

// How an effect changes a scene without it.
struct effect_change {
    enum dig_effect_id effect;
    const char        *unit;
    double             least, most;
    void (*apply)(double magnitude, struct dig_scene *scene);
};

static void set_cohesion(const double magnitude, struct dig_scene *const scene)
{
    scene->laws.cohesion_Jpm3 = magnitude;
    scene->laws.adhesion_Jpm3 = magnitude; // cohesive grains adhere to steel as well
}

static void set_adhesion(const double magnitude, struct dig_scene *const scene)
{
    scene->laws.adhesion_Jpm3 = magnitude;
}

static void set_bucket_smoothness(const double magnitude, struct dig_scene *const scene)
{
    scene->laws.bucket_smoothness = magnitude;
}

// 6, 7.5 and 10 mm at 5/3: the logarithms of both steps keep their ratio.
static void set_sizes(const double magnitude, struct dig_scene *const scene)
{
    const double down    = log(0.8) / log(5.0 / 3.0);
    const double d_m     = scene->material.diameter_m;
    const double small_m = d_m * pow(magnitude, down);
    scene->bed.sizes     = 3;
    scene->bed.size[0]   = (struct dig_size){ small_m, 0.3 };
    scene->bed.size[1]   = (struct dig_size){ d_m, 0.4 };
    scene->bed.size[2]   = (struct dig_size){ small_m * magnitude, 0.3 };
    scene->time_step_s *= small_m / d_m;
}

static void set_grain_shape(const double magnitude, struct dig_scene *const scene)
{
    scene->bed.clump = (struct dig_clump){ .spheres = 2,
                                           .x       = { 1.0 - magnitude, magnitude - 1.0 },
                                           .radius  = { 1.0, 1.0 } };
    struct dig_clump_shape shape;
    if (dig_clump_shape_make(&scene->bed.clump, &shape) == DIG_OK) {
        scene->time_step_s *= 2.0 * shape.radius[0];
    }
}

static void find_tooth(const struct dig_scene *const scene, const struct dig_trajectory *const t,
                       const double t_s, double *const x_m, double *const z_m)
{
    const struct dig_pose pose = dig_trajectory_pose(t, t_s);
    const double          c    = cos(pose.theta_rad);
    const double          s    = sin(pose.theta_rad);
    *x_m                       = pose.x_m + c * scene->bucket.x_m[0] - s * scene->bucket.z_m[0];
    *z_m                       = pose.z_m + s * scene->bucket.x_m[0] + c * scene->bucket.z_m[0];
}

static void set_slope(const double magnitude, struct dig_scene *const scene)
{
    const struct dig_box *const box  = &scene->box;
    const double                rise = tan(magnitude * DIG_RAD_PER_DEG);
    // Height of the plane at x = 0, below every tooth.
    double base_m = INFINITY;
    for (size_t i = 0; i < scene->trajectories; i++) {
        double x_m = 0.0;
        double z_m = 0.0;
        find_tooth(scene, &scene->trajectory[i], 0.0, &x_m, &z_m);
        base_m = fmin(base_m, fmin(z_m, box->z_max_m) - rise * x_m);
    }
    // The floor is bare where the plane comes within two grains of it.
    const double         least_m  = box->z_min_m + 2.0 * scene->material.diameter_m;
    const double         end_m[2] = { base_m + rise * box->x_min_m, base_m + rise * box->x_max_m };
    const double         bend_x_m = (least_m - base_m) / rise;
    const bool           bends    = bend_x_m > box->x_min_m && bend_x_m < box->x_max_m;
    struct dig_bed_plan *b        = &scene->bed;
    b->surface                    = 0;
    b->surface_x_m[b->surface]    = box->x_min_m;
    b->surface_z_m[b->surface++]  = fmax(end_m[0], least_m);
    if (bends) {
        b->surface_x_m[b->surface]   = bend_x_m;
        b->surface_z_m[b->surface++] = least_m;
    }
    b->surface_x_m[b->surface]   = box->x_max_m;
    b->surface_z_m[b->surface++] = fmax(end_m[1], least_m);
}

static void set_layer(const double magnitude, struct dig_scene *const scene)
{
    const struct dig_gravel of = dig_effect_layer_gravel(magnitude < 0.0);
    scene->bed.materials       = 1;
    scene->bed.material[0] =
        (struct dig_other_material){ .name          = "layer",
                                     .friction      = of.value[DIG_AXIS_FRICTION],
                                     .rolling       = of.value[DIG_AXIS_ROLLING],
                                     .density_kgpm3 = of.value[DIG_AXIS_DENSITY_kgpm3],
                                     .restitution   = scene->material.restitution };
    scene->bed.layers = 1;
    scene->bed.layer[0] =
        (struct dig_layer){ 1, scene->box.z_min_m, scene->box.z_min_m + fabs(magnitude) };
}

// At the middle of the tooth's path below the ground.
static void set_obstacle(const double magnitude, struct dig_scene *const scene)
{
    const struct dig_trajectory *const t          = &scene->trajectory[0];
    const double                       duration_s = dig_trajectory_duration_s(t);
    double                             low_m      = INFINITY;
    double                             high_m     = -INFINITY;
    for (int i = 0; i <= PATH_STEPS; i++) {
        double x_m = 0.0;
        double z_m = 0.0;
        find_tooth(scene, t, duration_s * i / PATH_STEPS, &x_m, &z_m);
        if (z_m <= scene->box.z_max_m) {
            low_m  = fmin(low_m, x_m);
            high_m = fmax(high_m, x_m);
        }
    }
    if (!(high_m >= low_m)) {
        low_m  = scene->box.x_min_m;
        high_m = scene->box.x_max_m;
    }
    scene->bed.obstacles   = 1;
    scene->bed.obstacle[0] = (struct dig_obstacle){
        .shape    = DIG_OBSTACLE_SPHERE,
        .centre_m = { 0.5 * (low_m + high_m), 0.5 * (scene->box.y_min_m + scene->box.y_max_m),
                      scene->box.z_max_m },
        .size_m   = { magnitude },
    };
}

static void set_earlier_digs(const double magnitude, struct dig_scene *const scene)
{
    scene->bed.earlier_digs = (size_t)llround(magnitude);
}

static const struct effect_change effect_change[] = {
    { DIG_EFFECT_COHESION, "J/m3", 1e-3, 1e8, set_cohesion },
    { DIG_EFFECT_ADHESION, "J/m3", 1e-3, 1e8, set_adhesion },
    { DIG_EFFECT_POLYDISPERSITY, "1", 1.01, 4.0, set_sizes },
    { DIG_EFFECT_GRAIN_SHAPE, "1", 1.01, 2.0, set_grain_shape },
    { DIG_EFFECT_GROUND_SLOPE, "deg", -30.0, 30.0, set_slope },
    { DIG_EFFECT_LAYERING, "m", -100.0, 100.0, set_layer },
    { DIG_EFFECT_OBSTACLE, "m", 1e-4, 100.0, set_obstacle },
    { DIG_EFFECT_COMPACTION, "digs", 1.0, DIG_EARLIER_MAX, set_earlier_digs },
    { DIG_EFFECT_BUCKET_FRICTION, "1", 1e-3, 1.0, set_bucket_smoothness },
};

static const struct effect_change *find_effect(const enum dig_effect_id effect)
{
    for (size_t i = 0; i < sizeof effect_change / sizeof effect_change[0]; i++) {
        if (effect_change[i].effect == effect) {
            return &effect_change[i];
        }
    }
    return NULL;
}

const char *dig_variant_unit(const enum dig_effect_id effect)
{
    const struct effect_change *const c = find_effect(effect);
    return c == NULL ? NULL : c->unit;
}

// A magnitude within range at which the effect is present and fits the bed.
static bool is_in_range(const struct effect_change *const c, const double magnitude,
                        const struct dig_scene *const scene)
{
    const double height_m = scene->box.z_max_m - scene->box.z_min_m;
    if (!(magnitude >= c->least && magnitude <= c->most)) {
        return false;
    }
    if (c->effect == DIG_EFFECT_GROUND_SLOPE) {
        return fabs(magnitude) >= 0.01;
    }
    if (c->effect == DIG_EFFECT_LAYERING || c->effect == DIG_EFFECT_OBSTACLE) {
        return fabs(magnitude) >= 1e-4 && fabs(magnitude) <= height_m;
    }
    return c->effect != DIG_EFFECT_COMPACTION || fabs(magnitude - round(magnitude)) < 1e-9;
}

enum dig_status dig_variant_make(const struct dig_scene *const scene,
                                 const enum dig_effect_id effect, const double magnitude,
                                 struct dig_scene *const varied, struct dig_error *const error)
{
    const struct effect_change *const c = find_effect(effect);
    if (c == NULL) {
        return dig_error_set(error, DIG_EINVAL, "%s: expected an effect that beds can hold",
                             dig_effect_name(effect));
    }
    if (!is_in_range(c, magnitude, scene)) {
        return dig_error_set(
            error, DIG_EINVAL,
            "%s: %g %s, expected %g to %g, not where it is absent, no higher than the bed, whole "
            "if it is a number of digs",
            dig_effect_name(effect), magnitude, c->unit, c->least, c->most);
    }
    struct dig_scene made = *scene;
    c->apply(magnitude, &made);
    *varied = made;
    return DIG_OK;
}
