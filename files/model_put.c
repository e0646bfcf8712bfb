// Writes a model: one half of files/model_json.h.

#include "core/markup.h"
#include "core/text.h"
#include "files/model_json.h"
#include "files/text/whole.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

static double finite(const double value)
{
    return isfinite(value) ? value : 0.0;
}

// A reader refuses control characters: they become '?' here.
static void put_text(FILE *const to, const char *const key, const char *const text)
{
    char clean[DIG_MODEL_PATH_SIZE];
    dig_text_copy(sizeof clean, clean, text);
    for (char *c = clean; *c != '\0'; c++) {
        if (*c == '\n' || *c == '\t') {
            *c = '?';
        }
    }
    dig_json_put(to, "%s: %s,\n ", key, clean);
}

static void put_gravel(FILE *const to, const char *const key, const struct dig_gravel *const g)
{
    dig_json_put(to, "%s: {", key);
    dig_json_gravel(to, &(const struct dig_gravel){
                            { finite(g->value[0]), finite(g->value[1]), finite(g->value[2]) } });
    (void)fputs("},\n ", to);
}

static void put_number(FILE *const to, const char *const key, const double value)
{
    if (isfinite(value)) {
        dig_json_put(to, "%s: %.9g,\n ", key, value);
    }
}

static void put_effect(FILE *const to, const struct dig_model_effect *const effect)
{
    dig_json_put(to, "{\"name\": %s, \"probability\": %.4g, \"parameters\": [",
                 dig_effect_name(effect->effect), finite(effect->probability));
    for (size_t p = 0; p < effect->parameters; p++) {
        const struct dig_model_parameter *const parameter = &effect->parameter[p];
        (void)fputs(p == 0 ? "\n   " : ",\n   ", to);
        dig_json_put(to, "{\"name\": %s, \"value\": %.9g, \"low\": %.9g, \"high\": %.9g}",
                     parameter->name, finite(parameter->value), finite(parameter->low),
                     finite(parameter->high));
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
            (void)fputs(first ? "\n  " : ",\n  ", to);
            dig_json_put(to, "{\"trajectory\": %d, \"channel\": %s, \"share\": [", t,
                         dig_channel_name((enum dig_channel)c));
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                dig_json_put(to, k == 0 ? "%g" : ", %g", finite((double)share[k]));
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
    if (model->unlisted.any) {
        put_unlisted(to, &model->unlisted);
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
