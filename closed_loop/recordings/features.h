// A dig as a short vector: each channel's smoothed curve averaged over equal bins of progress. What
// the closed loop compares; the noise of so few numbers can be known, that of 256 points cannot.

#ifndef DIG_CLOSED_LOOP_RECORDINGS_FEATURES_H
#define DIG_CLOSED_LOOP_RECORDINGS_FEATURES_H

#include "core/curve.h"

#include <stdbool.h>

#define DIG_FEATURE_BINS 10
#define DIG_FEATURES     ((size_t)DIG_FORCE_CHANNELS * DIG_FEATURE_BINS) // channel by channel

/// Points [from, to) of the progress grid that make a bin.
struct dig_bin {
    size_t from, to;
};
struct dig_bin dig_feature_bin(size_t bin);

/// Averages the channels of a curve.
void dig_features_of(const double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS],
                     double       feature[DIG_FEATURES]);

/// The same of a table's curve.
void dig_features_of_table(const float curve[DIG_CHANNELS][DIG_CURVE_POINTS],
                           double      feature[DIG_FEATURES]);

/// Which features a dig has that was measured from first to last: channels measured, bins that lie
/// within.
void dig_features_mask(const bool measured[DIG_FORCE_CHANNELS], double first, double last,
                       bool mask[DIG_FEATURES]);

/// The size of a dig, channel by channel: the rms of the moment over the bins, and for both forces
/// the rms of their resultant, over those of the bins that the mask allows (NULL: all). Never 0.
void dig_features_amplitude(const double feature[DIG_FEATURES], const bool mask[DIG_FEATURES],
                            double amplitude[DIG_FORCE_CHANNELS]);

/// How noise of a variance of 1 that becomes e times less alike in memory_s goes into the features
/// of a channel: their covariance. Bin b lies between edge_s[b] and edge_s[b + 1], smoothed over
/// +-half_s.
void dig_features_lasting(const double edge_s[DIG_FEATURE_BINS + 1], double half_s, double memory_s,
                          double covariance[DIG_FEATURE_BINS * DIG_FEATURE_BINS]);

#endif // DIG_CLOSED_LOOP_RECORDINGS_FEATURES_H
