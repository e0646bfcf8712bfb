#include "firmware_host/assemble.h"

#include <assert.h>
#include <math.h>

void dig_assembler_init(struct dig_assembler *const                assembler,
                        const struct dig_assembler_settings *const settings)
{
    assert(assembler != NULL && settings != NULL);
    assert(settings->time_scale > 0.0 && settings->groups <= DIG_GROUPS_MAX);
    *assembler = (struct dig_assembler){ .settings = *settings };
}

static int64_t ns(const double seconds)
{
    return (int64_t)llround(seconds * 1e9);
}

// Whole seconds apart from the rest, so that hours on the machine stay exact to the nanosecond.
static int64_t machine_time(const struct dig_assembler *const a, const int64_t time_ns)
{
    const int64_t elapsed_ns = time_ns - a->first_ns;
    return a->first_ns + (int64_t)llround((double)elapsed_ns * a->settings.time_scale);
}

static void count_drop(struct dig_drops *const drops, const uint8_t state)
{
    switch ((enum dig_reading_state)state) {
    case DIG_READING_NOT_AVAILABLE: drops->not_available++; break;
    case DIG_READING_OUT_OF_RANGE: drops->out_of_range++; break;
    case DIG_READING_NAN: drops->nan++; break;
    case DIG_READING_ABSENT:
    case DIG_READING_OK: break;
    }
}

static void store_values(struct dig_assembler *const a, const struct dig_reading *const reading,
                         const int64_t time_ns)
{
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        if (reading->state[i] == DIG_READING_ABSENT) {
            continue;
        }
        const bool ok   = reading->state[i] == DIG_READING_OK;
        a->now.valid[i] = ok;
        a->now.value[i] = ok ? reading->value[i] : 0.0;
        a->value_ns[i]  = time_ns;
        if (i < DIG_SIGNALS_NEEDED) {
            count_drop(&a->drops, reading->state[i]);
        }
    }
}

// False when the reading is a repetition of the one before.
static bool watch_alive(struct dig_assembler *const a, const struct dig_reading *const reading,
                        const int64_t time_ns)
{
    bool moved = true;
    if (reading->has_alive) {
        moved = !a->alive_known || reading->alive != a->alive;
        if (moved) {
            a->alive_ns = time_ns;
        }
        a->alive_known = true;
        a->alive       = reading->alive;
    } else if (!a->alive_known) {
        return true; // the counter's own message has not come yet
    }
    a->frozen = a->settings.has_alive && time_ns - a->alive_ns > ns(a->settings.frozen_s);
    return moved || !reading->has_alive || !a->settings.repeats;
}

// Every needed group came since the last sample, and they belong together.
static bool is_due(const struct dig_assembler *const a)
{
    int64_t oldest   = INT64_MAX;
    int64_t youngest = INT64_MIN;
    for (unsigned g = 0; g < a->settings.groups; g++) {
        if (!a->settings.needed[g]) {
            continue;
        }
        oldest   = a->group_ns[g] < oldest ? a->group_ns[g] : oldest;
        youngest = a->group_ns[g] > youngest ? a->group_ns[g] : youngest;
        if (!a->fresh[g]) {
            return false;
        }
    }
    return youngest >= oldest && youngest - oldest <= ns(a->settings.coherent_s);
}

static int64_t youngest_needed(const struct dig_assembler *const a)
{
    int64_t youngest = 0;
    for (unsigned g = 0; g < a->settings.groups; g++) {
        if (a->settings.needed[g] && a->group_ns[g] > youngest) {
            youngest = a->group_ns[g];
        }
    }
    return youngest;
}

bool dig_assembler_take(struct dig_assembler *const a, const struct dig_reading *const reading,
                        struct dig_sample *const sample)
{
    assert(a != NULL && reading != NULL && sample != NULL);
    assert(reading->group < a->settings.groups);
    if (!a->started) {
        a->started  = true;
        a->first_ns = reading->time_ns;
        a->alive_ns = reading->time_ns;
    }
    const int64_t time_ns = machine_time(a, reading->time_ns);
    const bool    news    = watch_alive(a, reading, time_ns);
    if (a->frozen) {
        a->drops.frozen++;
        return false;
    }
    if (!news) {
        return false;
    }
    store_values(a, reading, time_ns);
    a->group_ns[reading->group] = time_ns;
    a->fresh[reading->group]    = true;
    if (!is_due(a)) {
        return false;
    }
    for (unsigned g = 0; g < a->settings.groups; g++) {
        a->fresh[g] = false;
    }
    a->now.time_ns = youngest_needed(a);
    if (a->now.time_ns <= a->last_ns) {
        return false; // a clock that was set back; samples ascend
    }
    a->last_ns = a->now.time_ns;
    *sample    = a->now;
    for (size_t i = DIG_SIGNALS_NEEDED; i < DIG_SIGNALS; i++) {
        if (a->now.time_ns - a->value_ns[i] > ns(a->settings.optional_s)) {
            sample->valid[i] = false;
            sample->value[i] = 0.0;
        }
    }
    return true;
}
