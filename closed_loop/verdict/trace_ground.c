#include "closed_loop/verdict/trace_work.h"

#include "tables/scene.h"

#include <assert.h>
#include <math.h>

// How hard one gravel resists over another: My, the geometric mean over the trajectories dug.
static double ratio_of(const struct dig_trace_work *const w, const double above[DIG_AXES],
                       const double below[DIG_AXES])
{
    double sum = 0.0;
    for (size_t g = 0; g < w->batch->groups; g++) {
        const size_t t = w->batch->group[g].trajectory;
        double       feature[DIG_FEATURES];
        double       size[DIG_FORCE_CHANNELS];
        double       other[DIG_FORCE_CHANNELS];
        dig_response_surface_features(w->surface, t, above, feature, size);
        dig_response_surface_features(w->surface, t, below, feature, other);
        sum += log(size[DIG_CHANNEL_MY_Nm] / other[DIG_CHANNEL_MY_Nm]);
    }
    return exp(sum / (double)w->batch->groups);
}

// The friction of the table's bucket, where it has one of its own.
static enum dig_status take_bucket(const char *const table, struct dig_effect_ground *const ground,
                                   struct dig_error *const error)
{
    struct dig_scene      scene;
    const enum dig_status status = dig_table_scene(table, &scene, error);
    if (status == DIG_OK) {
        const struct dig_material_pair *const bucket = dig_scene_bucket_pair(&scene);
        if (bucket != NULL) {
            ground->bucket_friction = bucket->friction;
            ground->bucket_rolling  = bucket->rolling;
        }
    }
    return status;
}

enum dig_status dig_trace_ground(const struct dig_trace_work *const w,
                                 struct dig_effect_ground *const    ground,
                                 struct dig_error *const            error)
{
    assert(w != NULL && ground != NULL);
    const double *const place = w->search->chosen.number;
    ground->gravel            = dig_response_surface_gravel(w->surface, place);
    ground->bucket_friction   = ground->gravel.value[DIG_AXIS_FRICTION];
    ground->bucket_rolling    = ground->gravel.value[DIG_AXIS_ROLLING];
    for (int loose = 0; loose < 2; loose++) {
        const struct dig_gravel layer = dig_effect_layer_gravel(loose == 1);
        double                  at[DIG_AXES];
        dig_response_surface_place(w->surface, &layer, at);
        ground->layer[loose] = ratio_of(w, at, place);
    }
    return w->table != NULL ? take_bucket(w->table, ground, error) : DIG_OK;
}
