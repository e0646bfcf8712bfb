// digloop: which gravel resists like these recordings, what that gravel will resist with, and what
// the table lacks.

#include "core/streams.h"
#include "core/table_step.h"
#include "core/text.h"
#include "tables/load.h"
#include "tools/digloop/commands.h"
#include "tools/digloop/recording.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static enum dig_status run(const struct digloop_options *const options,
                           struct dig_curve_set *const set, struct dig_error *const error)
{
    static const struct {
        const char *command;
        enum dig_status (*run)(const struct digloop_job *job, struct dig_error *error);
    } of[] = {
        { "identify", digloop_identify },
        { "predict", digloop_predict },
        { "design", digloop_design },
        { "trace", digloop_trace },
    };
    struct digloop_machine machine;
    struct digloop_job     job    = { .options = options, .set = set };
    const enum dig_status  status = digloop_load_machine(&job, &machine, error);
    if (status != DIG_OK) {
        return status;
    }
    job.machine = options->machine != NULL ? &machine : NULL;
    size_t i    = 0;
    while (strcmp(options->command, of[i].command) != 0) {
        i++;
    }
    return of[i].run(&job, error);
}

// Once for every command: all of them go by the table's curves.
static void note_step(const char *const table, const struct dig_curve_set *const set)
{
    char text[DIG_TABLE_STEP_TEXT_SIZE];
    dig_table_step_text(&set->step, text);
    if (text[0] != '\0') {
        dig_text_print(stderr, "digloop: %s: %s\n", table, text);
    }
}

// Of two frictions the table knows no bend between them, which a trace may take for an effect.
static void note_few_frictions(const char *const table, const struct dig_curve_set *const set)
{
    if (set->axis_count[DIG_AXIS_FRICTION] == 2) {
        dig_text_print(
            stderr,
            "digloop: %s: gravel between its two frictions is guessed, and may be taken "
            "for an effect; three or more are needed (docs/tables.md, \"How many digs\")\n",
            table);
    }
}

int main(const int argc, char *argv[])
{
    struct digloop_options options = { .command = "" };
    struct dig_error       error   = { "" };
    dig_streams_begin();
    if (digloop_parse(argc, argv, &options, &error) != DIG_OK) {
        return digloop_refuse(argv[1], &error);
    }
    // The one command that goes by no table.
    const bool            checks = strcmp(options.command, "check") == 0;
    struct dig_curve_set *set    = NULL;
    bool                  wrong  = false;
    enum dig_status       status =
        dig_status_of_input(checks ? digloop_check(&options, &wrong, &error)
                                   : dig_table_load(options.table, &set, &error));
    if (status == DIG_OK && !checks) {
        note_step(options.table, set);
        if (strcmp(options.command, "trace") == 0) {
            note_few_frictions(options.table, set);
        }
        status = run(&options, set, &error);
    }
    dig_curve_set_destroy(set);
    if (status != DIG_OK) {
        (void)fprintf(stderr, "digloop: %s\n", error.text);
    }
    const bool input = status == DIG_EINVAL || status == DIG_ESCHEMA || status == DIG_ENOMATCH;
    return dig_streams_end("digloop", status == DIG_OK && !wrong ? EXIT_SUCCESS
                                      : input || wrong           ? 2
                                                                 : EXIT_FAILURE);
}
