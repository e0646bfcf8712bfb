// State that the parts of one search share. Internal to its sources.

#ifndef DIG_CLOSED_LOOP_SEARCH_SEARCH_WORK_H
#define DIG_CLOSED_LOOP_SEARCH_SEARCH_WORK_H

#include "closed_loop/search/search.h"

/// Log evidence within which two answers are not told apart: an effect from another, from none, or
/// from two.
#define DIG_SEARCH_TOLD_APART 6.0

/// Log evidence (twenty to one) by which an effect that changes from dig to dig must lead both
/// digs that are alike and digs that differ in no order.
#define DIG_SEARCH_BY_ORDER 3.0

struct dig_search_work {
    struct dig_batch          *batch;
    double                     false_alarm;
    size_t                     draws;
    uint64_t                   seed;
    struct dig_hypothesis      single[DIG_RIVALS_MAX]; // the rivals'
    struct dig_null_simulation plain_null;
    struct dig_search         *s;
};

/// Log evidence that so many fitted numbers cost.
double dig_search_penalty(const struct dig_batch *batch, size_t numbers);

/// Log evidence of a fit beside that of the plain hypothesis. more: numbers that were fitted beside
/// the gravel's and those of its effects.
double dig_search_evidence(const struct dig_search_work *c, const struct dig_fitted *fitted,
                           size_t more);

/// The most evidence of a single effect, or 0 when none has any.
double dig_search_best_evidence(const struct dig_search *s);

/// Chooses one effect, two, or none that has a name: s->chosen, s->unlisted.
void dig_search_which(struct dig_search_work *c);

/// Sizes of the digs against their order: log likelihood by which a line, and a parabola, lead
/// sizes in no order.
struct dig_drift {
    double line, parabola;
};

/// For a fit with wear; for any other, line is INFINITY. spread: by which the batch was widened. It
/// is undone: a dig that is unlike the others widened the batch, and must not hide by that.
/// Microseconds.
struct dig_drift dig_drift_of(const struct dig_batch *batch, const struct dig_fitted *fitted,
                              double spread);

#endif // DIG_CLOSED_LOOP_SEARCH_SEARCH_WORK_H
