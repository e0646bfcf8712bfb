#include "closed_loop/search/unlisted.h"

#include "closed_loop/numeric/dense.h"
#include "closed_loop/recordings/regressors.h"

#include <assert.h>
#include <math.h>
#include <string.h>

const char *dig_basis_name(const enum dig_basis basis)
{
    static const char *const name[DIG_BASES] = {
        "amplitude", "depth",       "depth squared", "fill", "path",  "speed",
        "turning",   "lifting out", "acceleration",  "pass", "pitch",
    };
    assert((size_t)basis < DIG_BASES);
    return name[basis];
}

enum {
    COMMON      = DIG_BASIS_ACCELERATION, // functions that the trajectory alone tells
    COLUMNS_MAX = DIG_AXES + DIG_UNLISTED_MOST * DIG_FORCE_CHANNELS,
    ROWS_MAX    = (DIG_TRAJECTORY_MAX + DIG_MEASURED_MAX) * DIG_FEATURES,
};

// Rows are the whitened features of the groups' means and, where digs differ in what the functions
// tell, of each dig less its group's mean.
struct regression {
    size_t rows;
    double y[ROWS_MAX];
    double gravel[DIG_AXES][ROWS_MAX]; // one for all digs: 0 in the rows of each
    double function[DIG_BASES][DIG_FORCE_CHANNELS][ROWS_MAX];
};

// Functions by bin, of one dig.
struct states {
    double value[DIG_BASES][DIG_FEATURE_BINS];
};

static void put_rows(const struct dig_group *const group, const double feature[DIG_FEATURES],
                     const double weight, double row[])
{
    double y[DIG_FEATURES];
    dig_batch_whiten(group, feature, y);
    for (size_t k = 0; k < group->features; k++) {
        row[k] = weight * y[k];
    }
}

static void fill_gravel(const struct dig_batch *const batch, const struct dig_fitted *const plain,
                        const size_t g, const double weight, const double model[DIG_FEATURES],
                        struct regression *const r)
{
    const double step = 0.02;
    for (size_t a = 0; a < DIG_AXES; a++) {
        struct dig_fitted moved = *plain;
        double            feature[DIG_FEATURES];
        moved.number[a] += batch->soil->surface->set->axis_count[a] > 1 ? step : 0.0;
        dig_fitted_features(batch->soil, &moved, dig_batch_first(batch, g), feature);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            feature[f] = (feature[f] - model[f]) / step;
        }
        put_rows(&batch->group[g], feature, weight, r->gravel[a] + r->rows);
    }
}

static void fill_functions(const struct dig_group *const group, const struct states *const states,
                           const double weight, const double amplitude[DIG_FORCE_CHANNELS],
                           struct regression *const r)
{
    for (size_t f = 0; f < DIG_BASES; f++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            double feature[DIG_FEATURES] = { 0.0 };
            for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
                feature[c * DIG_FEATURE_BINS + b] = amplitude[c] * states->value[f][b];
            }
            put_rows(group, feature, weight, r->function[f][c] + r->rows);
        }
    }
}

static void fill_mean(const struct dig_batch *const batch, const struct dig_fitted *const plain,
                      const size_t g, const struct states *const mean,
                      double amplitude[DIG_FORCE_CHANNELS], struct regression *const r)
{
    const struct dig_group *const group  = &batch->group[g];
    const double                  weight = 1.0 / sqrt(1.0 / (double)group->digs + plain->noise[g]);
    double                        model[DIG_FEATURES];
    dig_fitted_features(batch->soil, plain, dig_batch_first(batch, g), model);
    put_rows(group, model, weight, r->y + r->rows);
    for (size_t k = 0; k < group->features; k++) {
        r->y[r->rows + k] = weight * group->mean[k] - r->y[r->rows + k];
    }
    dig_features_amplitude(model, NULL, amplitude);
    fill_gravel(batch, plain, g, weight, model, r);
    fill_functions(group, mean, weight, amplitude, r);
    r->rows += group->features;
}

// Squares that the gravel and the chosen functions take off, and how many numbers that took.
static double explain(const struct regression *const r, const size_t functions,
                      const enum dig_basis chosen[], size_t *const columns)
{
    const double *column[COLUMNS_MAX];
    size_t        n = 0;
    for (size_t a = 0; a < DIG_AXES; a++) {
        column[n++] = r->gravel[a];
    }
    for (size_t i = 0; i < functions; i++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            column[n++] = r->function[chosen[i]][c];
        }
    }
    double normal[COLUMNS_MAX * COLUMNS_MAX];
    double right[COLUMNS_MAX];
    *columns = 0;
    for (size_t i = 0; i < n; i++) {
        right[i] = dig_product(r->rows, column[i], r->y);
        for (size_t j = 0; j <= i; j++) {
            normal[i * n + j] = dig_product(r->rows, column[i], column[j]);
        }
        *columns += normal[i * n + i] > 1e-9 ? 1 : 0;
        normal[i * n + i] = normal[i * n + i] * (1.0 + 1e-9) + 1e-9;
    }
    if (dig_cholesky(n, normal) != DIG_OK) {
        return 0.0;
    }
    dig_lower_solve(n, normal, right);
    return dig_product(n, right, right);
}

// The best functions of so many, one after the other.
static struct dig_regressed choose(const struct regression *const r, const size_t candidates)
{
    const double         price = log((double)candidates / COMMON);
    struct dig_regressed found = { .log_evidence = 0.0 };
    size_t               of_gravel;
    const double         alone = explain(r, 0, found.function, &of_gravel);
    for (bool better = true; better && found.functions < DIG_UNLISTED_MOST;) {
        better              = false;
        enum dig_basis best = DIG_BASIS_AMPLITUDE;
        for (size_t i = 0; i < candidates; i++) {
            size_t columns;
            found.function[found.functions] = (enum dig_basis)i;
            const double taken    = explain(r, found.functions + 1, found.function, &columns);
            const double evidence = 0.5 * (taken - alone) -
                                    0.5 * (double)(columns - of_gravel) * log((double)r->rows) -
                                    (double)(found.functions + 1) * price;
            if (evidence > found.log_evidence) {
                found.log_evidence = evidence;
                best               = (enum dig_basis)i;
                better             = true;
            }
        }
        if (better) {
            found.function[found.functions++] = best;
        }
    }
    return found;
}

// The functions along one dig, means over the bins of its features.
static void tell_along(const struct dig_curve_set *const set, const struct dig_measured *const dig,
                       double value[DIG_BASES][DIG_FEATURE_BINS])
{
    const struct dig_trajectory *const t          = &set->trajectory[dig->trajectory];
    const double                       tooth_m    = set->tooth_m;
    const double                       duration_s = dig_trajectory_duration_s(t);
    const double                       whole_m    = dig_trajectory_path_m(t, tooth_m, duration_s);
    double                             state[DIG_REGRESSORS][DIG_CURVE_POINTS];
    dig_regressors_along(set, dig, state);
    memset(value, 0, DIG_BASES * sizeof value[0]);
    for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
        const struct dig_bin points = dig_feature_bin(b);
        for (size_t k = points.from; k < points.to; k++) {
            const double progress = state[DIG_REGRESSOR_PATH][k];
            const double time_s   = dig_trajectory_time_s(t, tooth_m, progress);
            const double depth    = state[DIG_STATE_DEPTH_m][k] / tooth_m;

            const struct dig_phase *const phase = &t->phase[dig_trajectory_phase(t, time_s)];
            const double                  rate_mps =
                hypot(phase->vx_mps, phase->vz_mps) + tooth_m * fabs(phase->omega_radps);
            const double here[DIG_BASES] = {
                [DIG_BASIS_AMPLITUDE]     = 1.0,
                [DIG_BASIS_DEPTH]         = depth,
                [DIG_BASIS_DEPTH_SQUARED] = depth * depth,
                [DIG_BASIS_FILL]          = state[DIG_STATE_FILL_m2][k] / (tooth_m * tooth_m),
                [DIG_BASIS_PATH]          = progress,
                [DIG_BASIS_SPEED]         = rate_mps * duration_s / whole_m * dig->pace,
                [DIG_BASIS_TURNING]       = tooth_m * phase->omega_radps / rate_mps,
                [DIG_BASIS_LIFTING]       = phase->vz_mps > 0.5 * rate_mps ? 1.0 : 0.0,
                [DIG_BASIS_ACCELERATION] =
                    state[DIG_STATE_ACCELERATION_mps2][k] * duration_s * duration_s / whole_m,
                [DIG_BASIS_PASS]  = state[DIG_REGRESSOR_PASS][k] - 1.0,
                [DIG_BASIS_PITCH] = dig->pitch_known ? dig->pitch_rad : 0.0,
            };
            for (size_t f = 0; f < DIG_BASES; f++) {
                value[f][b] += here[f] / (double)(points.to - points.from);
            }
        }
    }
}

// The functions along every dig of a batch, and of each group: the mean over its digs, or what the
// trajectory alone tells.
struct told {
    struct states dig[DIG_MEASURED_MAX];
    struct states mean[DIG_TRAJECTORY_MAX];
};

static void tell(const struct dig_batch *const batch, const bool each, struct told *const told)
{
    bool pitched = each;
    for (size_t i = 0; i < batch->digs; i++) {
        pitched = pitched && batch->measured[batch->dig[i].measured].pitch_known;
    }
    memset(told->mean, 0, sizeof told->mean);
    for (size_t i = 0; i < batch->digs; i++) {
        const struct dig_measured *const dig = &batch->measured[batch->dig[i].measured];
        const size_t                     g   = batch->dig[i].group;
        const struct dig_measured        dug = { .trajectory  = dig->trajectory,
                                                 .pass        = each ? dig->pass : 1,
                                                 .pace        = each ? dig->pace : 1.0,
                                                 .pitch_known = pitched,
                                                 .pitch_rad   = dig->pitch_rad };
        tell_along(batch->soil->surface->set, &dug, told->dig[i].value);
        for (size_t f = 0; f < DIG_BASES; f++) {
            for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
                told->mean[g].value[f][b] +=
                    told->dig[i].value[f][b] / (double)batch->group[g].digs;
            }
        }
    }
}

// What dig i has that its group's mean has not; false where that is nothing.
static bool differ(const struct dig_batch *const batch, const struct told *const told,
                   const size_t i, struct states *const less)
{
    bool any = false;
    for (size_t f = 0; f < DIG_BASES; f++) {
        for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
            less->value[f][b] =
                told->dig[i].value[f][b] - told->mean[batch->dig[i].group].value[f][b];
            any = any || fabs(less->value[f][b]) > 1e-6;
        }
    }
    return any;
}

static void fill_dig(const struct dig_batch *const batch, const size_t i,
                     const struct states *const less, const double amplitude[DIG_FORCE_CHANNELS],
                     struct regression *const r)
{
    const struct dig_group *const group = &batch->group[batch->dig[i].group];
    for (size_t k = 0; k < group->features; k++) {
        r->y[r->rows + k] = batch->dig[i].y[k] - group->mean[k];
    }
    fill_functions(group, less, 1.0, amplitude, r);
    r->rows += group->features;
}

struct dig_regressed dig_regress(const struct dig_batch *const  batch,
                                 const struct dig_fitted *const plain, const bool each)
{
    assert(batch != NULL && plain != NULL);
    struct regression r = { .rows = 0 };
    struct told       told;
    double            amplitude[DIG_TRAJECTORY_MAX][DIG_FORCE_CHANNELS];
    tell(batch, each, &told);
    for (size_t g = 0; g < batch->groups; g++) {
        fill_mean(batch, plain, g, &told.mean[g], amplitude[g], &r);
    }
    for (size_t i = 0; each && i < batch->digs; i++) {
        struct states less;
        if (differ(batch, &told, i, &less)) {
            fill_dig(batch, i, &less, amplitude[batch->dig[i].group], &r);
        }
    }
    return choose(&r, each ? DIG_BASES : COMMON);
}
