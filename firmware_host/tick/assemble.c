#include "firmware_host/tick/assemble.h"

#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <string.h>

void dig_assembler_init(struct dig_assembler *const                assembler,
                        const struct dig_assembler_settings *const settings)
{
    assert(assembler != NULL && settings != NULL);
    assert(settings->time_scale > 0.0 && settings->groups <= DIG_GROUPS_MAX);
    memset(assembler, 0, sizeof *assembler);
    assembler->settings = *settings;
}

// Scales the time elapsed, not the time: hours on the machine stay exact to the nanosecond.
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

// A busy bus or host bunches frames up: one may carry the change of this long at once.
static const double bunched_s = 0.02;

// Whether the signal can have come here from its last valid value. A value that stays where it
// jumped to becomes valid once it could have.
static bool is_within_rate(struct dig_assembler *const a, const size_t signal, const double value,
                           const int64_t time_ns)
{
    const double rate = a->settings.max_rate[signal];
    if (rate > 0.0 && a->last_valid_ns[signal] > 0) {
        const double since_s = 1e-9 * (double)(time_ns - a->last_valid_ns[signal]);
        if (!(fabs(value - a->last_valid[signal]) <= rate * (fmax(since_s, 0.0) + bunched_s))) {
            a->drops.jump += dig_signal_is_optional((enum dig_signal)signal) ? 0 : 1;
            return false;
        }
    }
    a->last_valid[signal]    = value;
    a->last_valid_ns[signal] = time_ns;
    return true;
}

static void store_reading(struct dig_assembler *const a, const struct dig_reading *const reading,
                          const int64_t time_ns)
{
    const unsigned                 group = reading->group;
    struct dig_past_reading *const past  = &a->past[group][a->received[group]++ % DIG_HISTORY];

    *past = (struct dig_past_reading){ .time_ns = time_ns };
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        if (reading->state[i] == DIG_READING_ABSENT) {
            continue;
        }
        a->carried[i]  = true;
        a->group_of[i] = group;
        past->valid[i] =
            reading->state[i] == DIG_READING_OK && is_within_rate(a, i, reading->value[i], time_ns);
        past->value[i] = past->valid[i] ? reading->value[i] : 0.0;
        if (!dig_signal_is_optional((enum dig_signal)i)) {
            count_drop(&a->drops, reading->state[i]);
        }
    }
}

// Steps the alive counter. False when the reading repeats the one before.
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
    a->frozen = a->settings.has_alive && time_ns - a->alive_ns > dig_ns(a->settings.frozen_s);
    return moved || !reading->has_alive || !a->settings.repeats;
}

// The n-th last reading of a group; NULL: not stored.
static const struct dig_past_reading *past_of(const struct dig_assembler *const a,
                                              const unsigned group, const size_t n)
{
    return n < a->received[group] && n < DIG_HISTORY
               ? &a->past[group][(a->received[group] - 1 - n) % DIG_HISTORY]
               : NULL;
}

// The cycle of a group: as configured, or the shortest one stored, so that a silence among them
// does not count.
static int64_t cycle_ns(const struct dig_assembler *const a, const unsigned group)
{
    const struct dig_past_reading *younger     = past_of(a, group, 0);
    int64_t                        shortest_ns = INT64_MAX;
    for (size_t n = 1; younger != NULL && n < DIG_HISTORY; n++) {
        const struct dig_past_reading *const older = past_of(a, group, n);
        if (older != NULL && younger->time_ns - older->time_ns < shortest_ns) {
            shortest_ns = younger->time_ns - older->time_ns;
        }
        younger = older;
    }
    const int64_t configured_ns = dig_ns(a->settings.frame[group].cycle_s);
    return shortest_ns == INT64_MAX || shortest_ns < configured_ns ? configured_ns : shortest_ns;
}

// A dispensable group is silent when it does not come while the others do. The clock alone does not
// show it: after a pause of the whole bus the others may only be the first.
static bool is_silent(const struct dig_assembler *const a, const unsigned group,
                      const int64_t now_ns)
{
    if (!a->settings.dispensable[group] ||
        a->lead_readings - a->lead_readings_at[group] < DIG_SILENT_CYCLES) {
        return false;
    }
    const struct dig_past_reading *const last     = past_of(a, group, 0);
    const int64_t                        since_ns = last != NULL ? last->time_ns : a->first_ns;
    const int64_t                        most_ns  = DIG_SILENT_CYCLES * cycle_ns(a, group);
    return now_ns - since_ns > (most_ns > dig_ns(DIG_SILENT_s) ? most_ns : dig_ns(DIG_SILENT_s));
}

// Counts a reading of this group, and finds the silent groups.
static void update_silence(struct dig_assembler *const a, const unsigned group,
                           const int64_t now_ns)
{
    unsigned lead = 0;
    while (lead < a->settings.groups &&
           (!a->settings.needed[lead] || a->settings.dispensable[lead])) {
        lead++;
    }
    a->lead_readings += group == lead ? 1 : 0;
    a->lead_readings_at[group] = a->lead_readings;
    for (unsigned g = 0; g < a->settings.groups; g++) {
        a->silent[g] = is_silent(a, g, now_ns);
    }
}

static bool any_silent(const struct dig_assembler *const a)
{
    bool silent = false;
    for (unsigned g = 0; g < a->settings.groups; g++) {
        silent = silent || a->silent[g];
    }
    return silent;
}

// A sample is due when every needed group that is not silent came since the last one, and they are
// coherent: *time_ns is the time all of them reach.
static bool is_due(const struct dig_assembler *const a, int64_t *const time_ns)
{
    int64_t oldest   = INT64_MAX;
    int64_t youngest = INT64_MIN;
    for (unsigned g = 0; g < a->settings.groups; g++) {
        if (!a->settings.needed[g] || a->silent[g]) {
            continue;
        }
        const struct dig_past_reading *const last = past_of(a, g, 0);
        if (!a->fresh[g] || last == NULL) {
            return false;
        }
        const int64_t last_ns = last->time_ns;
        oldest                = last_ns < oldest ? last_ns : oldest;
        youngest              = last_ns > youngest ? last_ns : youngest;
    }
    *time_ns = oldest;
    return youngest >= oldest && youngest - oldest <= dig_ns(a->settings.coherent_s);
}

// A signal at a time: between the two readings around it; the younger alone where the older has no
// value; the last one where that is older.
static void interpolate(const struct dig_assembler *const a, const size_t signal,
                        const int64_t time_ns, struct dig_sample *const sample)
{
    const unsigned                 group   = a->group_of[signal];
    const struct dig_past_reading *younger = past_of(a, group, 0);
    const struct dig_past_reading *older   = past_of(a, group, 1);
    for (size_t n = 1; older != NULL && older->time_ns > time_ns; n++) {
        younger = older;
        older   = past_of(a, group, n + 1);
    }
    sample->valid[signal] = younger->valid[signal];
    sample->value[signal] = younger->value[signal];
    if (younger->time_ns > time_ns && younger->valid[signal] && older != NULL &&
        older->valid[signal]) {
        const double share =
            (double)(time_ns - older->time_ns) / (double)(younger->time_ns - older->time_ns);
        sample->value[signal] =
            older->value[signal] + share * (younger->value[signal] - older->value[signal]);
    }
}

static struct dig_sample sample_at(const struct dig_assembler *const a, const int64_t time_ns)
{
    struct dig_sample sample = { .time_ns = time_ns };
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        const struct dig_past_reading *const last =
            a->carried[i] ? past_of(a, a->group_of[i], 0) : NULL;
        const bool old = last == NULL || a->silent[a->group_of[i]] ||
                         (dig_signal_is_optional((enum dig_signal)i) &&
                          time_ns - last->time_ns > dig_ns(a->settings.optional_s));
        if (!old) {
            interpolate(a, i, time_ns, &sample);
        }
    }
    return sample;
}

// Steps the frame's stamp and counters. False for a repeated frame, or a frozen sender.
static bool is_new_frame(struct dig_assembler *const a, const struct dig_reading *const reading,
                         const int64_t time_ns)
{
    const unsigned                group = reading->group;
    struct dig_frame_watch *const watch = &a->watch[group];
    const int64_t                 owed  = watch->missed;
    const bool                    next =
        dig_frame_watch_take(watch, &a->settings.frame[group], time_ns, reading->counter);
    a->drops.missed += watch->missed - owed;
    a->drops.repeated += next ? 0 : 1;
    if (!next) {
        return false;
    }
    const bool moved = watch_alive(a, reading, time_ns);
    a->drops.frozen += a->frozen ? 1 : 0;
    return moved && !a->frozen;
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
    const int64_t time_ns =
        machine_time(a, reading->time_ns) - dig_ns(a->settings.frame[reading->group].delay_s);
    if (!is_new_frame(a, reading, time_ns)) {
        return false;
    }
    const struct dig_past_reading *const before = past_of(a, reading->group, 0);
    if (before != NULL && time_ns <= before->time_ns) {
        return false; // a clock that was set back; samples ascend
    }
    store_reading(a, reading, time_ns);
    update_silence(a, reading->group, time_ns);
    a->fresh[reading->group] = true;
    int64_t due_ns           = 0;
    if (!is_due(a, &due_ns)) {
        return false;
    }
    for (unsigned g = 0; g < a->settings.groups; g++) {
        a->fresh[g] = false;
    }
    if (due_ns <= a->last_ns) {
        return false;
    }
    a->last_ns = due_ns;

    const struct dig_sample made = sample_at(a, due_ns);
    if (a->settings.stuck_s > 0.0 && dig_sample_has_moment(&made) &&
        dig_stuck_step(&a->stuck, a->settings.stuck_s, &made)) {
        a->drops.stuck++;
        return false;
    }
    a->drops.without_force += any_silent(a) ? 1 : 0;
    *sample = made;
    return true;
}
