#include "firmware_host/bus/frame_watch.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// A counter that is behind by less than this share of its range went back; else it ran over.
static const double back_share = 0.25;

// How fast the expectation follows the sender's clock.
static const double follow_share = 0.1;

// More cycles without a frame than chance makes: perhaps the host was only busy.
static const int64_t pause = 2;

static bool follow_counter(struct dig_frame_watch *const watch, const uint64_t mod,
                           const uint64_t counter)
{
    const uint64_t ahead = (counter % mod + mod - watch->counter) % mod;
    if (ahead == 0 || (double)(mod - ahead) < back_share * (double)mod) {
        watch->repeated++;
        return false;
    }
    watch->missed += (int64_t)ahead - 1;
    watch->counter = counter % mod;
    return true;
}

static void follow_cycle(struct dig_frame_watch *const watch, const double cycle_s,
                         const int64_t time_ns)
{
    const double  cycle_ns = 1e9 * cycle_s;
    const int64_t late     = llround((double)(time_ns - watch->due_ns) / cycle_ns);
    watch->owed += late;

    const double expected_ns = (double)watch->due_ns + (double)late * cycle_ns;
    const double off_ns      = (double)time_ns - expected_ns;
    watch->due_ns            = llround(expected_ns + cycle_ns + follow_share * off_ns);
    watch->total++;
    watch->frames = (late < 0 && watch->owed > 0) || late > pause ? 0 : watch->frames + 1;
    if (watch->frames >= DIG_WATCH_FRAMES || watch->total >= DIG_WATCH_LONGEST) {
        watch->missed += watch->owed > 0 ? watch->owed : 0;
        watch->owed   = 0;
        watch->frames = 0;
        watch->total  = 0;
    }
}

bool dig_frame_watch_take(struct dig_frame_watch *const          watch,
                          const struct dig_frame_settings *const settings, const int64_t time_ns,
                          const uint64_t counter)
{
    assert(watch != NULL && settings != NULL);
    if (!watch->started) {
        watch->started = true;
        watch->counter = settings->counter_mod > 0 ? counter % settings->counter_mod : 0;
        watch->due_ns  = time_ns + llround(1e9 * settings->cycle_s);
        return true;
    }
    if (settings->counter_mod > 0) {
        return follow_counter(watch, settings->counter_mod, counter);
    }
    if (settings->cycle_s > 0.0) {
        follow_cycle(watch, settings->cycle_s, time_ns);
    }
    return true;
}
