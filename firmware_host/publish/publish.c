#include "firmware_host/publish/publish.h"

#include "core/units.h"
#include "firmware_host/publish/publish_log.h"
#include "firmware_host/threads/notify.h"

#include <assert.h>
#include <string.h>
#include <time.h>

#define BURST    6        // records, two messages each
#define AFTER_ns 250000LL // a turn comes so long after a tick began, or a quarter of a tick

// Joins LCM; on failure logs why and tries again later.
static bool join(struct dig_publisher *const p, const int64_t now_ns)
{
    if (p->output != NULL) {
        return true;
    }
    if (now_ns < p->next_lcm_ns) {
        return false;
    }
    struct dig_error error = { "" };
    if (dig_output_create(p->config->lcm_url, &p->output, &error) == DIG_OK) {
        dig_publisher_log_limited(p, "publishing on %s", p->config->lcm_url);
        p->next_health_ns = 0;
        return true;
    }
    if (p->lcm_pause_ns == 0) {
        dig_publisher_log_limited(p, "%s; trying again", error.text);
    }
    p->lcm_pause_ns = p->lcm_pause_ns == 0                 ? DIG_NS_PER_S / 4
                      : p->lcm_pause_ns < 4 * DIG_NS_PER_S ? 2 * p->lcm_pause_ns
                                                           : 5 * DIG_NS_PER_S;
    p->next_lcm_ns  = now_ns + p->lcm_pause_ns;
    return false;
}

// Counts a message that was not sent and joins LCM again: its network may be gone.
static void check_sent(struct dig_publisher *const p, const enum dig_status status)
{
    p->health.unsent += status == DIG_OK ? 0 : 1;
    if (status != DIG_OK && p->output != NULL) {
        dig_publisher_log_limited(p, "LCM %s: sending failed; joining again", p->config->lcm_url);
        dig_output_destroy(p->output);
        p->output       = NULL;
        p->lcm_pause_ns = DIG_NS_PER_S;
        p->next_lcm_ns  = dig_input_now_ns() + p->lcm_pause_ns;
    }
}

// Publishes the records, paced: LCM's receivers queue 30 messages a subscription and drop the rest.
// A machine's tick brings one or two; a replay at many times real time more.
static void publish_records(struct dig_publisher *const p)
{
    static const struct timespec pause = { .tv_nsec = 500000L };
    struct dig_record            record;
    int                          burst = 0;
    while (dig_ring_pop(&p->handoffs->records, &record)) {
        for (size_t i = 0; i < DIG_SIGNALS; i++) {
            p->seen[i] |= record.sample.valid[i];
            p->any_seen |= record.sample.valid[i];
        }
        const bool due = p->record_count++ % (uint64_t)p->config->estimate_every == 0;
        p->health.unsent += due && p->output == NULL ? 1 : 0;
        if (due && p->output != NULL) {
            check_sent(p, dig_output_record(p->output, p->set, &record));
            dig_latency_add(&p->health.latency, dig_input_now_ns() - record.arrived_ns);
            if (++burst % BURST == 0) {
                (void)clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, NULL);
            }
        }
    }
}

// Uses a new table as soon as the tick does.
static void follow_table(struct dig_publisher *const p)
{
    (void)dig_latest_take(&p->handoffs->tables, &p->update);
    if (p->update.generation == p->health.tick_status.generation && p->update.set != NULL) {
        p->set        = p->update.set;
        p->update.set = NULL;
        atomic_store(p->generation, p->update.generation);
        dig_publisher_log(p, "table exchanged: scene %.60s (%.12s…), %zu gravels",
                          p->set->scene_name, p->set->scene_hash, p->set->entries);
    }
}

static void publish_prediction(struct dig_publisher *const p)
{
    struct dig_prediction_record record;
    if (dig_latest_take(&p->handoffs->predictions, &record) && p->output != NULL &&
        record.generation == atomic_load(p->generation)) {
        check_sent(p, dig_output_prediction(p->output, p->set, &record));
    }
}

static void publish_matches(struct dig_publisher *const p, const int64_t now_ns)
{
    bool                  news   = false;
    struct dig_fit_result before = p->result;
    struct dig_fit_result next;
    while (dig_ring_pop(&p->handoffs->results, &next)) {
        // A provisional match is published once; it expires by itself.
        if (next.track.going_on) {
            if (p->output != NULL) {
                check_sent(p, dig_output_match(p->output, &next));
            }
            continue;
        }
        p->result = next;
        // A new drift alone is not logged.
        const bool same = p->any_result && p->result.track.time_ns == before.track.time_ns &&
                          p->result.track.valid == before.track.valid;
        news          = true;
        p->any_result = true;
        before        = p->result;
        if (!same) {
            dig_publisher_log_match(p);
        }
    }
    if (p->any_result && (news || now_ns >= p->next_match_ns) && p->output != NULL) {
        p->next_match_ns = now_ns + DIG_NS_PER_S;
        check_sent(p, dig_output_match(p->output, &p->result));
    }
}

static const char *state_of(const struct dig_publisher *const p, const bool stopping)
{
    if (stopping) {
        return DIG_STATE_STOPPING;
    }
    if (p->health.tick_status.ticks == 0) {
        return DIG_STATE_STARTING;
    }
    return p->health.tick_status.fresh ? DIG_STATE_RUNNING : DIG_STATE_WAITING;
}

static void take_log_lines(struct dig_publisher *const p, bool *const news)
{
    struct dig_log_line note;
    const bool          from_input = dig_latest_take(&p->handoffs->input_log, &note);
    if (from_input || dig_latest_take(&p->handoffs->fit_log, &note)) {
        if (strcmp(note.text, p->note.text) != 0) {
            *news   = true;
            p->note = note;
            if (note.text[0] != '\0') {
                dig_publisher_log_limited(p, "%s", note.text);
            }
        }
    }
}

// Finds the signals without a value since the last HEALTH; a silent bus does not count.
static void find_missing(struct dig_publisher *const p)
{
    if (!p->any_seen) {
        return;
    }
    char missing[DIG_SIGNAL_NAMES_SIZE];
    dig_signal_name_missing(p->seen, sizeof missing, missing);
    if (strcmp(missing, p->health.missing) != 0) {
        memcpy(p->health.missing, missing, sizeof missing);
        dig_publisher_log_limited(p, "without a value: %s",
                                  missing[0] != '\0' ? missing : "no signal any more");
    }
    memset(p->seen, 0, sizeof p->seen);
    p->any_seen = false;
}

static void publish_health(struct dig_publisher *const p, const int64_t now_ns, const bool stopping)
{
    bool news = false;
    take_log_lines(p, &news);
    (void)dig_latest_take(&p->handoffs->tick_status, &p->health.tick_status);
    const char *const state = state_of(p, stopping);
    if (state != p->health.state) {
        news            = true;
        p->health.state = state;
        dig_publisher_log_limited(p, "%s (%s)", state, p->health.input->name);
    }
    p->health.time_ns = now_ns;
    p->health.note    = p->note.text;
    p->health.table   = p->set->scene_hash;
    p->health.lost    = atomic_load(&p->health.input->overflow) + p->health.tick_status.lost +
                     p->health.tick_status.lost_digs;
    dig_publisher_log_drops(p, now_ns);
    dig_publisher_log_held(p, dig_log_limit_held_before(&p->log_limit, now_ns, stopping));
    if (now_ns >= p->next_health_ns) {
        find_missing(p);
    }
    if ((news || now_ns >= p->next_health_ns) && p->output != NULL) {
        p->next_health_ns = now_ns + DIG_NS_PER_S;
        check_sent(p, dig_output_health(p->output, &p->health));
    }
}

static void feed_watchdog(struct dig_publisher *const p, const int64_t now_ns)
{
    const int64_t interval_ns = dig_notify_watchdog_ns();
    // Fed by the tick's status: a tick that hangs lets the watchdog expire.
    const bool alive = now_ns - p->health.tick_status.time_ns < DIG_NS_PER_S;
    if (interval_ns > 0 && alive && now_ns >= p->next_watchdog_ns) {
        p->next_watchdog_ns = now_ns + interval_ns;
        (void)dig_notify("WATCHDOG=1");
    }
}

// Until the next tick has had time to put what it has, by the beat of the last one that was seen.
static void wait_for_tick(const struct dig_publisher *const p)
{
    const int64_t         tick_ns  = (int64_t)(p->config->tick_s * 1e9);
    const int64_t         after_ns = tick_ns / 4 < AFTER_ns ? tick_ns / 4 : AFTER_ns;
    const int64_t         next_ns  = p->health.tick_status.time_ns + after_ns;
    const int64_t         late_ns  = dig_input_now_ns() - next_ns;
    const int64_t         due_ns = next_ns + (late_ns < 0 ? 0 : (late_ns / tick_ns + 1) * tick_ns);
    const struct timespec due    = { .tv_sec  = (time_t)(due_ns / DIG_NS_PER_S),
                                     .tv_nsec = (long)(due_ns % DIG_NS_PER_S) };
    (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
}

void dig_publisher_run(struct dig_publisher *const p)
{
    assert(p != NULL && p->say != NULL);
    bool stopping = false;
    while (!stopping) {
        // Read first: the last round then finds everything put before *stop.
        stopping             = atomic_load(p->stop);
        const int64_t now_ns = dig_input_now_ns();
        (void)join(p, now_ns);
        publish_records(p);
        follow_table(p);
        publish_prediction(p);
        publish_matches(p, now_ns);
        publish_health(p, now_ns, stopping);
        feed_watchdog(p, now_ns);
        if (!stopping) {
            wait_for_tick(p);
        }
    }
    dig_output_destroy(p->output);
    p->output = NULL;
}
