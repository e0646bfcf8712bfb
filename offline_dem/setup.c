#include "offline_dem/setup.h"

#include "core/units.h"
#include "offline_dem/dig.h"

#include <math.h>

// As many contacts as a grain of a dense bed has at most, nearly.
#define DAMPING_CONTACTS 8.0

enum dig_status dig_setup_check(const struct dig_scene *const  scene,
                                const struct dig_gravel *const gravel,
                                struct dig_error *const        error)
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
    // Tangential damping takes spin off a grain with 8 contacts at a rate of 8 x 2/3 x gamma r^2 /
    // I; a neighbour that turns the same way doubles it. Beyond 2 / rate the spin flips at every
    // step.
    const double damping_s =
        2.0 * 0.4 * mass_kg / (DAMPING_CONTACTS * 2.0 / 3.0 * 2.0 * law.damping_Nspm);
    return fmin(fmin(0.14 * rayleigh_s, contact_s / 20.0), damping_s);
}

struct dig_world dig_setup_world(const struct dig_scene *const     scene,
                                 const struct dig_gravel *const    gravel,
                                 const struct dig_ode_scene *const ode,
                                 struct dig_grains *const          grains)
{
    struct dig_world world = {
        .dt_s         = dig_time_step_s(scene, gravel->value[DIG_AXIS_DENSITY_kgpm3]),
        .gravity_mps2 = { 0.0, 0.0, -scene->gravity_mps2 },
        .isa          = dig_kernel_best(),
    };
    world.walls = dig_ode_scene_walls(ode, world.wall);
    dig_world_init(&world, grains);
    const struct dig_law_material material = law_material(scene, gravel);
    dig_world_set_material(&world, &material);
    return world;
}

enum dig_status dig_setup_explain(const enum dig_status status, struct dig_error *const error)
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
