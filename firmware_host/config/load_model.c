#include "firmware_host/config/load_model.h"

#include "core/entry_set.h"
#include "core/name.h"
#include "estimator/effects/effect.h"
#include "files/model_json.h"
#include "files/yaml/yaml.h"
#include "tables/load.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// The file of that name beside another, when there is one; else the name as it stands.
static void find_beside(const char *const beside, const char *const name, const size_t size,
                        char path[])
{
    if (!dig_path_beside(beside, dig_path_last(name), size, path) || access(path, R_OK) != 0) {
        (void)snprintf(path, size, "%s", name);
    }
}

static bool needs_curves(const struct dig_model *const model)
{
    bool needs = model->unlisted.any;
    for (size_t e = 0; e < model->effects; e++) {
        needs = needs || !dig_effect_is_of_machine(model->effect[e].effect);
    }
    return needs;
}

// Applies the change of the plain curve to one at another depth or attack, in proportion to its
// size.
static void follow(const struct dig_curve *const before, const struct dig_curve *const after,
                   struct dig_curve *const curve)
{
    for (int c = 0; c < DIG_CHANNELS; c++) {
        const double plain = sqrt(dig_curve_mean_square(before->mean[c]));
        const double scale =
            plain > 0.0 ? sqrt(dig_curve_mean_square(curve->mean[c])) / plain : 0.0;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double change = (double)after->mean[c][k] - (double)before->mean[c][k];
            curve->mean[c][k] += (float)(scale * change);
        }
    }
}

static void change_approaches(const struct dig_curve_set *const before,
                              const struct dig_curve_set *const after)
{
    const struct dig_entry_set *const other = after->approaches;
    for (size_t i = 0; other != NULL && i < other->entries; i++) {
        size_t e = 0;
        while (e < after->entries &&
               !dig_gravel_is_same(&after->gravel[e], &other->entry[i].gravel)) {
            e++;
        }
        for (size_t t = 0; e < after->entries && t < after->trajectories; t++) {
            const size_t slot = e * after->trajectories + t;
            follow(&before->curve[slot], &after->curve[slot],
                   &other->curve[i * other->trajectories + t]);
        }
    }
}

// Applies the model's effects to every curve of *set; the plain table is read once more.
static enum dig_status change_curves(const char *const model_path, const char *const table_path,
                                     const struct dig_model *const model,
                                     struct dig_curve_set *const set, struct dig_error *const error)
{
    struct dig_curve_set *plain   = NULL;
    struct dig_entry_set *effects = NULL;
    enum dig_status       status  = dig_table_load(table_path, &plain, error);
    if (status == DIG_OK &&
        (plain->entries != set->entries || strcmp(plain->scene_hash, set->scene_hash) != 0)) {
        status = dig_error_set(error, DIG_EINVAL, "%s: it changed while it was read", table_path);
    }
    if (status == DIG_OK && model->effects_table[0] != '\0') {
        char path[DIG_MODEL_PATH_SIZE];
        find_beside(table_path, model->effects_table, sizeof path, path);
        status = dig_effects_load(path, plain, &effects, error);
    }
    if (status == DIG_OK && dig_effects_apply(plain, effects, model, set) != DIG_OK) {
        status =
            dig_yaml_refuse(model_path, error,
                            "effects: an effect of the soil that no table at hand tells, or a "
                            "parameter it does not have; expected those of the table of effects");
    }
    if (status == DIG_OK && plain != NULL) {
        change_approaches(plain, set);
    }
    dig_entry_set_destroy(effects);
    dig_curve_set_destroy(plain);
    return status;
}

static enum dig_status
correct(const char *const path, const char *const table_path, const struct dig_model *const model,
        const struct dig_machine *const machine, const struct dig_curve_set *const set,
        struct dig_corrected_machine *const corrected, struct dig_error *const error)
{
    struct dig_correction found;
    if (strcmp(model->scene_hash, set->scene_hash) != 0) {
        return dig_yaml_refuse(path, error, "scene_hash: %.12s…, but %s is of scene %.12s…",
                               model->scene_hash, table_path, set->scene_hash);
    }
    if (dig_effects_correction(model, &found) != DIG_OK ||
        (machine != NULL && dig_correction_apply(machine, &found, corrected) != DIG_OK)) {
        return dig_yaml_refuse(path, error,
                               "effects: the machine %s cannot be so, expected parameters of the "
                               "catalogue with which its linkages still close",
                               machine != NULL ? machine->name : "of the model");
    }
    return DIG_OK;
}

enum dig_status dig_load_model(const char *const model_path, const char *const table_path,
                               const struct dig_machine *const     machine,
                               struct dig_curve_set *const         set,
                               struct dig_corrected_machine *const corrected,
                               struct dig_error *const             error)
{
    assert(model_path != NULL && table_path != NULL && set != NULL && corrected != NULL);
    struct dig_model             model  = { .effects = 0 };
    struct dig_corrected_machine made   = { .corrects = false };
    enum dig_status              status = dig_model_read(model_path, &model, error);
    if (status == DIG_OK) {
        status = correct(model_path, table_path, &model, machine, set, &made, error);
    }
    if (status == DIG_OK && needs_curves(&model)) {
        status = change_curves(model_path, table_path, &model, set, error);
    }
    if (status == DIG_OK) {
        *corrected = made;
    }
    return status;
}
