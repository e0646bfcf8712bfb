#include "firmware_host/config/describe.h"

#include "core/table_step.h"
#include "core/text.h"

#include <assert.h>
#include <string.h>

#define LINE 512

static double scale_of(const struct dig_loaded *const l, const struct dig_curve_set *const set)
{
    return l->machine.link[DIG_JOINT_BUCKET].length_m / set->tooth_m;
}

void dig_describe(const struct dig_loaded *const l, const struct dig_curve_set *const set,
                  const char *const input, void (*const say)(const char *line))
{
    assert(l != NULL && set != NULL && input != NULL && say != NULL);
    char line[LINE];
    char digs[LINE] = "";
    char trembles[DIG_TABLE_STEP_TEXT_SIZE];
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
    (void)snprintf(line, sizeof line, "input %s; tick %.0f Hz; LCM %s", input,
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

static void put(FILE *const file, const char *const before, const char *const text)
{
    (void)fputs(before, file);
    dig_text_put_json(file, text);
}

void dig_describe_json(const struct dig_loaded *const l, const struct dig_curve_set *const set,
                       const char *const input, FILE *const file)
{
    assert(l != NULL && set != NULL && input != NULL && file != NULL);
    put(file, "{\"table\": {\"path\": ", l->config.table.text);
    put(file, ", \"scene\": ", set->scene_name);
    put(file, ", \"scene_hash\": ", set->scene_hash);
    (void)fprintf(file, ", \"gravels\": %zu,\n  \"digs\": [", set->entries);
    for (size_t t = 0; t < set->trajectories; t++) {
        put(file, t == 0 ? "{\"name\": " : ", {\"name\": ", set->trajectory[t].name);
        (void)fprintf(file, ", \"identifies\": %s}",
                      dig_config_identifies(&l->config, set->trajectory[t].name) ? "true"
                                                                                 : "false");
    }
    put(file, "]},\n \"machine\": {\"name\": ", l->machine.name);
    (void)fprintf(file, ", \"bucket_m\": %.9g, \"scale\": %.9g},\n",
                  l->machine.link[DIG_JOINT_BUCKET].length_m, scale_of(l, set));
    put(file, " \"input\": ", input);
    (void)fprintf(file, ", \"tick_Hz\": %.9g", 1.0 / l->config.tick_s);
    put(file, ", \"lcm_url\": ", l->config.lcm_url);
    (void)fputs(",\n \"not_measured\": [", file);
    const enum dig_sensing sensing = dig_signals_sensing(l->measured);
    const char            *comma   = "";
    for (int i = 0; i < DIG_SIGNALS; i++) {
        if (!l->measured[i] && dig_signal_is_needed(sensing, (enum dig_signal)i)) {
            put(file, comma, dig_signal_name((enum dig_signal)i));
            comma = ", ";
        }
    }
    (void)fputs("]}\n", file);
}
