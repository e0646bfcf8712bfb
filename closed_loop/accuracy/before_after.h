// What is predicted of a dig without and with what was found, and how wrong it is.

#ifndef DIG_CLOSED_LOOP_ACCURACY_BEFORE_AFTER_H
#define DIG_CLOSED_LOOP_ACCURACY_BEFORE_AFTER_H

#include "core/curve.h"

/// Error with its 90 % bootstrap interval over recordings.
struct dig_error_range {
    double value, low, high;
};

/// Curves of one dig for the report.
struct dig_trace_curves {
    double before[DIG_CHANNELS][DIG_CURVE_POINTS], before_sd[DIG_CHANNELS][DIG_CURVE_POINTS];
    double after[DIG_CHANNELS][DIG_CURVE_POINTS], after_sd[DIG_CHANNELS][DIG_CURVE_POINTS];
};

#endif // DIG_CLOSED_LOOP_ACCURACY_BEFORE_AFTER_H
