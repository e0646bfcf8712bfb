#include "closed_loop/design/design.h"

#include "closed_loop/design/design_simulate.h"
#include "closed_loop/numeric/dense.h"
#include "core/sort.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define PLACES_PER_AXIS ((size_t)4)
#define SQUARE          ((size_t)DIG_AXES * DIG_AXES)
#define WRENCH          ((size_t)DIG_FEATURES)
#define PLACES_MAX      (PLACES_PER_AXIS * PLACES_PER_AXIS * PLACES_PER_AXIS)
#define PRIOR           3.0 // 1 / variance of a place of which nothing is known

static const double step = 0.02; // of the derivatives, in places

// Gravels to average over, away from the table's edge; an axis of one point has one place. How
// many.
static size_t make_places(const struct dig_response_surface *const surface,
                          double                                   place[PLACES_MAX + 1][DIG_AXES])
{
    size_t n = 0;
    for (size_t i = 0; i < PLACES_MAX; i++) {
        const size_t at[DIG_AXES] = { i / (PLACES_PER_AXIS * PLACES_PER_AXIS),
                                      i / PLACES_PER_AXIS % PLACES_PER_AXIS, i % PLACES_PER_AXIS };
        bool         is_new       = true;
        for (int a = 0; a < DIG_AXES; a++) {
            const bool has = surface->set->axis_count[a] > 1;
            is_new         = is_new && (has || at[a] == 0);
            place[n][a] = has ? 2.0 * ((double)at[a] + 0.5) / (double)PLACES_PER_AXIS - 1.0 : 0.0;
        }
        n += is_new ? 1 : 0;
    }
    return n;
}

// J' C^-1 J of one dig at one gravel, by the first n features. DIG_EINVAL: the covariance is none.
static enum dig_status look(const struct dig_design_table *const table, const size_t t,
                            const double place[DIG_AXES], const size_t n, double normal[SQUARE])
{
    double feature[2][DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
    double lower[DIG_FEATURES * DIG_FEATURES]; // L of C = L L'
    double slope[DIG_AXES][DIG_FEATURES];      // L^-1 J
    dig_design_covariance(table, t, place, n, lower);
    if (dig_cholesky(n, lower) != DIG_OK) {
        return DIG_EINVAL;
    }
    for (int a = 0; a < DIG_AXES; a++) {
        for (int side = 0; side < 2; side++) {
            double at[DIG_AXES];
            memcpy(at, place, sizeof at);
            at[a] += side == 0 ? -step : step;
            dig_response_surface_features(table->surface, t, at, feature[side], amplitude);
        }
        for (size_t k = 0; k < n; k++) {
            slope[a][k] = (feature[1][k] - feature[0][k]) / (2.0 * step);
        }
        dig_lower_solve(n, lower, slope[a]);
    }
    for (size_t i = 0; i < SQUARE; i++) {
        normal[i] = dig_product(n, slope[i / DIG_AXES], slope[i % DIG_AXES]);
    }
    return DIG_OK;
}

// Bits that this much Fisher information is about the gravel.
static double bits_of(const double normal[SQUARE])
{
    double m[SQUARE];
    for (size_t i = 0; i < SQUARE; i++) {
        m[i] = normal[i] / PRIOR + (i % (DIG_AXES + 1) == 0 ? 1.0 : 0.0);
    }
    return dig_cholesky(DIG_AXES, m) == DIG_OK ? 0.5 * dig_lower_log_det(DIG_AXES, m) / log(2.0)
                                               : 0.0;
}

// 1 sigma that it leaves of each axis, as a share of knowing nothing.
static void tell_left(const double normal[SQUARE], double left[DIG_AXES])
{
    double lower[SQUARE];
    for (size_t i = 0; i < SQUARE; i++) {
        lower[i] = normal[i] + (i % (DIG_AXES + 1) == 0 ? PRIOR : 0.0);
    }
    dig_cholesky_sure(DIG_AXES, lower); // by what is on its diagonal
    for (size_t a = 0; a < DIG_AXES; a++) {
        double unit[DIG_AXES] = { 0.0 };
        unit[a]               = 1.0;
        dig_lower_solve(DIG_AXES, lower, unit);
        left[a] = sqrt(PRIOR * dig_product(DIG_AXES, unit, unit));
    }
}

// The gravel: information of one dig by moment and by wrench, what is left of each axis.
static enum dig_status weigh_gravel(const struct dig_design_table *const table, const size_t t,
                                    const size_t places, double (*const place)[DIG_AXES],
                                    double (*const normal)[SQUARE],
                                    struct dig_design_dig *const dig)
{
    double left[DIG_AXES][PLACES_MAX];
    for (size_t i = 0; i < places; i++) {
        double          wrench[SQUARE];
        double          here[DIG_AXES];
        enum dig_status status = look(table, t, place[i], WRENCH, wrench);
        if (status == DIG_OK) {
            status = look(table, t, place[i], DIG_FEATURE_BINS, normal[i]);
        }
        if (status != DIG_OK) {
            return status;
        }
        dig->bits_wrench += bits_of(wrench) / (double)places;
        dig->bits += bits_of(normal[i]) / (double)places;
        tell_left(normal[i], here);
        for (size_t a = 0; a < DIG_AXES; a++) {
            left[a][i] = here[a];
        }
    }
    for (size_t a = 0; a < DIG_AXES; a++) {
        dig->sd[a] = dig_sort_median(places, left[a]);
    }
    return DIG_OK;
}

// Two digs: the partner with which they tell most.
static void find_partners(struct dig_design *const design, const size_t places,
                          double (*const normal)[PLACES_MAX][SQUARE])
{
    for (size_t t = 0; t < design->digs; t++) {
        for (size_t u = 0; u < design->digs; u++) {
            double bits = 0.0;
            for (size_t i = 0; i < places; i++) {
                double both[SQUARE];
                for (size_t k = 0; k < SQUARE; k++) {
                    both[k] = normal[t][i][k] + normal[u][i][k];
                }
                bits += bits_of(both) / (double)places;
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
    const struct dig_curve_set *const set                          = table->surface->set;
    double          normal[DIG_TRAJECTORY_MAX][PLACES_MAX][SQUARE] = { { { 0.0 } } };
    double          place[PLACES_MAX + 1][DIG_AXES];
    const size_t    places = make_places(table->surface, place);
    enum dig_status status = DIG_OK;
    design->digs           = set->trajectories;
    for (size_t t = 0; t < set->trajectories && status == DIG_OK; t++) {
        struct dig_design_dig *const dig = &design->dig[t];
        dig->known                       = table->surface->known[t];
        dig->simple                      = set->trajectory[t].phases <= DIG_DESIGN_SIMPLE_PHASES;
        dig->duration_s                  = dig_trajectory_duration_s(&set->trajectory[t]);
        dig->path_m = dig_trajectory_path_m(&set->trajectory[t], set->tooth_m, dig->duration_s);
        if (dig->known) {
            status = weigh_gravel(table, t, places, place, normal[t], dig);
        }
    }
    if (status == DIG_OK) {
        find_partners(design, places, normal);
        status = rank(set, design);
    }
    return status;
}

enum dig_status dig_design_run(const struct dig_response_surface *const surface,
                               const struct dig_scatter *const scatter, const size_t draws,
                               const uint64_t seed, struct dig_design *const design)
{
    assert(surface != NULL && scatter != NULL && design != NULL);
    const struct dig_design_table table  = { surface, scatter };
    struct dig_design             made   = { .digs = 0 };
    enum dig_status               status = weigh_all(&table, &made);
    if (status == DIG_OK) {
        status = dig_design_simulate(&table, draws, seed, &made);
    }
    if (status == DIG_OK) {
        *design = made;
    }
    return status;
}
