// Worlds made by hand, for tests and benches: grains by their radii, and one material for all.

#ifndef DIG_TESTS_DEM_GRAINS_H
#define DIG_TESTS_DEM_GRAINS_H

#include "core/units.h"
#include "offline_dem/world/world.h"

#include <stdlib.h>

/// A kind of sphere.
static inline struct dig_grain_type dem_sphere(const double radius_m, const double density_kgpm3)
{
    const double kg = density_kgpm3 * 4.0 / 3.0 * DIG_PI * radius_m * radius_m * radius_m;
    return (struct dig_grain_type){ .radius_m     = radius_m,
                                    .mass_kg      = kg,
                                    .inertia_kgm2 = 0.4 * kg * radius_m * radius_m };
}

/// n spheres at rest at (x, y, z), a type for each radius. Status as dig_grains_create().
static inline enum dig_status dem_create_grains(const size_t n, const double x_m[],
                                                const double y_m[], const double z_m[],
                                                const double radius_m[], const double density_kgpm3,
                                                struct dig_grains *grains)
{
    struct dig_grain_type type[DIG_GRAIN_TYPES_MAX];
    size_t                types = 0;
    uint8_t *const        of    = malloc(n + 1);
    if (of == NULL) {
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < n; i++) {
        const double r_m = radius_m[i];
        size_t       k   = 0;
        while (k < types && (type[k].radius_m < r_m || type[k].radius_m > r_m)) {
            k++;
        }
        if (k == DIG_GRAIN_TYPES_MAX) {
            free(of);
            return DIG_EINVAL;
        }
        type[k] = dem_sphere(r_m, density_kgpm3);
        types += k == types;
        of[i] = (uint8_t)k;
    }
    const enum dig_status status = dig_grains_create(types, type, n, x_m, y_m, z_m, of, grains);
    free(of);
    return status;
}

/// Gives every pair of types, and every type with walls and tool, the laws of one material.
static inline void dem_set_material(struct dig_world *const              world,
                                    const struct dig_law_material *const material)
{
    const struct dig_grains *const g = &world->grains;
    for (size_t a = 0; a < g->types; a++) {
        const struct dig_grain_type ka = g->type[a];
        for (size_t b = a; b < g->types; b++) {
            const struct dig_grain_type kb = g->type[b];
            world->pair_law[a * DIG_GRAIN_TYPES_MAX + b] =
                dig_law_pair(material, ka.radius_m, kb.radius_m, ka.mass_kg, kb.mass_kg);
        }
        world->wall_law[a] = dig_law_wall(material, ka.radius_m, ka.mass_kg);
        world->tool_law[a] = world->wall_law[a];
    }
}

#endif // DIG_TESTS_DEM_GRAINS_H
