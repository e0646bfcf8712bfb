#include "closed_loop/design/design_view.h"

#include "closed_loop/numeric/dense.h"
#include "core/sort.h"
#include "estimator/effects/effect.h"

#include <math.h>
#include <string.h>

static const double magnitude  = 0.5; // of an effect, of the largest in the table of effects
static const double apart_from = 2.0; // sigmas

// What an effect adds at one gravel, whitened and without what the gravel explains.
static void remainder_of(const struct dig_design_table *const table,
                         const enum dig_effect_id effect, const size_t t,
                         const double place[DIG_AXES], const struct dig_design_view *const v,
                         double d[])
{
    const struct dig_soil *const soil = table->soil;
    double                       plain[DIG_FEATURES];
    double                       with[DIG_FEATURES];
    double                       amplitude[DIG_FORCE_CHANNELS];
    double                       noise = 0.0;
    dig_response_surface_features(table->surface, t, place, plain, amplitude);
    memcpy(with, plain, sizeof with);
    dig_soil_add(soil, effect, t, place, magnitude * soil->high[effect], 1.0, 1.0, plain, amplitude,
                 with, &noise);
    for (size_t k = 0; k < v->n; k++) {
        d[k] = with[k] - plain[k];
    }
    dig_lower_solve(v->n, v->lower, d);
    dig_design_take_gravel_off(v, d);
}

// Sigmas of every effect and of every pair of them, at each place.
struct sigmas {
    double alone[DIG_EFFECTS][DIG_DESIGN_PLACES_MAX];
    double pair[DIG_EFFECTS][DIG_EFFECTS][DIG_DESIGN_PLACES_MAX];
};

// By how much two remainders differ when the second may have any size and sign that is there.
static double differ(const size_t n, const double a[], const double b[])
{
    const double bb    = dig_product(n, b, b);
    const double share = bb > 0.0 ? fmin(fmax(dig_product(n, a, b) / bb, -2.0), 2.0) : 0.0;
    double       sum   = 0.0;
    for (size_t k = 0; k < n; k++) {
        sum += (a[k] - share * b[k]) * (a[k] - share * b[k]);
    }
    return sqrt(sum);
}

static void weigh_place(const struct dig_design_table *const table, const size_t t, const size_t i,
                        const struct dig_design_view *const v,
                        const struct dig_design_dig *const dig, struct sigmas *const s)
{
    double d[DIG_EFFECTS][DIG_FEATURES];
    for (int e = 0; e < DIG_EFFECTS; e++) {
        if (dig->tells[e]) {
            remainder_of(table, (enum dig_effect_id)e, t, table->place[i], v, d[e]);
            s->alone[e][i] = sqrt(dig_product(v->n, d[e], d[e]));
        }
    }
    for (int a = 0; a < DIG_EFFECTS; a++) {
        for (int b = a + 1; b < DIG_EFFECTS; b++) {
            if (dig->tells[a] && dig->tells[b]) {
                s->pair[a][b][i] = fmin(differ(v->n, d[a], d[b]), differ(v->n, d[b], d[a]));
            }
        }
    }
}

static void take_medians(const size_t places, struct sigmas *const s,
                         struct dig_design_dig *const dig)
{
    dig->close_sigmas = (double)INFINITY;
    for (int a = 0; a < DIG_EFFECTS; a++) {
        dig->sigmas[a] = dig->tells[a] ? dig_sort_median(places, s->alone[a]) : 0.0;
        for (int b = a + 1; b < DIG_EFFECTS; b++) {
            if (!dig->tells[a] || !dig->tells[b]) {
                continue;
            }
            const double sigmas = dig_sort_median(places, s->pair[a][b]);
            dig->pairs++;
            dig->apart += sigmas >= apart_from ? 1 : 0;
            if (sigmas < dig->close_sigmas) {
                dig->close_sigmas = sigmas;
                dig->close[0]     = (enum dig_effect_id)a;
                dig->close[1]     = (enum dig_effect_id)b;
            }
        }
    }
}

enum dig_status dig_design_effects(const struct dig_design_table *const table, const size_t t,
                                   struct dig_design_dig *const dig)
{
    // Those that act on each dig otherwise need several digs.
    for (int e = 0; e < DIG_EFFECTS; e++) {
        dig->tells[e] = !dig_effect_is_by_dig((enum dig_effect_id)e) &&
                        dig_soil_knows(table->soil, (enum dig_effect_id)e, t);
    }
    struct sigmas   s;
    enum dig_status status = DIG_OK;
    for (size_t i = 0; i < table->places && status == DIG_OK; i++) {
        struct dig_design_view v;
        status = dig_design_look(table, t, table->place[i], DIG_DESIGN_WRENCH, &v);
        if (status == DIG_OK) {
            weigh_place(table, t, i, &v, dig, &s);
        }
    }
    if (status == DIG_OK) {
        take_medians(table->places, &s, dig);
    }
    return status;
}
