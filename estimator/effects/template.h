// Templates: the change of a curve by an effect of the soil, from beds dug with the effect.
//
//   share(b, m) = (curve of the bed with effect at magnitude m - plain curve) / amplitude
//
// at the base gravel b, amplitude the rms of the plain curve of that channel and trajectory. At any
// gravel g the addition is amplitude(g) * share. Between magnitudes a share is piecewise linear
// through "absent", where it is 0; between base gravels linear in their strength,
// log(rms My / density), held beyond the weakest and strongest. Cohesion and adhesion act by their
// ratio to the stiffness of contacts (docs/numerics/dem.md, "Other laws"), so their magnitude is
// scaled by dig_template_scale() first.

#ifndef DIG_ESTIMATOR_EFFECTS_TEMPLATE_H
#define DIG_ESTIMATOR_EFFECTS_TEMPLATE_H

#include "core/curve.h"
#include "core/entry_set.h"
#include "core/status.h"

#include <stdbool.h>

/// Extrapolation: beyond the table's last magnitude by this share of its distance from absent; on
/// the side of absent that the table lacks, as far as half its first.
#define DIG_TEMPLATE_BEYOND 0.5

/// The addition to the mean curve, in its units, and 1 sigma of it: templates and plain curves are
/// means of few packings. Errors of the points of one channel are correlated as packings are.
struct dig_template {
    double delta[DIG_CHANNELS][DIG_CURVE_POINTS];
    double sigma[DIG_CHANNELS][DIG_CURVE_POINTS];
};

/// The magnitude at which an effect is absent: 1 for the ratios of polydispersity and grain_shape,
/// 0 for all others.
double dig_template_absent(enum dig_effect_id effect);

/// What a magnitude in gravel of a density is times, so that it acts as at the base's: the
/// stiffness of contacts there over that here where the effect acts over it, 1 for all others.
double dig_template_scale(const struct dig_curve_set *plain, enum dig_effect_id effect,
                          double base_kgpm3, double density_kgpm3);

/// Range of magnitudes with a template along this trajectory, extrapolation included; false when
/// the set has none. set NULL: false. O(entries).
bool dig_template_range(const struct dig_entry_set *effects, enum dig_effect_id effect,
                        size_t trajectory, double *low, double *high);

/// The addition at a magnitude and gravel. DIG_ENOMATCH: no template of the effect along this
/// trajectory, a magnitude beyond its range, or a gravel outside the plain set's grid (or a base
/// gravel that is). Where the density makes the scaled magnitude leave the range, it is held at its
/// end. Reads 2 magnitudes of each base gravel: some ten microseconds. The plain set's and the
/// effects' trajectories must be the same.
DIG_MUST_CHECK enum dig_status dig_template_find(const struct dig_curve_set *plain,
                                                 const struct dig_entry_set *effects,
                                                 enum dig_effect_id effect, double magnitude,
                                                 const struct dig_gravel *gravel, size_t trajectory,
                                                 struct dig_template *found);

#endif // DIG_ESTIMATOR_EFFECTS_TEMPLATE_H
