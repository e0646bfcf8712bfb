// HEALTH in words: what each of its counters and states says is wrong, and what to do about it.

#ifndef DIG_FILES_LCM_HEALTH_TEXT_H
#define DIG_FILES_LCM_HEALTH_TEXT_H

#include "messages/digsight_health_t.h"

#include <stddef.h>
#include <stdint.h>

/// ASCII, one line each.
struct dig_health_text {
    const char *name; // of the message's field, or the state's text
    const char *what; // is wrong
    const char *todo;
};

/// The counters that grow with a trouble, the worst first.
#define DIG_HEALTH_COUNTERS 19

/// Of the counter i in [0, DIG_HEALTH_COUNTERS).
const struct dig_health_text *dig_health_counter_text(size_t i);

/// The counters of a message, in that order.
void dig_health_counts(const digsight_health_t *health, int64_t count[DIG_HEALTH_COUNTERS]);

/// What a state says is wrong; NULL: nothing (running), or no state of ours.
const struct dig_health_text *dig_health_state_text(const char *state);

#endif // DIG_FILES_LCM_HEALTH_TEXT_H
