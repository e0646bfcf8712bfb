#include "closed_loop/model/response_surface.h"

#include "closed_loop/numeric/dense.h"
#include "estimator/approach/interpolate.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Of the diagonal: keeps a table with holes from being singular, and moves nothing else.
static const double ridge = 1e-9;

// The prior of a cubic term's coefficient: one over its variance, in variances of one dig. The
// gravels of both tables that ship are likeliest by 5 to 10; with few of them it is the prior that
// decides, so that no table needs fewer terms.
static const double cubic_prior = 5.0;

enum { FREE_DEGREE = 2, MOST_DEGREE = 3 };

static unsigned degree_of(const struct dig_response_surface *const surface, const size_t term)
{
    const unsigned *const power = surface->power[term];
    return power[0] + power[1] + power[2];
}

// A term is one of a degree less, which stands before it, times the last axis that it has.
static void add_term(const unsigned power[DIG_AXES], struct dig_response_surface *const surface)
{
    const size_t j = surface->terms++;
    unsigned     less[DIG_AXES];
    memcpy(surface->power[j], power, sizeof surface->power[j]);
    memcpy(less, power, sizeof less);
    for (size_t a = 0; a < DIG_AXES; a++) {
        surface->last[j] = power[a] > 0 ? a : surface->last[j];
    }
    less[surface->last[j]] -= j > 0 ? 1 : 0;
    while (memcmp(surface->power[surface->of[j]], less, sizeof less) != 0) {
        surface->of[j]++;
    }
}

// Entries that hold the digs of one.
static size_t copies_of(const struct dig_curve_set *const set)
{
    return set->copies > 1 ? set->copies : 1;
}

static void choose_terms(const struct dig_curve_set *const  set,
                         struct dig_response_surface *const surface)
{
    const enum dig_axis axis      = DIG_AXIS_DENSITY_kgpm3;
    const bool          copied    = set->copies > 1;
    const size_t        densities = copied ? 1 : set->axis_count[axis];
    surface->log_density =
        copied ? 0.5 * log(set->axis[axis][set->axis_count[axis] - 1] / set->axis[axis][0]) : 0.0;
    surface->terms = 0;
    for (unsigned degree = 0; degree <= MOST_DEGREE; degree++) {
        for (unsigned x = 0; x <= degree; x++) {
            for (unsigned y = 0; x + y <= degree; y++) {
                const unsigned power[DIG_AXES] = { x, y, degree - x - y };
                if (power[0] < set->axis_count[0] && power[1] < set->axis_count[1] &&
                    power[2] < densities) {
                    add_term(power, surface);
                }
            }
        }
    }
}

static void terms_at(const struct dig_response_surface *const surface, const double place[DIG_AXES],
                     double term[DIG_RESPONSE_SURFACE_TERMS])
{
    term[0] = 1.0;
    for (size_t j = 1; j < surface->terms; j++) {
        term[j] = term[surface->of[j]] * place[surface->last[j]];
    }
}

void dig_response_surface_place(const struct dig_response_surface *const surface,
                                const struct dig_gravel *const gravel, double place[DIG_AXES])
{
    for (int a = 0; a < DIG_AXES; a++) {
        const enum dig_axis axis = (enum dig_axis)a;
        place[a]                 = surface->set->axis_count[a] > 1
                                       ? 2.0 * dig_axis_position(surface->set, axis, gravel->value[a]) - 1.0
                                       : 0.0;
    }
}

struct dig_gravel dig_response_surface_gravel(const struct dig_response_surface *const surface,
                                              const double place[DIG_AXES])
{
    struct dig_gravel gravel;
    for (int a = 0; a < DIG_AXES; a++) {
        gravel.value[a] = dig_axis_value(surface->set, (enum dig_axis)a, 0.5 * (place[a] + 1.0));
    }
    return gravel;
}

// What a density adds to log amplitude without a term.
static double log_scale(const struct dig_response_surface *const surface,
                        const double                             place[DIG_AXES])
{
    return surface->log_density * place[DIG_AXIS_DENSITY_kgpm3];
}

// An entry along a trajectory.
struct dug {
    const struct dig_curve *curve;
    double                  weight; // packings that no other entry holds too
    double                  place[DIG_AXES];
    double                  term[DIG_RESPONSE_SURFACE_TERMS];
};

// False when the entry was not dug.
static bool look_up(const struct dig_response_surface *const surface, const size_t t,
                    const size_t entry, struct dug *const dug)
{
    const struct dig_curve_set *const set  = surface->set;
    const size_t                      slot = entry * set->trajectories + t;
    if (set->packings[slot] <= 0) {
        return false;
    }
    *dug = (struct dug){ .curve  = &set->curve[slot],
                         .weight = (double)set->packings[slot] / (double)copies_of(set) };
    dig_response_surface_place(surface, &set->gravel[entry], dug->place);
    terms_at(surface, dug->place, dug->term);
    return true;
}

// The inverse of X' W X of one trajectory. False when the table has too few entries for it.
static bool invert(struct dig_response_surface *const surface, const size_t t)
{
    const size_t n                                                               = surface->terms;
    double       normal[DIG_RESPONSE_SURFACE_TERMS * DIG_RESPONSE_SURFACE_TERMS] = { 0.0 };
    size_t       entries                                                         = 0;
    size_t       free_terms                                                      = 0;
    for (size_t e = 0; e < surface->set->entries; e++) {
        struct dug dug;
        if (!look_up(surface, t, e, &dug)) {
            continue;
        }
        entries++;
        for (size_t i = 0; i < n; i++) {
            for (size_t j = 0; j < n; j++) {
                normal[i * n + j] += dug.weight * dug.term[i] * dug.term[j];
            }
        }
    }
    for (size_t i = 0; i < n; i++) {
        const bool is_free = degree_of(surface, i) <= FREE_DEGREE;
        normal[i * n + i] += ridge * normal[i * n + i] + (is_free ? 0.0 : cubic_prior);
        free_terms += is_free ? 1 : 0;
    }
    if (entries < free_terms * copies_of(surface->set) || dig_cholesky(n, normal) != DIG_OK) {
        return false;
    }
    for (size_t j = 0; j < n; j++) {
        double column[DIG_RESPONSE_SURFACE_TERMS] = { 0.0 };
        column[j]                                 = 1.0;
        dig_cholesky_solve(n, normal, column);
        for (size_t i = 0; i < n; i++) {
            surface->inverse[t][i][j] = column[i];
        }
    }
    return true;
}

// What each term's coefficient takes from an entry: a column of (X' W X)^-1 X' W.
static void share_of(const struct dig_response_surface *const surface, const size_t t,
                     const struct dug *const dug, double share[DIG_RESPONSE_SURFACE_TERMS])
{
    for (size_t j = 0; j < surface->terms; j++) {
        share[j] = 0.0;
        for (size_t i = 0; i < surface->terms; i++) {
            share[j] += dug->weight * surface->inverse[t][j][i] * dug->term[i];
        }
    }
}

static void amplitude_at(const struct dig_response_surface *const surface, const size_t t,
                         const double place[DIG_AXES],
                         const double term[DIG_RESPONSE_SURFACE_TERMS],
                         double       amplitude[DIG_FORCE_CHANNELS])
{
    const double scale                   = log_scale(surface, place);
    double       sum[DIG_FORCE_CHANNELS] = { 0.0 };
    for (size_t j = 0; j < surface->terms; j++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            sum[c] += surface->log_amplitude[t][j][c] * term[j];
        }
    }
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        amplitude[c] = exp(sum[c] + scale);
    }
}

static void fit_amplitudes(struct dig_response_surface *const surface, const size_t t)
{
    for (size_t e = 0; e < surface->set->entries; e++) {
        struct dug dug;
        if (!look_up(surface, t, e, &dug)) {
            continue;
        }
        const double scale = log_scale(surface, dug.place);
        double       feature[DIG_FEATURES];
        double       amplitude[DIG_FORCE_CHANNELS];
        double       share[DIG_RESPONSE_SURFACE_TERMS];
        dig_features_of_table((const float(*)[DIG_CURVE_POINTS])dug.curve->mean, feature);
        dig_features_amplitude(feature, NULL, amplitude);
        share_of(surface, t, &dug, share);
        for (size_t j = 0; j < surface->terms; j++) {
            for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
                surface->log_amplitude[t][j][c] += share[j] * (log(amplitude[c]) - scale);
            }
        }
    }
}

static void fit_shapes(struct dig_response_surface *const surface, const size_t t)
{
    for (size_t e = 0; e < surface->set->entries; e++) {
        struct dug dug;
        if (!look_up(surface, t, e, &dug)) {
            continue;
        }
        double amplitude[DIG_FORCE_CHANNELS];
        double share[DIG_RESPONSE_SURFACE_TERMS];
        amplitude_at(surface, t, dug.place, dug.term, amplitude);
        share_of(surface, t, &dug, share);
        for (size_t j = 0; j < surface->terms; j++) {
            for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
                for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                    surface->curve[t][j][c][k] +=
                        share[j] * (double)dug.curve->mean[c][k] / amplitude[c];
                }
            }
        }
    }
    for (size_t j = 0; j < surface->terms; j++) {
        dig_features_of((const double(*)[DIG_CURVE_POINTS])surface->curve[t][j],
                        surface->feature[t][j]);
    }
}

enum dig_status dig_response_surface_fit(const struct dig_curve_set *const  set,
                                         struct dig_response_surface *const surface)
{
    assert(set != NULL && surface != NULL);
    memset(surface, 0, sizeof *surface);
    surface->set = set;
    choose_terms(set, surface);
    bool any = false;
    for (size_t t = 0; t < set->trajectories; t++) {
        surface->known[t] = invert(surface, t);
        if (surface->known[t]) {
            fit_amplitudes(surface, t);
            fit_shapes(surface, t);
            any = true;
        }
    }
    return any ? DIG_OK : DIG_EINVAL;
}

_Static_assert(DIG_FEATURE_BINS == DIG_ROWS_AT_ONCE, "a channel at once");

DIG_VECTORS void dig_response_surface_features(const struct dig_response_surface *const surface,
                                               const size_t                             trajectory,
                                               const double place[DIG_AXES],
                                               double       feature[DIG_FEATURES],
                                               double       amplitude[DIG_FORCE_CHANNELS])
{
    double term[DIG_RESPONSE_SURFACE_TERMS];
    terms_at(surface, place, term);
    amplitude_at(surface, trajectory, place, term, amplitude);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        double shape[DIG_FEATURE_BINS];
        dig_rows_add(surface->terms, term, DIG_FEATURES,
                     &surface->feature[trajectory][0][c * DIG_FEATURE_BINS], shape);
        for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
            feature[c * DIG_FEATURE_BINS + b] = shape[b] * amplitude[c];
        }
    }
}

void dig_response_surface_curve(const struct dig_response_surface *const surface,
                                const size_t trajectory, const double place[DIG_AXES],
                                double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    double term[DIG_RESPONSE_SURFACE_TERMS];
    double amplitude[DIG_FORCE_CHANNELS];
    terms_at(surface, place, term);
    amplitude_at(surface, trajectory, place, term, amplitude);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            double sum = 0.0;
            for (size_t j = 0; j < surface->terms; j++) {
                sum += term[j] * surface->curve[trajectory][j][c][k];
            }
            curve[c][k] = amplitude[c] * sum;
        }
    }
}

double dig_response_surface_noise(const struct dig_response_surface *const surface,
                                  const size_t trajectory, const double place[DIG_AXES])
{
    double term[DIG_RESPONSE_SURFACE_TERMS];
    terms_at(surface, place, term);
    double sum = 0.0;
    for (size_t i = 0; i < surface->terms; i++) {
        for (size_t j = 0; j < surface->terms; j++) {
            sum += term[i] * surface->inverse[trajectory][i][j] * term[j];
        }
    }
    return sum;
}
