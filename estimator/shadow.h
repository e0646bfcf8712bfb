// A dig going on, followed from what each tick tells: another thread's own copy of what the
// estimator records, so that it can look at the dig before it is over without asking the tick for
// anything.

#ifndef DIG_ESTIMATOR_SHADOW_H
#define DIG_ESTIMATOR_SHADOW_H

#include "estimator/raw.h"

struct dig_shadow {
    bool           on;   // a dig goes on
    uint32_t       digs; // finished before it
    struct dig_raw raw;
};

/// Forgets all; a dig that goes on is not seen any more. Before the first estimate, and when the
/// table becomes another.
void dig_shadow_forget(struct dig_shadow *shadow, const struct dig_curve_set *set);

/// What a tick of a machine lambda times the table's size told; each of them, in order. Some that
/// are missing are samples that are missing. Constant time.
void dig_shadow_take(struct dig_shadow *shadow, const struct dig_curve_set *set, double lambda,
                     const struct dig_estimate *estimate);

/// What was dug so far, as dig_raw_observe() has it, up to where samples on both sides smooth it:
/// last is less than 1 until the path is done. dig_count is that of the dig when it will be
/// finished. DIG_ENOMATCH when no dig goes on, too. Copies what was recorded into scratch, 2.5 MB
/// at most, and works there: two to three milliseconds.
DIG_MUST_CHECK enum dig_status dig_shadow_observe(const struct dig_curve_set          *set,
                                                  const struct dig_estimator_settings *settings,
                                                  const struct dig_shadow             *shadow,
                                                  struct dig_raw                      *scratch,
                                                  struct dig_observation              *observation);

#endif // DIG_ESTIMATOR_SHADOW_H
