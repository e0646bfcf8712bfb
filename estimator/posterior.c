#include "estimator/posterior.h"

#include "estimator/interpolate.h"
#include "estimator/match.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

enum { FINE = 25, FINE_DENSITY = 13, GRID_MAX = FINE * FINE * FINE_DENSITY };

// How many packings the pooled spread is worth against an entry's own.
static const double pooled_weight = 4.0;

// Share of the table's pooled spread below which no point of a curve is believed.
static const double least_spread = 0.25;

// Keeps variances apart from 0, and products of four of them from the end of the numbers.
static const double least_d = 1e-60;

// Of the digs along one trajectory.
struct likelihood {
    const struct dig_pooled *group;
    size_t                   channels;                      // the moment alone, or with both forces
    double                   effective;                     // independent errors along the dig
    double                   relative2[DIG_FORCE_CHANNELS]; // pooled (sd / mean)^2
    size_t                   from, end;                     // points: the first, behind the last
    double                   points;                        // measured
};

// Mean and variance of one dig at each point, of one channel at one gravel.
struct channel_curve {
    double mean[DIG_CURVE_POINTS];
    double spread2[DIG_CURVE_POINTS];
};

static void make_curve(const struct likelihood *const l, const struct dig_cell *const cell,
                       const size_t channel, struct channel_curve *const curve)
{
    const double own    = fmax(1.0 / cell->inverse_packings - 1.0, 0.0);
    const double shared = pooled_weight / (pooled_weight + own);
    dig_cell_blend(cell, (enum dig_channel)channel, curve->mean, curve->spread2);

    double mean2 = 0.0;
    for (size_t k = l->from; k < l->end; k++) {
        mean2 += l->group->count[k] > 0.0 ? curve->mean[k] * curve->mean[k] : 0.0;
    }
    const double relative2 = l->relative2[channel];
    const double floor2    = least_spread * least_spread * relative2 * mean2 / l->points;
    for (size_t k = l->from; k < l->end; k++) {
        const double sd      = curve->spread2[k];
        const double pooled2 = relative2 * curve->mean[k] * curve->mean[k];
        curve->spread2[k]    = (1.0 - shared) * sd * sd + shared * pooled2 + floor2;
    }
}

// The moment alone.
static double log_likelihood_of_moment(const struct likelihood *const l,
                                       const struct dig_cell *const   cell)
{
    struct channel_curve moment;
    make_curve(l, cell, DIG_CHANNEL_MY_Nm, &moment);

    // A logarithm is dear: one of a few variances' product.
    double sum     = 0.0;
    double product = 1.0;
    for (size_t k = l->from; k < l->end; k++) {
        const double n = l->group->count[k];
        if (!(n > 0.0)) {
            continue;
        }
        const double d = moment.spread2[k] * (1.0 / n + cell->inverse_packings) +
                         l->group->sigma2_Nm2[k] / n + least_d;
        const double miss = l->group->mean_Nm[k] - moment.mean[k];
        sum += miss * miss / d;
        product *= d;
        if (k % 4 == 3) {
            sum += log(product);
            product = 1.0;
        }
    }
    return -0.5 * l->effective * (sum + log(product)) / l->points;
}

// Moment and forces of one point: their misses, the variances of the digs' spread, and of the
// measurement, about a mean. Returns miss' D^-1 miss, and det D.
static double joint2(const double miss[DIG_FORCE_CHANNELS], const double spread2[],
                     const double sigma2[], double *const determinant)
{
    double s[DIG_FORCE_CHANNELS];
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        s[c] = sqrt(spread2[c]);
    }
    const double d00 = spread2[0] + sigma2[0];
    const double d11 = spread2[1] + sigma2[1];
    const double d22 = spread2[2] + sigma2[2];
    const double d01 = DIG_POSTERIOR_MY_FX * s[0] * s[1];
    const double d02 = DIG_POSTERIOR_MY_FZ * s[0] * s[2];
    const double d12 = DIG_POSTERIOR_FX_FZ * s[1] * s[2];

    // Cholesky's square-free form: D = L diag(e) L'.
    const double l10 = d01 / d00;
    const double l20 = d02 / d00;
    const double e1  = d11 - l10 * d01;
    const double l21 = (d12 - l20 * d01) / e1;
    const double e2  = d22 - l20 * d02 - l21 * l21 * e1;
    const double y1  = miss[1] - l10 * miss[0];
    const double y2  = miss[2] - l20 * miss[0] - l21 * y1;
    *determinant     = d00 * e1 * e2;
    return miss[0] * miss[0] / d00 + y1 * y1 / e1 + y2 * y2 / e2;
}

static double log_likelihood_of_all(const struct likelihood *const l,
                                    const struct dig_cell *const   cell)
{
    const struct dig_pooled *const group = l->group;
    struct channel_curve           curve[DIG_FORCE_CHANNELS];
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        make_curve(l, cell, c, &curve[c]);
    }
    double sum = 0.0;
    for (size_t k = l->from; k < l->end; k++) {
        const double n = group->count[k];
        if (!(n > 0.0)) {
            continue;
        }
        const double widened   = 1.0 / n + cell->inverse_packings;
        const double miss[]    = { group->mean_Nm[k] - curve[0].mean[k],
                                   group->force_N[0][k] - curve[1].mean[k],
                                   group->force_N[1][k] - curve[2].mean[k] };
        const double spread2[] = { widened * curve[0].spread2[k] + least_d,
                                   widened * curve[1].spread2[k] + least_d,
                                   widened * curve[2].spread2[k] + least_d };
        const double sigma2[]  = { group->sigma2_Nm2[k] / n, group->force_sigma2_N2[0][k] / n,
                                   group->force_sigma2_N2[1][k] / n };
        double       determinant;
        sum += joint2(miss, spread2, sigma2, &determinant);
        sum += log(determinant);
    }
    return -0.5 * l->effective * sum / l->points;
}

static struct likelihood likelihood_of(const struct dig_curve_set *const set,
                                       const struct dig_summary *const   summary,
                                       const struct dig_pooled *const    group)
{
    const struct dig_trajectory *const t = &set->trajectory[group->trajectory];
    const double whole_m = dig_trajectory_path_m(t, set->tooth_m, dig_trajectory_duration_s(t));
    const double correlation_m = DIG_POSTERIOR_CORRELATION * set->tooth_m;

    struct likelihood l = { .group    = group,
                            .channels = group->forces ? DIG_FORCE_CHANNELS : 1,
                            .from     = DIG_CURVE_POINTS };
    for (size_t c = 0; c < l.channels; c++) {
        l.relative2[c] = summary != NULL
                             ? summary->relative2[group->trajectory][c]
                             : dig_summary_relative2(set, group->trajectory, (enum dig_channel)c);
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        if (group->count[k] > 0.0) {
            l.from = k < l.from ? k : l.from;
            l.end  = k + 1;
            l.points += 1.0;
        }
    }
    const double share = (l.points - 1.0) / (DIG_CURVE_POINTS - 1);
    l.effective        = fmax(share * whole_m / correlation_m, 1.0);
    return l;
}

// Of all digs at one gravel; -infinity where the table has no curve.
static double log_likelihood_at(const struct dig_curve_set *const set,
                                const struct dig_gravel *const gravel, const size_t groups,
                                const struct likelihood l[])
{
    double sum = 0.0;
    for (size_t g = 0; g < groups; g++) {
        struct dig_cell cell;
        if (dig_cell_find(set, gravel, l[g].group->trajectory, &cell) != DIG_OK) {
            return -INFINITY;
        }
        sum += l[g].channels == 1 ? log_likelihood_of_moment(&l[g], &cell)
                                  : log_likelihood_of_all(&l[g], &cell);
    }
    return sum;
}

// The fine grid: points are centres of equal intervals of each axis's position.
struct fine {
    size_t count[DIG_AXES];
    size_t all;
};

static struct fine make_fine(const struct dig_curve_set *const set)
{
    struct fine fine = { .all = 1 };
    for (int a = 0; a < DIG_AXES; a++) {
        const size_t most = a == DIG_AXIS_DENSITY_kgpm3 ? FINE_DENSITY : FINE;
        fine.count[a]     = set->axis_count[a] > 1 ? most : 1;
        fine.all *= fine.count[a];
    }
    return fine;
}

static size_t index_on(const struct fine *const fine, const size_t point, const int axis)
{
    size_t rest = point;
    for (int a = DIG_AXES - 1; a > axis; a--) {
        rest /= fine->count[a];
    }
    return rest % fine->count[axis];
}

static struct dig_gravel gravel_at(const struct dig_curve_set *const set,
                                   const struct fine *const fine, const size_t point)
{
    struct dig_gravel gravel;
    for (int a = 0; a < DIG_AXES; a++) {
        const double position = ((double)index_on(fine, point, a) + 0.5) / (double)fine->count[a];
        gravel.value[a]       = dig_axis_value(set, (enum dig_axis)a, position);
    }
    return gravel;
}

// The same of the most probable point; what piles up at an end of an axis belongs there.
static struct dig_gravel mode_at(const struct dig_curve_set *const set,
                                 const struct fine *const fine, const size_t point)
{
    struct dig_gravel gravel = gravel_at(set, fine, point);
    for (int a = 0; a < DIG_AXES; a++) {
        const size_t index = index_on(fine, point, a);
        if (index == 0 || index + 1 == fine->count[a]) {
            gravel.value[a] = dig_axis_value(set, (enum dig_axis)a, index == 0 ? 0.0 : 1.0);
        }
    }
    return gravel;
}

// Position at which the marginal distribution reaches a probability; weights sum to 1.
static double quantile(const struct fine *const fine, const int axis, const double weight[],
                       const double probability)
{
    double marginal[FINE] = { 0 };
    for (size_t i = 0; i < fine->all; i++) {
        marginal[index_on(fine, i, axis)] += weight[i];
    }
    double below = 0.0;
    for (size_t i = 0; i < fine->count[axis]; i++) {
        if (below + marginal[i] >= probability && marginal[i] > 0.0) {
            return ((double)i + (probability - below) / marginal[i]) / (double)fine->count[axis];
        }
        below += marginal[i];
    }
    return 1.0;
}

// Gravels at equal steps of the cumulative weight: each stands for as much of the posterior.
static void draw_samples(const struct dig_curve_set *const set, const struct fine *const fine,
                         const double weight[], struct dig_match *const match)
{
    double sum = 0.0;
    size_t i   = 0;
    for (size_t s = 0; s < DIG_MATCH_SAMPLES; s++) {
        const double at = ((double)s + 0.5) / DIG_MATCH_SAMPLES;
        while (i + 1 < fine->all && sum + weight[i] < at) {
            sum += weight[i++];
        }
        match->sample[s] = gravel_at(set, fine, i);
    }
    match->samples = DIG_MATCH_SAMPLES;
}

enum dig_status dig_posterior_fill(const struct dig_curve_set *const set,
                                   const struct dig_summary *const   summary,
                                   const struct dig_pool_sums *const sums,
                                   struct dig_match *const           match)
{
    assert(set != NULL && sums != NULL && match != NULL);
    for (int a = 0; a < DIG_AXES; a++) {
        if (set->axis_count[a] == 0) {
            return DIG_ENOMATCH;
        }
    }
    struct likelihood l[DIG_TRAJECTORY_MAX];
    for (size_t g = 0; g < sums->groups; g++) {
        l[g] = likelihood_of(set, summary, &sums->group[g]);
    }
    const struct fine fine = make_fine(set);

    double weight[GRID_MAX];
    double most = -INFINITY;
    for (size_t i = 0; i < fine.all; i++) {
        const struct dig_gravel gravel = gravel_at(set, &fine, i);
        weight[i]                      = log_likelihood_at(set, &gravel, sums->groups, l);
        most                           = fmax(most, weight[i]);
    }
    if (!isfinite(most)) {
        return DIG_ENOMATCH;
    }

    size_t mode = 0;
    for (size_t i = 1; i < fine.all; i++) {
        mode = weight[i] > weight[mode] ? i : mode;
    }
    double sum = 0.0;
    for (size_t i = 0; i < fine.all; i++) {
        weight[i] = exp(weight[i] - most);
        sum += weight[i];
    }
    struct dig_gravel mean = { { 0 } };
    for (size_t i = 0; i < fine.all; i++) {
        weight[i] /= sum;
        const struct dig_gravel gravel = gravel_at(set, &fine, i);
        for (int a = 0; a < DIG_AXES; a++) {
            mean.value[a] += weight[i] * gravel.value[a];
        }
    }

    match->mean = mean;
    match->mode = mode_at(set, &fine, mode);
    for (int a = 0; a < DIG_AXES; a++) {
        const enum dig_axis axis = (enum dig_axis)a;
        match->low.value[a]      = dig_axis_value(set, axis, quantile(&fine, a, weight, 0.05));
        match->high.value[a]     = dig_axis_value(set, axis, quantile(&fine, a, weight, 0.95));
    }
    draw_samples(set, &fine, weight, match);
    return DIG_OK;
}
