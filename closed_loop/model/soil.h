// What effects of the soil add to a dig, as the closed loop tries them out: one number per effect.
//
// An effect with templates is fitted to all its beds at once, as the plain curves are
// (closed_loop/model/response_surface.h): at strength s and magnitude u, relative to the plain
// dig's amplitude,
//
//   delta = sum_p s^p (a_p u + b_p u^2 + sum_k c_kp hat_k(u)),  p = 0 … 2
//
// u = (magnitude - absent) / the table's largest, for cohesion and adhesion over the stiffness of
// contacts (dig_template_scale()); s = log(amplitude of My / density), -1 … 1 over the base
// gravels; hat_k is 1 at the k-th magnitude of the table, 0 at the others and where the effect is
// absent, linear between; the last two are extrapolated. (A layer is felt only from where the tooth
// reaches it.) Left out are powers for which there are too few gravels, u^2 where there is one
// magnitude, and hats at magnitudes of a single gravel. All but a_0 have a prior about 0, as wide
// as the beds make likeliest: without them the curve over u is a parabola or a line.
//
// A layer below zero is a loose one, above it a hard one: two templates that meet where u is 0. An
// effect without templates is a factor on the plain dig instead, as its file in estimator/effects/
// has it. One that differs from dig to dig acts by its share: compaction (pass - 1)-fold.

#ifndef DIG_CLOSED_LOOP_MODEL_SOIL_H
#define DIG_CLOSED_LOOP_MODEL_SOIL_H

#include "closed_loop/model/response_surface.h"
#include "closed_loop/model/scatter.h"
#include "closed_loop/recordings/measured.h"
#include "core/effect.h"
#include "core/entry_set.h"

#define DIG_SOIL_POWERS 3                    // of s
#define DIG_SOIL_KNOTS  9                    // magnitudes and where it is absent
#define DIG_SOIL_SHAPES (2 + DIG_SOIL_KNOTS) // u, u^2 and hats
#define DIG_SOIL_TERMS  (DIG_SOIL_POWERS * DIG_SOIL_SHAPES)
#define DIG_SOIL_SIDES  2 // u >= 0, u < 0; one template serves both unless they are unlike things

struct dig_soil_template {
    bool   known;
    size_t powers;
    size_t shapes;
    size_t knots;                // 0: no hats
    double knot[DIG_SOIL_KNOTS]; // u, ascending, 0 among them
    size_t terms;                // powers times shapes
    double centre, half;         // of strength over the base gravels
    double base_density_kgpm3;
    double inverse[DIG_SOIL_TERMS][DIG_SOIL_TERMS];
    double feature[DIG_SOIL_TERMS][DIG_FEATURES];
    double curve[DIG_SOIL_TERMS][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
};

struct dig_soil {
    const struct dig_response_surface *surface; // not owned
    double                             absent[DIG_EFFECTS];
    double                             scale[DIG_EFFECTS]; // magnitude - absent at u = 1
    double                             low[DIG_EFFECTS], high[DIG_EFFECTS]; // of u
    // The tooth's speed along a trajectory, over bins and points; and whether the ground of
    // rate_dependence feels that (1) or the pace of a dig alone (0).
    double along;
    double bin_speed[DIG_TRAJECTORY_MAX][DIG_FEATURE_BINS];
    double speed[DIG_TRAJECTORY_MAX][DIG_CURVE_POINTS];

    struct dig_soil_template template[DIG_EFFECTS][DIG_SOIL_SIDES][DIG_TRAJECTORY_MAX];
};

/// Fits the templates. effects may be NULL (scatter then, too): the reduced forms alone are known
/// then. Some megabytes; free with free(). DIG_EINVAL: effects of another table's scene or
/// trajectories.
DIG_MUST_CHECK enum dig_status dig_soil_create(const struct dig_response_surface *surface,
                                               const struct dig_entry_set        *effects,
                                               const struct dig_scatter          *scatter,
                                               struct dig_soil                  **soil);

/// True when the effect can be computed along this trajectory, at every u from low to high.
bool dig_soil_knows(const struct dig_soil *soil, enum dig_effect_id effect, size_t trajectory);

/// What distinguishes digs of one trajectory for an effect: u acts by this much. log(pace), order,
/// pass - 1; 1 for all that act on every dig alike.
double dig_soil_share(enum dig_effect_id effect, const struct dig_measured *dig);

/// Adds the effect at u to a plain dig's features (in place) and the variance of what was added, in
/// units of the variance of one plain dig, to *noise (NULL: not asked for). contrast: what a
/// template adds is times that; share as above.
void dig_soil_add(const struct dig_soil *soil, enum dig_effect_id effect, size_t trajectory,
                  const double place[DIG_AXES], double u, double contrast, double share,
                  const double plain[DIG_FEATURES], const double amplitude[DIG_FORCE_CHANNELS],
                  double feature[DIG_FEATURES], double *noise);

/// The same for a whole curve.
void dig_soil_add_curve(const struct dig_soil *soil, enum dig_effect_id effect, size_t trajectory,
                        const double place[DIG_AXES], double u, double contrast, double share,
                        const double plain[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS],
                        double       curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

/// The magnitude, in the effect's own unit (docs/formats/model.md), of u.
double dig_soil_magnitude(const struct dig_soil *soil, enum dig_effect_id effect, double u);

#endif // DIG_CLOSED_LOOP_MODEL_SOIL_H
