#include "core/scene.h"

#include "core/bed_plan.h"
#include "core/name.h"
#include "core/sha256.h"
#include "core/text.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

static void check_box(const struct dig_box *const box, const double diameter_m,
                      struct dig_conditions *const c)
{
    const struct {
        const char *key;
        double      low, high;
    } side[] = {
        { "box_m.x", box->x_min_m, box->x_max_m },
        { "box_m.y", box->y_min_m, box->y_max_m },
        { "box_m.z", box->z_min_m, box->z_max_m },
    };
    for (size_t i = 0; i < sizeof side / sizeof side[0]; i++) {
        dig_require(c,
                    isfinite(side[i].low) && isfinite(side[i].high) &&
                        side[i].high - side[i].low > 2.0 * diameter_m,
                    "%s: [%g, %g], expected two numbers, ascending, more than two grain diameters "
                    "apart",
                    side[i].key, side[i].low, side[i].high);
    }
}

static void check_bucket(const struct dig_bucket *const bucket, struct dig_conditions *const c)
{
    dig_require(c, bucket->points >= 3 && bucket->points <= DIG_PROFILE_MAX,
                "bucket.profile_m: %zu points, expected 3 to %d", bucket->points, DIG_PROFILE_MAX);
    for (size_t i = 0; c->status == DIG_OK && i < bucket->points; i++) {
        const bool same = i > 0 && hypot(bucket->x_m[i] - bucket->x_m[i - 1],
                                         bucket->z_m[i] - bucket->z_m[i - 1]) < 1e-9;
        dig_require(c, isfinite(bucket->x_m[i]) && isfinite(bucket->z_m[i]) && !same,
                    "bucket.profile_m[%zu]: [%g, %g], expected two finite numbers that differ from "
                    "the point before",
                    i, bucket->x_m[i], bucket->z_m[i]);
    }
}

static void check_trajectory(const struct dig_trajectory *const t, const size_t at,
                             struct dig_conditions *const c)
{
    dig_require(c, dig_name_ok(t->name), "trajectories[%zu].name: \"%s\", expected " DIG_NAME_RULE,
                at, t->name);
    dig_require(c, isfinite(t->theta0_rad) && isfinite(t->start_x_m) && isfinite(t->start_z_m),
                "trajectories[%zu].start_pin_m: expected finite numbers", at);
    dig_require(c, t->phases >= 1 && t->phases <= DIG_PHASES_MAX,
                "trajectories[%zu].phases: %zu phases, expected 1 to %d", at, t->phases,
                DIG_PHASES_MAX);
    for (size_t i = 0; c->status == DIG_OK && i < t->phases; i++) {
        const struct dig_phase *const p = &t->phase[i];
        dig_require(c, dig_name_ok(p->name),
                    "trajectories[%zu].phases[%zu].name: \"%s\", expected " DIG_NAME_RULE, at, i,
                    p->name);
        dig_require(c, p->duration_s > 0.0 && p->duration_s <= 600.0,
                    "trajectories[%zu].phases[%zu].duration_s: %g, expected > 0 and <= 600", at, i,
                    p->duration_s);
        dig_require(c, isfinite(p->vx_mps) && isfinite(p->vz_mps) && isfinite(p->omega_radps),
                    "trajectories[%zu].phases[%zu]: rates expected finite", at, i);
    }
}

static void check_trajectories(const struct dig_scene *const scene, struct dig_conditions *const c)
{
    dig_require(c, scene->trajectories >= 1 && scene->trajectories <= DIG_TRAJECTORY_MAX,
                "trajectories: %zu, expected 1 to %d", scene->trajectories, DIG_TRAJECTORY_MAX);
    for (size_t i = 0; c->status == DIG_OK && i < scene->trajectories; i++) {
        const struct dig_trajectory *const t = &scene->trajectory[i];
        check_trajectory(t, i, c);
        dig_require(c, dig_scene_find(scene, t->name) == t,
                    "trajectories[%zu].name: \"%s\" again, expected a new name", i, t->name);
    }
}

enum dig_status dig_scene_check(const struct dig_scene *const scene, struct dig_error *const error)
{
    assert(scene != NULL);
    struct dig_conditions c = { .error = error };
    dig_require(&c, dig_name_ok(scene->name), "name: \"%s\", expected " DIG_NAME_RULE, scene->name);

    const struct dig_scene_range range[] = {
        { "bucket.width_m", scene->bucket.width_m, 0.0, 100.0, true },
        { "material.diameter_m", scene->material.diameter_m, 0.0, 10.0, true },
        { "material.young_Pa", scene->material.young_Pa, 0.0, 1e12, true },
        { "material.poisson", scene->material.poisson, -1.0, 0.5, true },
        { "material.restitution", scene->material.restitution, 0.0, 1.0, true },
        { "material.characteristic_velocity_mps", scene->material.characteristic_velocity_mps, 0.0,
          1e3, true },
        { "packing.solid_fraction", scene->packing.solid_fraction, 0.0, 0.4, true },
        { "packing.fill_factor", scene->packing.fill_factor, 0.0, 2.0, true },
        { "packing.fall_mps", scene->packing.fall_mps, 0.0, 10.0, false },
        { "packing.settle_s", scene->packing.settle_s, 0.0, 60.0, true },
        { "packing.relax_s", scene->packing.relax_s, 0.0, 60.0, false },
        { "material.young_at_kgpm3", scene->material.young_at_kgpm3,
          scene->material.young_at_kgpm3 > 0.0 ? 99.0 : 0.0, 20000.0,
          scene->material.young_at_kgpm3 > 0.0 },
        { "gravity_mps2", scene->gravity_mps2, 0.0, 100.0, true },
        { "time_step_s", scene->time_step_s, 0.0, 1e-2, false },
        { "output_s", scene->output_s, 0.0, 0.02, true },
    };
    dig_scene_check_ranges(NULL, 0, sizeof range / sizeof range[0], range, &c);
    check_box(&scene->box, scene->material.diameter_m, &c);
    check_bucket(&scene->bucket, &c);
    check_trajectories(scene, &c);
    // What the bed is compared with has been checked.
    if (c.status == DIG_OK) {
        dig_bed_plan_check(scene, &c);
    }
    return c.status;
}

enum { SIZE = DIG_SCENE_TEXT_SIZE };

static void add_trajectory(char text[const SIZE], const struct dig_trajectory *const t)
{
    dig_text_add(SIZE, text, "trajectory=%s\ntheta0_rad=%.17g\nstart_m=%.17g %.17g\n", t->name,
                 t->theta0_rad, t->start_x_m, t->start_z_m);
    for (size_t i = 0; i < t->phases; i++) {
        const struct dig_phase *const p = &t->phase[i];
        dig_text_add(SIZE, text, "phase=%s %.17g %.17g %.17g %.17g\n", p->name, p->duration_s,
                     p->vx_mps, p->vz_mps, p->omega_radps);
    }
}

void dig_scene_canonical(const struct dig_scene *const scene, char text[const SIZE])
{
    assert(scene != NULL && text != NULL);
    const struct dig_box *const      b = &scene->box;
    const struct dig_packing *const  p = &scene->packing;
    const struct dig_material *const m = &scene->material;

    text[0] = '\0';
    dig_text_add(SIZE, text, "scene=%s\nbucket_width_m=%.17g\n", scene->name,
                 scene->bucket.width_m);
    for (size_t i = 0; i < scene->bucket.points; i++) {
        dig_text_add(SIZE, text, "profile_m=%.17g %.17g\n", scene->bucket.x_m[i],
                     scene->bucket.z_m[i]);
    }
    dig_text_add(SIZE, text, "box_m=%.17g %.17g %.17g %.17g %.17g %.17g\n", b->x_min_m, b->x_max_m,
                 b->y_min_m, b->y_max_m, b->z_min_m, b->z_max_m);
    dig_text_add(SIZE, text, "packing=%.17g %.17g %.17g %.17g %.17g\n", p->solid_fraction,
                 p->fill_factor, p->fall_mps, p->settle_s, p->relax_s);
    dig_text_add(SIZE, text, "material=%.17g %.17g %.17g %.17g %.17g\n", m->diameter_m, m->young_Pa,
                 m->poisson, m->restitution, m->characteristic_velocity_mps);
    dig_text_add(SIZE, text, "gravity_mps2=%.17g\ntime_step_s=%.17g\noutput_s=%.17g\n",
                 scene->gravity_mps2, scene->time_step_s, scene->output_s);
    for (size_t i = 0; i < scene->trajectories; i++) {
        add_trajectory(text, &scene->trajectory[i]);
    }
    if (m->young_at_kgpm3 > 0.0) {
        dig_text_add(SIZE, text, "young_at_kgpm3=%.17g\n", m->young_at_kgpm3);
    }
    dig_bed_plan_canonical(scene, text);
}

void dig_scene_hash(const struct dig_scene *const scene, char hex[const 65])
{
    char text[SIZE];
    dig_scene_canonical(scene, text);
    dig_sha256_hex(text, strlen(text), hex);
}
