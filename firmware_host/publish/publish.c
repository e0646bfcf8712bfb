#include "firmware_host/publish/publish.h"

#include "core/units.h"
#include "estimator/match/match.h"
#include "firmware_host/threads/notify.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define NS_PER_S 1000000000LL
#define BURST    6        // records, two messages each
#define TURN_ns  500000LL // between two turns, at most

__attribute__((format(printf, 2, 0))) static void speak(const struct dig_publisher *const p,
                                                        const char *const format, va_list args)
{
    char line[512];
    (void)vsnprintf(line, sizeof line, format, args);
    p->voice.say(line);
}

__attribute__((format(printf, 2, 3))) static void say(const struct dig_publisher *const p,
                                                      const char *const                 format, ...)
{
    va_list args;
    va_start(args, format);
    // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is the line above
    speak(p, format, args);
    va_end(args);
}

static void say_held(const struct dig_publisher *const p, const int64_t held)
{
    if (held > 0) {
        say(p, "lines held back, as too many came at once: %" PRId64, held);
    }
}

// What may come again and again: troubles, and states that come and go.
__attribute__((format(printf, 2, 3))) static void mention(struct dig_publisher *const p,
                                                          const char *const           format, ...)
{
    if (!dig_log_limit_allows(&p->talk, dig_input_now_ns())) {
        return;
    }
    say_held(p, dig_log_limit_held(&p->talk));
    va_list args;
    va_start(args, format);
    // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start is the line above
    speak(p, format, args);
    va_end(args);
}

// Joins LCM, or says why not and tries again later.
static bool is_online(struct dig_publisher *const p, const int64_t now_ns)
{
    if (p->output != NULL) {
        return true;
    }
    if (now_ns < p->next_lcm_ns) {
        return false;
    }
    struct dig_error error = { "" };
    if (dig_output_create(p->config->lcm_url, &p->output, &error) == DIG_OK) {
        mention(p, "publishing on %s", p->config->lcm_url);
        p->next_health_ns = 0;
        return true;
    }
    if (p->lcm_pause_ns == 0) {
        mention(p, "%s; trying again", error.text);
    }
    p->lcm_pause_ns = p->lcm_pause_ns == 0             ? NS_PER_S / 4
                      : p->lcm_pause_ns < 4 * NS_PER_S ? 2 * p->lcm_pause_ns
                                                       : 5 * NS_PER_S;
    p->next_lcm_ns  = now_ns + p->lcm_pause_ns;
    return false;
}

// LCM's own buffers may be full for a moment; a network that is gone is joined anew.
static void check_sent(struct dig_publisher *const p, const enum dig_status status)
{
    p->health.unsent += status == DIG_OK ? 0 : 1;
    if (status != DIG_OK && p->output != NULL) {
        mention(p, "LCM %s: sending failed; joining again", p->config->lcm_url);
        dig_output_destroy(p->output);
        p->output       = NULL;
        p->lcm_pause_ns = NS_PER_S;
        p->next_lcm_ns  = dig_input_now_ns() + p->lcm_pause_ns;
    }
}

// LCM's receivers queue 30 messages a subscription and drop what comes beyond. On a machine a tick
// brings one or two; a replay at many times real time is paced.
static void publish_records(struct dig_publisher *const p)
{
    static const struct timespec breath = { .tv_nsec = 500000L };
    struct dig_record            record;
    int                          burst = 0;
    while (dig_ring_pop(p->records, &record)) {
        if (record.has_estimate) {
            p->estimate = record.estimate;
        }
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
                (void)clock_nanosleep(CLOCK_MONOTONIC, 0, &breath, NULL);
            }
        }
    }
}

// A table the tick has adopted is used here from now on.
static void follow_table(struct dig_publisher *const p)
{
    (void)dig_latest_take(p->tables, &p->news);
    if (p->news.generation == p->health.tick_status.generation && p->news.set != NULL) {
        p->set      = p->news.set;
        p->news.set = NULL;
        atomic_store(p->generation, p->news.generation);
        say(p, "table exchanged: scene %.60s (%.12s…), %zu gravels", p->set->scene_name,
            p->set->scene_hash, p->set->entries);
    }
}

static void publish_prediction(struct dig_publisher *const p)
{
    struct dig_prediction_record record;
    if (dig_latest_take(p->predictions, &record) && p->output != NULL &&
        record.generation == atomic_load(p->generation)) {
        check_sent(p, dig_output_prediction(p->output, p->set, &record));
    }
}

// Of a dig of which it was told: how it was made, and what of the table it was matched at, where
// that is another.
static void approach_text(const struct dig_gravel_track *const k, const size_t size, char text[])
{
    static const double       told    = 0.005; // what the last digit of a depth stands for
    const struct dig_approach matched = dig_approach_told(&k->matched);
    const struct dig_approach made    = k->made;
    text[0]                           = '\0';
    if (!(made.depth > 0.0)) {
        return;
    }
    const int length = snprintf(text, size, ", depth %.2f, attack %.1f deg", made.depth,
                                made.attack_rad / DIG_RAD_PER_DEG);
    if (fabs(matched.depth - made.depth) > told ||
        fabs(matched.attack_rad - made.attack_rad) > told) {
        (void)snprintf(text + length, size - (size_t)length, ", matched at %.2f and %.1f deg",
                       matched.depth, matched.attack_rad / DIG_RAD_PER_DEG);
    }
}

static void say_known(const struct dig_publisher *const p)
{
    const struct dig_gravel_track *const k = &p->result.track;
    const struct dig_match *const        m = &k->match;
    if (!k->valid) {
        say(p, "no gravel known: %s", k->wanted);
        return;
    }
    char        how[96];
    char        untold[DIG_UNTOLD_SIZE];
    char        digs[48]     = "";
    char        weighted[96] = "";
    const char *forces       = m->forces ? ", by moment and forces" : ", by the moment alone";
    if (m->digs > 1) {
        (void)snprintf(digs, sizeof digs, ", %zu digs together", m->digs);
    }
    if (m->weighted >= 0) {
        (void)snprintf(weighted, sizeof weighted,
                       ", noise-weighted entry %.2f / %.2f / %.0f at %.2f",
                       k->weighted.value[DIG_AXIS_FRICTION], k->weighted.value[DIG_AXIS_ROLLING],
                       k->weighted.value[DIG_AXIS_DENSITY_kgpm3], m->weighted_distance);
    }
    approach_text(k, sizeof how, how);
    dig_match_untold(m, untold);
    say(p,
        "%s %u (%s%s): friction %.2f (%.2f … %.2f), rolling %.2f (%.2f … %.2f), density %.0f "
        "(%.0f … %.0f) kg/m3, distance %.3f, noise floor %.3f%s%s%s%s%s%s",
        k->restored ? "from before, dig" : "dig", m->dig_count, k->trajectory, how,
        m->gravel.value[DIG_AXIS_FRICTION], m->low.value[DIG_AXIS_FRICTION],
        m->high.value[DIG_AXIS_FRICTION], m->gravel.value[DIG_AXIS_ROLLING],
        m->low.value[DIG_AXIS_ROLLING], m->high.value[DIG_AXIS_ROLLING],
        m->gravel.value[DIG_AXIS_DENSITY_kgpm3], m->low.value[DIG_AXIS_DENSITY_kgpm3],
        m->high.value[DIG_AXIS_DENSITY_kgpm3], m->distance, m->noise_floor, weighted, forces, digs,
        m->outside ? "; OUTSIDE the table: none of its gravels" : "",
        untold[0] != '\0' ? "; a FAMILY of gravels, not told: " : "", untold);
}

// Of a dig that goes on: told once, and for a while.
static void publish_hunch(struct dig_publisher *const p, const struct dig_fit_result *const hunch)
{
    if (p->output != NULL) {
        check_sent(p, dig_output_match(p->output, hunch));
    }
}

static void publish_matches(struct dig_publisher *const p, const int64_t now_ns)
{
    bool                  news   = false;
    struct dig_fit_result before = p->result;
    struct dig_fit_result next;
    while (dig_ring_pop(p->results, &next)) {
        if (next.track.going_on) {
            publish_hunch(p, &next);
            continue;
        }
        p->result = next;
        // A drift that was watched is no news for a person.
        const bool same = p->any_result && p->result.track.time_ns == before.track.time_ns &&
                          p->result.track.valid == before.track.valid;
        news          = true;
        p->any_result = true;
        before        = p->result;
        if (!same) {
            say_known(p);
        }
    }
    if (p->any_result && (news || now_ns >= p->next_match_ns) && p->output != NULL) {
        p->next_match_ns = now_ns + NS_PER_S;
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
    const bool          from_input = dig_latest_take(p->input_log, &note);
    if (from_input || dig_latest_take(p->fit_log, &note)) {
        if (strcmp(note.text, p->note.text) != 0) {
            *news   = true;
            p->note = note;
            if (note.text[0] != '\0') {
                mention(p, "%s", note.text);
            }
        }
    }
}

// Drops are counted for programs in HEALTH; a person hears of them at most every ten seconds.
static void say_drops(struct dig_publisher *const p, const int64_t now_ns)
{
    const struct dig_drops *const d   = &p->health.tick_status.drops;
    const int64_t                 all = d->nan + d->not_available + d->out_of_range + d->frozen +
                        p->health.malformed + p->health.lost;
    if (all > p->logged_drops && now_ns >= p->next_drops_ns) {
        p->logged_drops  = all;
        p->next_drops_ns = now_ns + 10 * NS_PER_S;
        say(p,
            "dropped so far: %" PRId64 " not available, %" PRId64 " out of range, %" PRId64
            " frozen, %" PRId64 " NaN, %" PRId64 " malformed, %" PRId64 " wrong checksums, %" PRId64
            " repeated, %" PRId64 " jumps, %" PRId64 " stuck, %" PRId64 " missed, %" PRId64
            " timeouts, %" PRId64 " lost",
            d->not_available, d->out_of_range, d->frozen, d->nan, p->health.malformed,
            p->health.checksum, d->repeated, d->jump, d->stuck, d->missed, p->health.timeouts,
            p->health.lost);
    }
}

// Which signals had no value in the second that ends; a silent bus says nothing about them.
static void name_missing(struct dig_publisher *const p)
{
    if (!p->any_seen) {
        return;
    }
    char missing[DIG_SIGNAL_NAMES_SIZE];
    dig_signal_name_missing(p->seen, sizeof missing, missing);
    if (strcmp(missing, p->health.missing) != 0) {
        memcpy(p->health.missing, missing, sizeof missing);
        mention(p, "without a value: %s", missing[0] != '\0' ? missing : "no signal any more");
    }
    memset(p->seen, 0, sizeof p->seen);
    p->any_seen = false;
}

static void publish_health(struct dig_publisher *const p, const int64_t now_ns, const bool stopping)
{
    bool news = false;
    take_log_lines(p, &news);
    (void)dig_latest_take(p->tick_status, &p->health.tick_status);
    const char *const state = state_of(p, stopping);
    if (state != p->state) {
        news     = true;
        p->state = state;
        mention(p, "%s (%s)", state, p->input->name);
    }
    p->health.time_ns    = now_ns;
    p->health.state      = state;
    p->health.input      = p->input->name;
    p->health.note       = p->note.text;
    p->health.rt         = p->grant;
    p->health.tick_s     = p->config->tick_s;
    p->health.frames     = atomic_load(&p->input->frames);
    p->health.malformed  = atomic_load(&p->input->malformed);
    p->health.reconnects = atomic_load(&p->input->reconnects);
    p->health.lost       = atomic_load(&p->input->overflow) + p->health.tick_status.lost +
                     p->health.tick_status.lost_digs;
    p->health.checksum        = atomic_load(&p->input->checksum);
    p->health.errors          = atomic_load(&p->input->errors);
    p->health.bus_offs        = atomic_load(&p->input->bus_offs);
    p->health.timeouts        = atomic_load(&p->input->timeouts);
    p->health.reloads         = atomic_load(&p->fit->count.reloads);
    p->health.reloads_refused = atomic_load(&p->fit->count.reloads_refused);
    p->health.table           = p->set->scene_hash;
    p->health.matches         = (int32_t)atomic_load(&p->fit->count.matches);
    p->health.whole           = (int32_t)atomic_load(&p->fit->count.whole);
    p->health.aborted         = (int32_t)atomic_load(&p->fit->count.aborted);
    p->health.unknown         = (int32_t)atomic_load(&p->fit->count.unknown);
    say_drops(p, now_ns);
    say_held(p, dig_log_limit_held_before(&p->talk, now_ns, stopping));
    if (now_ns >= p->next_health_ns) {
        name_missing(p);
    }
    if ((news || now_ns >= p->next_health_ns) && p->output != NULL) {
        p->next_health_ns = now_ns + NS_PER_S;
        check_sent(p, dig_output_health(p->output, &p->health));
    }
}

static void show(struct dig_publisher *const p, const int64_t now_ns)
{
    static const char *const phases[]  = { "air", "contact", "dig", "exit" };
    static const char *const motions[] = { "", ", penetration", ", drag", ", curl", ", lift" };
    if (p->voice.show == NULL || now_ns < p->next_show_ns) {
        return;
    }
    p->next_show_ns                     = now_ns + NS_PER_S / 2;
    const struct dig_estimate *const e  = &p->estimate;
    const bool                       on = e->trajectory >= 0 && p->record_count > 0;
    char                             gravel[96];
    char                             line[256];
    (void)snprintf(gravel, sizeof gravel, "gravel not known");
    if (p->any_result) {
        const struct dig_match *const  m = &p->result.track.match;
        const struct dig_gravel *const g = &m->gravel;
        (void)snprintf(gravel, sizeof gravel, "gravel %s%.2f / %.2f / %.0f kg/m3 by %s%s",
                       dig_match_is_family(m) ? "like " : "", g->value[DIG_AXIS_FRICTION],
                       g->value[DIG_AXIS_ROLLING], g->value[DIG_AXIS_DENSITY_kgpm3],
                       m->forces ? "moment and forces" : "moment",
                       p->result.track.valid ? "" : " (no longer)");
    }
    (void)snprintf(line, sizeof line, "%s | %s%s%s%s | moment %+.2f kNm | %s | %" PRId64 " frames",
                   p->state, phases[e->phase], motions[e->motion], on ? " " : "",
                   on ? p->set->trajectory[e->trajectory].name : "", 1e-3 * e->wrench.My_Nm, gravel,
                   p->health.frames);
    p->voice.show(line);
}

static void feed_watchdog(struct dig_publisher *const p, const int64_t now_ns)
{
    const int64_t interval_ns = dig_notify_watchdog_ns();
    // The tick's own pulse is the proof of life: a tick that hangs lets the watchdog bark.
    const bool alive = now_ns - p->health.tick_status.time_ns < NS_PER_S;
    if (interval_ns > 0 && alive && now_ns >= p->next_watchdog_ns) {
        p->next_watchdog_ns = now_ns + interval_ns;
        (void)dig_notify("WATCHDOG=1");
    }
}

void dig_publisher_run(struct dig_publisher *const p)
{
    assert(p != NULL && p->voice.say != NULL);
    const int64_t         tick_ns  = (int64_t)(p->config->tick_s * 1e9);
    const struct timespec pause    = { .tv_nsec = (long)(tick_ns < TURN_ns ? tick_ns : TURN_ns) };
    bool                  stopping = false;
    while (!stopping) {
        // Read before the last round, so that it finds everything that was put before *stop.
        stopping             = atomic_load(p->stop);
        const int64_t now_ns = dig_input_now_ns();
        (void)is_online(p, now_ns);
        publish_records(p);
        follow_table(p);
        publish_prediction(p);
        publish_matches(p, now_ns);
        publish_health(p, now_ns, stopping);
        feed_watchdog(p, now_ns);
        show(p, now_ns);
        if (!stopping) {
            (void)clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, NULL);
        }
    }
    dig_output_destroy(p->output);
    p->output = NULL;
}
