#include "offline_dem/world/grain_types.h"

#include "core/bed_plan.h"
#include "core/contact.h"
#include "core/units.h"

#include <math.h>

// Constants of one material of grains.
struct own {
    double friction, rolling, density_kgpm3, restitution;
};

static struct own own_of(const struct dig_scene *const scene, const struct dig_gravel *const gravel,
                         const size_t material)
{
    if (material == 0) {
        return (struct own){ gravel->value[DIG_AXIS_FRICTION], gravel->value[DIG_AXIS_ROLLING],
                             gravel->value[DIG_AXIS_DENSITY_kgpm3], scene->material.restitution };
    }
    const struct dig_other_material *const m = &scene->bed.material[material - 1];
    return (struct own){ m->friction, m->rolling, m->density_kgpm3, m->restitution };
}

struct dig_law_material dig_grain_types_between(const struct dig_scene *const  scene,
                                                const struct dig_gravel *const gravel,
                                                const size_t a, const size_t b)
{
    const struct dig_material *const m        = &scene->material;
    const size_t                     grain    = a < DIG_MATERIAL_BUCKET ? a : b;
    const size_t                     other    = grain == a ? b : a;
    const struct own                 own      = own_of(scene, gravel, grain);
    struct dig_law_material          material = {
                 .young_Pa    = dig_scene_young_Pa(scene, gravel->value[DIG_AXIS_DENSITY_kgpm3]),
                 .poisson     = m->poisson,
                 .restitution = own.restitution,
                 .characteristic_velocity_mps = m->characteristic_velocity_mps,
                 .friction                    = own.friction,
                 .rolling                     = own.rolling,
                 .normal_law                  = scene->laws.normal,
                 .rolling_law                 = scene->laws.rolling,
    };
    if (other == DIG_MATERIAL_BUCKET) {
        material.cohesion_Jpm3 = scene->laws.adhesion_Jpm3;
    } else if (other < DIG_MATERIAL_BUCKET) {
        material.cohesion_Jpm3 = scene->laws.cohesion_Jpm3;
    }
    if (other < DIG_MATERIAL_BUCKET && other != grain) {
        const struct own theirs = own_of(scene, gravel, other);
        material.friction       = fmin(own.friction, theirs.friction);
        material.rolling        = fmin(own.rolling, theirs.rolling);
        material.restitution    = sqrt(own.restitution * theirs.restitution);
    }
    for (size_t i = 0; i < scene->bed.pairs; i++) {
        const struct dig_material_pair *const p = &scene->bed.pair[i];
        if ((p->a == a && p->b == b) || (p->a == b && p->b == a)) {
            material.friction    = p->friction;
            material.rolling     = p->rolling;
            material.restitution = p->restitution;
        }
    }
    if (other == DIG_MATERIAL_BUCKET) {
        material.friction *= 1.0 - scene->laws.bucket_smoothness;
        material.rolling *= 1.0 - scene->laws.bucket_smoothness;
    }
    return material;
}

static double sphere_m3(const double radius_m)
{
    return 4.0 / 3.0 * DIG_PI * radius_m * radius_m * radius_m;
}

// The type of a grain, or a new one; DIG_GRAIN_TYPES_MAX when there is no room. Radii from one file
// or one pouring are equal but for rounding.
static size_t find_type(struct dig_grain_types *const types, const struct dig_grain_type type,
                        const size_t material, const double contact_kg)
{
    for (size_t k = 0; k < types->types; k++) {
        if (fabs(types->type[k].radius_m - type.radius_m) <= 1e-9 * type.radius_m &&
            fabs(types->contact_kg[k] - contact_kg) <= 1e-6 * contact_kg &&
            types->material[k] == material) {
            return k;
        }
    }
    if (types->types == DIG_GRAIN_TYPES_MAX) {
        return DIG_GRAIN_TYPES_MAX;
    }
    const size_t k       = types->types++;
    types->type[k]       = type;
    types->material[k]   = material;
    types->contact_kg[k] = contact_kg;
    return k;
}

// Index of a sphere within its clump; the spheres of a clump are consecutive.
static enum dig_status find_member(const struct dig_bed *const         bed,
                                   const struct dig_clump_shape *const shape, const size_t i,
                                   size_t *const member)
{
    const size_t first = i / shape->spheres * shape->spheres;
    const size_t last  = first + shape->spheres - 1;
    const double unit  = bed->radius_m[first] / shape->radius[0];
    const bool   whole = last < bed->grains && bed->clump[i] > 0 &&
                       bed->clump[first] == bed->clump[i] && bed->clump[last] == bed->clump[i];
    *member = i - first;
    return whole && fabs(bed->radius_m[i] - unit * shape->radius[*member]) <= 1e-6 * unit
               ? DIG_OK
               : DIG_EINVAL;
}

static double spheres_m3(const struct dig_clump_shape *const shape)
{
    double sum = 0.0;
    for (size_t k = 0; k < shape->spheres; k++) {
        sum += shape->radius[k] * shape->radius[k] * shape->radius[k];
    }
    return sum;
}

static enum dig_status make_type(const struct dig_scene *const       scene,
                                 const struct dig_gravel *const      gravel,
                                 const struct dig_bed *const         bed,
                                 const struct dig_clump_shape *const shape, const size_t i,
                                 struct dig_grain_type *const type, double *const contact_kg,
                                 struct dig_error *const error)
{
    const double radius_m = bed->radius_m[i];
    const size_t material = bed->material == NULL ? 0 : bed->material[i];
    if (!(radius_m > 0.0) || !isfinite(radius_m)) {
        return dig_error_set(error, DIG_EINVAL, "bed: grain %zu: radius_m %g, expected > 0", i,
                             radius_m);
    }
    if (material > scene->bed.materials) {
        return dig_error_set(error, DIG_EINVAL,
                             "bed: grain %zu: material %zu, expected one of the scene's %zu", i,
                             material, scene->bed.materials + 1);
    }
    const double density_kgpm3 = own_of(scene, gravel, material).density_kgpm3;
    double       mass_kg       = density_kgpm3 * sphere_m3(radius_m);
    *contact_kg                = mass_kg;
    if (shape->spheres > 0) {
        size_t member = 0;
        if (bed->clump == NULL || find_member(bed, shape, i, &member) != DIG_OK) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed: grain %zu: expected whole clumps of the scene's %zu spheres",
                                 i, shape->spheres);
        }
        const double r = shape->radius[member];
        *contact_kg    = density_kgpm3 * sphere_m3(0.5 * radius_m / r);
        mass_kg        = *contact_kg * r * r * r / spheres_m3(shape);
    } else if (bed->clump != NULL) {
        return dig_error_set(error, DIG_EINVAL,
                             "bed: holds clumps, expected spheres as in the scene");
    }
    *type = (struct dig_grain_type){ .radius_m     = radius_m,
                                     .mass_kg      = mass_kg,
                                     .inertia_kgm2 = 0.4 * mass_kg * radius_m * radius_m,
                                     .driven       = shape->spheres > 0 };
    return DIG_OK;
}

enum dig_status dig_grain_types_find(const struct dig_scene *const       scene,
                                     const struct dig_gravel *const      gravel,
                                     const struct dig_bed *const         bed,
                                     const struct dig_clump_shape *const shape,
                                     struct dig_grain_types *const types, uint8_t type_of[],
                                     struct dig_error *const error)
{
    struct dig_grain_types made = { 0 };
    for (size_t i = 0; i < bed->grains; i++) {
        struct dig_grain_type type       = { 0 };
        double                contact_kg = 0.0;
        const enum dig_status status =
            make_type(scene, gravel, bed, shape, i, &type, &contact_kg, error);
        if (status != DIG_OK) {
            return status;
        }
        const size_t material = bed->material == NULL ? 0 : bed->material[i];
        const size_t k        = find_type(&made, type, material, contact_kg);
        if (k == DIG_GRAIN_TYPES_MAX) {
            return dig_error_set(error, DIG_EINVAL,
                                 "bed: more than %d sizes and materials, expected fewer",
                                 DIG_GRAIN_TYPES_MAX);
        }
        type_of[i] = (uint8_t)k;
    }
    *types = made;
    return DIG_OK;
}

void dig_grain_types_set_laws(const struct dig_scene *const       scene,
                              const struct dig_gravel *const      gravel,
                              const struct dig_grain_types *const types,
                              struct dig_world *const             world)
{
    for (size_t a = 0; a < types->types; a++) {
        const size_t ma   = types->material[a];
        const double ra_m = types->type[a].radius_m;
        const double a_kg = types->contact_kg[a];
        for (size_t b = a; b < types->types; b++) {
            const struct dig_law_material between =
                dig_grain_types_between(scene, gravel, ma, types->material[b]);
            world->pair_law[a * DIG_GRAIN_TYPES_MAX + b] =
                dig_law_pair(&between, ra_m, types->type[b].radius_m, a_kg, types->contact_kg[b]);
        }
        const struct dig_law_material wall =
            dig_grain_types_between(scene, gravel, ma, DIG_MATERIAL_WALLS);
        const struct dig_law_material tool =
            dig_grain_types_between(scene, gravel, ma, DIG_MATERIAL_BUCKET);
        world->wall_law[a] = dig_law_wall(&wall, ra_m, a_kg);
        world->tool_law[a] = dig_law_wall(&tool, ra_m, a_kg);
    }
}

double dig_grain_types_time_step_s(const struct dig_scene *const       scene,
                                   const struct dig_gravel *const      gravel,
                                   const struct dig_grain_types *const types)
{
    if (scene->time_step_s > 0.0) {
        return scene->time_step_s;
    }
    double least_s = INFINITY;
    for (size_t k = 0; k < types->types; k++) {
        const struct dig_law_material between =
            dig_grain_types_between(scene, gravel, types->material[k], types->material[k]);
        struct dig_material grain = scene->material;
        grain.diameter_m          = 2.0 * types->type[k].radius_m;
        grain.young_Pa            = between.young_Pa;
        grain.restitution         = between.restitution;
        least_s                   = fmin(least_s,
                                         dig_contact_step_s(&grain, scene->laws.normal,
                                                            own_of(scene, gravel, types->material[k]).density_kgpm3));
    }
    return least_s;
}
