#include "closed_loop/unlisted.h"

#include "closed_loop/dense.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    FUNCTIONS     = 8,
    FUNCTIONS_MAX = 3, // in one answer
    COLUMNS_MAX   = DIG_AXES + FUNCTIONS_MAX * DIG_FORCE_CHANNELS,
    ROWS_MAX      = DIG_TRAJECTORY_MAX * DIG_FEATURES,
};

static const char *const name_of[FUNCTIONS] = {
    "amplitude", "depth", "depth squared", "fill", "path", "speed", "turning", "lifting out",
};

// The functions of state in each bin of a trajectory.
struct states {
    double value[FUNCTIONS][DIG_FEATURE_BINS];
};

static double tooth_z_m(const struct dig_curve_set *const set, const struct dig_pose *const pose)
{
    return pose->z_m - set->tooth_m * cos(pose->theta_rad);
}

static double tooth_x_m(const struct dig_curve_set *const set, const struct dig_pose *const pose)
{
    return pose->x_m + set->tooth_m * sin(pose->theta_rad);
}

// A dig starts with its tooth on the ground.
static void describe(const struct dig_curve_set *const set, const size_t trajectory,
                     struct states *const states)
{
    const struct dig_trajectory *const t          = &set->trajectory[trajectory];
    const double                       duration_s = dig_trajectory_duration_s(t);
    const struct dig_pose              start      = dig_trajectory_pose(t, 0.0);
    const double                       ground_m   = tooth_z_m(set, &start);
    double                             swept_m2   = 0.0;
    double                             before_m   = tooth_x_m(set, &start);
    memset(states, 0, sizeof *states);
    for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
        size_t from;
        size_t to;
        dig_feature_bin(b, &from, &to);
        for (size_t k = from; k < to; k++) {
            const double                  progress = (double)k / (DIG_CURVE_POINTS - 1);
            const double                  time_s = dig_trajectory_time_s(t, set->tooth_m, progress);
            const struct dig_pose         pose   = dig_trajectory_pose(t, time_s);
            const struct dig_phase *const phase  = &t->phase[dig_trajectory_phase(t, time_s)];
            const double                  depth_m = fmax(ground_m - tooth_z_m(set, &pose), 0.0);
            const double                  x_m     = tooth_x_m(set, &pose);
            const double                  depth   = depth_m / set->tooth_m;
            swept_m2 += depth_m * fabs(x_m - before_m);
            before_m = x_m;

            const double rate_mps =
                hypot(phase->vx_mps, phase->vz_mps) + set->tooth_m * fabs(phase->omega_radps);
            const double whole_m          = dig_trajectory_path_m(t, set->tooth_m, duration_s);
            const double value[FUNCTIONS] = {
                1.0,
                depth,
                depth * depth,
                swept_m2 / (set->tooth_m * set->tooth_m),
                progress,
                rate_mps * duration_s / whole_m,
                set->tooth_m * phase->omega_radps / rate_mps,
                phase->vz_mps > 0.5 * rate_mps ? 1.0 : 0.0,
            };
            for (size_t f = 0; f < FUNCTIONS; f++) {
                states->value[f][b] += value[f] / (double)(to - from);
            }
        }
    }
}

// The regression: rows are the whitened features of the groups' means.
struct regression {
    size_t rows;
    double y[ROWS_MAX];
    double gravel[DIG_AXES][ROWS_MAX];
    double function[FUNCTIONS][DIG_FORCE_CHANNELS][ROWS_MAX];
};

static double weight_of(const struct dig_batch *const batch, const struct dig_fitted *const fitted,
                        const size_t g)
{
    return 1.0 / sqrt(1.0 / (double)batch->group[g].digs + fitted->noise[g]);
}

static void put_rows(const struct dig_batch_group *const group, const double feature[DIG_FEATURES],
                     const double weight, double row[])
{
    double y[DIG_FEATURES];
    dig_batch_whiten(group, feature, y);
    for (size_t k = 0; k < group->features; k++) {
        row[k] = weight * y[k];
    }
}

static void fill_gravel(const struct dig_batch *const batch, const struct dig_soil *const soil,
                        const struct dig_fitted *const plain, const size_t g, const double weight,
                        const double model[DIG_FEATURES], struct regression *const r)
{
    const double step = 0.02;
    for (size_t a = 0; a < DIG_AXES; a++) {
        double moved[DIG_HYPOTHESIS_NUMBERS];
        double feature[DIG_FEATURES];
        double noise;
        memcpy(moved, plain->number, sizeof moved);
        moved[a] += soil->surface->set->axis_count[a] > 1 ? step : 0.0;
        dig_hypothesis_features(soil, &plain->hypothesis, moved, dig_batch_first(batch, g), feature,
                                &noise);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            feature[f] = (feature[f] - model[f]) / step;
        }
        put_rows(&batch->group[g], feature, weight, r->gravel[a] + r->rows);
    }
}

static void fill_functions(const struct dig_batch *const batch, const size_t g, const double weight,
                           const double model[DIG_FEATURES], struct regression *const r)
{
    struct states states;
    double        amplitude[DIG_FORCE_CHANNELS];
    describe(batch->surface->set, batch->group[g].trajectory, &states);
    dig_features_amplitude(model, NULL, amplitude);
    for (size_t f = 0; f < FUNCTIONS; f++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            double feature[DIG_FEATURES] = { 0.0 };
            for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
                feature[c * DIG_FEATURE_BINS + b] = amplitude[c] * states.value[f][b];
            }
            put_rows(&batch->group[g], feature, weight, r->function[f][c] + r->rows);
        }
    }
}

static void fill(const struct dig_batch *const batch, const struct dig_soil *const soil,
                 const struct dig_fitted *const plain, struct regression *const r)
{
    r->rows = 0;
    for (size_t g = 0; g < batch->groups; g++) {
        const struct dig_batch_group *const group  = &batch->group[g];
        const double                        weight = weight_of(batch, plain, g);
        double                              model[DIG_FEATURES];
        double                              noise;
        dig_hypothesis_features(soil, &plain->hypothesis, plain->number, dig_batch_first(batch, g),
                                model, &noise);
        put_rows(group, model, weight, r->y + r->rows);
        for (size_t k = 0; k < group->features; k++) {
            r->y[r->rows + k] = weight * group->mean[k] - r->y[r->rows + k];
        }
        fill_gravel(batch, soil, plain, g, weight, model, r);
        fill_functions(batch, g, weight, model, r);
        r->rows += group->features;
    }
}

// Squares that the gravel and the chosen functions take off, and how many numbers that took.
static double explain(const struct regression *const r, const size_t functions,
                      const size_t chosen[], size_t *const columns)
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
        right[i] = 0.0;
        for (size_t k = 0; k < r->rows; k++) {
            right[i] += column[i][k] * r->y[k];
        }
        for (size_t j = 0; j <= i; j++) {
            normal[i * n + j] = 0.0;
            for (size_t k = 0; k < r->rows; k++) {
                normal[i * n + j] += column[i][k] * column[j][k];
            }
        }
        *columns += normal[i * n + i] > 1e-9 ? 1 : 0;
        normal[i * n + i] = normal[i * n + i] * (1.0 + 1e-9) + 1e-9;
    }
    if (dig_cholesky(n, normal) != DIG_OK) {
        return 0.0;
    }
    dig_lower_solve(n, normal, right);
    double taken = 0.0;
    for (size_t i = 0; i < n; i++) {
        taken += right[i] * right[i];
    }
    return taken;
}

enum dig_status dig_unlisted_find(const struct dig_batch *const  batch,
                                  const struct dig_soil *const   soil,
                                  const struct dig_fitted *const plain,
                                  struct dig_unlisted *const     unlisted)
{
    assert(batch != NULL && plain != NULL && unlisted != NULL);
    struct regression *const r = malloc(sizeof *r);
    if (r == NULL) {
        return DIG_ENOMEM;
    }
    fill(batch, soil, plain, r);
    struct dig_unlisted found                     = { .log_evidence = 0.0 };
    size_t              chosen[FUNCTIONS_MAX + 1] = { 0 };
    size_t              of_gravel;
    const double        alone = explain(r, 0, chosen, &of_gravel);
    for (bool better = true; better && found.functions < FUNCTIONS_MAX;) {
        better      = false;
        size_t best = 0;
        for (size_t f = 0; f < FUNCTIONS; f++) {
            size_t columns;
            chosen[found.functions] = f;
            const double taken      = explain(r, found.functions + 1, chosen, &columns);
            const double evidence =
                0.5 * (taken - alone) - 0.5 * (double)(columns - of_gravel) * log((double)r->rows);
            if (evidence > found.log_evidence) {
                found.log_evidence = evidence;
                best               = f;
                better             = true;
            }
        }
        if (better) {
            chosen[found.functions++] = best;
        }
    }
    for (size_t i = 0; i < found.functions; i++) {
        const size_t used = strlen(found.depends_on);
        (void)snprintf(found.depends_on + used, sizeof found.depends_on - used, "%s%s",
                       i > 0 ? ", " : "", name_of[chosen[i]]);
    }
    free(r);
    *unlisted = found;
    return DIG_OK;
}

// How much of a group's mean residual is more than its noise: 0 … 1.
static double credible(const struct dig_batch *const batch, const struct dig_soil *const soil,
                       const struct dig_fitted *const fitted, const size_t g)
{
    const struct dig_batch_group *const group = &batch->group[g];
    double                              feature[DIG_FEATURES];
    double                              model[DIG_FEATURES];
    double                              noise;
    double                              squares = 0.0;
    dig_hypothesis_features(soil, &fitted->hypothesis, fitted->number, dig_batch_first(batch, g),
                            feature, &noise);
    dig_batch_whiten(group, feature, model);
    for (size_t k = 0; k < group->features; k++) {
        squares += pow(group->mean[k] - model[k], 2.0);
    }
    const double expected =
        (double)group->features * (1.0 / (double)group->digs + fitted->noise[g]);
    return squares > expected ? 1.0 - expected / squares : 0.0;
}

// What is left of a dig's curves.
static void left_of(const struct dig_soil *const soil, const struct dig_fitted *const fitted,
                    const struct dig_measured *const dig,
                    double                           left[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    dig_hypothesis_curve(soil, &fitted->hypothesis, fitted->number, dig, curve);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            left[c][k] = dig->value[c][k] - dig->machine[c][k] - curve[c][k];
        }
    }
}

// The mean of what is left of a group's digs.
static void mean_left(const struct dig_batch *const batch, const struct dig_soil *const soil,
                      const struct dig_fitted *const fitted, const size_t g,
                      double mean[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    memset(mean, 0, DIG_FORCE_CHANNELS * sizeof mean[0]);
    for (size_t i = 0; i < batch->digs; i++) {
        double left[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        left_of(soil, fitted, &batch->measured[batch->dig[i].measured], left);
        for (size_t c = 0; batch->dig[i].group == g && c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                mean[c][k] += left[c][k] / (double)batch->group[g].digs;
            }
        }
    }
}

// What is gained, in squares of the moment, when each dig of a group is predicted from the others'
// residuals.
static double gain_of(const struct dig_batch *const batch, const struct dig_soil *const soil,
                      const struct dig_fitted *const fitted, const size_t g)
{
    const double by = credible(batch, soil, fitted, g);
    const double n  = (double)batch->group[g].digs;
    double       mean[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    double       gain = 0.0;
    mean_left(batch, soil, fitted, g, mean);
    for (size_t i = 0; n > 1.0 && i < batch->digs; i++) {
        double left[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        if (batch->dig[i].group != g) {
            continue;
        }
        left_of(soil, fitted, &batch->measured[batch->dig[i].measured], left);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double own    = left[DIG_CHANNEL_MY_Nm][k];
            const double others = (n * mean[DIG_CHANNEL_MY_Nm][k] - own) / (n - 1.0);
            gain += own * own - pow(own - by * others, 2.0);
        }
    }
    return gain;
}

// Whether a trajectory's mean residual is worth taking off. Digs that differ from each other rather
// than from the table are made worse by it; of a dig alone the other trajectories tell.
static void choose_groups(const struct dig_batch *const batch, const struct dig_soil *const soil,
                          const struct dig_fitted *const fitted, bool helps[DIG_TRAJECTORY_MAX])
{
    bool all = true;
    for (size_t g = 0; g < batch->groups; g++) {
        helps[g] = batch->group[g].digs < 2 || gain_of(batch, soil, fitted, g) > 0.0;
        all      = all && helps[g];
    }
    for (size_t g = 0; g < batch->groups; g++) {
        helps[g] = helps[g] && (all || batch->group[g].digs > 1);
    }
}

void dig_unlisted_correct(const struct dig_batch *const batch, const struct dig_soil *const soil,
                          const struct dig_fitted *const   fitted,
                          struct dig_model_unlisted *const share)
{
    bool helps[DIG_TRAJECTORY_MAX] = { false };
    memset(share->share, 0, sizeof share->share);
    choose_groups(batch, soil, fitted, helps);
    for (size_t g = 0; g < batch->groups; g++) {
        const size_t t  = batch->group[g].trajectory;
        const double by = helps[g] ? credible(batch, soil, fitted, g) : 0.0;
        double       curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        double       mean[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        mean_left(batch, soil, fitted, g, mean);
        dig_hypothesis_curve(soil, &fitted->hypothesis, fitted->number, dig_batch_first(batch, g),
                             curve);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            double squares = 0.0;
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                squares += curve[c][k] * curve[c][k] / DIG_CURVE_POINTS;
            }
            for (size_t k = 0; dig_batch_first(batch, g)->measured[c] && k < DIG_CURVE_POINTS;
                 k++) {
                share->share[t][c][k] = (float)(by * mean[c][k] / fmax(sqrt(squares), 1e-12));
            }
        }
    }
}
