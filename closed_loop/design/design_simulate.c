#include "closed_loop/design/design_simulate.h"

#include "closed_loop/model/soil_fit.h"
#include "closed_loop/numeric/dense.h"
#include "core/chance.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { N = DIG_FEATURE_BINS, STEPS_FRICTION = 11, STEPS_ROLLING = 11, STEPS_DENSITY = 7 };
#define GRID ((size_t)STEPS_FRICTION * STEPS_ROLLING * STEPS_DENSITY)

// One dig's scatter at a place, in the table's own.
static double factor_at(const struct dig_design_table *const table, const size_t trajectory,
                        const double place[DIG_AXES], const double amplitude[DIG_FORCE_CHANNELS])
{
    return dig_scatter_factor(table->scatter, trajectory,
                              dig_soil_strength(table->surface, place, amplitude));
}

void dig_design_covariance(const struct dig_design_table *const table, const size_t trajectory,
                           const double place[DIG_AXES], const size_t n, double covariance[])
{
    assert(table != NULL && n <= (size_t)DIG_FEATURES);
    double feature[DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
    dig_response_surface_features(table->surface, trajectory, place, feature, amplitude);
    const double all = factor_at(table, trajectory, place, amplitude) *
                       (1.0 + dig_response_surface_noise(table->surface, trajectory, place));
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            covariance[i * n + j] = all * amplitude[i / DIG_FEATURE_BINS] *
                                    amplitude[j / DIG_FEATURE_BINS] *
                                    table->scatter->covariance[trajectory][i][j];
        }
    }
}

// What a gravel of the grid predicts: mean and covariance, as the posterior needs them.
struct node {
    double place[DIG_AXES];
    double mean[N];
    double lower[N * N]; // covariance = lower lower'
    double log_det;
};

static enum dig_status fill_nodes(const struct dig_design_table *const table, const size_t t,
                                  struct node node[])
{
    for (size_t i = 0; i < GRID; i++) {
        const size_t rest            = i / STEPS_DENSITY;
        const size_t at[DIG_AXES]    = { rest / STEPS_ROLLING, rest % STEPS_ROLLING,
                                         i % STEPS_DENSITY };
        const double steps[DIG_AXES] = { STEPS_FRICTION, STEPS_ROLLING, STEPS_DENSITY };
        double       feature[DIG_FEATURES];
        double       amplitude[DIG_FORCE_CHANNELS];
        for (int a = 0; a < DIG_AXES; a++) {
            node[i].place[a] = 2.0 * ((double)at[a] + 0.5) / steps[a] - 1.0;
        }
        dig_response_surface_features(table->surface, t, node[i].place, feature, amplitude);
        memcpy(node[i].mean, feature, sizeof node[i].mean);
        dig_design_covariance(table, t, node[i].place, N, node[i].lower);
        if (dig_cholesky(N, node[i].lower) != DIG_OK) {
            return DIG_EINVAL;
        }
        node[i].log_det = dig_lower_log_det(N, node[i].lower);
    }
    return DIG_OK;
}

// One dig of the gravel at this place: the table's mean and a packing's residual.
static void draw_dig(const struct dig_design_table *const table, const size_t t,
                     const double place[DIG_AXES], uint64_t *const seed, double y[N])
{
    const struct dig_scatter *const scatter = table->scatter;
    double                          feature[DIG_FEATURES];
    double                          amplitude[DIG_FORCE_CHANNELS];
    double                          noise[N] = { 0.0 };
    dig_response_surface_features(table->surface, t, place, feature, amplitude);
    if (scatter->residuals[t] > 0) {
        const size_t i      = dig_chance_index(seed, scatter->residuals[t]);
        const double factor = factor_at(table, t, place, amplitude);
        for (size_t k = 0; k < N; k++) {
            noise[k] = sqrt(factor) * amplitude[DIG_CHANNEL_MY_Nm] * scatter->residual[t][i][k];
        }
    } else {
        double lower[N * N];
        dig_design_covariance(table, t, place, N, lower);
        for (size_t k = 0; k < N; k++) {
            noise[k] = dig_chance_normal(seed);
        }
        if (dig_cholesky(N, lower) == DIG_OK) {
            dig_lower_multiply(N, lower, noise);
        }
    }
    for (size_t k = 0; k < N; k++) {
        y[k] = feature[k] + noise[k];
    }
}

static void identify(const struct node node[], const double y[N], double place[DIG_AXES])
{
    double log_p[GRID];
    double most = -(double)INFINITY;
    for (size_t i = 0; i < GRID; i++) {
        double off[N];
        for (size_t k = 0; k < N; k++) {
            off[k] = y[k] - node[i].mean[k];
        }
        dig_lower_solve(N, node[i].lower, off);
        log_p[i] = -0.5 * (node[i].log_det + dig_product(N, off, off));
        most     = fmax(most, log_p[i]);
    }
    double whole         = 0.0;
    double sum[DIG_AXES] = { 0.0 };
    for (size_t i = 0; i < GRID; i++) {
        const double p = exp(log_p[i] - most);
        whole += p;
        for (int a = 0; a < DIG_AXES; a++) {
            sum[a] += p * node[i].place[a];
        }
    }
    for (int a = 0; a < DIG_AXES; a++) {
        place[a] = sum[a] / whole;
    }
}

// Square of the relative error of the target's moment when one gravel is taken for another.
static double target_square(const struct dig_response_surface *const surface, const size_t target,
                            const double is[DIG_AXES], const double taken[DIG_AXES])
{
    double a[DIG_FEATURES];
    double b[DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
    double wrong = 0.0;
    double whole = 0.0;
    dig_response_surface_features(surface, target, is, a, amplitude);
    dig_response_surface_features(surface, target, taken, b, amplitude);
    for (size_t k = 0; k < N; k++) {
        wrong += (a[k] - b[k]) * (a[k] - b[k]);
        whole += a[k] * a[k];
    }
    return wrong / whole;
}

static bool has_axis(const struct dig_response_surface *const surface, const int axis)
{
    return surface->set->axis_count[axis] > 1;
}

// Mean square error of place, per axis, over that of knowing nothing (1/3).
static double take_error(const struct dig_response_surface *const surface,
                         const double is[DIG_AXES], const double found[DIG_AXES],
                         struct dig_design_dig *const dig)
{
    double sum  = 0.0;
    double axes = 0.0;
    for (int a = 0; a < DIG_AXES; a++) {
        if (has_axis(surface, a)) {
            const double square = 3.0 * (found[a] - is[a]) * (found[a] - is[a]);
            dig->error_axis[a] += square;
            sum += square;
            axes += 1.0;
        }
    }
    return axes > 0.0 ? sum / axes : 0.0;
}

static void finish_errors(struct dig_design *const design, const double square[],
                          const size_t draws)
{
    const size_t digs = design->digs;
    for (size_t t = 0; t < digs; t++) {
        struct dig_design_dig *const dig = &design->dig[t];
        double                       sum = 0.0;
        for (size_t i = 0; i < draws; i++) {
            sum += square[i * digs + t];
        }
        dig->error        = sqrt(sum / (double)draws);
        dig->target_error = sqrt(dig->target_error / (double)draws);
        for (int a = 0; a < DIG_AXES; a++) {
            dig->error_axis[a] = sqrt(dig->error_axis[a] / (double)draws);
        }
    }
    double mean = 0.0;
    double sq   = 0.0;
    for (size_t i = 0; i < draws; i++) {
        const double gain =
            square[i * digs + design->reference] - square[i * digs + design->rank[0]];
        mean += gain / (double)draws;
        sq += gain * gain / (double)draws;
    }
    const double error = 1.645 * sqrt(fmax(sq - mean * mean, 0.0) / (double)draws);
    design->gain       = mean;
    design->gain_low   = mean - error;
    design->gain_high  = mean + error;
    design->confirmed  = design->gain_low > 0.0;
    design->draws      = draws;
}

// The gravel of the i-th draw: the same for every trajectory, so that they are compared in pairs.
static void draw_place(const struct dig_response_surface *const surface, const uint64_t seed,
                       const size_t i, double place[DIG_AXES])
{
    uint64_t state = seed + 1000003U * (uint64_t)i;
    for (int a = 0; a < DIG_AXES; a++) {
        const double u = 2.0 * dig_chance_uniform(&state) - 1.0;
        place[a]       = has_axis(surface, a) ? u : 0.0;
    }
}

enum dig_status dig_design_simulate(const struct dig_design_table *const table, const size_t draws,
                                    const uint64_t seed, struct dig_design *const design)
{
    const struct dig_response_surface *const surface = table->surface;
    assert(design->ranked > 0 && draws > 0);
    const size_t    digs = design->digs;
    struct node     node[GRID];
    double *const   square = calloc(draws * digs, sizeof *square);
    enum dig_status status = square != NULL ? DIG_OK : DIG_ENOMEM;
    for (size_t t = 0; t < digs && status == DIG_OK; t++) {
        struct dig_design_dig *const dig = &design->dig[t];
        if (!dig->known) {
            continue;
        }
        uint64_t state = seed + t;
        status         = fill_nodes(table, t, node);
        for (size_t i = 0; i < draws && status == DIG_OK; i++) {
            double is[DIG_AXES];
            double found[DIG_AXES];
            double y[N];
            draw_place(surface, seed, i, is);
            draw_dig(table, t, is, &state, y);
            identify(node, y, found);
            square[i * digs + t] = take_error(surface, is, found, dig);
            dig->target_error += target_square(surface, design->target, is, found);
        }
    }
    if (status == DIG_OK) {
        finish_errors(design, square, draws);
    }
    free(square);
    return status;
}
