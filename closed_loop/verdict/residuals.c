#include "closed_loop/verdict/residuals.h"

#include "closed_loop/accuracy/score.h"
#include "closed_loop/recordings/measured.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

static void fill_bin(const size_t digs, const struct dig_trend_dig dig[], const double from,
                     const double to, const bool last, struct dig_trend *const trend)
{
    struct dig_trend_bin bin     = { .at = 0.5 * (from + to) };
    double               squares = 0.0;
    for (size_t i = 0; i < digs; i++) {
        double sum = 0.0;
        double n   = 0.0;
        for (size_t k = 0; k < dig[i].points; k++) {
            if (dig[i].x[k] >= from && (dig[i].x[k] < to || last)) {
                sum += dig[i].y[k];
                n += 1.0;
            }
        }
        if (n > 0.0) {
            const double off = sum / n - bin.mean;
            bin.digs++;
            bin.mean += off / (double)bin.digs;
            squares += off * (sum / n - bin.mean);
        }
    }
    bin.standard_error =
        bin.digs > 1 ? sqrt(squares / (double)((bin.digs - 1) * bin.digs)) : (double)NAN;
    if (bin.digs > 0) {
        trend->bin[trend->bins++] = bin;
    }
}

void dig_trend_fit(const size_t digs, const struct dig_trend_dig dig[],
                   struct dig_trend *const trend)
{
    assert(digs <= DIG_MEASURED_MAX && (digs == 0 || dig != NULL) && trend != NULL);
    const double     gap   = (double)NAN;
    struct dig_trend made  = { .slope = gap, .correlation = gap };
    double           least = INFINITY;
    double           most  = -INFINITY;
    for (size_t i = 0; i < digs; i++) {
        for (size_t k = 0; k < dig[i].points; k++) {
            least = fmin(least, dig[i].x[k]);
            most  = fmax(most, dig[i].x[k]);
        }
    }
    if (most >= least) {
        const double range2 = (most - least) * (most - least);
        double       n      = 0.0;
        double       sx     = 0.0;
        double       sy     = 0.0;
        double       xx     = 0.0;
        double       xy     = 0.0;
        double       yy     = 0.0;
        for (size_t i = 0; i < digs; i++) {
            for (size_t k = 0; k < dig[i].points; k++) {
                const double x = dig[i].x[k] - 0.5 * (least + most); // from near them
                const double y = dig[i].y[k];
                n += 1.0;
                sx += x;
                sy += y;
                xx += x * x;
                xy += x * y;
                yy += y * y;
            }
        }
        // Where x does not vary there is no slope: range2 is what its square might be.
        const double within_x = xx - sx * sx / n;
        const double within_y = yy - sy * sy / n;
        made.slope            = within_x > 1e-9 * range2 * n ? (xy - sx * sy / n) / within_x : gap;
        made.correlation      = within_y > 0.0 ? made.slope * sqrt(within_x / within_y) : gap;
        const size_t bins     = most > least ? DIG_TREND_BINS : 1;
        for (size_t b = 0; b < bins; b++) {
            const double width = (most - least) / (double)bins;
            fill_bin(digs, dig, least + width * (double)b, least + width * (double)(b + 1),
                     b + 1 == bins, &made);
        }
    }
    *trend = made;
}

const char *dig_part_name(const enum dig_part part)
{
    static const char *const name[DIG_TRACE_PHASES] = { "air", "soil", "lifted" };
    assert((size_t)part < DIG_TRACE_PHASES);
    return name[part];
}

const char *dig_residual_channel_name(const enum dig_channel channel)
{
    static const char *const name[DIG_FORCE_CHANNELS] = { "moment_Nm", "fx_N", "fz_N" };
    assert((size_t)channel < DIG_FORCE_CHANNELS);
    return name[channel];
}

// Integrals over rig time.
struct integral {
    double wrong2, over_sigma2, time_s;
};

static struct dig_residual sum_up(const struct integral *const part, const double whole2)
{
    const double              gap  = (double)NAN;
    const struct dig_residual none = { gap, gap, gap };
    return part->time_s > 0.0
               ? (struct dig_residual){ sqrt(part->wrong2 / part->time_s),
                                        whole2 > 0.0 ? sqrt(part->wrong2 / whole2) : gap,
                                        sqrt(part->over_sigma2 / part->time_s) }
               : none;
}

void dig_residual_of(const struct dig_curve_set *const set, const struct dig_measured *const dig,
                     const struct dig_predicted *const predicted,
                     struct dig_residual residual[DIG_TRACE_PHASES][DIG_FORCE_CHANNELS])
{
    assert(set != NULL && dig != NULL && predicted != NULL && residual != NULL);
    assert((size_t)dig->trajectory < set->trajectories);
    const size_t    trajectory = (size_t)dig->trajectory;
    struct integral part[DIG_TRACE_PHASES][DIG_FORCE_CHANNELS];
    double          whole2[DIG_FORCE_CHANNELS] = { 0.0 };
    memset(part, 0, sizeof part);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double progress = (double)k / (DIG_CURVE_POINTS - 1);
        if (progress < dig->first || progress > dig->last) {
            continue;
        }
        const enum dig_part in =
            dig_regressors_is_lifted(set, trajectory, progress) ? DIG_PART_LIFTED : DIG_PART_SOIL;
        const double time_s = dig_score_time_s(set, trajectory, k);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            const double wrong = dig->value[c][k] - predicted->value[c][k];
            const double sigma = hypot(predicted->sd[c][k], dig->sigma[c][k]);
            if (dig->measured[c]) {
                part[in][c].wrong2 += wrong * wrong * time_s;
                part[in][c].over_sigma2 += sigma > 0.0 ? pow(wrong / sigma, 2.0) * time_s : 0.0;
                part[in][c].time_s += time_s;
                whole2[c] += dig->value[c][k] * dig->value[c][k] * time_s;
            }
        }
    }
    for (size_t p = 0; p < DIG_TRACE_PHASES; p++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            residual[p][c] = sum_up(&part[p][c], whole2[c]);
        }
    }
}

// States and relative residuals of the digs fitted to; n points from first on were measured.
struct points {
    size_t digs;
    size_t first[DIG_MEASURED_MAX], n[DIG_MEASURED_MAX];
    double state[DIG_MEASURED_MAX][DIG_REGRESSORS][DIG_CURVE_POINTS];
    double y[DIG_MEASURED_MAX][DIG_CURVE_POINTS];
};

// Adds a dig: over the size of what was predicted of the channel; both forces have that of their
// resultant. One without any has none.
static void add(const struct dig_curve_set *const set, const struct dig_measured *const dig,
                const double predicted[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS], const size_t channel,
                struct points *const p)
{
    const size_t i   = p->digs;
    double       sum = 0.0;
    p->n[i]          = 0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double progress = (double)k / (DIG_CURVE_POINTS - 1);
        if (progress >= dig->first && progress <= dig->last) {
            const double size =
                channel == DIG_CHANNEL_MY_Nm
                    ? predicted[DIG_CHANNEL_MY_Nm][k]
                    : hypot(predicted[DIG_CHANNEL_FX_N][k], predicted[DIG_CHANNEL_FZ_N][k]);
            sum += size * size;
            p->first[i] = k - p->n[i]++;
        }
    }
    const double size = sqrt(sum / fmax((double)p->n[i], 1.0));
    if (!(size > 0.0)) {
        return;
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        p->y[i][k] = (dig->value[channel][k] - predicted[channel][k]) / size;
    }
    dig_regressors_along(set, dig, p->state[i]);
    p->digs++;
}

static void fill_trends(const struct dig_trace_work *const w,
                        const struct dig_trace_curves      curves[],
                        struct dig_residuals *const        residuals)
{
    struct points p;
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        p.digs = 0;
        for (size_t i = 0; i < w->digs; i++) {
            if (w->measured[i].use != DIG_USE_HOLDOUT && w->measured[i].measured[c]) {
                add(w->set, &w->measured[i], curves[i].before.value, c, &p);
            }
        }
        residuals->known[c] = p.digs > 0;
        for (size_t s = 0; s < DIG_REGRESSORS; s++) {
            struct dig_trend_dig dig[DIG_MEASURED_MAX];
            for (size_t i = 0; i < p.digs; i++) {
                dig[i] = (struct dig_trend_dig){ p.n[i], &p.state[i][s][p.first[i]],
                                                 &p.y[i][p.first[i]] };
            }
            dig_trend_fit(p.digs, dig, &residuals->trend[c][s]);
        }
    }
}

void dig_residuals_make(const struct dig_trace_work *const w,
                        const struct dig_trace_curves      curves[],
                        struct dig_residuals *const        residuals)
{
    assert(w != NULL && curves != NULL && residuals != NULL);
    memset(residuals, 0, sizeof *residuals);
    for (size_t i = 0; i < w->digs; i++) {
        struct dig_residuals_dig *const dig = &residuals->dig[i];
        dig->air_sigmas = w->machine != NULL ? w->air->residual_air_of[i] : (double)NAN;
        dig_residual_of(w->set, &w->measured[i], &curves[i].before, dig->before);
        dig_residual_of(w->set, &w->measured[i], &curves[i].after, dig->after);
    }
    fill_trends(w, curves, residuals);
}
