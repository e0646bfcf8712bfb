#include "files/model_json.h"

#include "core/name.h"
#include "core/text.h"
#include "files/whole.h"
#include "files/yaml.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char *const channel_name[DIG_FORCE_CHANNELS] = { "My_Nm", "Fx_N", "Fz_N" };

static double finite(const double value)
{
    return isfinite(value) ? value : 0.0;
}

// A reader refuses control characters: they become '?' here.
static void put_text(FILE *const to, const char *const key, const char *const text)
{
    char clean[DIG_MODEL_PATH_SIZE];
    (void)snprintf(clean, sizeof clean, "%s", text);
    dig_text_clean(clean);
    for (char *c = clean; *c != '\0'; c++) {
        if (*c == '\n' || *c == '\t') {
            *c = '?';
        }
    }
    (void)fprintf(to, "\"%s\": ", key);
    dig_text_put_json(to, clean);
    (void)fputs(",\n ", to);
}

static void put_gravel(FILE *const to, const char *const key, const struct dig_gravel *const g)
{
    (void)fprintf(to, "\"%s\": ", key);
    for (int a = 0; a < DIG_AXES; a++) {
        (void)fprintf(to, "%s\"%s\": %.9g", a == 0 ? "{" : ", ", dig_axis_name((enum dig_axis)a),
                      finite(g->value[a]));
    }
    (void)fputs("},\n ", to);
}

static void put_number(FILE *const to, const char *const key, const double value)
{
    if (isfinite(value)) {
        (void)fprintf(to, "\"%s\": %.9g,\n ", key, value);
    }
}

static void put_effect(FILE *const to, const struct dig_model_effect *const effect)
{
    (void)fprintf(to, "{\"name\": \"%s\", \"probability\": %.4g, \"parameters\": [",
                  dig_effect_name(effect->effect), finite(effect->probability));
    for (size_t p = 0; p < effect->parameters; p++) {
        const struct dig_model_parameter *const parameter = &effect->parameter[p];
        (void)fprintf(to, "%s\n   {\"name\": ", p == 0 ? "" : ",");
        dig_text_put_json(to, parameter->name);
        (void)fprintf(to, ", \"value\": %.9g, \"low\": %.9g, \"high\": %.9g}",
                      finite(parameter->value), finite(parameter->low), finite(parameter->high));
    }
    (void)fputs("]}", to);
}

static void put_effects(FILE *const to, const char *const key, const size_t effects,
                        const struct dig_model_effect effect[])
{
    (void)fprintf(to, "\"%s\": [", key);
    for (size_t e = 0; e < effects; e++) {
        (void)fputs(e == 0 ? "\n  " : ",\n  ", to);
        put_effect(to, &effect[e]);
    }
    (void)fputs("]", to);
}

// Curves that are 0 throughout are left out.
static void put_unlisted(FILE *const to, const struct dig_model_unlisted *const unlisted)
{
    (void)fputs(",\n \"unlisted\": {", to);
    put_text(to, "depends_on", unlisted->depends_on);
    (void)fputs("\"curves\": [", to);
    bool first = true;
    for (int t = 0; t < DIG_TRAJECTORY_MAX; t++) {
        for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
            const float *const share = unlisted->share[t][c];
            double             most  = 0.0;
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                most = fmax(most, fabs((double)share[k]));
            }
            if (!(most > 0.0)) {
                continue;
            }
            (void)fprintf(to, "%s\n  {\"trajectory\": %d, \"channel\": \"%s\", \"share\": [",
                          first ? "" : ",", t, channel_name[c]);
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                (void)fprintf(to, "%s%.6g", k == 0 ? "" : ", ", finite((double)share[k]));
            }
            (void)fputs("]}", to);
            first = false;
        }
    }
    (void)fputs("]}", to);
}

static void write_model(FILE *const to, const struct dig_model *const model)
{
    (void)fputs("{\"version\": 1,\n ", to);
    put_text(to, "table", model->table);
    put_text(to, "effects_table", model->effects_table);
    put_text(to, "scene_hash", model->scene_hash);
    put_gravel(to, "gravel", &model->gravel);
    put_gravel(to, "low", &model->low);
    put_gravel(to, "high", &model->high);
    put_number(to, "noise_floor", model->noise_floor);
    put_number(to, "error_before", model->error_before);
    put_number(to, "error_after", model->error_after);
    put_text(to, "provenance", model->provenance);
    put_effects(to, "effects", model->effects, model->effect);
    if (model->not_applied > 0) {
        (void)fputs(",\n ", to);
        put_effects(to, "not_applied", model->not_applied, model->left_out);
    }
    if (model->unlisted != NULL) {
        put_unlisted(to, model->unlisted);
    }
    (void)fputs("}\n", to);
}

enum dig_status dig_model_save(const char *const path, const struct dig_model *const model,
                               struct dig_error *const error)
{
    assert(path != NULL && model != NULL);
    struct dig_out        out;
    const enum dig_status status = dig_out_open(&out, path, error);
    if (status != DIG_OK) {
        return status;
    }
    write_model(out.file, model);
    return dig_out_commit(&out, error);
}

#define REQUIRED CYAML_FLAG_DEFAULT
#define OPTIONAL CYAML_FLAG_OPTIONAL

struct gravel_text {
    double friction, rolling, density_kgpm3;
};

struct parameter_text {
    char   name[DIG_NAME_SIZE];
    double value, low, high;
};

struct effect_text {
    char                  name[DIG_NAME_SIZE];
    double                probability;
    struct parameter_text parameters[DIG_MODEL_PARAMETERS_MAX];
    uint32_t              parameters_count;
};

struct curve_text {
    uint32_t trajectory;
    char     channel[DIG_NAME_SIZE];
    double   share[DIG_CURVE_POINTS];
    uint32_t share_count;
};

struct unlisted_text {
    char              depends_on[128];
    struct curve_text curves[DIG_TRAJECTORY_MAX * DIG_FORCE_CHANNELS];
    uint32_t          curves_count;
};

struct model_text {
    uint32_t              version;
    char                  table[DIG_MODEL_PATH_SIZE], effects_table[DIG_MODEL_PATH_SIZE];
    char                  scene_hash[65];
    char                  provenance[256];
    struct gravel_text    gravel, low, high;
    double               *noise_floor, *error_before, *error_after;
    struct effect_text    effects[DIG_MODEL_EFFECTS_MAX], not_applied[DIG_MODEL_EFFECTS_MAX];
    uint32_t              effects_count, not_applied_count;
    struct unlisted_text *unlisted;
};

static const cyaml_schema_field_t gravel_fields[] = {
    CYAML_FIELD_FLOAT("friction", REQUIRED, struct gravel_text, friction),
    CYAML_FIELD_FLOAT("rolling", REQUIRED, struct gravel_text, rolling),
    CYAML_FIELD_FLOAT("density_kgpm3", REQUIRED, struct gravel_text, density_kgpm3),
    CYAML_FIELD_END,
};

static const cyaml_schema_field_t parameter_fields[] = {
    CYAML_FIELD_STRING("name", REQUIRED, struct parameter_text, name, 1),
    CYAML_FIELD_FLOAT("value", REQUIRED, struct parameter_text, value),
    CYAML_FIELD_FLOAT("low", REQUIRED, struct parameter_text, low),
    CYAML_FIELD_FLOAT("high", REQUIRED, struct parameter_text, high),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t parameter = { CYAML_VALUE_MAPPING(REQUIRED, struct parameter_text,
                                                                    parameter_fields) };

static const cyaml_schema_field_t effect_fields[] = {
    CYAML_FIELD_STRING("name", REQUIRED, struct effect_text, name, 1),
    CYAML_FIELD_FLOAT("probability", REQUIRED, struct effect_text, probability),
    CYAML_FIELD_SEQUENCE("parameters", REQUIRED, struct effect_text, parameters, &parameter, 0,
                         DIG_MODEL_PARAMETERS_MAX),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t effect = { CYAML_VALUE_MAPPING(REQUIRED, struct effect_text,
                                                                 effect_fields) };

static const cyaml_schema_value_t share = { CYAML_VALUE_FLOAT(REQUIRED, double) };

static const cyaml_schema_field_t curve_fields[] = {
    CYAML_FIELD_UINT("trajectory", REQUIRED, struct curve_text, trajectory),
    CYAML_FIELD_STRING("channel", REQUIRED, struct curve_text, channel, 1),
    CYAML_FIELD_SEQUENCE("share", REQUIRED, struct curve_text, share, &share, DIG_CURVE_POINTS,
                         DIG_CURVE_POINTS),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t curve = { CYAML_VALUE_MAPPING(REQUIRED, struct curve_text,
                                                                curve_fields) };

static const cyaml_schema_field_t unlisted_fields[] = {
    CYAML_FIELD_STRING("depends_on", REQUIRED, struct unlisted_text, depends_on, 0),
    CYAML_FIELD_SEQUENCE("curves", REQUIRED, struct unlisted_text, curves, &curve, 0,
                         DIG_TRAJECTORY_MAX *DIG_FORCE_CHANNELS),
    CYAML_FIELD_END,
};

#define GRAVEL(name) CYAML_FIELD_MAPPING(#name, REQUIRED, struct model_text, name, gravel_fields)
#define NUMBER(name)                                                                               \
    CYAML_FIELD_FLOAT_PTR(#name, CYAML_FLAG_POINTER | OPTIONAL, struct model_text, name)

static const cyaml_schema_field_t fields[] = {
    CYAML_FIELD_UINT("version", REQUIRED, struct model_text, version),
    CYAML_FIELD_STRING("table", REQUIRED, struct model_text, table, 0),
    CYAML_FIELD_STRING("effects_table", REQUIRED, struct model_text, effects_table, 0),
    CYAML_FIELD_STRING("scene_hash", REQUIRED, struct model_text, scene_hash, 64),
    GRAVEL(gravel),
    GRAVEL(low),
    GRAVEL(high),
    NUMBER(noise_floor),
    NUMBER(error_before),
    NUMBER(error_after),
    CYAML_FIELD_STRING("provenance", REQUIRED, struct model_text, provenance, 0),
    CYAML_FIELD_SEQUENCE("effects", REQUIRED, struct model_text, effects, &effect, 0,
                         DIG_MODEL_EFFECTS_MAX),
    CYAML_FIELD_SEQUENCE("not_applied", OPTIONAL, struct model_text, not_applied, &effect, 0,
                         DIG_MODEL_EFFECTS_MAX),
    CYAML_FIELD_MAPPING_PTR("unlisted", CYAML_FLAG_POINTER | OPTIONAL, struct model_text, unlisted,
                            unlisted_fields),
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = { CYAML_VALUE_MAPPING(CYAML_FLAG_POINTER,
                                                                 struct model_text, fields) };

static struct dig_gravel gravel_of(const struct gravel_text *const text)
{
    return (struct dig_gravel){ { text->friction, text->rolling, text->density_kgpm3 } };
}

static double number_of(const double *const number)
{
    return number != NULL ? *number : (double)NAN;
}

static enum dig_status take_effect(const char *const path, const struct effect_text *const text,
                                   struct dig_model_effect *const out,
                                   struct dig_error *const        error)
{
    const int id = dig_effect_find(text->name);
    if (id < 0) {
        return dig_yaml_refuse(path, "effects.name", error,
                               "\"%s\", expected the name of an effect of the catalogue",
                               text->name);
    }
    if (!(text->probability >= 0.0 && text->probability <= 1.0)) {
        return dig_yaml_refuse(path, "effects.probability", error, "%g, expected 0 to 1",
                               text->probability);
    }
    *out = (struct dig_model_effect){
        .effect      = (enum dig_effect_id)id,
        .probability = text->probability,
        .parameters  = text->parameters_count,
    };
    for (size_t p = 0; p < out->parameters; p++) {
        const struct parameter_text *const from = &text->parameters[p];
        if (!dig_name_ok(from->name)) {
            return dig_yaml_refuse(path, "effects.parameters", error,
                                   "\"%s\" of %s, expected " DIG_NAME_RULE, from->name, text->name);
        }
        if (!(isfinite(from->value) && isfinite(from->low) && isfinite(from->high))) {
            return dig_yaml_refuse(path, "effects.parameters", error,
                                   "%s of %s is not finite, expected three numbers", from->name,
                                   text->name);
        }
        out->parameter[p] = (struct dig_model_parameter){ .value = from->value,
                                                          .low   = from->low,
                                                          .high  = from->high };
        memcpy(out->parameter[p].name, from->name, sizeof from->name);
    }
    return DIG_OK;
}

static int channel_of(const char *const name)
{
    for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
        if (strcmp(name, channel_name[c]) == 0) {
            return c;
        }
    }
    return -1;
}

static enum dig_status take_unlisted(const char *const path, const struct unlisted_text *const text,
                                     struct dig_model_unlisted **const out,
                                     struct dig_error *const           error)
{
    struct dig_model_unlisted *const made = calloc(1, sizeof *made);
    if (made == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%s: out of memory", path);
    }
    memcpy(made->depends_on, text->depends_on, sizeof made->depends_on);
    for (size_t i = 0; i < text->curves_count; i++) {
        const struct curve_text *const from    = &text->curves[i];
        const int                      channel = channel_of(from->channel);
        bool                           finite  = true;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            finite = finite && isfinite(from->share[k]) && fabs(from->share[k]) < 1e6;
        }
        if (from->trajectory >= DIG_TRAJECTORY_MAX || channel < 0 || !finite) {
            free(made);
            return dig_yaml_refuse(path, "unlisted.curves", error,
                                   "curve %zu: trajectory %u, channel \"%s\"; expected an index "
                                   "below %d, My_Nm, Fx_N or Fz_N, and finite shares",
                                   i + 1, from->trajectory, from->channel, DIG_TRAJECTORY_MAX);
        }
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            made->share[from->trajectory][channel][k] = (float)from->share[k];
        }
    }
    *out = made;
    return DIG_OK;
}

static enum dig_status take(const char *const path, const struct model_text *const text,
                            struct dig_model *const model, struct dig_error *const error)
{
    if (text->version != 1) {
        return dig_yaml_refuse(path, "version", error, "%u, expected 1", text->version);
    }
    struct dig_model m = {
        .gravel       = gravel_of(&text->gravel),
        .low          = gravel_of(&text->low),
        .high         = gravel_of(&text->high),
        .noise_floor  = number_of(text->noise_floor),
        .error_before = number_of(text->error_before),
        .error_after  = number_of(text->error_after),
        .effects      = text->effects_count,
        .not_applied  = text->not_applied_count,
    };
    memcpy(m.table, text->table, sizeof m.table);
    memcpy(m.effects_table, text->effects_table, sizeof m.effects_table);
    memcpy(m.scene_hash, text->scene_hash, sizeof m.scene_hash);
    memcpy(m.provenance, text->provenance, sizeof m.provenance);
    for (int a = 0; a < DIG_AXES; a++) {
        if (!(isfinite(m.gravel.value[a]) && m.gravel.value[a] >= 0.0)) {
            return dig_yaml_refuse(path, "gravel", error, "is no gravel, expected numbers >= 0");
        }
    }
    enum dig_status status = DIG_OK;
    for (size_t e = 0; e < m.effects && status == DIG_OK; e++) {
        status = take_effect(path, &text->effects[e], &m.effect[e], error);
    }
    for (size_t e = 0; e < m.not_applied && status == DIG_OK; e++) {
        status = take_effect(path, &text->not_applied[e], &m.left_out[e], error);
    }
    if (status == DIG_OK && text->unlisted != NULL) {
        status = take_unlisted(path, text->unlisted, &m.unlisted, error);
    }
    if (status == DIG_OK) {
        *model = m;
    }
    return status;
}

enum dig_status dig_model_read(const char *const path, struct dig_model *const model,
                               struct dig_error *const error)
{
    assert(path != NULL && model != NULL);
    cyaml_data_t   *data   = NULL;
    enum dig_status status = dig_yaml_load(path, &schema, &data, error);
    if (status == DIG_OK) {
        status = take(path, data, model, error);
        dig_yaml_free(&schema, data);
    }
    return status;
}
