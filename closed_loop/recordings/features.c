#include "closed_loop/recordings/features.h"

#include <assert.h>
#include <math.h>

static const double least_amplitude = 1e-12;

struct dig_bin dig_feature_bin(const size_t bin)
{
    assert(bin < DIG_FEATURE_BINS);
    return (struct dig_bin){ bin * DIG_CURVE_POINTS / DIG_FEATURE_BINS,
                             (bin + 1) * DIG_CURVE_POINTS / DIG_FEATURE_BINS };
}

void dig_features_of(const double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS],
                     double       feature[DIG_FEATURES])
{
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
            const struct dig_bin points = dig_feature_bin(b);
            double               sum    = 0.0;
            for (size_t k = points.from; k < points.to; k++) {
                sum += curve[c][k];
            }
            feature[c * DIG_FEATURE_BINS + b] = sum / (double)(points.to - points.from);
        }
    }
}

void dig_features_of_table(const float curve[DIG_CHANNELS][DIG_CURVE_POINTS],
                           double      feature[DIG_FEATURES])
{
    double wide[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            wide[c][k] = (double)curve[c][k];
        }
    }
    dig_features_of((const double(*)[DIG_CURVE_POINTS])wide, feature);
}

void dig_features_mask(const bool measured[DIG_FORCE_CHANNELS], const double first,
                       const double last, bool mask[DIG_FEATURES])
{
    // A bin may lack its outermost point: the path of a recording ends between two points.
    const double slack = 1.0 / (DIG_CURVE_POINTS - 1);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
            const struct dig_bin points = dig_feature_bin(b);
            mask[c * DIG_FEATURE_BINS + b] =
                measured[c] && (double)points.from / (DIG_CURVE_POINTS - 1) >= first - slack &&
                (double)(points.to - 1) / (DIG_CURVE_POINTS - 1) <= last + slack;
        }
    }
}

static double mean_square(const double feature[DIG_FEATURES], const bool mask[DIG_FEATURES],
                          const size_t channel)
{
    double sum = 0.0;
    double n   = 0.0;
    for (size_t b = 0; b < DIG_FEATURE_BINS; b++) {
        const size_t f = channel * DIG_FEATURE_BINS + b;
        if (mask == NULL || mask[f]) {
            sum += feature[f] * feature[f];
            n += 1.0;
        }
    }
    return n > 0.0 ? sum / n : 0.0;
}

void dig_features_amplitude(const double feature[DIG_FEATURES], const bool mask[DIG_FEATURES],
                            double amplitude[DIG_FORCE_CHANNELS])
{
    const double moment          = sqrt(mean_square(feature, mask, DIG_CHANNEL_MY_Nm));
    const double force           = sqrt(mean_square(feature, mask, DIG_CHANNEL_FX_N) +
                                        mean_square(feature, mask, DIG_CHANNEL_FZ_N));
    amplitude[DIG_CHANNEL_MY_Nm] = fmax(moment, least_amplitude);
    amplitude[DIG_CHANNEL_FX_N]  = fmax(force, least_amplitude);
    amplitude[DIG_CHANNEL_FZ_N]  = fmax(force, least_amplitude);
}

// e^(-|x|), integrated four times from its middle on.
static double integrated(const double x)
{
    return pow(fabs(x), 3.0) / 6.0 + fabs(x) + exp(-fabs(x));
}

// Means over so wide a stretch about two places so far apart, integrated twice over that.
static double smoothed(const double apart, const double width)
{
    return (integrated(apart + width) - 2.0 * integrated(apart) + integrated(apart - width)) /
           (width * width);
}

void dig_features_lasting(const double edge_s[DIG_FEATURE_BINS + 1], const double half_s,
                          const double memory_s,
                          double       covariance[DIG_FEATURE_BINS * DIG_FEATURE_BINS])
{
    assert(half_s > 0.0 && memory_s > 0.0);
    const double width = 2.0 * half_s / memory_s;
    for (size_t i = 0; i < DIG_FEATURE_BINS; i++) {
        for (size_t j = 0; j < DIG_FEATURE_BINS; j++) {
            const double a[2] = { edge_s[i] / memory_s, edge_s[i + 1] / memory_s };
            const double b[2] = { edge_s[j] / memory_s, edge_s[j + 1] / memory_s };
            covariance[i * DIG_FEATURE_BINS + j] =
                (smoothed(a[1] - b[0], width) + smoothed(a[0] - b[1], width) -
                 smoothed(a[1] - b[1], width) - smoothed(a[0] - b[0], width)) /
                ((a[1] - a[0]) * (b[1] - b[0]));
        }
    }
}
