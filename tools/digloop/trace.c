// digloop trace: finds what the model lacks in the recordings of a campaign.

#include "closed_loop/verdict/trace.h"
#include "closed_loop/report/trace_report.h"
#include "core/text.h"
#include "estimator/effects/effect.h"
#include "files/model_json.h"
#include "files/text/whole.h"
#include "tables/load.h"
#include "tools/digloop/campaign.h"
#include "tools/digloop/commands.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// TABLE_effects.sqlite beside TABLE.sqlite.
static void name_effects(const char *const table, char path[const DIGLOOP_PATH_SIZE])
{
    const char *const dot = strrchr(table, '.');
    const int         stem =
        dot != NULL && strchr(dot, '/') == NULL ? (int)(dot - table) : (int)strlen(table);
    (void)snprintf(path, DIGLOOP_PATH_SIZE, "%.*s_effects%s", stem, table, table + stem);
}

static void say_without_beds(const char *const path)
{
    dig_text_print(stderr,
                   "digloop: no %s: of the soil's effects only those are named that need no beds (",
                   path);
    const char *before = "";
    for (int e = DIG_MACHINE_EFFECTS; e < DIG_EFFECT_UNLISTED; e++) {
        if (!dig_effect_of((enum dig_effect_id)e)->templated) {
            (void)fprintf(stderr, "%s%s", before, dig_effect_name((enum dig_effect_id)e));
            before = ", ";
        }
    }
    (void)fputs("), and anything else is \"unlisted\"\n", stderr);
}

// The table of effects asked for, or the one beside the table, which path names, too, when there is
// none: then it says so and leaves *effects.
static enum dig_status load_effects(const struct digloop_job *const job,
                                    char                            path[const DIGLOOP_PATH_SIZE],
                                    struct dig_entry_set **const    effects,
                                    struct dig_error *const         error)
{
    struct stat found;
    if (job->options->effects != NULL) {
        (void)snprintf(path, DIGLOOP_PATH_SIZE, "%s", job->options->effects);
    } else {
        name_effects(job->options->table, path);
        if (stat(path, &found) != 0) {
            say_without_beds(path);
            return DIG_OK;
        }
    }
    return dig_status_of_input(dig_effects_load(path, job->set, effects, error));
}

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

// A force sensor stays with its recordings: the gravel is told without it, and no machine has it.
static bool is_for_model(const struct dig_trace *const trace, const bool machine, const size_t e)
{
    return trace->applied && (machine || !dig_effect_is_of_machine(trace->effect[e].effect));
}

// Writes the model file that digsightd loads, with the files it needs. What the trace named and did
// not apply is told, and no part of the model.
static enum dig_status save_model(const struct digloop_job *const job, const char *const effects,
                                  const bool machine, const struct dig_trace *const trace,
                                  struct dig_error *const error)
{
    struct dig_model *const model = calloc(1, sizeof *model);
    if (model == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    (void)snprintf(model->table, sizeof model->table, "%s", job->options->table);
    dig_text_copy(sizeof model->effects_table, model->effects_table, effects);
    memcpy(model->scene_hash, job->set->scene_hash, sizeof model->scene_hash);
    model->gravel       = trace->applied ? trace->gravel : trace->gravel_before;
    model->low          = trace->applied ? trace->low : trace->low_before;
    model->high         = trace->applied ? trace->high : trace->high_before;
    model->noise_floor  = trace->noise_floor;
    model->error_before = trace->before.value;
    model->error_after  = trace->after.value;
    (void)snprintf(model->provenance, sizeof model->provenance, "digloop %s trace %.200s",
                   DIG_VERSION, job->options->recording[0]);
    for (size_t e = 0; e < trace->effects; e++) {
        struct dig_model_effect *const to = is_for_model(trace, machine, e)
                                                ? &model->effect[model->effects++]
                                                : &model->left_out[model->not_applied++];
        *to                               = trace->effect[e];
        count_digs(trace->judged.digs, to);
    }
    if (trace->applied) {
        model->unlisted = trace->unlisted;
    }
    const enum dig_status status = dig_model_save(job->options->add, model, error);
    free(model);
    return status;
}

static enum dig_status write_results(const struct digloop_job *const job, const char *const effects,
                                     const struct digloop_campaign *const campaign,
                                     const struct dig_trace *const        trace,
                                     struct dig_error *const              error)
{
    const struct digloop_options *const options = job->options;
    struct dig_out                      out;
    enum dig_status                     status = DIG_OK;
    if (dig_out_begin(&out, options->json_out, &status, error)) {
        dig_trace_json(trace, out.file);
        status = dig_out_commit(&out, error);
    }
    if (dig_out_begin(&out, options->html, &status, error)) {
        const struct dig_trace_subject subject = {
            .campaign = options->recording[0],
            .table    = options->table,
            .lambda   = campaign->lambda,
        };
        status = dig_out_end(&out, dig_trace_html(trace, &subject, out.file, error), error);
    }
    if (status == DIG_OK && options->add != NULL) {
        status = save_model(job, effects, campaign->machine != NULL, trace, error);
    }
    // Where programs are to read the result, people read on standard error.
    const bool for_program =
        options->json_out != NULL || options->add != NULL || dig_out_is_stdout(options->html);
    if (!options->quiet) {
        dig_trace_text(trace, for_program ? stderr : stdout);
    }
    return status;
}

enum dig_status digloop_trace(const struct digloop_job *const job, struct dig_error *const error)
{
    char                    path[DIGLOOP_PATH_SIZE];
    struct dig_entry_set   *effects  = NULL;
    struct digloop_campaign campaign = { .digs = 0 };
    struct dig_trace       *trace    = calloc(1, sizeof *trace);
    enum dig_status         status   = trace != NULL ? DIG_OK : DIG_ENOMEM;
    if (status == DIG_OK) {
        status = load_effects(job, path, &effects, error);
    }
    if (status == DIG_OK) {
        status = digloop_campaign_load(job, &campaign, error);
    }
    if (status == DIG_OK) {
        const struct dig_trace_settings settings = dig_trace_settings_default();
        status                                   = dig_error_name(error,
                                                                  dig_trace_run(job->set, job->options->table, effects, &settings,
                                                                                campaign.machine, campaign.digs, campaign.measured,
                                                                                trace, error),
                                                                  "%s", job->options->recording[0]);
    }
    if (status == DIG_OK) {
        status = digloop_next_table(job, path, campaign.digs, campaign.measured, trace, error);
    }
    if (status == DIG_OK) {
        status = write_results(job, effects != NULL ? path : "", &campaign, trace, error);
    }
    if (trace != NULL) {
        dig_trace_finish(trace);
    }
    free(trace);
    digloop_campaign_finish(&campaign);
    dig_entry_set_destroy(effects);
    return status;
}
