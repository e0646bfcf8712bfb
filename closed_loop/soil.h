// What effects of the soil add to a dig, as the closed loop tries them out: one number per effect.
//
// An effect with templates is fitted to all its beds at once, as the plain curves are
// (closed_loop/surface.h): at strength s and magnitude u, relative to the plain dig's amplitude,
//
//   delta = c0 u + c1 u s + c2 u s^2 + c3 u^2 + c4 u^2 s
//
// u = (magnitude - absent) / the table's largest, for cohesion and adhesion times base density /
// density; s = log(amplitude of My / density), -1 … 1 over the base gravels; terms for which the
// beds are too few are left out, and all but c0 are drawn towards nothing as far as the beds allow.
// Two effects have a reduced form instead, a factor on the plain dig (estimator/effects/):
// rate_dependence (pace speed^along)^u, wear 1 + u order. Compaction acts pass - 1 fold.

#ifndef DIG_CLOSED_LOOP_SOIL_H
#define DIG_CLOSED_LOOP_SOIL_H

#include "closed_loop/measured.h"
#include "closed_loop/scatter.h"
#include "closed_loop/surface.h"
#include "core/effect.h"
#include "core/effect_set.h"

#define DIG_SOIL_TERMS 5

struct dig_soil_template {
    bool     known;
    size_t   terms;
    unsigned power[DIG_SOIL_TERMS][2]; // of u, of s
    double   centre, half;             // of strength over the base gravels
    double   base_density_kgpm3;
    double   inverse[DIG_SOIL_TERMS][DIG_SOIL_TERMS];
    double   feature[DIG_SOIL_TERMS][DIG_FEATURES];
    double   curve[DIG_SOIL_TERMS][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
};

struct dig_soil {
    const struct dig_surface *surface; // not owned
    double                    absent[DIG_EFFECTS];
    double                    scale[DIG_EFFECTS];                  // magnitude - absent at u = 1
    double                    low[DIG_EFFECTS], high[DIG_EFFECTS]; // of u
    // Of rate_dependence: log of the tooth's speed along a trajectory, over bins and points, and
    // whether the ground feels that (1) or the pace of a dig alone (0).
    double along;
    double bin_speed[DIG_TRAJECTORY_MAX][DIG_FEATURE_BINS];
    double speed[DIG_TRAJECTORY_MAX][DIG_CURVE_POINTS];

    struct dig_soil_template template[DIG_EFFECTS][DIG_TRAJECTORY_MAX];
};

/// Fits the templates. effects may be NULL (scatter then, too): the reduced forms alone are known
/// then. Some megabytes; free with free(). DIG_EINVAL: effects of another table's scene or
/// trajectories.
DIG_MUST_CHECK enum dig_status dig_soil_create(const struct dig_surface    *surface,
                                               const struct dig_effect_set *effects,
                                               const struct dig_scatter    *scatter,
                                               struct dig_soil            **soil);

/// True when the effect can be told along this trajectory.
bool dig_soil_knows(const struct dig_soil *soil, enum dig_effect_id effect, size_t trajectory);

/// What distinguishes digs of one trajectory for an effect: u acts by this much. log(pace), order,
/// pass - 1; 1 for all that act on every dig alike.
double dig_soil_share(enum dig_effect_id effect, const struct dig_measured *dig);

/// Adds the effect at u to a plain dig's features (in place) and the variance of what was added, in
/// units of the variance of one plain dig, to *noise. share as above.
void dig_soil_add(const struct dig_soil *soil, enum dig_effect_id effect, size_t trajectory,
                  const double place[DIG_AXES], double u, double share,
                  const double plain[DIG_FEATURES], const double amplitude[DIG_FORCE_CHANNELS],
                  double feature[DIG_FEATURES], double *noise);

/// The same for a whole curve.
void dig_soil_add_curve(const struct dig_soil *soil, enum dig_effect_id effect, size_t trajectory,
                        const double place[DIG_AXES], double u, double share,
                        const double plain[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS],
                        double       curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

/// The magnitude a person knows, of u.
double dig_soil_magnitude(const struct dig_soil *soil, enum dig_effect_id effect, double u);

#endif // DIG_CLOSED_LOOP_SOIL_H
