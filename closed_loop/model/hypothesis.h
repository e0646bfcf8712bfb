// A way the digs of a campaign may have come about - a gravel, and effects of the soil or none -
// and how well it explains them, everything refitted together.
//
//   y(dig) = model(gravel, effects, dig) + common + scatter
//
// In a batch's units scatter is 1 per dig, and common, shared by all digs of a trajectory, has the
// variance v: of the surface, of the templates at the fitted magnitudes, of the DEM itself, and of
// a template's likeness to the effect in the ground. The misfit is -2 log likelihood:
//
//   sum over trajectories [ |mean y - mean model|^2 / (1/n + v) + m log(1/n + v)
//                           + sum over digs |(y - mean y) - (model - mean model)|^2 ]

#ifndef DIG_CLOSED_LOOP_MODEL_HYPOTHESIS_H
#define DIG_CLOSED_LOOP_MODEL_HYPOTHESIS_H

#include "closed_loop/model/soil.h"
#include "closed_loop/model/whitened_digs.h"

#define DIG_HYPOTHESIS_EFFECTS 3
#define DIG_HYPOTHESIS_NUMBERS (DIG_AXES + DIG_HYPOTHESIS_EFFECTS)

struct dig_hypothesis {
    size_t             effects; // 0: nothing but a gravel
    enum dig_effect_id effect[DIG_HYPOTHESIS_EFFECTS];
    bool               outside; // the gravel may lie beyond the table's grid
};

struct dig_fitted {
    struct dig_hypothesis hypothesis;
    double                number[DIG_HYPOTHESIS_NUMBERS]; // place, then u of each effect
    double                low[DIG_HYPOTHESIS_NUMBERS];    // 90 % interval, by the curvature
    double                high[DIG_HYPOTHESIS_NUMBERS];
    double                noise[DIG_TRAJECTORY_MAX]; // v by group
    double                misfit;                    // as above
    double                squares;                   // of it, what is not a logarithm
    size_t                observations;              // numbers fitted to
    size_t                free;                      // numbers fitted
};

/// True when the digs of a batch can show the effect at all: templates along every trajectory,
/// passes, paces or an order that differ.
bool dig_hypothesis_possible(const struct dig_whitened_digs *batch, const struct dig_soil *soil,
                             enum dig_effect_id effect);

/// True when some effect of it differs from dig to dig of a trajectory.
bool dig_hypothesis_differs(const struct dig_hypothesis *hypothesis);

/// What of a fit is asked for: number and misfit from one start; its intervals too (low and high
/// are 0 otherwise); all that, from more starts.
enum dig_fit_care { DIG_FIT_BARE, DIG_FIT_ONCE, DIG_FIT_THOROUGH };

/// Fits. start: numbers to start from (place, u). Some hundred microseconds a start.
void dig_hypothesis_fit(const struct dig_whitened_digs *batch, const struct dig_soil *soil,
                        const struct dig_hypothesis *hypothesis, const double start[],
                        enum dig_fit_care care, struct dig_fitted *fitted);

/// Features of one dig of a batch by a fitted hypothesis, units of the table; *noise (NULL: not
/// asked for) as v, without what all hypotheses have.
void dig_hypothesis_features(const struct dig_soil *soil, const struct dig_hypothesis *hypothesis,
                             const double number[], const struct dig_measured *dig,
                             double feature[DIG_FEATURES], double *noise);

/// The whole curve.
void dig_hypothesis_curve(const struct dig_soil *soil, const struct dig_hypothesis *hypothesis,
                          const double number[], const struct dig_measured *dig,
                          double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

/// Squares of the means' misfit of a fitted hypothesis as they would be with another's noise.
double dig_hypothesis_squares(const struct dig_whitened_digs *batch, const struct dig_soil *soil,
                              const struct dig_fitted *fitted, const double noise[]);

#endif // DIG_CLOSED_LOOP_MODEL_HYPOTHESIS_H
