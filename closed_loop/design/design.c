#include "closed_loop/design/design.h"

#include "closed_loop/design/design_view.h"
#include "closed_loop/numeric/dense.h"
#include "core/sort.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Gravels to average over, away from the table's edge; an axis of one point has one place.
static void make_places(struct dig_design_table *const table)
{
    size_t n = 0;
    for (size_t i = 0; i < DIG_DESIGN_PLACES_MAX; i++) {
        const size_t at[DIG_AXES] = { i / (DIG_DESIGN_PLACES_PER_AXIS * DIG_DESIGN_PLACES_PER_AXIS),
                                      i / DIG_DESIGN_PLACES_PER_AXIS % DIG_DESIGN_PLACES_PER_AXIS,
                                      i % DIG_DESIGN_PLACES_PER_AXIS };
        bool         is_new       = true;
        for (int a = 0; a < DIG_AXES; a++) {
            const bool has = table->surface->set->axis_count[a] > 1;
            is_new         = is_new && (has || at[a] == 0);
            table->place[n][a] =
                has ? 2.0 * ((double)at[a] + 0.5) / (double)DIG_DESIGN_PLACES_PER_AXIS - 1.0 : 0.0;
        }
        n += is_new ? 1 : 0;
    }
    table->places = n;
}

// The gravel: information of one dig by moment and by wrench, what is left of each axis.
static enum dig_status weigh_gravel(const struct dig_design_table *const table, const size_t t,
                                    double (*const normal)[DIG_AXES * DIG_AXES],
                                    struct dig_design_dig *const dig)
{
    const size_t places = table->places;
    double       left[DIG_AXES][DIG_DESIGN_PLACES_MAX];
    for (size_t i = 0; i < places; i++) {
        struct dig_design_view v;
        enum dig_status status = dig_design_look(table, t, table->place[i], DIG_DESIGN_WRENCH, &v);
        if (status == DIG_OK) {
            dig->bits_wrench += dig_design_bits(v.normal) / (double)places;
            status = dig_design_look(table, t, table->place[i], DIG_FEATURE_BINS, &v);
        }
        if (status != DIG_OK) {
            return status;
        }
        dig->bits += dig_design_bits(v.normal) / (double)places;
        memcpy(normal[i], v.normal, sizeof v.normal);
        for (size_t a = 0; a < DIG_AXES; a++) {
            double unit[DIG_AXES] = { 0.0 };
            unit[a]               = 1.0;
            dig_lower_solve(DIG_AXES, v.normal_lower, unit);
            left[a][i] = sqrt(DIG_DESIGN_PRIOR * dig_product(DIG_AXES, unit, unit));
        }
    }
    for (size_t a = 0; a < DIG_AXES; a++) {
        dig->sd[a] = dig_sort_median(places, left[a]);
    }
    return DIG_OK;
}

// Two digs: the partner with which they tell most.
static void find_partners(struct dig_design *const design, const size_t places,
                          double (*const normal)[DIG_DESIGN_PLACES_MAX][DIG_AXES * DIG_AXES])
{
    for (size_t t = 0; t < design->digs; t++) {
        for (size_t u = 0; u < design->digs; u++) {
            double bits = 0.0;
            for (size_t i = 0; i < places; i++) {
                double both[DIG_AXES * DIG_AXES];
                for (size_t k = 0; k < DIG_DESIGN_SQUARE; k++) {
                    both[k] = normal[t][i][k] + normal[u][i][k];
                }
                bits += dig_design_bits(both) / (double)places;
            }
            if (design->dig[t].known && design->dig[u].known && design->dig[u].simple &&
                bits > design->dig[t].bits_partner) {
                design->dig[t].partner      = u;
                design->dig[t].bits_partner = bits;
            }
        }
    }
}

// Simple digs by their bits, best first; what they are compared with; what they are for.
static enum dig_status rank(const struct dig_curve_set *const set, struct dig_design *const design)
{
    bool   named = false;
    size_t most  = 0;
    for (size_t t = 0; t < set->trajectories; t++) {
        const struct dig_design_dig *const dig = &design->dig[t];
        if (dig->known && set->trajectory[t].phases > most) {
            most           = set->trajectory[t].phases;
            design->target = t;
        }
        if (!dig->known || !dig->simple) {
            continue;
        }
        size_t at = design->ranked++;
        for (; at > 0 && design->dig[design->rank[at - 1]].bits < dig->bits; at--) {
            design->rank[at] = design->rank[at - 1];
        }
        design->rank[at] = t;
        if (design->ranked == 1 || (!named && strcmp(set->trajectory[t].name, "simpleA") == 0)) {
            design->reference = t;
            named             = strcmp(set->trajectory[t].name, "simpleA") == 0;
        }
    }
    return design->ranked > 0 ? DIG_OK : DIG_EINVAL;
}

static enum dig_status weigh_all(const struct dig_design_table *const table,
                                 struct dig_design *const             design)
{
    const struct dig_curve_set *const set = table->surface->set;
    double normal[DIG_TRAJECTORY_MAX][DIG_DESIGN_PLACES_MAX][DIG_AXES * DIG_AXES] = { { { 0.0 } } };
    enum dig_status status                                                        = DIG_OK;
    design->digs = set->trajectories;
    for (size_t t = 0; t < set->trajectories && status == DIG_OK; t++) {
        struct dig_design_dig *const dig = &design->dig[t];
        dig->known                       = table->surface->known[t];
        dig->simple                      = set->trajectory[t].phases <= DIG_DESIGN_SIMPLE_PHASES;
        dig->duration_s                  = dig_trajectory_duration_s(&set->trajectory[t]);
        dig->path_m = dig_trajectory_path_m(&set->trajectory[t], set->tooth_m, dig->duration_s);
        if (dig->known) {
            status = weigh_gravel(table, t, normal[t], dig);
        }
        if (dig->known && status == DIG_OK && table->soil != NULL) {
            status = dig_design_effects(table, t, dig);
        }
    }
    if (status == DIG_OK) {
        find_partners(design, table->places, normal);
        status = rank(set, design);
    }
    return status;
}

enum dig_status dig_design_run(const struct dig_response_surface *const surface,
                               const struct dig_scatter *const          scatter,
                               const struct dig_soil *const soil, const size_t draws,
                               const uint64_t seed, struct dig_design *const design)
{
    assert(surface != NULL && scatter != NULL && design != NULL);
    struct dig_design_table table = { .surface = surface, .scatter = scatter, .soil = soil };
    struct dig_design       made  = { .digs = 0 };
    make_places(&table);
    enum dig_status status = weigh_all(&table, &made);
    if (status == DIG_OK) {
        status = dig_design_simulate(&table, draws, seed, &made);
    }
    if (status == DIG_OK) {
        *design = made;
    }
    return status;
}
