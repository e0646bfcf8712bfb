// Residuals of a campaign's digs, for people and programs: dig by dig, and over the state of the
// dig: means over bins of a regressor, and the slope of a straight line through all points. Nothing
// is decided by them.

#ifndef DIG_CLOSED_LOOP_VERDICT_RESIDUALS_H
#define DIG_CLOSED_LOOP_VERDICT_RESIDUALS_H

#include "closed_loop/recordings/regressors.h"
#include "closed_loop/verdict/trace_work.h"

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

/// Of one channel in one part of a dig; all NaN where nothing was measured. relative adds up in
/// squares over the parts: of the moment the sum's root is this dig's error (docs/numerics.md).
struct dig_residual {
    double rms; // N m or N
    double
        relative;  // sqrt(integral of its square over the part / of the measured one's, whole dig)
    double sigmas; // rms of it over 1 sigma of one dig about the prediction, sensors included
};

/// By what was predicted, of enum dig_part DIG_PART_SOIL and DIG_PART_LIFTED; that of the air is
/// all NaN.
void dig_residual_of(const struct dig_curve_set *set, const struct dig_measured *dig,
                     const struct dig_predicted *predicted,
                     struct dig_residual         residual[DIG_TRACE_PHASES][DIG_FORCE_CHANNELS]);

struct dig_residuals_dig {
    // In free air, rms over the rms expected, machine as its file says; NaN: none, or a holdout.
    double              air_sigmas;
    struct dig_residual before[DIG_TRACE_PHASES][DIG_FORCE_CHANNELS];
    struct dig_residual after[DIG_TRACE_PHASES][DIG_FORCE_CHANNELS];
};

struct dig_residuals {
    struct dig_residuals_dig dig[DIG_MEASURED_MAX]; // those judged
    // Before, of the digs fitted to that measure the channel, over the rms of what was predicted
    // (of forces: of their resultant). known: any dig does.
    bool             known[DIG_FORCE_CHANNELS];
    struct dig_trend trend[DIG_FORCE_CHANNELS][DIG_REGRESSORS];
};

/// "air", "soil", "lifted".
const char *dig_part_name(enum dig_part part);

/// "moment_Nm", "fx_N", "fz_N".
const char *dig_residual_channel_name(enum dig_channel channel);

/// From what a trace has worked out; curves as in the trace. Some tens of milliseconds.
void dig_residuals_make(const struct dig_trace_work *w, const struct dig_trace_curves curves[],
                        struct dig_residuals *residuals);

#endif // DIG_CLOSED_LOOP_VERDICT_RESIDUALS_H
