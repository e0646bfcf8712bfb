#include "firmware_host/loop.h"

#include <assert.h>
#include <math.h>
#include <time.h>

#define NS_PER_S 1000000000LL

void dig_loop_init(struct dig_loop *const loop, const struct dig_loop_settings *const settings,
                   const struct dig_loop_ports *const ports, struct dig_estimator *const estimator)
{
    assert(loop != NULL && settings != NULL && ports != NULL && estimator != NULL);
    *loop = (struct dig_loop){ .settings = *settings, .ports = *ports, .estimator = estimator };
    dig_assembler_init(&loop->assembler, &settings->assembler);
}

static int64_t ns(const double seconds)
{
    return (int64_t)llround(seconds * (double)NS_PER_S);
}

// One assembled sample: through the estimator if it is whole, out in any case.
static void take_sample(struct dig_loop *const loop, const struct dig_sample *const sample,
                        const int64_t now_ns)
{
    struct dig_record record = { .sample = *sample };
    if (dig_sample_is_complete(sample) &&
        dig_estimator_step(loop->estimator, sample, &loop->estimate) == DIG_OK) {
        loop->sampled_ns    = now_ns;
        loop->pulse.digs    = loop->estimate.dig_count;
        record.estimate     = loop->estimate;
        record.has_estimate = true;
    }
    loop->pulse.lost += dig_ring_push(loop->ports.records, &record) ? 0 : 1;
    if (dig_estimator_take_dig(loop->estimator, &loop->observation)) {
        loop->pulse.lost += dig_ring_push(loop->ports.digs, &loop->observation) ? 0 : 1;
    }
}

static void hand_on(struct dig_loop *const loop, const int64_t now_ns, const double lives_s)
{
    struct dig_outlook *const outlook = &loop->outlook;
    outlook->time_ns                  = loop->estimate.time_ns;
    outlook->expires_ns               = now_ns + ns(lives_s);
    outlook->dig_count                = loop->match_dig;
    dig_latest_put(loop->ports.outlook, outlook);
}

// In the air, what each of the table's digs would resist with, one trajectory after the other. Not
// in a tick that has just said that a dig is over: the slot holds one outlook.
static void look_ahead(struct dig_loop *const loop, const int64_t now_ns)
{
    if (loop->settings.trajectories == 0 || loop->estimate.phase != DIG_PHASE_AIR ||
        loop->predicted_ns == now_ns || now_ns - loop->ahead_ns < ns(loop->settings.ahead_s)) {
        return;
    }
    loop->ahead = (loop->ahead + 1) % loop->settings.trajectories;
    dig_estimator_predict_whole(loop->estimator, loop->ahead, &loop->outlook.prediction);
    if (loop->outlook.prediction.valid) {
        loop->ahead_ns = now_ns;
        hand_on(loop, now_ns, 2.0 * loop->settings.ahead_s * loop->settings.trajectories);
    }
}

// A prediction while a dig goes on on fresh samples; one that says "no longer" when it ends.
static void predict(struct dig_loop *const loop, const int64_t now_ns)
{
    if (now_ns - loop->predicted_ns < ns(loop->settings.prediction_s)) {
        return;
    }
    struct dig_outlook *const outlook = &loop->outlook;
    outlook->prediction.valid         = false;
    if (loop->pulse.fresh && loop->estimate.phase != DIG_PHASE_AIR) {
        dig_estimator_predict(loop->estimator, &outlook->prediction);
    }
    if (outlook->prediction.valid || loop->predicting) {
        loop->predicting   = outlook->prediction.valid;
        loop->predicted_ns = now_ns;
        hand_on(loop, now_ns, 2.0 * loop->settings.prediction_s);
    }
}

void dig_loop_tick(struct dig_loop *const loop, const int64_t now_ns)
{
    assert(loop != NULL);
    struct dig_match match;
    if (dig_latest_take(loop->ports.match, &match)) {
        dig_estimator_give_match(loop->estimator, &match);
        loop->match_dig = match.dig_count;
    }
    struct dig_reading reading;
    for (int i = 0; i < DIG_READINGS_PER_TICK && dig_ring_pop(loop->ports.readings, &reading);
         i++) {
        struct dig_sample sample;
        if (dig_assembler_take(&loop->assembler, &reading, &sample)) {
            take_sample(loop, &sample, now_ns);
        }
    }
    loop->pulse.fresh =
        loop->sampled_ns > 0 && now_ns - loop->sampled_ns <= ns(loop->settings.stale_s);
    predict(loop, now_ns);
    look_ahead(loop, now_ns);

    loop->pulse.ticks++;
    loop->pulse.missing += loop->pulse.fresh ? 0 : 1;
    loop->pulse.time_ns = now_ns;
    loop->pulse.drops   = loop->assembler.drops;
    dig_latest_put(loop->ports.pulse, &loop->pulse);
}

static int64_t now(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * NS_PER_S + t.tv_nsec;
}

void dig_loop_run(struct dig_loop *const loop, const atomic_bool *const stop)
{
    assert(loop != NULL && stop != NULL);
    const int64_t period_ns = ns(loop->settings.tick_s);
    int64_t       due_ns    = now();
    while (!atomic_load_explicit(stop, memory_order_relaxed)) {
        const int64_t start_ns = now();
        if (start_ns - due_ns >= period_ns) {
            loop->pulse.overruns++;
            due_ns = start_ns;
        }
        dig_loop_tick(loop, start_ns);
        const double took_us = (double)(now() - start_ns) * 1e-3;
        if (took_us > loop->pulse.worst_tick_us) {
            loop->pulse.worst_tick_us = took_us;
        }
        due_ns += period_ns;
        const struct timespec deadline = { .tv_sec  = (time_t)(due_ns / NS_PER_S),
                                           .tv_nsec = (long)(due_ns % NS_PER_S) };
        (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, NULL);
    }
}
