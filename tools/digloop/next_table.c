// The command that computes a table for the effects a trace found.

#include "core/shell.h"
#include "core/text.h"
#include "estimator/effects/effect.h"
#include "files/campaign_yaml.h"
#include "files/scene_yaml.h"
#include "offline_dem/dig/variant.h"
#include "tables/scene.h"
#include "tools/digloop/commands.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PACKINGS = 4 };

struct work {
    struct dig_campaign campaign;
    struct dig_scene    own, file, varied; // the table's, a file's, with an effect in it
};

// A path as a word of a shell, and never an option.
static void add_path(const size_t size, char text[], const char *const path)
{
    dig_text_add(size, text, "%s", path[0] == '-' ? "./" : "");
    const size_t used = strlen(text);
    (void)dig_shell_word(path, size - used, text + used);
}

// Three digits: what is behind them no fit knows.
static double rounded(const double value)
{
    char text[32];
    (void)snprintf(text, sizeof text, "%.3g", value);
    return strtod(text, NULL);
}

// The magnitude of a bed like what was found. False: none can hold it.
static bool magnitude_of(const struct dig_model_effect *const effect, struct work *const w,
                         double *const magnitude)
{
    // A rock that lies elsewhere has a place in place of a size.
    if (dig_variant_unit(effect->effect) == NULL || effect->parameters == 0 ||
        strcmp(effect->parameter[0].name, "ahead_m") == 0) {
        return false;
    }
    const double found = effect->parameter[0].value;
    *magnitude = dig_effect_of(effect->effect)->whole ? fmax(round(found), 1.0) : rounded(found);
    return dig_variant_make(&w->own, effect->effect, *magnitude, &w->varied, NULL) == DIG_OK;
}

static bool is_scene_of(const struct dig_curve_set *const set, const char *const path,
                        struct work *const w)
{
    char hash[sizeof set->scene_hash];
    if (dig_scene_read(path, &w->file, NULL) != DIG_OK) {
        return false;
    }
    dig_scene_hash(&w->file, hash);
    return strcmp(hash, set->scene_hash) == 0;
}

// A file that holds the table's own scene: the campaign's, or the one of its name that ships.
static bool find_scene(const struct dig_curve_set *const set, const char *const folder,
                       struct work *const w, const size_t size, char path[])
{
    if (dig_campaign_read(folder, &w->campaign, NULL) == DIG_OK &&
        is_scene_of(set, w->campaign.scene, w)) {
        (void)snprintf(path, size, "%s", w->campaign.scene);
        return true;
    }
    (void)snprintf(path, size, "config/scenes/%s.yaml", set->scene_name);
    return is_scene_of(set, path, w);
}

static void add_trajectories(const struct dig_curve_set *const set, const size_t digs,
                             const struct dig_measured measured[], const size_t size, char text[])
{
    bool dug[DIG_TRAJECTORY_MAX]                         = { false };
    char names[DIG_TRAJECTORY_MAX * (DIG_NAME_SIZE + 2)] = "";
    for (size_t i = 0; i < digs; i++) {
        dug[measured[i].trajectory] = true;
    }
    for (size_t t = 0; t < set->trajectories; t++) {
        if (dug[t]) {
            dig_text_list(sizeof names, names, set->trajectory[t].name);
        }
    }
    dig_text_add(size, text, "trajectories: [%s]\n", names);
}

static void add_grid(const struct dig_curve_set *const set, const size_t digs,
                     const struct dig_measured measured[], const struct dig_trace *const trace,
                     struct work *const w, const size_t size, char text[])
{
    dig_text_add(size, text,
                 "cat >effects_grid.yaml <<'END'\npoints:\n  - {friction: %.3g, rolling: %.3g, ",
                 trace->gravel.value[DIG_AXIS_FRICTION], trace->gravel.value[DIG_AXIS_ROLLING]);
    dig_text_add(size, text, "density_kgpm3: %.0f, packings: %d}\n",
                 trace->gravel.value[DIG_AXIS_DENSITY_kgpm3], PACKINGS);
    add_trajectories(set, digs, measured, size, text);
    dig_text_add(size, text, "effects:\n");
    for (size_t e = 0; e < trace->effects; e++) {
        double magnitude;
        if (magnitude_of(&trace->effect[e], w, &magnitude)) {
            dig_text_add(size, text, "  - {name: %s, magnitudes: [%.6g]}\n",
                         dig_effect_name(trace->effect[e].effect), magnitude);
        }
    }
    dig_text_add(size, text, "END\n");
}

enum dig_status digloop_next_table(const struct digloop_job *const job, const char *const effects,
                                   const size_t digs, const struct dig_measured measured[],
                                   struct dig_trace *const trace, struct dig_error *const error)
{
    assert(job != NULL && effects != NULL && trace != NULL);
    struct work *const w = calloc(1, sizeof *w);
    if (w == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    const enum dig_status status = dig_table_scene(job->options->table, &w->own, error);

    size_t held = 0;
    for (size_t e = 0; status == DIG_OK && !trace->no_air && e < trace->effects; e++) {
        double magnitude;
        held += magnitude_of(&trace->effect[e], w, &magnitude) ? 1 : 0;
    }
    if (held > 0) {
        char         scene[DIGLOOP_PATH_SIZE];
        char *const  text = trace->command;
        const size_t size = sizeof trace->command;
        const bool known = find_scene(job->set, job->options->recording[0], w, sizeof scene, scene);
        text[0]          = '\0';
        add_grid(job->set, digs, measured, trace, w, size, text);
        if (!known) {
            dig_text_add(size, text,
                         "# SCENE.yaml: the scene \"%s\" that the table was computed in\n",
                         w->own.name);
        }
        dig_text_add(size, text, "digtable generate ");
        add_path(size, text, known ? scene : "SCENE.yaml");
        dig_text_add(size, text, " effects_grid.yaml -o ");
        add_path(size, text, effects);
        dig_text_add(size, text, "\n");

        // Of a line that was cut a shell would make something else.
        if (strlen(text) + 1 == size) {
            text[0] = '\0';
        }
    }
    free(w);
    return status;
}
