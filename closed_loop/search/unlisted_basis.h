// What a residual without a name may depend on: functions of the bucket's state, of the dig and of
// how the machine stands, all without dimension.

#ifndef DIG_CLOSED_LOOP_SEARCH_UNLISTED_BASIS_H
#define DIG_CLOSED_LOOP_SEARCH_UNLISTED_BASIS_H

#include "closed_loop/recordings/features.h"
#include "closed_loop/recordings/measured.h"

/// Those before DIG_BASIS_ACCELERATION are told by the trajectory and the pace.
enum dig_basis {
    DIG_BASIS_AMPLITUDE, // 1
    DIG_BASIS_DEPTH,     // over the tooth's length
    DIG_BASIS_DEPTH_SQUARED,
    DIG_BASIS_FILL,         // area swept / tooth^2
    DIG_BASIS_PATH,         // progress
    DIG_BASIS_SPEED,        // over the mean of the table's dig
    DIG_BASIS_TURNING,      // share of the tooth's speed
    DIG_BASIS_LIFTING,      // 1 where the bucket goes up faster than along
    DIG_BASIS_ACCELERATION, // of the tooth, over mean speed^2 / path of the table's dig
    DIG_BASIS_PASS,         // how often the place was dug before
    DIG_BASIS_PITCH,        // of the machine, mean over the dig, rad
    DIG_BASES
};

/// "amplitude", "depth", …, for people.
const char *dig_basis_name(enum dig_basis basis);

/// The functions along one dig, means over the bins of its features.
void dig_basis_along(const struct dig_curve_set *set, const struct dig_measured *dig,
                     double value[DIG_BASES][DIG_FEATURE_BINS]);

#endif // DIG_CLOSED_LOOP_SEARCH_UNLISTED_BASIS_H
