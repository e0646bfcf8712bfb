#include "tools/digreport/shift.h"

#include "core/room.h"
#include "core/sort.h"
#include "core/text.h"
#include "files/lcm/lcm_log.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SAME_EVENT_us 60000000 // signs of one trouble
#define LOOK_BACK     64       // events among which the same is looked for
#define MOST          10000    // digs, matches or events of a shift; more are counted
#define COUNT_MOST    (INT64_C(1) << 53)

#define BACK_us       1000000
#define AHEAD_us      60000000.0
#define SCALE_MOST    100.0              // of time_scale
#define MOVED_MOST_us (INT64_C(1) << 54) // a log that says more is nobody's

static const struct dig_health_text reloaded = { "reloads", "a new table or model was taken",
                                                 "predictions after it are made with it" };
static const struct dig_health_text outside  = { "outside",
                                                 "a simple dig was none of the table's gravels",
                                                 "do not rely on predictions of that ground" };

static const struct dig_health_text clock_set = { "clock", "the clock of the computer was set",
                                                  "times before it are those of the new clock" };

void digreport_shift_begin(struct digreport_shift *const shift, const double lambda)
{
    assert(shift != NULL);
    *shift = (struct digreport_shift){
        .lambda = lambda,
        .track  = { .half_s = DIG_SMOOTH_HALF_s * sqrt(lambda > 0.0 ? lambda : 10.0) },
    };
}

const char *digreport_ending_name(const enum digreport_ending ended)
{
    static const char *const name[] = { "", "whole", "aborted", "unknown" };
    return name[ended];
}

// The array with room for one more element; NULL, and it stays as it is: there are as many as are
// kept, which is counted, or no memory, which is the status.
static void *with_room(struct digreport_shift *const shift, void *const array, const size_t n,
                       const size_t size)
{
    if (n == MOST) {
        shift->left_out++;
        return NULL;
    }
    void *const grown = dig_room(array, n, size);
    shift->status     = grown != NULL ? shift->status : DIG_ENOMEM;
    return grown;
}

// By how much a counter has grown; a daemon that began anew, or another's message, says nothing.
static int64_t growth(const int64_t before, const int64_t now)
{
    return before >= 0 && now > before && now <= COUNT_MOST ? now - before : 0;
}

// Extends an event of the same text, or words, or begins one.
static void add_event(struct digreport_shift *const shift, const int64_t time_us,
                      const struct dig_health_text *const text, const char *const said,
                      const int64_t count)
{
    struct digreport_event e = { time_us, time_us, count, text, "" };
    dig_text_copy(DIGREPORT_TEXT, e.said, said);
    for (size_t back = 0; back < LOOK_BACK && back < shift->events; back++) {
        struct digreport_event *const old = &shift->event[shift->events - 1 - back];
        // Times of logs before are those of a clock already.
        const bool moved =
            shift->clock.moved_us != 0 && shift->events - 1 - back < shift->log_events;
        if (!moved && old->text == text && strcmp(old->said, e.said) == 0 &&
            llabs(time_us - old->to_us) <= SAME_EVENT_us) {
            old->to_us = time_us;
            old->count = old->count < COUNT_MOST ? old->count + count : old->count;
            return;
        }
    }
    struct digreport_event *const grown =
        with_room(shift, shift->event, shift->events, sizeof *grown);
    if (grown != NULL) {
        shift->event                  = grown;
        shift->event[shift->events++] = e;
    }
}

// True where the clock was set since the message before: back by a second or more, or ahead by more
// than a minute and a hundred times what the monotonic clock went on by (a bench may scale it).
// moved_us then is another. A monotonic clock that stands, or begins anew, tells no leap.
static bool is_clock_set(struct digreport_clock *const clock, const int64_t time_us,
                         const int64_t time_ns)
{
    const struct digreport_clock before  = *clock;
    const int64_t                went_us = time_us - before.time_us;
    const double                 mono_us = 1e-3 * ((double)time_ns - (double)before.time_ns);
    const bool                   back    = went_us < -BACK_us;
    const bool ahead = mono_us > 0.0 && (double)went_us > AHEAD_us + SCALE_MOST * mono_us;
    clock->any       = true;
    clock->time_us   = time_us;
    clock->time_ns   = time_ns;
    if (!before.any || !(back || ahead)) {
        return false;
    }
    // Between the two messages it went on as the monotonic clock did, where that did not begin
    // anew.
    const double mono_most_us = 60e6;
    const double on_us        = mono_us > 0.0 && mono_us < mono_most_us ? mono_us : 0.0;
    clock->moved_us           = before.moved_us - went_us + (int64_t)on_us;
    if (llabs(clock->moved_us) > MOVED_MOST_us) {
        clock->moved_us = 0;
    }
    return true;
}

// The time of a message on a clock that nobody sets.
static int64_t shift_time(struct digreport_shift *const shift, const int64_t time_us,
                          const int64_t time_ns)
{
    const bool    is_set = is_clock_set(&shift->clock, time_us, time_ns);
    const int64_t time   = time_us + shift->clock.moved_us;
    if (is_set) {
        add_event(shift, time, &clock_set, "", 1);
    }
    return time;
}

static void take_estimate(void *const context, const int64_t log_us,
                          const digsight_estimate_t *const said)
{
    struct digreport_shift *const shift   = context;
    const int64_t                 time_us = shift_time(shift, log_us, said->time_ns);
    struct digreport_dig          dig;
    bool                          finished = false;
    shift->status = digreport_track_estimate(&shift->track, time_us, said, &finished, &dig);
    if (!finished) {
        return;
    }
    struct digreport_dig *const grown = with_room(shift, shift->dig, shift->digs, sizeof *grown);
    if (grown != NULL) {
        shift->dig                = grown;
        shift->dig[shift->digs++] = dig;
    }
}

static void take_prediction(void *const context, const int64_t time_us,
                            const digsight_prediction_t *const said)
{
    (void)time_us;
    digreport_track_prediction(&((struct digreport_shift *)context)->track, said);
}

// A match names the simple dig it came from, and how that ended.
static void take_ending(struct digreport_shift *const shift, const digsight_match_t *const said)
{
    const bool known = said->ending == DIGREPORT_WHOLE || said->ending == DIGREPORT_ABORTED;
    for (size_t i = shift->digs; i > shift->log_digs && known && !said->restored; i--) {
        if (shift->dig[i - 1].number == said->dig_count) {
            shift->dig[i - 1].ended = (enum digreport_ending)said->ending;
        }
    }
}

// HEALTH counts digs by how they ended, soon after each: what grew is of the last digs. Of digs
// that ended in several ways within a second it does not say which is which.
static void count_endings(struct digreport_shift *const shift, const digsight_health_t *const said)
{
    const int64_t now[DIGREPORT_ENDINGS] = { 0, said->digs_whole, said->digs_aborted,
                                             said->digs_unknown };
    int           kinds                  = 0;
    int64_t       left                   = 0;
    int           kind                   = DIGREPORT_NOT_TOLD;
    for (int k = DIGREPORT_WHOLE; k < DIGREPORT_ENDINGS && shift->any_health; k++) {
        const int64_t grown = growth(shift->log_ended[k], now[k]);
        shift->ended[k] += grown;
        kinds += grown > 0 ? 1 : 0;
        left = grown > 0 ? grown : left;
        kind = grown > 0 ? k : kind;
    }
    for (size_t i = shift->digs; i > shift->log_digs && left > 0 && kinds == 1; i--, left--) {
        if (shift->dig[i - 1].ended != DIGREPORT_NOT_TOLD) {
            break;
        }
        shift->dig[i - 1].ended = (enum digreport_ending)kind;
    }
    memcpy(shift->log_ended, now, sizeof now);
}

// MATCH comes once a second; what is new has another time, or has ended.
static void take_match(void *const context, const int64_t log_us,
                       const digsight_match_t *const said)
{
    struct digreport_shift *const shift = context;
    // Said again, it has the time of before.
    const int64_t time_us = shift_time(shift, log_us, shift->clock.time_ns);
    const bool    known   = said->valid != 0;
    take_ending(shift, said);
    if (said->going_on || (said->time_ns == shift->match_ns && known == shift->match_known)) {
        return;
    }
    struct digreport_gravel g = { .time_us = time_us };
    if (!dig_matched_gravel_take(said, &g.match)) {
        return;
    }
    struct digreport_gravel *const grown =
        with_room(shift, shift->gravel, shift->gravels, sizeof *grown);
    if (grown == NULL) {
        return;
    }
    shift->gravel                   = grown;
    shift->gravel[shift->gravels++] = g;
    shift->match_ns                 = said->time_ns;
    shift->match_known              = known;
    if (known && g.match.outside) {
        add_event(shift, time_us, &outside, "", 0);
    }
    if (!known) {
        add_event(shift, time_us, NULL, g.match.wanted, 0);
    }
}

static void take_health(void *const context, const int64_t log_us,
                        const digsight_health_t *const said)
{
    struct digreport_shift *const       shift   = context;
    const int64_t                       time_us = shift_time(shift, log_us, said->time_ns);
    const struct dig_health_text *const state   = dig_health_state_text(said->state);
    int64_t                             count[DIG_HEALTH_COUNTERS];
    dig_health_counts(said, count);
    if (state != NULL) {
        add_event(shift, time_us, state, "", 0);
    }
    if (said->note[0] != '\0') {
        add_event(shift, time_us, NULL, said->note, 0);
    }
    for (size_t i = 0; i < DIG_HEALTH_COUNTERS && shift->any_health; i++) {
        const int64_t grown = growth(shift->count[i], count[i]);
        if (grown > 0) {
            add_event(shift, time_us, dig_health_counter_text(i), "", grown);
        }
    }
    const int64_t taken = growth(shift->reloads, said->reloads);
    if (shift->any_health && taken > 0) {
        add_event(shift, time_us, &reloaded, "", taken);
    }
    count_endings(shift, said);
    if (said->table[0] != '\0') {
        dig_text_copy(sizeof shift->scene_hash, shift->scene_hash, said->table);
    }
    memcpy(shift->count, count, sizeof shift->count);
    shift->reloads    = said->reloads;
    shift->any_health = true;
}

static enum dig_status take(void *const context, const struct dig_lcm_log *const log,
                            const struct dig_lcm_event *const event, struct dig_error *const error)
{
    struct digreport_shift *const shift  = context;
    const struct dig_lcm_reader   reader = { .context    = shift,
                                             .estimate   = take_estimate,
                                             .match      = take_match,
                                             .prediction = take_prediction,
                                             .health     = take_health };
    (void)log;
    (void)error;
    shift->status = DIG_OK;
    if (event->size == 0 || event->time_us < 0 || event->time_us > INT64_C(1) << 53) {
        return DIG_OK; // of another channel, or of no time
    }
    if (dig_lcm_message_read(event, &reader) != DIG_OK) {
        shift->misread++;
        return DIG_OK;
    }
    const int64_t time_us = event->time_us + shift->clock.moved_us;
    shift->first_us       = shift->messages == 0 ? time_us : shift->first_us;
    shift->last_us        = time_us;
    shift->messages++;
    return shift->status;
}

// What a clock shows when it was set last is right: the log's times become that clock's.
static void take_last_clock(struct digreport_shift *const shift, const bool first)
{
    const int64_t moved_us = shift->clock.moved_us;
    for (size_t i = shift->log_digs; i < shift->digs; i++) {
        shift->dig[i].time_us -= moved_us;
    }
    for (size_t i = shift->log_gravels; i < shift->gravels; i++) {
        shift->gravel[i].time_us -= moved_us;
    }
    for (size_t i = shift->log_events; i < shift->events; i++) {
        shift->event[i].from_us -= moved_us;
        shift->event[i].to_us -= moved_us;
    }
    shift->first_us -= first ? moved_us : 0;
    shift->last_us -= moved_us;
}

enum dig_status digreport_shift_log(struct digreport_shift *const shift, const char *const log,
                                    struct dig_error *const error)
{
    assert(shift != NULL && log != NULL);
    digreport_track_finish(&shift->track);
    const bool first   = shift->messages == 0;
    shift->any_health  = false;
    shift->clock       = (struct digreport_clock){ .any = false };
    shift->log_digs    = shift->digs;
    shift->log_gravels = shift->gravels;
    shift->log_events  = shift->events;
    shift->match_ns    = 0;
    shift->status      = DIG_OK;

    const enum dig_status status = dig_lcm_log_walk(log, take, shift, error);
    take_last_clock(shift, first);
    return shift->status == DIG_OK ? status
                                   : dig_error_set(error, status, "%s: out of memory", log);
}

const struct dig_matched_gravel *
digreport_shift_gravel_at(const struct digreport_shift *const shift, const int64_t time_us)
{
    assert(shift != NULL);
    const struct dig_matched_gravel *found = NULL;
    for (size_t i = 0; i < shift->gravels && shift->gravel[i].time_us <= time_us; i++) {
        found = &shift->gravel[i].match;
    }
    return found != NULL && found->known ? found : NULL;
}

static double median(const size_t n, double value[])
{
    dig_sort(n, value);
    return n == 0 ? (double)NAN : 0.5 * (value[(n - 1) / 2] + value[n / 2]);
}

size_t digreport_shift_error(const struct digreport_shift *const shift, double *const error,
                             double *const noise_floor)
{
    assert(shift != NULL && error != NULL && noise_floor != NULL);
    double *const both = malloc((2 * shift->digs + 1) * sizeof *both);
    size_t        n    = 0;
    for (size_t i = 0; i < shift->digs && both != NULL; i++) {
        if (isfinite(shift->dig[i].error)) {
            both[n]                 = shift->dig[i].error;
            both[shift->digs + n++] = shift->dig[i].noise_floor;
        }
    }
    *error       = n > 0 ? median(n, both) : (double)NAN;
    *noise_floor = n > 0 ? median(n, both + shift->digs) : (double)NAN;
    free(both);
    return n;
}

void digreport_shift_finish(struct digreport_shift *const shift)
{
    if (shift != NULL) {
        digreport_track_finish(&shift->track);
        free(shift->dig);
        free(shift->gravel);
        free(shift->event);
        *shift = (struct digreport_shift){ .lambda = shift->lambda };
    }
}
