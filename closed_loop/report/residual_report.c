#include "closed_loop/report/residual_report.h"

#include "core/markup.h"
#include "core/units.h"

#include <assert.h>
#include <math.h>

const char *dig_residuals_use_name(const enum dig_use use)
{
    static const char *const name[] = { "identify", "fit", "holdout" };
    return name[use];
}

void dig_residuals_approach_text(const struct dig_approach *const taken_off,
                                 char                             text[DIG_APPROACH_TEXT_SIZE])
{
    const struct dig_approach rounded = {
        0.01 * round(100.0 * dig_approach_normalized(taken_off).depth),
        0.1 * DIG_RAD_PER_DEG * round(10.0 * taken_off->attack_rad / DIG_RAD_PER_DEG)
    };
    dig_approach_text(&rounded, text);
}

static bool is_known(const struct dig_residuals_dig *const dig, const size_t channel)
{
    return dig->before[DIG_PART_SOIL][channel].rms >= 0.0 ||
           dig->before[DIG_PART_LIFTED][channel].rms >= 0.0;
}

static void put_residual(FILE *const to, const char *const name,
                         const struct dig_residual *const residual)
{
    dig_json_put(to, "%s: {\"rms\": %g, \"relative\": %g, \"sigmas\": %g}", name, residual->rms,
                 residual->relative, residual->sigmas);
}

static void put_dig(FILE *const to, const struct dig_curve_set *const set,
                    const struct dig_measured *const m, const struct dig_residuals_dig *const dig)
{
    const struct dig_approach taken_off = dig_approach_normalized(&m->taken_off);
    dig_json_put(to,
                 "{\"file\": %s, \"trajectory\": %s, \"role\": %s, \"pass\": %u, \"depth\": %g, "
                 "\"attack_deg\": %g, \"air\": {\"sigmas\": %g}",
                 m->name, set->trajectory[m->trajectory].name, dig_residuals_use_name(m->use),
                 m->pass, taken_off.depth, taken_off.attack_rad / DIG_RAD_PER_DEG, dig->air_sigmas);
    for (int p = DIG_PART_SOIL; p < DIG_TRACE_PHASES; p++) {
        dig_json_put(to, ",\n   %s: {", dig_part_name((enum dig_part)p));
        bool any = false;
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            if (!is_known(dig, c)) {
                continue;
            }
            dig_json_put(to, any ? ", %s: {" : "%s: {",
                         dig_residual_channel_name((enum dig_channel)c));
            put_residual(to, "before", &dig->before[p][c]);
            (void)fputs(", ", to);
            put_residual(to, "after", &dig->after[p][c]);
            (void)fputs("}", to);
            any = true;
        }
        (void)fputs("}", to);
    }
    (void)fputs("}", to);
}

static void put_trend(FILE *const to, const char *const channel, const enum dig_regressors state,
                      const struct dig_trend *const trend)
{
    dig_json_put(to,
                 "{\"of\": %s, \"against\": %s, \"slope\": %g, \"correlation\": %g, \"bins\": [",
                 channel, dig_regressors_name(state), trend->slope, trend->correlation);
    for (size_t b = 0; b < trend->bins; b++) {
        (void)fputs(b == 0 ? "" : ", ", to);
        dig_json_put(to, "{\"at\": %g, \"mean\": %g, \"standard_error\": %g, \"digs\": %zu}",
                     trend->bin[b].at, trend->bin[b].mean, trend->bin[b].standard_error,
                     trend->bin[b].digs);
    }
    (void)fputs("]}", to);
}

void dig_residuals_json(const struct dig_trace *const trace, FILE *const to)
{
    assert(trace != NULL && to != NULL);
    const struct dig_residuals *const residuals = trace->residuals;
    (void)fputs(" \"residuals\": [", to);
    for (size_t i = 0; residuals != NULL && i < trace->judged.digs; i++) {
        (void)fputs(i == 0 ? "\n  " : ",\n  ", to);
        put_dig(to, trace->judged.set, &trace->judged.measured[i], &residuals->dig[i]);
    }
    (void)fputs("],\n \"residual_against\": [", to);
    bool any = false;
    for (size_t c = 0; residuals != NULL && c < DIG_FORCE_CHANNELS; c++) {
        for (int s = 0; residuals->known[c] && s < DIG_REGRESSORS; s++) {
            (void)fputs(any ? ",\n  " : "\n  ", to);
            put_trend(to, dig_residual_channel_name((enum dig_channel)c), (enum dig_regressors)s,
                      &residuals->trend[c][s]);
            any = true;
        }
    }
    (void)fputs("],\n", to);
}
