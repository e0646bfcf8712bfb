// Which gravel of the table resists like the one measured: Euclidean norm over the path, as the
// paper has it. dig_match_nearest() is exact over all entries; dig_fit_refine() (fit_nlopt.c) goes
// on between the grid points with NLopt. Both run off the real-time thread.

#ifndef DIG_ESTIMATOR_MATCH_MATCH_H
#define DIG_ESTIMATOR_MATCH_MATCH_H

#include "core/curve.h"
#include "estimator/match/gravel_match.h"
#include "estimator/track/observation.h"

#include <math.h>

/// How far digs are from a curve of the table, and what the noise alone would make that; relative
/// to what was measured.
struct dig_distance {
    double distance, noise_floor;
};

/// The same before roots are drawn: sums over points and digs.
struct dig_misfit {
    double miss2_Nm2, floor2_Nm2, whole2_Nm2;
};

static inline void dig_misfit_add(struct dig_misfit *const sum, const struct dig_misfit more)
{
    sum->miss2_Nm2 += more.miss2_Nm2;
    sum->floor2_Nm2 += more.floor2_Nm2;
    sum->whole2_Nm2 += more.whole2_Nm2;
}

static inline struct dig_distance dig_misfit_distance(const struct dig_misfit *const sum)
{
    return (struct dig_distance){ .distance    = sqrt(sum->miss2_Nm2 / sum->whole2_Nm2),
                                  .noise_floor = sqrt(sum->floor2_Nm2 / sum->whole2_Nm2) };
}

struct dig_cell;      // estimator/approach/interpolate.h
struct dig_pooled;    // estimator/match/pool.h
struct dig_prefilter; // estimator/match/prefilter.h

/// Over the points measured, each dig by itself: pooling changes neither distance nor floor but
/// for what chance does to them.
struct dig_misfit dig_cell_misfit(const struct dig_cell *cell, const struct dig_pooled *group);

/// DIG_EINVAL: not finite, 0 everywhere, a range outside 0 … 1, or a trajectory the set lacks.
DIG_MUST_CHECK enum dig_status dig_observation_check(const struct dig_curve_set   *set,
                                                     const struct dig_observation *observation);

/// Interpolates the table's curves of one trajectory at gravel: multilinear in friction, rolling
/// friction and log density within the grid cell around it. DIG_ENOMATCH when the gravel is outside
/// the grid or a corner of its cell that has any weight is missing.
DIG_MUST_CHECK enum dig_status dig_match_interpolate(const struct dig_curve_set *set,
                                                     const struct dig_gravel    *gravel,
                                                     size_t trajectory, struct dig_curve *curve);

/// Nearest entry. gravel, mean, low and high are that entry's; noise_floor is
/// sqrt(sum (sd^2 (1 + 1/packings) + sigma^2)) / ||measured||: one dig about a mean of few, and the
/// measurement. DIG_ENOMATCH: no entry has the observation's trajectory. DIG_EINVAL: an observation
/// that is not finite, is 0 everywhere, or of no trajectory of the set. O(entries).
DIG_MUST_CHECK enum dig_status dig_match_nearest(const struct dig_curve_set   *set,
                                                 const struct dig_observation *observation,
                                                 double outside_floors, struct dig_match *match);

/// The same of several digs of one ground (1 or more, youngest last): the entry that is nearest to
/// all, the root mean square of their distances. An entry that lacks a trajectory that was dug is
/// passed over. 120 kB of stack.
DIG_MUST_CHECK enum dig_status dig_match_nearest_pool(const struct dig_curve_set *set, size_t digs,
                                                      const struct dig_observation dig[],
                                                      double                       outside_floors,
                                                      struct dig_match            *match);

/// The same of a table that was summed up, the very same answer sooner (estimator/match/nearest.h).
DIG_MUST_CHECK enum dig_status dig_match_nearest_prefiltered(const struct dig_prefilter  *summary,
                                                             size_t                       digs,
                                                             const struct dig_observation dig[],
                                                             double            outside_floors,
                                                             struct dig_match *match);

/// Sets weighted and weighted_distance of a valid match of these digs: the entry that is nearest by
/// the noise-weighted distance, over every channel that all of them measured. By a summary of the
/// set the same sooner; NULL is allowed. 200 kB of stack. O(entries).
void dig_match_find_weighted(const struct dig_curve_set *set, const struct dig_prefilter *summary,
                             size_t digs, const struct dig_observation dig[],
                             struct dig_match *match);

/// An axis is not told where its 90 % interval is wider than this share of the table's axis (of
/// density, of its logarithm): the digs do not say which half of it. Where nothing is told at all
/// the interval is nine tenths of the axis; where two gravels far apart are both likely it spans
/// the way between them.
#define DIG_MATCH_TOLD 0.5

/// Sets untold of a match that has low and high; no axis of one point is, nor any of a match that
/// was not refined.
void dig_match_find_family(const struct dig_curve_set *set, struct dig_match *match);

/// True when an axis is not told: the gravels that stand for the match are a family, all of which
/// resist like the digs, and `gravel` is only one of them.
bool dig_match_is_family(const struct dig_match *match);

/// The axes that are not told, "rolling, density_kgpm3"; "" when none.
#define DIG_UNTOLD_SIZE 48
void dig_match_untold(const struct dig_match *match, char text[DIG_UNTOLD_SIZE]);

/// From a nearest match on between the grid points, and the posterior of the gravel (low and high
/// widened where needed to hold the gravel told); judges again by the smallest distance whether the
/// gravel is outside the table. So it is, too, where every dig has forces and they and the moment
/// are too far from the most probable gravel (DIG_POSTERIOR_OUTSIDE); the gravel is that of the
/// moment alone then. Allocates (in NLopt); never call it in the tick. At most
/// max_evaluations of the distance, then the posterior on a fixed grid: some ten milliseconds and
/// 350 kB of stack. DIG_EINVAL: no valid match of this observation, or max_evaluations < 1;
/// DIG_ENOMEM. Then *match is unchanged.
DIG_MUST_CHECK enum dig_status dig_fit_refine(const struct dig_curve_set   *set,
                                              const struct dig_observation *observation,
                                              int max_evaluations, struct dig_match *match);

/// The same of the digs that dig_match_nearest_pool() took: the posterior given all of them.
DIG_MUST_CHECK enum dig_status dig_fit_refine_pool(const struct dig_curve_set *set, size_t digs,
                                                   const struct dig_observation dig[],
                                                   int max_evaluations, struct dig_match *match);

/// The same by a summary, sooner: gravels that look hopeless by its outlines are left out of the
/// posterior, which moves no end of an interval by a thousandth of its axis.
DIG_MUST_CHECK enum dig_status dig_fit_refine_prefiltered(const struct dig_prefilter  *summary,
                                                          size_t                       digs,
                                                          const struct dig_observation dig[],
                                                          int               max_evaluations,
                                                          struct dig_match *match);

/// The curve predicted for one trajectory at the match, rig scale: mean and 1 sigma of one dig, the
/// spread between packings and the uncertainty of the gravel taken together. A match that was not
/// refined predicts for its gravel alone. DIG_EINVAL: no valid match or no such trajectory;
/// DIG_ENOMATCH: the table lacks that trajectory there.
DIG_MUST_CHECK enum dig_status dig_predict_curve(const struct dig_curve_set *set,
                                                 const struct dig_match *match, size_t trajectory,
                                                 struct dig_curve *curve);

#endif // DIG_ESTIMATOR_MATCH_MATCH_H
