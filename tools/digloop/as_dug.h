// The table at the approaches of some digs: the loaded one or, where it holds several depths and
// attacks, its curves interpolated there.

#ifndef DIG_TOOLS_DIGLOOP_AS_DUG_H
#define DIG_TOOLS_DIGLOOP_AS_DUG_H

#include "core/error.h"
#include "estimator/approach/approach_slots.h"

struct digloop_as_dug {
    const struct dig_curve_set *set;
    struct dig_approach_slots   slots; // none: set is the one that was loaded
    void                       *memory;
};

/// The table for these digs. Where it is not the one loaded, each dig's trajectory becomes its slot
/// in it; a dig for which no slot is left is refused. Free with digloop_as_dug_finish().
DIG_MUST_CHECK enum dig_status digloop_as_dug_make(const struct dig_curve_set *set, size_t digs,
                                                   struct dig_observation dig[],
                                                   struct digloop_as_dug *table,
                                                   struct dig_error      *error);

/// Gives the digs their trajectories of the loaded table back, and as approach that of their slot.
void digloop_as_dug_restore(const struct digloop_as_dug *table, size_t digs,
                            struct dig_observation dig[]);

/// The table with one trajectory, dug so; *index is where that stands in table->set. DIG_ENOMATCH
/// when it is farther from what the table was dug at than digs are let be (DIG_OBSERVE_PATH_LIMIT).
DIG_MUST_CHECK enum dig_status digloop_as_dug_at(const struct dig_curve_set *set, size_t trajectory,
                                                 const struct dig_approach *approach,
                                                 struct digloop_as_dug *table, size_t *index,
                                                 struct dig_error *error);

/// A zeroed struct is allowed.
void digloop_as_dug_finish(struct digloop_as_dug *table);

#endif // DIG_TOOLS_DIGLOOP_AS_DUG_H
