#include "offline_dem/variant.h"

const char *dig_variant_unit(const enum dig_effect_id effect)
{
    (void)effect;
    return NULL;
}

enum dig_status dig_variant_make(const struct dig_scene *const  scene,
                                 const struct dig_gravel *const gravel,
                                 const enum dig_effect_id effect, const double magnitude,
                                 struct dig_scene *const varied, struct dig_error *const error)
{
    (void)scene;
    (void)gravel;
    (void)varied;
    return dig_error_set(error, DIG_EINVAL, "%s %g: expected an effect that beds can hold",
                         dig_effect_name(effect), magnitude);
}
