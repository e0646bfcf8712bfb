// The table's mean curves as one smooth function of the gravel.
//
//   curve(g) = amplitude(g) shape(g),   log amplitude and shape polynomials in (x, y, z)
//
// x, y, z: friction, rolling friction and log density, -1 … 1 over the table's axes; of the third
// degree, fitted by least squares weighted by packings, with a prior about 0 for the cubic terms.
// All entries inform every gravel, so the surface's variance is a fraction of an entry's;
// dig_response_surface_noise() gives it, over the variance of one dig. Amplitude:
// closed_loop/recordings/features.h.

#ifndef DIG_CLOSED_LOOP_MODEL_RESPONSE_SURFACE_H
#define DIG_CLOSED_LOOP_MODEL_RESPONSE_SURFACE_H

#include "closed_loop/recordings/features.h"
#include "core/curve.h"

#define DIG_RESPONSE_SURFACE_TERMS 20
#define DIG_RESPONSE_SURFACE_LEAST 10 // gravels that a parabola needs

struct dig_response_surface {
    const struct dig_curve_set *set; // not owned
    size_t                      terms;
    unsigned                    power[DIG_RESPONSE_SURFACE_TERMS][DIG_AXES];
    size_t                      of[DIG_RESPONSE_SURFACE_TERMS];   // each is this term times
    size_t                      last[DIG_RESPONSE_SURFACE_TERMS]; // the place on this axis
    bool                        known[DIG_TRAJECTORY_MAX];
    // Half of the density axis in log density, where the table's densities are copies of one: log
    // amplitude grows by it times z and no term has z. Else 0.
    double log_density;
    double log_amplitude[DIG_TRAJECTORY_MAX][DIG_RESPONSE_SURFACE_TERMS][DIG_FORCE_CHANNELS];
    double curve[DIG_TRAJECTORY_MAX][DIG_RESPONSE_SURFACE_TERMS][DIG_FORCE_CHANNELS]
                [DIG_CURVE_POINTS];
    double feature[DIG_TRAJECTORY_MAX][DIG_RESPONSE_SURFACE_TERMS][DIG_FEATURES];
    double inverse[DIG_TRAJECTORY_MAX][DIG_RESPONSE_SURFACE_TERMS]
                  [DIG_RESPONSE_SURFACE_TERMS]; // of X' W X
};

/// Fits it; *surface is some megabytes. A trajectory with too few entries is left unknown.
/// DIG_EINVAL when all are.
DIG_MUST_CHECK enum dig_status dig_response_surface_fit(const struct dig_curve_set  *set,
                                                        struct dig_response_surface *surface);

/// x, y, z of a gravel and back. An axis with one point has the coordinate 0.
void              dig_response_surface_place(const struct dig_response_surface *surface,
                                             const struct dig_gravel *gravel, double place[DIG_AXES]);
struct dig_gravel dig_response_surface_gravel(const struct dig_response_surface *surface,
                                              const double                       place[DIG_AXES]);

/// Features and amplitude at a place. Under a microsecond.
void dig_response_surface_features(const struct dig_response_surface *surface, size_t trajectory,
                                   const double place[DIG_AXES], double feature[DIG_FEATURES],
                                   double amplitude[DIG_FORCE_CHANNELS]);

/// The whole curve at a place.
void dig_response_surface_curve(const struct dig_response_surface *surface, size_t trajectory,
                                const double place[DIG_AXES],
                                double       curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS]);

/// Variance of the surface at a place, in units of the variance of one dig.
double dig_response_surface_noise(const struct dig_response_surface *surface, size_t trajectory,
                                  const double place[DIG_AXES]);

#endif // DIG_CLOSED_LOOP_MODEL_RESPONSE_SURFACE_H
