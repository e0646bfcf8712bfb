#include "closed_loop/accuracy/trend.h"

#include "closed_loop/recordings/measured.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

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
