#include "closed_loop/report/trace_report.h"

#include "closed_loop/report/report.h"
#include "closed_loop/report/residual_report.h"
#include "core/markup.h"
#include "core/text.h"
#include "estimator/effects/effect.h"

#include <assert.h>
#include <math.h>
#include <string.h>

static void put_interval(FILE *const to, const char *const before, const char *const name,
                         const double value, const double low, const double high)
{
    (void)fputs(before, to);
    dig_json_put(to, "%s: {\"value\": %g, \"low\": %g, \"high\": %g}", name, value, low, high);
}

static void put_parameters(FILE *const to, const struct dig_model_effect *const effect)
{
    (void)fputs(", \"parameters\": {", to);
    for (size_t p = 0; p < effect->parameters; p++) {
        const struct dig_model_parameter *const q = &effect->parameter[p];
        put_interval(to, p == 0 ? "" : ", ", q->name, q->value, q->low, q->high);
    }
    (void)fputs("}}", to);
}

static void put_verdict(FILE *const to, const struct dig_trace *const trace)
{
    (void)fputs("\"verdict\": [", to);
    for (size_t e = 0; e < trace->effects; e++) {
        dig_json_put(to, e == 0 ? "%s" : ", %s", dig_effect_name(trace->effect[e].effect));
    }
    (void)fputs(trace->effects == 0 ? "\"none\"],\n" : "],\n", to);
}

static void put_sets(FILE *const to, const struct dig_trace *const trace)
{
    (void)fputs(" \"indistinguishable\": [", to);
    for (size_t s = 0; s < trace->sets; s++) {
        (void)fputs(s == 0 ? "[" : ", [", to);
        for (size_t e = 0; e < trace->set[s].effects; e++) {
            dig_json_put(to, e == 0 ? "%s" : ", %s", dig_effect_name(trace->set[s].effect[e]));
        }
        (void)fputs("]", to);
    }
    (void)fputs("],\n", to);
}

void dig_trace_meaning(const struct dig_trace *const trace, const size_t effect, const size_t size,
                       char text[])
{
    assert(trace != NULL && effect < trace->effects && text != NULL && size > 0);
    const struct dig_effect *const known = dig_effect_of(trace->effect[effect].effect);
    double                         value[DIG_MODEL_PARAMETERS_MAX];
    text[0] = '\0';
    if (known != NULL && known->say != NULL &&
        dig_effect_values(&trace->effect[effect], value) == DIG_OK) {
        known->say(value, &trace->ground, size, text);
    }
}

static void put_effects(FILE *const to, const struct dig_trace *const trace)
{
    (void)fputs(" \"effects\": [", to);
    for (size_t e = 0; e < trace->effects; e++) {
        const struct dig_model_effect *const effect = &trace->effect[e];
        (void)fputs(e == 0 ? "\n  " : ",\n  ", to);
        dig_json_put(to, "{\"name\": %s, \"probability\": %g, \"seen_in\": %s",
                     dig_effect_name(effect->effect), effect->probability,
                     dig_part_name(trace->seen_in[e]));
        if (effect->effect == DIG_EFFECT_UNLISTED && trace->unlisted.any) {
            dig_json_put(to, ", \"depends_on\": %s", trace->unlisted.depends_on);
        }
        char text[256];
        dig_trace_meaning(trace, e, sizeof text, text);
        if (text[0] != '\0') {
            dig_json_put(to, ", \"meaning\": %s", text);
        }
        put_parameters(to, effect);
    }
    (void)fputs("],\n", to);
}

static void put_material(FILE *const to, const struct dig_trace *const trace)
{
    (void)fputs(" \"material\": {", to);
    for (int a = 0; a < DIG_AXES; a++) {
        put_interval(to, a == 0 ? "" : ", ", dig_axis_name((enum dig_axis)a),
                     trace->gravel.value[a], trace->low.value[a], trace->high.value[a]);
    }
    (void)fputs("},\n \"material_before\": {", to);
    for (int a = 0; a < DIG_AXES; a++) {
        dig_json_put(to, a == 0 ? "%s: %g" : ", %s: %g", dig_axis_name((enum dig_axis)a),
                     trace->gravel_before.value[a]);
    }
    (void)fputs("},\n", to);
}

static void put_error(FILE *const to, const char *const name,
                      const struct dig_error_range *const range)
{
    dig_json_put(to, " %s: {\"holdout\": %g, \"low\": %g, \"high\": %g},\n", name, range->value,
                 range->low, range->high);
}

static void put_candidates(FILE *const to, const struct dig_trace *const trace)
{
    (void)fputs(" \"candidates\": [", to);
    for (size_t i = 0; i < trace->candidates; i++) {
        const struct dig_candidate *const c = &trace->candidate[i];
        (void)fputs(i == 0 ? "\n  " : ",\n  ", to);
        dig_json_put(to,
                     "{\"name\": %s, \"log_evidence\": %g, \"p_fit\": %g, \"inclusion\": %g, "
                     "\"error\": %g, \"seen_in\": %s",
                     dig_effect_name(c->as.effect), c->log_evidence, c->p_fit, c->as.probability,
                     c->error, dig_part_name(c->seen_in));
        put_parameters(to, &c->as);
    }
    (void)fputs("],\n", to);
}

// Numbers of a pair that nothing tells apart are null.
static void put_tells(FILE *const to, const struct dig_trace *const trace)
{
    (void)fputs(",\n \"tell_apart\": [", to);
    for (size_t i = 0; i < trace->tells; i++) {
        const struct dig_tell_apart *const tell = &trace->tell[i];
        const bool                         told = tell->how[0] != '\0';
        (void)fputs(i == 0 ? "\n  " : ",\n  ", to);
        dig_json_put(to, "{\"effects\": [%s, %s], \"in\": ", dig_effect_name(tell->effect[0]),
                     dig_effect_name(tell->effect[1]));
        (void)fputs(told ? (tell->in_air ? "\"air\"" : "\"soil\"") : "null", to);
        dig_json_put(to, ", \"how\": %s, \"sigmas\": %g, \"repeats\": %g}", tell->how,
                     told ? tell->sigmas : (double)NAN, told ? tell->repeats : (double)NAN);
    }
    (void)fputs("]", to);
}

void dig_trace_json(const struct dig_trace *const trace, FILE *const to)
{
    assert(trace != NULL && to != NULL);
    dig_json_put(to,
                 "{\"significant\": %i, \"p_complete\": %g, \"false_alarm\": %g, "
                 "\"noise_floor\": %g,\n ",
                 trace->significant, trace->p_complete, trace->false_alarm, trace->noise_floor);
    put_verdict(to, trace);
    dig_json_put(to, " \"applied\": %i,\n", trace->applied);
    put_sets(to, trace);
    put_effects(to, trace);
    put_material(to, trace);
    put_error(to, "error_before", &trace->before);
    put_error(to, "error_after", &trace->after);
    dig_json_put(to, " \"digs\": %zu, \"holdouts\": %zu, \"residual\": {", trace->judged.digs,
                 trace->holdouts);
    for (int p = 0; p < DIG_TRACE_PHASES; p++) {
        dig_json_put(to, p == 0 ? "%s: %g" : ", %s: %g", dig_part_name((enum dig_part)p),
                     trace->residual[p]);
    }
    dig_json_put(to, "}, \"no_air\": %i,\n", trace->no_air);
    put_candidates(to, trace);
    dig_residuals_json(trace, to);
    dig_json_put(to, " \"advice\": %s", trace->advice);
    put_tells(to, trace);
    dig_json_put(to,
                 ",\n \"command\": %s,\n \"metric\": \"relative Euclidean norm of the moment, "
                 "moving average ±0.16 s\"}\n",
                 trace->command);
}

// Of a trace that found no effect.
static const char *nothing_of(const struct dig_trace *const trace)
{
    if (trace->beyond) {
        return trace->applied ? "No effect is missing: the gravel lies beyond the table, and the "
                                "prediction is made with it."
                              : "No effect is missing: the gravel lies beyond the table, and the "
                                "prediction is not surely better with it and stays as it was.";
    }
    return trace->significant ? "Something is missing, but none of the effects known explains it."
           : trace->no_air    ? "Nothing is missing in the soil; no free air tells of the machine."
                              : "Nothing is missing: what is left is within the noise.";
}

static void put_found(const struct dig_trace *const trace, const size_t e, const size_t size,
                      char text[])
{
    const struct dig_model_effect *const effect = &trace->effect[e];

    const bool unlisted = effect->effect == DIG_EFFECT_UNLISTED;
    dig_text_add(size, text, "%s",
                 unlisted ? "an effect that has no name here" : dig_effect_name(effect->effect));
    if (unlisted && trace->unlisted.any && trace->unlisted.depends_on[0] != '\0') {
        dig_text_add(size, text, ", which depends on %s", trace->unlisted.depends_on);
    }
    dig_text_add(size, text, " (probability %.2f, seen in %s)", effect->probability,
                 trace->seen_in[e] == DIG_PART_LIFTED ? "lifting out"
                                                      : dig_part_name(trace->seen_in[e]));
    if (!unlisted) {
        dig_text_add(size, text, ": %s", dig_effect_of(effect->effect)->summary);
    }
}

void dig_trace_sentence(const struct dig_trace *const trace, const size_t size, char text[])
{
    assert(trace != NULL && text != NULL && size > 0);
    text[0] = '\0';
    dig_text_add(size, text, "%s", trace->effects == 0 ? nothing_of(trace) : "Missing: ");
    for (size_t e = 0; e < trace->effects; e++) {
        const bool last = e + 1 == trace->effects;
        dig_text_add(size, text, "%s", e == 0 ? "" : last ? "; and " : "; ");
        put_found(trace, e, size, text);
        dig_text_add(size, text, "%s", last ? "." : "");
    }
}

void dig_trace_not_applied(const struct dig_trace *const trace, const size_t size, char text[])
{
    assert(trace != NULL && text != NULL && size > 0);
    text[0] = '\0';
    if (trace->applied || trace->effects == 0) {
        return;
    }
    dig_text_add(size, text, "named, not applied: ");
    for (size_t e = 0; e < trace->effects; e++) {
        dig_text_add(size, text, "%s%s", e == 0 ? "" : ", ",
                     dig_effect_name(trace->effect[e].effect));
    }
    dig_text_add(size, text, "; the prediction is not surely better for it, and stays as it was");
}

// An interval is drawn from recordings: of one there is none.
static void put_error_line(FILE *const to, const char *const title,
                           const struct dig_error_range *const range, const size_t holdouts)
{
    if (!isfinite(range->value)) {
        (void)fprintf(to, "  error %s unknown: no holdout dig\n", title);
    } else if (holdouts == 1) {
        (void)fprintf(to, "  error %s %.3f   one dig: no interval\n", title, range->value);
    } else {
        (void)fprintf(to, "  error %s %.3f   90 %%: %.3f to %.3f\n", title, range->value,
                      range->low, range->high);
    }
}

static void put_meanings(FILE *const to, const struct dig_trace *const trace)
{
    for (size_t e = 0; e < trace->effects; e++) {
        char text[256];
        dig_trace_meaning(trace, e, sizeof text, text);
        if (text[0] != '\0') {
            (void)fprintf(to, "  %s\n", text);
        }
    }
}

// Which digs were compared as if they had been dug as the table's.
static void put_approaches(FILE *const to, const struct dig_trace *const trace)
{
    for (size_t i = 0; i < trace->judged.digs; i++) {
        const struct dig_measured *const dig = &trace->judged.measured[i];
        char                             way[DIG_APPROACH_TEXT_SIZE];
        dig_residuals_approach_text(&dig->taken_off, way);
        if (way[0] != '\0') {
            (void)fprintf(to, "  %s: dug at %s, as its path tells; taken off\n", dig->name,
                          way + 2);
        }
    }
}

void dig_trace_text(const struct dig_trace *const trace, FILE *const to)
{
    assert(trace != NULL && to != NULL);
    char sentence[1024];
    char chance[32];
    dig_trace_sentence(trace, sizeof sentence, sentence);
    (void)fprintf(to, "%s\n", sentence);
    for (size_t e = 0; e < trace->effects; e++) {
        for (size_t p = 0; p < trace->effect[e].parameters; p++) {
            const struct dig_model_parameter *const parameter = &trace->effect[e].parameter[p];
            (void)fprintf(to, "  %s %s %.4g   90 %%: %.4g to %.4g\n",
                          dig_effect_name(trace->effect[e].effect), parameter->name,
                          parameter->value, parameter->low, parameter->high);
        }
    }
    dig_trace_not_applied(trace, sizeof sentence, sentence);
    if (sentence[0] != '\0') {
        (void)fprintf(to, "  %s\n", sentence);
    }
    for (size_t s = 0; s < trace->sets; s++) {
        (void)fputs("  these digs cannot tell apart:", to);
        for (size_t e = 0; e < trace->set[s].effects; e++) {
            (void)fprintf(to, "%s %s", e == 0 ? "" : ",", dig_effect_name(trace->set[s].effect[e]));
        }
        (void)fputs("\n", to);
    }
    (void)fprintf(to, "  gravel: friction %.3g, rolling %.3g, density %.4g kg/m3\n",
                  trace->gravel.value[DIG_AXIS_FRICTION], trace->gravel.value[DIG_AXIS_ROLLING],
                  trace->gravel.value[DIG_AXIS_DENSITY_kgpm3]);
    put_meanings(to, trace);
    put_approaches(to, trace);
    put_error_line(to, "before", &trace->before, trace->holdouts);
    put_error_line(to, "after ", &trace->after, trace->holdouts);
    (void)fprintf(to,
                  "  noise floor  %.3f   chance of such residuals if nothing were missing "
                  "%s, decided at %.3g\n",
                  trace->noise_floor, dig_report_chance(trace->p_complete, sizeof chance, chance),
                  trace->false_alarm);
    if (trace->advice[0] != '\0') {
        (void)fprintf(to, "  next: %s\n", trace->advice);
    }
    for (size_t i = 0; i < trace->tells; i++) {
        dig_tell_apart_say(&trace->tell[i], sizeof sentence, sentence);
        // The first may be the advice itself.
        if (strcmp(sentence, trace->advice) != 0) {
            (void)fprintf(to, "  to tell apart: %s\n", sentence);
        }
    }
    if (trace->command[0] != '\0') {
        (void)fprintf(to, "\nA table with it in its beds:\n\n%s", trace->command);
    }
}
