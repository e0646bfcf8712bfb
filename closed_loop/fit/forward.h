// The forward model: what a gravel, and effects of the soil or none, make of a dig; and forces that
// are read late.

#ifndef DIG_CLOSED_LOOP_FIT_FORWARD_H
#define DIG_CLOSED_LOOP_FIT_FORWARD_H

#include "closed_loop/fit/batch.h"

#define DIG_HYPOTHESIS_EFFECTS 3
#define DIG_HYPOTHESIS_NUMBERS (DIG_AXES + 2 * DIG_HYPOTHESIS_EFFECTS)

/// Where the numbers of a hypothesis' effects stand, behind the gravel's place: u of effect e, and
/// the contrast, which is 1 for all effects that have none.
#define DIG_AT_U(e)        (DIG_AXES + 2 * (e))
#define DIG_AT_CONTRAST(e) (DIG_AXES + 2 * (e) + 1)

/// Effects are of the soil, but for sensor_delay, which the forces of a recording may have.
struct dig_hypothesis {
    size_t             effects; // 0: nothing but a gravel
    enum dig_effect_id effect[DIG_HYPOTHESIS_EFFECTS];
    bool               outside;  // the gravel may lie beyond the table's grid
    double             unlisted; // 1 sigma of what has no name, over the plain dig: likelihood.h
};

/// The plain dig that effects are added to: the same for all digs of a trajectory.
struct dig_plain {
    double feature[DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
};

struct dig_plain dig_plain_of(const struct dig_soil *soil, size_t trajectory,
                              const double number[]);

/// True when the digs of a batch can show the effect at all: templates along every trajectory,
/// passes, paces or an order that differ.
bool dig_hypothesis_possible(const struct dig_batch *batch, enum dig_effect_id effect);

/// How many numbers of its effects are free.
size_t dig_hypothesis_free(const struct dig_hypothesis *hypothesis);

/// True when some effect of it differs from dig to dig of a trajectory.
bool dig_hypothesis_differs(const struct dig_hypothesis *hypothesis);

/// Features of one dig, units of the table: the plain ones with the hypothesis' effects added.
/// number: the gravel's place, then u and contrast of each effect. *noise (NULL: not asked for):
/// the variance of the templates, in variances of one plain dig.
void dig_forward_add(const struct dig_soil *soil, const struct dig_plain *plain,
                     const struct dig_hypothesis *hypothesis, const double number[],
                     const struct dig_measured *dig, double feature[DIG_FEATURES], double *noise);

/// What the effects add to the mean dig of a group of the batch, units of the table; returns the
/// variance of their templates, in variances of one plain dig.
double dig_forward_added(const struct dig_batch *batch, size_t group, const struct dig_plain *plain,
                         const struct dig_hypothesis *hypothesis, const double number[],
                         double added[DIG_FEATURES]);

#endif // DIG_CLOSED_LOOP_FIT_FORWARD_H
