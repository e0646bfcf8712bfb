// Inside of the estimator: for estimator/ and for who places one statically. Fixed size.

#ifndef DIG_ESTIMATOR_ESTIMATOR_STATE_H
#define DIG_ESTIMATOR_ESTIMATOR_STATE_H

#include "estimator/estimator.h"

struct dig_estimator {
    const struct dig_machine     *machine;
    const struct dig_curve_set   *set;
    struct dig_estimator_settings settings;
    struct dig_match              match;
};

#endif // DIG_ESTIMATOR_ESTIMATOR_STATE_H
