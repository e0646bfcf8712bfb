// Trend of digs' residuals over a regressor: means over its bins, and the slope of a straight line
// through all points.

#ifndef DIG_CLOSED_LOOP_ACCURACY_TREND_H
#define DIG_CLOSED_LOOP_ACCURACY_TREND_H

#include <stddef.h>

#define DIG_TREND_BINS 8

/// The points of one dig: y over x.
struct dig_trend_dig {
    size_t        points;
    const double *x;
    const double *y;
};

struct dig_trend_bin {
    double at;             // its middle
    double mean;           // over digs of their means in it
    double standard_error; // of that mean, as the digs tell it; NaN with one dig
    size_t digs;           // that come there
};

struct dig_trend {
    double               slope; // of y over x
    double               correlation;
    size_t               bins; // equal widths of x, empty ones left out
    struct dig_trend_bin bin[DIG_TREND_BINS];
};

/// x and y must be finite. Slope and correlation are NaN where x is the same everywhere.
void dig_trend_fit(size_t digs, const struct dig_trend_dig dig[], struct dig_trend *trend);

#endif // DIG_CLOSED_LOOP_ACCURACY_TREND_H
