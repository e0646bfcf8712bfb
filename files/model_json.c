#include "files/model_json.h"

#include "core/name.h"
#include "files/text/whole.h"
#include "files/yaml/yaml.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

struct effect_text {
    char                    name[DIG_NAME_SIZE];
    struct dig_model_effect effect; // but for its id
};

struct curve_text {
    uint32_t trajectory;
    int      channel;
    double   share[DIG_CURVE_POINTS];
};

// The model, but for what is named or of another type in the file.
struct model_text {
    struct dig_model   model;
    uint32_t           version;
    struct effect_text effect[DIG_MODEL_EFFECTS_MAX], left_out[DIG_MODEL_EFFECTS_MAX];
    struct curve_text  curve[DIG_TRAJECTORY_MAX * DIG_FORCE_CHANNELS];
    size_t             curves;
};

static const struct model_text defaults = {
    .model = { .noise_floor = (double)NAN, .error_before = (double)NAN, .error_after = (double)NAN }
};

static const struct dig_yaml_field parameter_fields[] = {
    TEXT(dig_model_parameter, name),
    NUMBER(dig_model_parameter, value),
    NUMBER(dig_model_parameter, low),
    NUMBER(dig_model_parameter, high),
    END,
};
static const struct dig_yaml_field parameter = ENTRY(dig_model_parameter, parameter_fields);

static const struct dig_yaml_field effect_fields[] = {
    TEXT(effect_text, name),
    FIELD(NUMBER, "probability", effect_text, effect.probability, REQUIRED, .low = 0.0,
          .high = 1.0),
    LIST("parameters", REQUIRED, effect_text, effect.parameter, effect.parameters, &parameter, 0),
    END,
};
static const struct dig_yaml_field effect = ENTRY(effect_text, effect_fields);

static const struct dig_yaml_word channels[] = { { "My_Nm", DIG_CHANNEL_MY_Nm },
                                                 { "Fx_N", DIG_CHANNEL_FX_N },
                                                 { "Fz_N", DIG_CHANNEL_FZ_N },
                                                 { .word = NULL } };

static const struct dig_yaml_field share = {
    .kind = DIG_YAML_NUMBER, .size = sizeof(double), .low = -1e6, .high = 1e6
};

static const struct dig_yaml_field curve_fields[] = {
    FIELD(COUNT, "trajectory", curve_text, trajectory, REQUIRED, .high = DIG_TRAJECTORY_MAX - 1),
    FIELD(WORD, "channel", curve_text, channel, REQUIRED, .word = channels),
    FIELD(LIST, "share", curve_text, share, REQUIRED, .of = &share),
    END,
};
static const struct dig_yaml_field curve = ENTRY(curve_text, curve_fields);

static const struct dig_yaml_field unlisted_fields[] = {
    FIELD(TEXT, "depends_on", model_text, model.unlisted.depends_on, REQUIRED),
    LIST("curves", REQUIRED, model_text, curve, curves, &curve, 0),
    END,
};

#define OF_MODEL(kind, name, ...) FIELD(kind, #name, model_text, model.name, __VA_ARGS__)
#define WORDS(name, least_)       OF_MODEL(TEXT, name, REQUIRED, .least = (least_))
#define GRAVEL(name)              OF_MODEL(MAPPING, name, REQUIRED, .of = dig_yaml_gravel)

static const struct dig_yaml_field fields[] = {
    FIELD(COUNT, "version", model_text, version, REQUIRED),
    WORDS(table, 0),
    WORDS(effects_table, 0),
    WORDS(scene_hash, 64),
    GRAVEL(gravel),
    GRAVEL(low),
    GRAVEL(high),
    OF_MODEL(NUMBER, noise_floor, OPTIONAL),
    OF_MODEL(NUMBER, error_before, OPTIONAL),
    OF_MODEL(NUMBER, error_after, OPTIONAL),
    WORDS(provenance, 0),
    LIST("effects", REQUIRED, model_text, effect, model.effects, &effect, 0),
    LIST("not_applied", OPTIONAL, model_text, left_out, model.not_applied, &effect, 0),
    { .key  = "unlisted",
      .kind = DIG_YAML_MAPPING,
      OPTIONAL,
      .of = unlisted_fields,
      GIVEN(model_text, model.unlisted.any) },
    END,
};

static const struct dig_yaml_file schema = { .of       = fields,
                                             .size     = sizeof(struct model_text),
                                             .kept     = sizeof(struct dig_model),
                                             .defaults = &defaults };

static void take_effect(const struct effect_text *const text, struct dig_model_effect *const out,
                        struct dig_conditions *const c)
{
    const int id = dig_effect_find(text->name);
    *out         = text->effect;
    out->effect  = (enum dig_effect_id)id;
    dig_require(c, id >= 0, "effects.name: \"%s\", expected the name of an effect of the catalogue",
                text->name);
    for (size_t p = 0; p < out->parameters; p++) {
        const struct dig_model_parameter *const from = &out->parameter[p];
        dig_require(c, dig_name_ok(from->name),
                    "effects.parameters: \"%s\" of %s, expected " DIG_NAME_RULE, from->name,
                    text->name);
    }
}

static void take(const char *const path, void *const loaded, struct dig_conditions *const c)
{
    struct model_text *const text = loaded;
    struct dig_model *const  m    = &text->model;
    (void)path;
    dig_require(c, text->version == 1, "version: %u, expected 1", text->version);
    for (int a = 0; a < DIG_AXES; a++) {
        dig_require(c, m->gravel.value[a] >= 0.0, "gravel: is no gravel, expected numbers >= 0");
    }
    for (size_t e = 0; e < m->effects; e++) {
        take_effect(&text->effect[e], &m->effect[e], c);
    }
    for (size_t e = 0; e < m->not_applied; e++) {
        take_effect(&text->left_out[e], &m->left_out[e], c);
    }
    for (size_t i = 0; i < text->curves; i++) {
        const struct curve_text *const from = &text->curve[i];
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            m->unlisted.share[from->trajectory][from->channel][k] = (float)from->share[k];
        }
    }
}

static void put_effects(const size_t effects, const struct dig_model_effect from[],
                        struct effect_text text[])
{
    for (size_t e = 0; e < effects; e++) {
        text[e].effect = from[e];
        (void)snprintf(text[e].name, sizeof text[e].name, "%s", dig_effect_name(from[e].effect));
    }
}

// Curves that are 0 throughout are left out.
static void put_curves(const struct dig_model_unlisted *const unlisted,
                       struct model_text *const               text)
{
    for (size_t t = 0; t < DIG_TRAJECTORY_MAX; t++) {
        for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
            struct curve_text *const to  = &text->curve[text->curves];
            bool                     any = false;
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                to->share[k] = (double)unlisted->share[t][c][k];
                any          = any || fabs(to->share[k]) > 0.0;
            }
            to->trajectory = (uint32_t)t;
            to->channel    = c;
            text->curves += any ? 1 : 0;
        }
    }
}

enum dig_status dig_model_save(const char *const path, const struct dig_model *const model,
                               struct dig_error *const error)
{
    assert(path != NULL && model != NULL);
    struct dig_out           out;
    struct model_text *const text = calloc(1, sizeof *text);
    if (text == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory", path);
    }
    text->model   = *model;
    text->version = 1;
    put_effects(model->effects, model->effect, text->effect);
    put_effects(model->not_applied, model->left_out, text->left_out);
    put_curves(&model->unlisted, text);
    enum dig_status status = dig_out_open(&out, path, error);
    if (status == DIG_OK) {
        dig_json_write(out.file, &schema, text);
        status = dig_out_commit(&out, error);
    }
    free(text);
    return status;
}

enum dig_status dig_model_read(const char *const path, struct dig_model *const model,
                               struct dig_error *const error)
{
    return dig_yaml_read(path, &schema, take, model, error);
}
