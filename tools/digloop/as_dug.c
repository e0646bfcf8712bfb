#include "tools/digloop/as_dug.h"

#include "closed_loop/recordings/observe.h"
#include "estimator/approach/approaches.h"

#include <assert.h>
#include <stdlib.h>

static enum dig_status make(const struct dig_curve_set *const      set,
                            const struct dig_approach_slots *const slots,
                            struct digloop_as_dug *const table, struct dig_error *const error)
{
    void *const memory = malloc(dig_approached_size(set, slots->slots));
    if (memory == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    *table = (struct digloop_as_dug){
        .set    = dig_approached_make(set, slots->slots, slots->slot, NULL, memory),
        .slots  = *slots,
        .memory = memory,
    };
    return DIG_OK;
}

enum dig_status digloop_as_dug_make(const struct dig_curve_set *const set, const size_t digs,
                                    struct dig_observation       dig[],
                                    struct digloop_as_dug *const table,
                                    struct dig_error *const      error)
{
    assert(set != NULL && digs > 0 && dig != NULL && table != NULL);
    if (!dig_approach_varies_any(set)) {
        *table = (struct digloop_as_dug){ .set = set };
        return DIG_OK;
    }
    struct dig_approach_slots slots = { .slots = 0 };
    for (size_t d = 0; d < digs; d++) {
        const int slot =
            dig_approach_slot(set, (size_t)dig[d].trajectory, &dig[d].approach, &slots);
        if (slot < 0) {
            return dig_error_set(error, DIG_EINVAL,
                                 "digs made in more than %d different ways along several "
                                 "trajectories, expected fewer at a time",
                                 DIG_TRAJECTORY_MAX);
        }
        dig[d].trajectory = slot;
    }
    return make(set, &slots, table, error);
}

void digloop_as_dug_restore(const struct digloop_as_dug *const table, const size_t digs,
                            struct dig_observation dig[])
{
    for (size_t d = 0; table->slots.slots > 0 && d < digs; d++) {
        const struct dig_approached_slot *const slot = &table->slots.slot[dig[d].trajectory];
        dig[d].trajectory                            = (int)slot->trajectory;
        dig[d].approach                              = slot->approach;
    }
}

enum dig_status digloop_as_dug_at(const struct dig_curve_set *const set, const size_t trajectory,
                                  const struct dig_approach *const approach,
                                  struct digloop_as_dug *const table, size_t *const index,
                                  struct dig_error *const error)
{
    assert(set != NULL && approach != NULL && table != NULL && index != NULL);
    struct dig_approach nearest;
    const double        away_m = dig_approach_clamp(set, trajectory, approach, &nearest);
    if (set->approaches == NULL && !dig_approach_is_plain(approach)) {
        return dig_error_set(error, DIG_ENOMATCH,
                             "%s: off the table, which was dug at depth 1, attack 0 deg alone",
                             set->trajectory[trajectory].name);
    }
    if (away_m > DIG_OBSERVE_PATH_LIMIT * set->tooth_m) {
        char how[DIG_APPROACH_TEXT_SIZE];
        dig_approach_text(approach, how);
        return dig_error_set(error, DIG_ENOMATCH,
                             "%s%s: off the table by %.3f bucket lengths of path, expected at most "
                             "%.2f beyond what it was dug at",
                             set->trajectory[trajectory].name, how, away_m / set->tooth_m,
                             DIG_OBSERVE_PATH_LIMIT);
    }
    if (dig_approach_is_plain(&nearest)) {
        *table = (struct digloop_as_dug){ .set = set };
        *index = trajectory;
        return DIG_OK;
    }
    const struct dig_approach_slots slots  = { .slots = 1,
                                               .slot  = { { trajectory, nearest, 0.0 } } };
    const enum dig_status           status = make(set, &slots, table, error);
    if (status == DIG_OK) {
        *index = 0;
    }
    return status;
}

void digloop_as_dug_finish(struct digloop_as_dug *const table)
{
    if (table != NULL) {
        free(table->memory);
        *table = (struct digloop_as_dug){ .set = NULL };
    }
}
