// Advice of a trace for people: the ground in which effects are explained, and what to do next.

#include "closed_loop/verdict/trace_work.h"
#include "core/units.h"
#include "estimator/effects/effect.h"
#include "tables/scene.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

static const char *const no_air =
    "no free air in the recordings: effects of the machine cannot be told, and what is said of the "
    "soil and its gravel may be theirs; record two seconds or more before contact and after the "
    "dump";

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

// The gravel the search chose, the table's bucket (without a table as rough as the gravel), and how
// hard the layers that tables of effects hold resist beside the gravel.
static enum dig_status fill_ground(const struct dig_trace_work *const w,
                                   struct dig_effect_ground *const    ground,
                                   struct dig_error *const            error)
{
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

static void advise(const struct dig_trace_work *const w, struct dig_trace *const trace)
{
    const struct dig_search *const s = w->search;
    if (s->outside) {
        const struct dig_gravel g = dig_response_surface_gravel(w->surface, s->chosen.number);
        (void)snprintf(trace->advice, sizeof trace->advice,
                       "no effect: the gravel lies beyond the table's grid, near friction %.2f, "
                       "rolling %.2f, %.0f kg/m3; compute a table that holds it",
                       g.value[DIG_AXIS_FRICTION], g.value[DIG_AXIS_ROLLING],
                       g.value[DIG_AXIS_DENSITY_kgpm3]);
    } else if (s->is_rock) {
        (void)snprintf(trace->advice, sizeof trace->advice,
                       "a rock, felt %.0f mm (rig scale) from where the table's is; what it adds "
                       "is corrected as measured, and holds while it lies there",
                       1e3 * s->rock.ahead_m);
    } else if (s->unlisted) {
        (void)snprintf(trace->advice, sizeof trace->advice,
                       "no effect of the list explains the digs; what is left depends on %s",
                       s->without_name.depends_on[0] != '\0' ? s->without_name.depends_on
                                                             : "nothing that was tried");
    } else if (trace->tells > 0 && trace->tell[0].how[0] != '\0') {
        dig_tell_apart_say(&trace->tell[0], sizeof trace->advice, trace->advice);
    } else if (s->significant && s->chosen.hypothesis.effects > 0 &&
               dig_effect_of(s->chosen.hypothesis.effect[0])->templated) {
        (void)snprintf(trace->advice, sizeof trace->advice,
                       "a table computed with %s in its beds would serve better than a correction",
                       dig_effect_name(s->chosen.hypothesis.effect[0]));
    }
}

// Where nothing better is to be said: why a probability stops at one half.
static void advise_on_size(const struct dig_trace_work *const w, struct dig_trace *const trace)
{
    for (size_t e = 0; e < w->air->effects && trace->advice[0] == '\0'; e++) {
        if (w->size[e] < 1.0) {
            (void)snprintf(trace->advice, sizeof trace->advice,
                           "%s shows in %s; in the soil a gravel of the table leaves %.1f of "
                           "the noise floor of it, so the digs themselves do not confirm it",
                           dig_effect_name(w->air->effect[e].effect),
                           w->air->by_digs ? "the forces of the digs" : "free air", w->size[e]);
        }
    }
}

// What of the machine's file is wrong by more than it allows.
static void advise_on_file(const struct dig_machine_unlike_file *const unlike,
                           struct dig_trace *const                     trace)
{
    const char *const what = dig_file_error_text(unlike->error);
    if (unlike->error == DIG_FILE_LEVEL_rad) {
        (void)snprintf(trace->advice, sizeof trace->advice,
                       "by free air the machine was pitched by %.1f degrees and did not say so: "
                       "record its pitch",
                       unlike->value / DIG_RAD_PER_DEG);
    } else {
        const bool mass = (unlike->error - DIG_FILE_LINKS) % 3 == 0;
        (void)snprintf(trace->advice, sizeof trace->advice,
                       "by free air %s differs from the machine's file by %.0f %s, which allows "
                       "%.0f: mend the file",
                       what, unlike->value, mass ? "kg" : "kg m", unlike->allowed);
    }
}

// First, where the recordings hold no free air, that they do not.
static void advise_on_air(struct dig_trace *const trace)
{
    char more[sizeof trace->advice];
    (void)snprintf(more, sizeof more, "%s", trace->advice);
    (void)snprintf(trace->advice, sizeof trace->advice, "%s%s%.280s", no_air,
                   more[0] != '\0' ? ". Of the digs alone: " : "", more);
}

enum dig_status dig_trace_explain(const struct dig_trace_work *const w,
                                  struct dig_trace *const trace, struct dig_error *const error)
{
    assert(w != NULL && trace != NULL);
    advise(w, trace);
    if (w->air->unlike.is && trace->advice[0] == '\0') {
        advise_on_file(&w->air->unlike, trace);
    }
    advise_on_size(w, trace);
    if (w->air->no_air) {
        advise_on_air(trace);
    }
    return fill_ground(w, &trace->ground, error);
}
