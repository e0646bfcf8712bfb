// One dig at one gravel as linear theory sees it: whitened, with its slopes by the gravel's place.
// Internal to design*.c.

#ifndef DIG_CLOSED_LOOP_DESIGN_DESIGN_VIEW_H
#define DIG_CLOSED_LOOP_DESIGN_DESIGN_VIEW_H

#include "closed_loop/design/design.h"

#define DIG_DESIGN_PLACES_PER_AXIS ((size_t)4)
#define DIG_DESIGN_SQUARE          ((size_t)DIG_AXES * DIG_AXES)
#define DIG_DESIGN_WRENCH          ((size_t)DIG_FEATURES)
#define DIG_DESIGN_PLACES_MAX      64
#define DIG_DESIGN_PRIOR           3.0 // 1 / variance of a place of which nothing is known

/// What a design is of, and the gravels to average over.
struct dig_design_table {
    const struct dig_response_surface *surface;
    const struct dig_scatter          *scatter;
    const struct dig_soil             *soil; // NULL: nothing about effects
    size_t                             places;
    double                             place[DIG_DESIGN_PLACES_MAX + 1][DIG_AXES];
};

/// The covariance of one dig's features at a place, the table's own error included; row major, n by
/// n, of the first n features (DIG_FEATURE_BINS: the moment's).
void dig_design_covariance(const struct dig_design_table *table, size_t trajectory,
                           const double place[DIG_AXES], size_t n, double covariance[]);

struct dig_design_view {
    size_t n; // features: DIG_FEATURE_BINS (moment) or DIG_FEATURES
    double lower[DIG_FEATURES * DIG_FEATURES]; // L of C = L L'
    double slope[DIG_AXES][DIG_FEATURES];      // L^-1 J
    double normal[DIG_AXES * DIG_AXES];        // J' C^-1 J
    double normal_lower[DIG_AXES * DIG_AXES];  // of normal + prior
};

/// DIG_EINVAL: the covariance is none.
DIG_MUST_CHECK enum dig_status dig_design_look(const struct dig_design_table *table,
                                               size_t trajectory, const double place[DIG_AXES],
                                               size_t n, struct dig_design_view *view);

/// Bits that this much Fisher information is about the gravel.
double dig_design_bits(const double normal[DIG_AXES * DIG_AXES]);

/// Takes off a whitened vector what a change of the gravel would explain of it.
void dig_design_take_gravel_off(const struct dig_design_view *view, double d[]);

/// Fills what *dig says of effects (design_effects.c).
DIG_MUST_CHECK enum dig_status dig_design_effects(const struct dig_design_table *table,
                                                  size_t trajectory, struct dig_design_dig *dig);

/// Draws gravels evenly over the table, digs each along every trajectory with the scatter of the
/// table's own packings, and identifies it from the moment by its posterior mean on a grid: how
/// right the theory is. Fills the simulated members of *design, whose ranking stands
/// (design_simulate.c).
DIG_MUST_CHECK enum dig_status dig_design_simulate(const struct dig_design_table *table,
                                                   size_t draws, uint64_t seed,
                                                   struct dig_design *design);

#endif // DIG_CLOSED_LOOP_DESIGN_DESIGN_VIEW_H
