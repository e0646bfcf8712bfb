// Derives entries from runs: each run is smoothed and mapped to trajectory progress, and the runs
// of one gravel give a mean and a spread. Also packs curves into bytes. Internal to tables/.
//
//   run (moment and forces at 5 ms) -> moving average +-0.16 s -> value at the time at which k/255
//   of the path is done -> mean and standard deviation (n - 1) over packings

#ifndef DIG_TABLES_DERIVE_H
#define DIG_TABLES_DERIVE_H

#include "core/curve.h"
#include "core/status.h"

#include <stdbool.h>
#include <stdint.h>

/// Maps one run to path progress. value holds DIG_CHANNELS arrays of `windows` samples, the i-th at
/// first_s + i step_s. O(windows). DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_derive_run(const struct dig_trajectory *trajectory,
                                              double tooth_m, double half_s, size_t windows,
                                              double first_s, double step_s, const float value[],
                                              double out[DIG_CHANNELS][DIG_CURVE_POINTS]);

/// Sums runs up to a mean and a spread. A zeroed struct is empty.
struct dig_ensemble {
    size_t packings;
    double mean[DIG_CHANNELS][DIG_CURVE_POINTS];
    double squares[DIG_CHANNELS][DIG_CURVE_POINTS]; // about the mean
};

void dig_ensemble_add(struct dig_ensemble *ensemble,
                      const double         run[DIG_CHANNELS][DIG_CURVE_POINTS]);

/// sd is NaN when there is one packing only.
void dig_ensemble_curve(const struct dig_ensemble *ensemble, struct dig_curve *curve);

/// float32, little endian, whatever the machine.
void dig_floats_pack(size_t n, const float value[], uint8_t bytes[]);
void dig_floats_unpack(size_t n, const uint8_t bytes[], float value[]);

/// True when DIG_CHANNELS arrays of n numbers can be a run or a curve: all finite, or the carried
/// mass NaN throughout.
bool dig_channels_sound(size_t n, const float value[]);

#endif // DIG_TABLES_DERIVE_H
