// Grain types of a bed, and the laws between them: each combination of size, material and sphere of
// the clump is a type.

#ifndef DIG_OFFLINE_DEM_WORLD_GRAIN_TYPES_H
#define DIG_OFFLINE_DEM_WORLD_GRAIN_TYPES_H

#include "core/bed.h"
#include "core/error.h"
#include "core/scene.h"
#include "offline_dem/law/law.h"
#include "offline_dem/shapes/clump.h"
#include "offline_dem/world/world.h"

/// mass_kg of a clump's sphere is its share of the clump by volume; contacts use the whole mass.
struct dig_grain_types {
    size_t                types;
    struct dig_grain_type type[DIG_GRAIN_TYPES_MAX];
    size_t                material[DIG_GRAIN_TYPES_MAX];
    double                contact_kg[DIG_GRAIN_TYPES_MAX]; // mass of the grain, or of its clump
};

/// Constants of contacts between two materials, bucket and walls among them: the scene's pair if it
/// has one. Else, between grains, the smaller frictions and the geometric mean of restitution; of
/// grains with bucket or walls, the grains' own. At the bucket either friction is cut by the
/// scene's bucket_smoothness. Grains cohere with each other, adhere to the bucket, and neither to
/// walls.
struct dig_law_material dig_grain_types_between(const struct dig_scene  *scene,
                                                const struct dig_gravel *gravel, size_t a,
                                                size_t b);

/// Sorts the bed's grains into types, type_of[grain]. DIG_EINVAL for more than DIG_GRAIN_TYPES_MAX
/// types, a radius that is not positive, a material the scene does not have, or an incomplete
/// clump; *error says which.
DIG_MUST_CHECK enum dig_status
dig_grain_types_find(const struct dig_scene *scene, const struct dig_gravel *gravel,
                     const struct dig_bed *bed, const struct dig_clump_shape *shape,
                     struct dig_grain_types *types, uint8_t type_of[], struct dig_error *error);

/// Fills the world's laws for these types.
void dig_grain_types_set_laws(const struct dig_scene *scene, const struct dig_gravel *gravel,
                              const struct dig_grain_types *types, struct dig_world *world);

/// Time step of a bed of these types, s: the scene's, or derived.
double dig_grain_types_time_step_s(const struct dig_scene *scene, const struct dig_gravel *gravel,
                                   const struct dig_grain_types *types);

#endif // DIG_OFFLINE_DEM_WORLD_GRAIN_TYPES_H
