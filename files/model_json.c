#include "files/model_json.h"

#include "core/name.h"
#include "files/yaml/yaml.h"
#include "files/yaml/yaml_schema.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

struct effect_text {
    char                    name[DIG_NAME_SIZE];
    struct dig_model_effect effect; // but for its id
};

struct curve_text {
    uint32_t trajectory;
    char     channel[DIG_NAME_SIZE];
    double   share[DIG_CURVE_POINTS];
    uint32_t points;
};

struct unlisted_text {
    char              depends_on[128];
    struct curve_text curve[DIG_TRAJECTORY_MAX * DIG_FORCE_CHANNELS];
    uint32_t          curves;
};

// The model, but for what is named, absent or of another type in the file.
struct model_text {
    struct dig_model      model;
    uint32_t              version;
    double               *noise_floor, *error_before, *error_after;
    struct effect_text    effect[DIG_MODEL_EFFECTS_MAX], left_out[DIG_MODEL_EFFECTS_MAX];
    struct unlisted_text *unlisted;
};

static const cyaml_schema_field_t parameter_fields[] = {
    TEXT(dig_model_parameter, name),
    NUMBER(dig_model_parameter, value),
    NUMBER(dig_model_parameter, low),
    NUMBER(dig_model_parameter, high),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t parameter = ENTRY(dig_model_parameter, parameter_fields);

static const cyaml_schema_field_t effect_fields[] = {
    TEXT(effect_text, name),
    CYAML_FIELD_FLOAT("probability", REQUIRED, struct effect_text, effect.probability),
    LIST("parameters", REQUIRED, effect_text, effect.parameter, effect.parameters, &parameter, 0,
         DIG_MODEL_PARAMETERS_MAX),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t effect = ENTRY(effect_text, effect_fields);

static const cyaml_schema_field_t curve_fields[] = {
    CYAML_FIELD_UINT("trajectory", REQUIRED, struct curve_text, trajectory),
    TEXT(curve_text, channel),
    LIST("share", REQUIRED, curve_text, share, points, &dig_yaml_number, DIG_CURVE_POINTS,
         DIG_CURVE_POINTS),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t curve = ENTRY(curve_text, curve_fields);

static const cyaml_schema_field_t unlisted_fields[] = {
    CYAML_FIELD_STRING("depends_on", REQUIRED, struct unlisted_text, depends_on, 0),
    LIST("curves", REQUIRED, unlisted_text, curve, curves, &curve, 0,
         DIG_TRAJECTORY_MAX *DIG_FORCE_CHANNELS),
    CYAML_FIELD_END,
};

#define WORDS(name, least) CYAML_FIELD_STRING(#name, REQUIRED, struct model_text, model.name, least)
#define GRAVEL(name)                                                                               \
    CYAML_FIELD_MAPPING(#name, REQUIRED, struct model_text, model.name, dig_yaml_gravel)
#define NUMBER_PERHAPS(name)                                                                       \
    CYAML_FIELD_FLOAT_PTR(#name, CYAML_FLAG_POINTER | OPTIONAL, struct model_text, name)

static const cyaml_schema_field_t fields[] = {
    CYAML_FIELD_UINT("version", REQUIRED, struct model_text, version),
    WORDS(table, 0),
    WORDS(effects_table, 0),
    WORDS(scene_hash, 64),
    GRAVEL(gravel),
    GRAVEL(low),
    GRAVEL(high),
    NUMBER_PERHAPS(noise_floor),
    NUMBER_PERHAPS(error_before),
    NUMBER_PERHAPS(error_after),
    WORDS(provenance, 0),
    LIST("effects", REQUIRED, model_text, effect, model.effects, &effect, 0, DIG_MODEL_EFFECTS_MAX),
    LIST("not_applied", OPTIONAL, model_text, left_out, model.not_applied, &effect, 0,
         DIG_MODEL_EFFECTS_MAX),
    CYAML_FIELD_MAPPING_PTR("unlisted", CYAML_FLAG_POINTER | OPTIONAL, struct model_text, unlisted,
                            unlisted_fields),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = FILE_OF(model_text, fields);

static double number_of(const double *const number)
{
    return number != NULL ? *number : (double)NAN;
}

static void take_effect(const struct effect_text *const text, struct dig_model_effect *const out,
                        struct dig_conditions *const c)
{
    const int id = dig_effect_find(text->name);
    *out         = text->effect;
    out->effect  = (enum dig_effect_id)id;
    dig_require(c, id >= 0, "effects.name: \"%s\", expected the name of an effect of the catalogue",
                text->name);
    dig_require(c, out->probability >= 0.0 && out->probability <= 1.0,
                "effects.probability: %g, expected 0 to 1", out->probability);
    for (size_t p = 0; p < out->parameters; p++) {
        const struct dig_model_parameter *const from = &out->parameter[p];
        dig_require(c, dig_name_ok(from->name),
                    "effects.parameters: \"%s\" of %s, expected " DIG_NAME_RULE, from->name,
                    text->name);
        dig_require(c, isfinite(from->value) && isfinite(from->low) && isfinite(from->high),
                    "effects.parameters: %s of %s is not finite, expected three numbers",
                    from->name, text->name);
    }
}

static int channel_of(const char *const name)
{
    for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
        if (strcmp(name, dig_channel_name((enum dig_channel)c)) == 0) {
            return c;
        }
    }
    return -1;
}

static void take_unlisted(const struct unlisted_text *const text,
                          struct dig_model_unlisted *const made, struct dig_conditions *const c)
{
    made->any = true;
    memcpy(made->depends_on, text->depends_on, sizeof made->depends_on);
    for (size_t i = 0; i < text->curves && c->status == DIG_OK; i++) {
        const struct curve_text *const from    = &text->curve[i];
        const int                      channel = channel_of(from->channel);
        bool                           finite  = true;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            finite = finite && isfinite(from->share[k]) && fabs(from->share[k]) < 1e6;
        }
        dig_require(c, from->trajectory < DIG_TRAJECTORY_MAX && channel >= 0 && finite,
                    "unlisted.curves: curve %zu: trajectory %u, channel \"%s\"; expected an index "
                    "below %d, My_Nm, Fx_N or Fz_N, and finite shares",
                    i + 1, from->trajectory, from->channel, DIG_TRAJECTORY_MAX);
        for (size_t k = 0; k < DIG_CURVE_POINTS && c->status == DIG_OK; k++) {
            made->share[from->trajectory][channel][k] = (float)from->share[k];
        }
    }
}

static void take(const char *const path, cyaml_data_t *const loaded, void *const into,
                 struct dig_conditions *const c)
{
    struct model_text *const text = loaded;
    struct dig_model *const  m    = &text->model;
    (void)path;
    dig_require(c, text->version == 1, "version: %u, expected 1", text->version);
    m->noise_floor  = number_of(text->noise_floor);
    m->error_before = number_of(text->error_before);
    m->error_after  = number_of(text->error_after);
    for (int a = 0; a < DIG_AXES; a++) {
        dig_require(c, isfinite(m->gravel.value[a]) && m->gravel.value[a] >= 0.0,
                    "gravel: is no gravel, expected numbers >= 0");
    }
    for (size_t e = 0; e < m->effects; e++) {
        take_effect(&text->effect[e], &m->effect[e], c);
    }
    for (size_t e = 0; e < m->not_applied; e++) {
        take_effect(&text->left_out[e], &m->left_out[e], c);
    }
    if (text->unlisted != NULL) {
        take_unlisted(text->unlisted, &m->unlisted, c);
    }
    if (c->status == DIG_OK) {
        *(struct dig_model *)into = *m;
    }
}

enum dig_status dig_model_read(const char *const path, struct dig_model *const model,
                               struct dig_error *const error)
{
    return dig_yaml_read(path, &schema, take, model, error);
}
