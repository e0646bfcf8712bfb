// What a configuration and all it names turned out to be, for people and for programs.

#include "core/markup.h"
#include "core/table_step.h"
#include "firmware_host/daemon_private.h"

#include <assert.h>
#include <string.h>

#define LINE 512

static double scale_of(const struct dig_loaded *const l, const struct dig_curve_set *const set)
{
    return l->machine.link[DIG_JOINT_BUCKET].length_m / set->tooth_m;
}

void dig_daemon_describe(const struct dig_daemon *const d, void (*const say)(const char *line))
{
    assert(d != NULL && say != NULL);
    const struct dig_loaded *const    l   = &d->loaded;
    const struct dig_curve_set *const set = d->fit.matcher.set; // the table in use
    char                              line[LINE];
    char                              digs[LINE] = "";
    char                              trembles[DIG_TABLE_STEP_TEXT_SIZE];
    for (size_t t = 0; t < set->trajectories; t++) {
        const size_t used = strlen(digs);
        (void)snprintf(digs + used, sizeof digs - used, "%s%s%s", used > 0 ? ", " : "",
                       set->trajectory[t].name,
                       dig_config_identifies(&l->config, set->trajectory[t].name) ? " (identifies)"
                                                                                  : "");
    }
    (void)snprintf(line, sizeof line, "table %.200s: scene %s (%.12s…), %zu gravels, digs: %.150s",
                   l->config.table.text, set->scene_name, set->scene_hash, set->entries, digs);
    say(line);
    dig_table_step_text(&set->step, trembles);
    if (trembles[0] != '\0') {
        (void)snprintf(line, sizeof line, "table: %s", trembles);
        say(line);
    }
    (void)snprintf(line, sizeof line, "machine %s: bucket %.3f m, %.2f times the table's",
                   l->machine.name, l->machine.link[DIG_JOINT_BUCKET].length_m, scale_of(l, set));
    say(line);
    if (!l->machine.sensor.fitted) {
        // Not by the daemon, which has no closed loop: its log is what is checked.
        (void)snprintf(line, sizeof line,
                       "does the machine file fit? Log a minute in free air: digloop check %.200s "
                       "AIR.lcm",
                       l->config.machine.text);
        say(line);
    }
    (void)snprintf(line, sizeof line, "input %s; tick %.0f Hz; LCM %s", d->input.name,
                   1.0 / l->config.tick_s, l->config.lcm_url);
    say(line);
    char missing[DIG_SIGNAL_NAMES_SIZE];
    dig_signal_name_missing(l->measured, sizeof missing, missing);
    if (missing[0] != '\0') {
        (void)snprintf(line, sizeof line, "not measured: %s; the moment is told, the force is not",
                       missing);
        say(line);
    }
}

void dig_daemon_describe_json(const struct dig_daemon *const d, FILE *const file)
{
    assert(d != NULL && file != NULL);
    const struct dig_loaded *const    l   = &d->loaded;
    const struct dig_curve_set *const set = d->fit.matcher.set;
    dig_json_put(file,
                 "{\"table\": {\"path\": %s, \"scene\": %s, \"scene_hash\": %s, \"gravels\": %zu,\n"
                 "  \"digs\": [",
                 l->config.table.text, set->scene_name, set->scene_hash, set->entries);
    for (size_t t = 0; t < set->trajectories; t++) {
        const char *const name = set->trajectory[t].name;
        (void)fputs(t == 0 ? "" : ", ", file);
        dig_json_put(file, "{\"name\": %s, \"identifies\": %i}", name,
                     dig_config_identifies(&l->config, name));
    }
    dig_json_put(file,
                 "]},\n \"machine\": {\"name\": %s, \"bucket_m\": %.9g, \"scale\": %.9g},\n"
                 " \"input\": %s, \"tick_Hz\": %.9g, \"lcm_url\": %s,\n \"not_measured\": [",
                 l->machine.name, l->machine.link[DIG_JOINT_BUCKET].length_m, scale_of(l, set),
                 d->input.name, 1.0 / l->config.tick_s, l->config.lcm_url);
    const enum dig_sensing sensing = dig_signals_sensing(l->measured);
    const char            *comma   = "";
    for (int i = 0; i < DIG_SIGNALS; i++) {
        const enum dig_signal signal = (enum dig_signal)i;
        if (!l->measured[i] && dig_signal_is_needed(sensing, signal)) {
            (void)fputs(comma, file);
            dig_json_put(file, "%s", dig_signal_name(signal));
            comma = ", ";
        }
    }
    (void)fputs("]}\n", file);
}
