#include "closed_loop/search/rock.h"

#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum {
    ROUNDS     = 6,  // of fitting the gravel and the factors in turn
    PLACES_MAX = 64, // that are tried
};

// Lengths over the tooth's: between places that are tried, at least; from where the tooth goes in
// to the first rock that can be told from what it meets there anyway.
static const double step   = 0.05;
static const double margin = 0.2;

// Of the hump's squares: a factor is of something only where so much of the largest rock's hump
// lies within the dig.
static const double least_hump = 0.02;

// As for the effects with templates (hypothesis.c): of what it adds, the share that is its error.
static const double unlikeness = 0.2;

// Two log likelihoods this far apart bound a 90 % interval of one number; how much further along a
// buried rock may lie than its hump says, over the tooth's length.
static const double nearly = 1.35;
static const double buried = 0.25;

// What a rock adds along one trajectory, by the tooth's x.
struct hump {
    double x_m[DIG_CURVE_POINTS];
    double more[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]; // of the largest rock where the table has it
    double peak_x_m;
};

// One place tried: each group's hump there, in the batch's units.
struct place {
    double ahead_m;
    double feature[DIG_TRAJECTORY_MAX][DIG_FEATURES]; // units of the table
    double y[DIG_TRAJECTORY_MAX][DIG_FEATURES];
    double squares[DIG_TRAJECTORY_MAX];
};

struct room {
    const struct dig_batch *batch;
    struct hump             hump[DIG_TRAJECTORY_MAX];
    struct dig_batch        without; // the digs less the hump
};

static void describe(const struct room *const r, const size_t g, struct hump *const hump)
{
    static const double               middle[DIG_AXES]                           = { 0.0 };
    static const double               none[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS] = { { 0.0 } };
    const struct dig_curve_set *const set  = r->batch->soil->surface->set;
    const size_t                      t    = r->batch->group[g].trajectory;
    double                            most = 0.0;
    memset(hump, 0, sizeof *hump);
    dig_soil_add_curve(r->batch->soil, DIG_EFFECT_OBSTACLE, t, middle, 1.0, 1.0, 1.0, none,
                       hump->more);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double          progress = (double)k / (DIG_CURVE_POINTS - 1);
        const struct dig_pose pose =
            dig_trajectory_pose(&set->trajectory[t],
                                dig_trajectory_time_s(&set->trajectory[t], set->tooth_m, progress));
        hump->x_m[k] = pose.x_m + set->tooth_m * sin(pose.theta_rad);
        if (hump->more[DIG_CHANNEL_MY_Nm][k] > most) {
            most           = hump->more[DIG_CHANNEL_MY_Nm][k];
            hump->peak_x_m = hump->x_m[k];
        }
    }
}

// What the rock adds where the tooth is at point k, when it lies so much further along. Nothing
// where the tooth stands in x: what is lifted has left the rock behind.
static void shift(const struct hump *const hump, const size_t k, const double ahead_m,
                  double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    const double x_m    = hump->x_m[k] - ahead_m;
    const bool   stands = k > 0 && hump->x_m[k] - hump->x_m[k - 1] < 1e-9;
    size_t       j      = 0;
    while (j + 2 < DIG_CURVE_POINTS && hump->x_m[j + 1] < x_m) {
        j++;
    }
    const double wide_m = hump->x_m[j + 1] - hump->x_m[j];
    const bool within = !stands && wide_m > 1e-9 && x_m >= hump->x_m[0] && x_m <= hump->x_m[j + 1];
    const double w    = within ? (x_m - hump->x_m[j]) / wide_m : 0.0;
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        curve[c][k] = within ? (1.0 - w) * hump->more[c][j] + w * hump->more[c][j + 1] : 0.0;
    }
}

static void put_place(const struct room *const r, const double ahead_m, struct place *const p)
{
    p->ahead_m = ahead_m;
    for (size_t g = 0; g < r->batch->groups; g++) {
        double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            shift(&r->hump[g], k, ahead_m, curve);
        }
        dig_features_of((const double(*)[DIG_CURVE_POINTS])curve, p->feature[g]);
        dig_batch_whiten(&r->batch->group[g], p->feature[g], p->y[g]);
        p->squares[g] = dig_product(r->batch->group[g].features, p->y[g], p->y[g]);
    }
}

// The batch without factor times the hump.
static void take_off(struct room *const r, const struct place *const p, const double factor[])
{
    for (size_t i = 0; i < r->batch->digs; i++) {
        const size_t g = r->batch->dig[i].group;
        for (size_t k = 0; k < r->batch->group[g].features; k++) {
            r->without.dig[i].y[k] = r->batch->dig[i].y[k] - factor[g] * p->y[g][k];
        }
    }
    dig_batch_summarise(&r->without);
}

// What a fit leaves of the mean dig of a group of the batch, or of it without the hump.
static void rest_of(const struct room *const r, const struct dig_fitted *const fitted,
                    const struct dig_batch *const batch, const size_t g, double rest[DIG_FEATURES])
{
    dig_fitted_whitened(batch, fitted, g, dig_batch_first(r->batch, g), rest);
    for (size_t k = 0; k < batch->group[g].features; k++) {
        rest[k] = batch->group[g].mean[k] - rest[k];
    }
}

// The factors that leave least of the means beside the fitted gravel.
static void fit_factors(const struct room *const r, const struct place *const p,
                        const double most_squares[], const struct dig_fitted *const fitted,
                        double factor[])
{
    struct dig_common_error error[DIG_TRAJECTORY_MAX];
    dig_hypothesis_errors(r->batch, fitted, error);
    for (size_t g = 0; g < r->batch->groups; g++) {
        const struct dig_group *const group = &r->batch->group[g];
        double                        rest[DIG_FEATURES];
        double                        hump[DIG_FEATURES];
        rest_of(r, fitted, r->batch, g, rest);
        memcpy(hump, p->y[g], sizeof hump);
        (void)dig_common_error_squares(group, &error[g], rest);
        const double squares  = dig_common_error_squares(group, &error[g], hump);
        const double along    = dig_product(group->features, hump, rest);
        const bool   is_there = p->squares[g] > least_hump * most_squares[g];
        factor[g]             = is_there ? fmax(along / squares, 0.0) : 0.0;
    }
}

// Squares of the means and the misfit with what the hump may be unlike; and the squares as they
// would be by the covariance of another fit.
static void judge(const struct room *const r, const struct place *const p,
                  const struct dig_fitted *const plain, struct dig_rock *const rock)
{
    struct dig_fitted *const f = &rock->plain;
    struct dig_common_error  own[DIG_TRAJECTORY_MAX];
    struct dig_common_error  other[DIG_TRAJECTORY_MAX];
    dig_hypothesis_errors(&r->without, f, own);
    dig_hypothesis_errors(r->batch, plain, other);
    f->squares    = 0.0;
    f->misfit     = 0.0;
    rock->squares = 0.0;
    rock->numbers = 1;
    for (size_t g = 0; g < r->batch->groups; g++) {
        const struct dig_group *const group = &r->without.group[g];
        double                        rest[DIG_FEATURES];
        double                        again[DIG_FEATURES];
        rest_of(r, f, &r->without, g, rest);
        memcpy(again, rest, sizeof again);
        for (size_t i = 0; i < DIG_FEATURES; i++) {
            own[g].size[1][i] = unlikeness * rock->factor[g] * p->feature[g][i];
        }
        dig_common_error_build(group, &own[g]);
        const double left = dig_common_error_squares(group, &own[g], rest);
        f->noise[g]       = own[g].noise;
        f->squares += left;
        f->misfit += own[g].log_det;
        rock->squares += dig_common_error_squares(group, &other[g], again);
        rock->numbers += rock->factor[g] > 0.0 ? 1 : 0;
    }
    f->misfit += dig_batch_misfit(r->batch, f->squares + dig_batch_about(&r->without));
}

// Gravel and factors for one place, in turn.
static void fit_place(struct room *const r, const struct place *const p,
                      const double most_squares[], const struct dig_fitted *const plain,
                      struct dig_rock *const rock)
{
    *rock       = (struct dig_rock){ .known = true, .ahead_m = p->ahead_m };
    rock->plain = *plain;
    for (int round = 0; round < ROUNDS; round++) {
        fit_factors(r, p, most_squares, &rock->plain, rock->factor);
        take_off(r, p, rock->factor);
        double from[DIG_HYPOTHESIS_NUMBERS];
        memcpy(from, rock->plain.number, sizeof from);
        dig_hypothesis_fit(&r->without, &plain->hypothesis, from,
                           round == 0 ? DIG_FIT_THOROUGH : DIG_FIT_BARE, &rock->plain);
    }
    judge(r, p, plain, rock);
}

// From the first place that is not where the tooth goes in to the last that some dig reaches.
static void find_range(const struct room *const r, double *const first_m, double *const last_m)
{
    const double tooth_m = r->batch->soil->surface->set->tooth_m;
    *first_m             = INFINITY;
    *last_m              = -INFINITY;
    for (size_t g = 0; g < r->batch->groups; g++) {
        const struct hump *const h = &r->hump[g];
        *first_m                   = fmin(*first_m, h->x_m[0] + margin * tooth_m - h->peak_x_m);
        *last_m                    = fmax(*last_m, h->x_m[DIG_CURVE_POINTS - 1] - h->peak_x_m);
    }
}

static void fit_all(struct room *const r, const struct dig_fitted *const plain,
                    struct dig_rock *const rock)
{
    struct place place[PLACES_MAX] = { { .ahead_m = 0.0 } };
    double       first_m;
    double       last_m;
    double       most_squares[DIG_TRAJECTORY_MAX] = { 0.0 };
    double       misfit[PLACES_MAX];
    size_t       n = 0;
    find_range(r, &first_m, &last_m);
    const double tooth_m = r->batch->soil->surface->set->tooth_m;
    const double step_m  = fmax(step * tooth_m, (last_m - first_m) / (PLACES_MAX - 1));
    for (; n < PLACES_MAX && first_m + step_m * (double)n <= last_m; n++) {
        put_place(r, first_m + step_m * (double)n, &place[n]);
        for (size_t g = 0; g < r->batch->groups; g++) {
            most_squares[g] = fmax(most_squares[g], place[n].squares[g]);
        }
    }
    rock->plain.misfit = INFINITY;
    for (size_t i = 0; i < n; i++) {
        struct dig_rock tried;
        fit_place(r, &place[i], most_squares, plain, &tried);
        misfit[i] = tried.plain.misfit;
        if (tried.plain.misfit < rock->plain.misfit) {
            *rock = tried;
        }
    }
    rock->low_m  = rock->ahead_m - 0.5 * step_m;
    rock->high_m = rock->ahead_m + 0.5 * step_m;
    for (size_t i = 0; i < n; i++) {
        if (0.5 * (misfit[i] - rock->plain.misfit) < nearly) {
            rock->low_m  = fmin(rock->low_m, place[i].ahead_m - 0.5 * step_m);
            rock->high_m = fmax(rock->high_m, place[i].ahead_m + 0.5 * step_m);
        }
    }
    rock->high_m += buried * tooth_m;
}

struct dig_rock dig_rock_fit(const struct dig_batch *const  batch,
                             const struct dig_fitted *const plain)
{
    assert(batch != NULL && plain != NULL);
    struct dig_rock rock = { .known = false };
    if (!dig_hypothesis_possible(batch, DIG_EFFECT_OBSTACLE)) {
        return rock;
    }
    struct room r = { .batch = batch, .without = *batch };
    for (size_t g = 0; g < batch->groups; g++) {
        describe(&r, g, &r.hump[g]);
    }
    fit_all(&r, plain, &rock);
    rock.known = isfinite(rock.plain.misfit);
    return rock;
}
