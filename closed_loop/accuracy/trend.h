// Trend of digs' residuals over a regressor: means over its bins, and the slope of a straight line
// through all points. Points of one dig depend on each other, so a bootstrap draws whole digs.

#ifndef DIG_CLOSED_LOOP_ACCURACY_TREND_H
#define DIG_CLOSED_LOOP_ACCURACY_TREND_H

#include <stddef.h>
#include <stdint.h>

#define DIG_TREND_BINS       8
#define DIG_TREND_LEAST_DIGS 3 // of fewer no bootstrap tells anything

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
    double               slope, low, high; // of y over x, with its 90 % interval
    double               correlation;
    double               p;    // chance of a slope as far from 0 if there were none
    size_t               bins; // equal widths of x, empty ones left out
    struct dig_trend_bin bin[DIG_TREND_BINS];
};

/// x and y must be finite. Slope and correlation are NaN where x is the same everywhere, low, high
/// and p besides where there are fewer than DIG_TREND_LEAST_DIGS. The same seed gives the same
/// answer. Some hundred microseconds for ten digs.
void dig_trend_fit(size_t digs, const struct dig_trend_dig dig[], uint64_t seed,
                   struct dig_trend *trend);

#endif // DIG_CLOSED_LOOP_ACCURACY_TREND_H
