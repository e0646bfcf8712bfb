// Error of predicted curves against measured digs (docs/numerics.md), its interval and its noise
// floor; and whether to apply a correction: one that is small beside the scatter of one dig makes
// the next dig's error worse nearly as often as better, even where it is right.

#ifndef DIG_CLOSED_LOOP_ACCURACY_JUDGE_H
#define DIG_CLOSED_LOOP_ACCURACY_JUDGE_H

#include "closed_loop/model/scatter.h"
#include "closed_loop/recordings/measured.h"

#include <stdint.h>

/// Error with its 90 % bootstrap interval over recordings.
struct dig_error_range {
    double value, low, high;
};

/// What is predicted of a dig, and 1 sigma of one dig about it.
struct dig_predicted {
    double value[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS], sd[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
};

/// Of one dig, without what was found and with it.
struct dig_trace_curves {
    struct dig_predicted before, after;
};

/// Digs, and what was predicted of them; all of it the caller's.
struct dig_judged {
    const struct dig_curve_set *set; // whose trajectories the digs are of
    size_t                      digs;
    const struct dig_measured  *measured; // [digs]
    struct dig_trace_curves    *curves;   // [digs]
};

/// 1 sigma of one dig about a predicted curve: the table's own relative scatter at each point, at
/// the size and strength of the gravel at place; noise: variance of the prediction itself, in those
/// of one dig.
void dig_judge_sd(const struct dig_response_surface *surface, const struct dig_scatter *scatter,
                  size_t trajectory, const double place[DIG_AXES], double noise,
                  double sd[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

/// Of a dig that effects make another than its gravel alone would be: the scatter of digs is
/// relative to what they are (closed_loop/fit/batch.h), so sd grows as the sizes of the
/// curves do.
void dig_judge_sd_of_dug(const double plain[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS],
                         const double dug[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS],
                         double       sd[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

/// The error of the moment before or after over the digs that take[] allows, and its 90 % interval
/// by drawing recordings: of one recording alone both ends are the value. All NaN without any.
struct dig_error_range dig_judge_error(const struct dig_judged *judged, const bool take[],
                                       bool after, uint64_t seed);

/// 1 sigma of what the error after would be of a complete model.
double dig_judge_floor(const struct dig_judged *judged, const bool take[]);

/// Chance, 0 … 1, that the curves after are farther from the next dig than those before, if they
/// are exactly its mean: averaged over these digs. A correction d of the moment makes a dig that
/// scatters by e worse where 2 <d, e> < -<d, d>, products over rig time. e is normal, as large as
/// the curves' before.sd and correlated from bin to bin as the scatter is. 1/2 where d is 0.
double dig_decision_chance_of_worse(const struct dig_judged  *judged,
                                    const struct dig_scatter *scatter);

/// Whether the moment's error (docs/numerics.md) after is below that before, over the fitted digs.
bool dig_decision_brings_nearer(const struct dig_judged *judged, const bool fit[]);

#endif // DIG_CLOSED_LOOP_ACCURACY_JUDGE_H
