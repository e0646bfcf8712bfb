// How right the theory of a design is: digs drawn and identified. Internal to design*.c.

#ifndef DIG_CLOSED_LOOP_DESIGN_DESIGN_SIMULATE_H
#define DIG_CLOSED_LOOP_DESIGN_DESIGN_SIMULATE_H

#include "closed_loop/design/design.h"

/// What a design is of.
struct dig_design_table {
    const struct dig_response_surface *surface;
    const struct dig_scatter          *scatter;
};

/// The covariance of one dig's features at a place, the table's own error included; row major, n by
/// n, of the first n features (DIG_FEATURE_BINS: the moment's).
void dig_design_covariance(const struct dig_design_table *table, size_t trajectory,
                           const double place[DIG_AXES], size_t n, double covariance[]);

/// Draws gravels evenly over the table, digs each along every trajectory with the scatter of the
/// table's own packings, and identifies it from the moment by its posterior mean on a grid. Fills
/// the simulated members of *design, whose ranking stands.
DIG_MUST_CHECK enum dig_status dig_design_simulate(const struct dig_design_table *table,
                                                   size_t draws, uint64_t seed,
                                                   struct dig_design *design);

#endif // DIG_CLOSED_LOOP_DESIGN_DESIGN_SIMULATE_H
