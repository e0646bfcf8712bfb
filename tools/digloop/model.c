// Writes the result of a trace as a model file that digsightd loads.

#include "estimator/effects/effect.h"
#include "files/model_json.h"
#include "tools/digloop/commands.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// What changes from dig to dig, as a tooth wears, goes on from where the campaign left it.
static void count_digs(const size_t digs, struct dig_model_effect *const effect)
{
    const struct dig_effect *const known = dig_effect_of(effect->effect);
    if (known != NULL && known->digs_done > 0 && effect->parameters < DIG_MODEL_PARAMETERS_MAX) {
        struct dig_model_parameter *const done = &effect->parameter[effect->parameters++];
        (void)snprintf(done->name, sizeof done->name, "%s",
                       known->parameter[known->digs_done].name);
        done->value = (double)digs;
        done->low   = done->value;
        done->high  = done->value;
    }
}

// What the trace named and did not apply is told, and no part of the model.
enum dig_status digloop_save_model(const struct digloop_job *const job, const char *const effects,
                                   const struct dig_trace *const trace,
                                   struct dig_error *const       error)
{
    struct dig_model *const model = calloc(1, sizeof *model);
    if (model == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    (void)snprintf(model->table, sizeof model->table, "%s", job->options->table);
    (void)snprintf(model->effects_table, sizeof model->effects_table, "%s", effects);
    memcpy(model->scene_hash, job->set->scene_hash, sizeof model->scene_hash);
    model->gravel       = trace->applied ? trace->gravel : trace->gravel_before;
    model->low          = trace->applied ? trace->low : trace->low_before;
    model->high         = trace->applied ? trace->high : trace->high_before;
    model->noise_floor  = trace->noise_floor;
    model->error_before = trace->before.value;
    model->error_after  = trace->after.value;
    model->effects      = trace->applied ? trace->effects : 0;
    model->not_applied  = trace->effects - model->effects;
    (void)snprintf(model->provenance, sizeof model->provenance, "digloop %s trace %.200s",
                   DIG_VERSION, job->options->recording[0]);
    for (size_t e = 0; e < trace->effects; e++) {
        struct dig_model_effect *const to =
            trace->applied ? &model->effect[e] : &model->left_out[e];
        *to = trace->effect[e];
        count_digs(trace->digs, to);
    }
    model->unlisted              = trace->applied ? trace->unlisted : NULL; // the trace keeps it
    const enum dig_status status = dig_model_save(job->options->add, model, error);
    free(model);
    return status;
}
