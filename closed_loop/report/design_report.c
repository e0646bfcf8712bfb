#include "closed_loop/report/design_report.h"

#include "core/markup.h"

#include <assert.h>

static void put_row(FILE *const to, const struct dig_design *const design,
                    const struct dig_curve_set *const set, const size_t t)
{
    const struct dig_design_dig *const dig = &design->dig[t];
    (void)fprintf(to, "  %-12s %6.2f %8.2f %6.2f %6.2f %6.2f %8.2f %8.3f\n",
                  set->trajectory[t].name, dig->bits, dig->bits_wrench, dig->sd[0], dig->sd[1],
                  dig->sd[2], dig->error, dig->target_error);
}

void dig_design_text(const struct dig_design *const design, const struct dig_curve_set *const set,
                     FILE *const to)
{
    assert(design != NULL && set != NULL && to != NULL && design->ranked > 0);
    (void)fputs("bits on the gravel of one dig, by its moment and with its forces; 1 sigma left of "
                "friction,\nrolling and density as a share of knowing nothing; the same over all "
                "three, simulated; error of\nthe predicted target\n\n",
                to);
    (void)fprintf(to, "  %-12s %6s %8s %6s %6s %6s %8s %8s\n", "simple dig", "bits", "+forces",
                  "fric", "roll", "dens", "left", "target");
    for (size_t i = 0; i < design->ranked; i++) {
        put_row(to, design, set, design->rank[i]);
    }
    (void)fputs("  not simple, for comparison:\n", to);
    for (size_t t = 0; t < design->digs; t++) {
        if (design->dig[t].known && !design->dig[t].simple) {
            put_row(to, design, set, t);
        }
    }
    const size_t best = design->rank[0];
    (void)fprintf(to, "\nrecommended: %s; a second dig tells most along %s (%.2f bits together)\n",
                  set->trajectory[best].name, set->trajectory[design->dig[best].partner].name,
                  design->dig[best].bits_partner);
    if (best == design->reference) {
        (void)fprintf(to, "%s is the dig that others are compared with: nothing to confirm\n",
                      set->trajectory[best].name);
        return;
    }
    (void)fprintf(
        to,
        "simulated on %zu gravels: squared error of the gravel by %s less that by %s %.4f, "
        "90 %% interval %.4f to %.4f: %s\n",
        design->draws, set->trajectory[design->reference].name, set->trajectory[best].name,
        design->gain, design->gain_low, design->gain_high,
        design->confirmed ? "it identifies better" : "not shown to identify better");
}

static void put_axes(FILE *const to, const char *const key, const double value[DIG_AXES])
{
    dig_json_put(to, ",\n   %s: {", key);
    for (int a = 0; a < DIG_AXES; a++) {
        dig_json_put(to, a == 0 ? "%s: %g" : ", %s: %g", dig_axis_name((enum dig_axis)a), value[a]);
    }
    (void)fputs("}", to);
}

static void put_dig(FILE *const to, const struct dig_design *const design,
                    const struct dig_curve_set *const set, const size_t t)
{
    const struct dig_design_dig *const dig = &design->dig[t];
    dig_json_put(to,
                 "\n  {\"trajectory\": %s, \"simple\": %i, \"duration_s\": %g, \"path_m\": %g,\n"
                 "   \"bits\": %g, \"bits_with_forces\": %g, \"partner\": %s, "
                 "\"bits_with_partner\": %g",
                 set->trajectory[t].name, dig->simple, dig->duration_s, dig->path_m, dig->bits,
                 dig->bits_wrench, set->trajectory[dig->partner].name, dig->bits_partner);
    put_axes(to, "sd_left", dig->sd);
    put_axes(to, "simulated_left", dig->error_axis);
    dig_json_put(to, ", \"simulated_left_all\": %g, \"simulated_target_error\": %g}", dig->error,
                 dig->target_error);
}

void dig_design_json(const struct dig_design *const design, const struct dig_curve_set *const set,
                     FILE *const to)
{
    assert(design != NULL && set != NULL && to != NULL && design->ranked > 0);
    dig_json_put(to,
                 "{\"recommended\": %s, \"reference\": %s, \"target\": %s, \"draws\": %zu,\n"
                 " \"gain\": {\"value\": %g, \"low\": %g, \"high\": %g}, \"confirmed\": %i,\n"
                 " \"ranking\": [",
                 set->trajectory[design->rank[0]].name, set->trajectory[design->reference].name,
                 set->trajectory[design->target].name, design->draws, design->gain,
                 design->gain_low, design->gain_high, design->confirmed);
    for (size_t i = 0; i < design->ranked; i++) {
        dig_json_put(to, i == 0 ? "%s" : ", %s", set->trajectory[design->rank[i]].name);
    }
    (void)fputs("],\n \"digs\": [", to);
    bool first = true;
    for (size_t t = 0; t < design->digs; t++) {
        if (design->dig[t].known) {
            (void)fputs(first ? "" : ",", to);
            put_dig(to, design, set, t);
            first = false;
        }
    }
    (void)fputs("]}\n", to);
}
