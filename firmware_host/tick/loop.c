#include "firmware_host/tick/loop.h"

#include <assert.h>
#include <math.h>
#include <time.h>

#define NS_PER_S 1000000000LL

const char *dig_why_not_str(const enum dig_why_not why)
{
    static const char *const words[DIG_WHY_NOTS] = {
        [DIG_WHY_NOT_VALID]      = "",
        [DIG_WHY_NOT_KNOWN]      = "no gravel known",
        [DIG_WHY_NOT_EXPIRED]    = "the gravel known has expired",
        [DIG_WHY_NOT_STALE]      = "no fresh samples",
        [DIG_WHY_NOT_TRAJECTORY] = "which dig it is cannot be told yet",
        [DIG_WHY_NOT_ON_TABLE]   = "off the table",
        [DIG_WHY_NOT_OVER]       = "the dig is over",
    };
    return (unsigned)why < DIG_WHY_NOTS ? words[why] : "";
}

void dig_loop_init(struct dig_loop *const loop, const struct dig_loop_settings *const settings,
                   const struct dig_loop_ports *const ports, struct dig_estimator *const estimator)
{
    assert(loop != NULL && settings != NULL && ports != NULL && estimator != NULL);
    *loop = (struct dig_loop){ .settings  = *settings,
                               .ports     = *ports,
                               .estimator = estimator,
                               .set       = settings->set,
                               .said      = DIG_WHY_NOT_KNOWN,
                               .pulse     = { .generation = 1 } };
    atomic_store(&loop->generation, 1);
    dig_assembler_init(&loop->assembler, &settings->assembler);
}

static int64_t ns(const double seconds)
{
    return (int64_t)llround(seconds * (double)NS_PER_S);
}

// One assembled sample: through the estimator if it tells the moment, out in any case. True when
// there is an estimate of it.
static bool take_sample(struct dig_loop *const loop, const struct dig_sample *const sample,
                        const int64_t arrived_ns, const int64_t now_ns)
{
    struct dig_record record = { .sample     = *sample,
                                 .arrived_ns = arrived_ns,
                                 .expires_ns = now_ns + ns(loop->settings.stale_s) };
    if (dig_sample_has_moment(sample) &&
        dig_estimator_step(loop->estimator, sample, &loop->estimate) == DIG_OK) {
        loop->sampled_ns    = now_ns;
        loop->pulse.digs    = loop->estimate.dig_count;
        record.estimate     = loop->estimate;
        record.has_estimate = true;
    }
    loop->pulse.lost += dig_ring_push(loop->ports.records, &record) ? 0 : 1;
    return record.has_estimate;
}

// Digs that ended leave, memory for the next comes in. The ring has room for all memory there is.
static void exchange_digs(struct dig_loop *const loop)
{
    struct dig_recorded_dig *raw = dig_estimator_take_raw(loop->estimator);
    if (raw != NULL) {
        (void)dig_ring_push(loop->ports.digs, &raw);
    }
    if (dig_estimator_wants_raw(loop->estimator) && dig_ring_pop(loop->ports.spares, &raw)) {
        dig_estimator_lend(loop->estimator, raw);
    }
}

// Behind the dig it may have ended: who finds the end here finds the dig there.
static void share_estimate(struct dig_loop *const loop)
{
    if (loop->ports.estimates != NULL) {
        (void)dig_ring_push(loop->ports.estimates, &loop->estimate);
    }
}

// A gravel at once; another table and machine only while no dig goes on.
static void take_offers(struct dig_loop *const loop)
{
    const struct dig_offer *const offer = dig_latest_look(loop->ports.offer);
    if (offer != NULL && offer->generation == loop->pulse.generation) {
        loop->offer = offer;
        dig_estimator_give_forecast(loop->estimator, offer->known ? &offer->forecast : NULL);
    }
    if (!dig_estimator_is_idle(loop->estimator)) {
        return;
    }
    const struct dig_offer *const table = dig_latest_look(loop->ports.table);
    if (table != NULL) {
        dig_estimator_adopt(loop->estimator, table->set);
        dig_estimator_take(loop->estimator, &table->machine);
        dig_estimator_give_forecast(loop->estimator, table->known ? &table->forecast : NULL);
        loop->set              = table->set;
        loop->offer            = table;
        loop->pulse.generation = table->generation;
        atomic_store(&loop->generation, table->generation);
        loop->estimate.trajectory = -1;
        loop->ahead               = 0;
    }
}

static void hand_on(struct dig_loop *const loop, const int64_t now_ns, const double lives_s)
{
    struct dig_outlook *const     outlook = &loop->outlook;
    const struct dig_offer *const offer   = loop->offer;
    outlook->time_ns                      = loop->estimate.time_ns;
    outlook->expires_ns                   = now_ns + ns(lives_s);
    outlook->generation                   = loop->pulse.generation;
    outlook->dig_count                    = offer != NULL ? offer->dig_count : 0;
    outlook->outside                      = offer != NULL && offer->known && offer->outside;
    dig_latest_put(loop->ports.outlook, outlook);
}

// Why nothing can be predicted at all, whatever is dug.
static enum dig_why_not why_not_at_all(const struct dig_loop *const loop, const int64_t now_ns)
{
    if (!loop->pulse.fresh) {
        return DIG_WHY_NOT_STALE;
    }
    if (loop->offer == NULL || (!loop->offer->known && loop->offer->expires_ns == 0)) {
        return DIG_WHY_NOT_KNOWN;
    }
    return loop->offer->known && now_ns < loop->offer->expires_ns ? DIG_WHY_NOT_VALID
                                                                  : DIG_WHY_NOT_EXPIRED;
}

// In the air, what each of the table's digs would resist with, one trajectory after the other. Not
// in a tick that has just said that a dig is over: the slot holds one outlook.
static void look_ahead(struct dig_loop *const loop, const int64_t now_ns)
{
    const int trajectories = (int)loop->set->trajectories;
    if (trajectories == 0 || loop->estimate.phase != DIG_PHASE_AIR ||
        loop->predicted_ns == now_ns || now_ns - loop->ahead_ns < ns(loop->settings.ahead_s) ||
        why_not_at_all(loop, now_ns) != DIG_WHY_NOT_VALID) {
        return;
    }
    loop->ahead = (loop->ahead + 1) % trajectories;
    dig_estimator_predict_whole(loop->estimator, loop->ahead, &loop->outlook.prediction);
    loop->outlook.why_not = DIG_WHY_NOT_VALID;
    if (loop->outlook.prediction.valid) {
        loop->ahead_ns = now_ns;
        hand_on(loop, now_ns, 2.0 * loop->settings.ahead_s * trajectories);
    }
}

static enum dig_why_not why_not(struct dig_loop *const loop, const int64_t now_ns)
{
    const enum dig_why_not at_all = why_not_at_all(loop, now_ns);
    if (loop->estimate.phase == DIG_PHASE_AIR) {
        return DIG_WHY_NOT_OVER;
    }
    if (at_all != DIG_WHY_NOT_VALID) {
        return at_all;
    }
    dig_estimator_predict(loop->estimator, &loop->outlook.prediction);
    if (loop->outlook.prediction.valid) {
        return DIG_WHY_NOT_VALID;
    }
    return dig_estimator_is_off_table(loop->estimator) ? DIG_WHY_NOT_ON_TABLE
                                                       : DIG_WHY_NOT_TRAJECTORY;
}

// Predictions while a dig goes on on fresh samples; and why there is none, said once.
static void predict(struct dig_loop *const loop, const int64_t now_ns)
{
    if (now_ns - loop->predicted_ns < ns(loop->settings.prediction_s)) {
        return;
    }
    loop->outlook.prediction.valid = false;
    const enum dig_why_not why     = why_not(loop, now_ns);
    if (why != DIG_WHY_NOT_VALID && why == loop->said) {
        return;
    }
    const bool in_the_air_as_before = why == DIG_WHY_NOT_OVER && loop->said != DIG_WHY_NOT_VALID;
    loop->said                      = why;
    if (in_the_air_as_before) {
        return; // nothing was predicted that would have to end
    }
    loop->outlook.why_not = why;
    loop->predicted_ns    = now_ns;
    hand_on(loop, now_ns, 2.0 * loop->settings.prediction_s);
}

void dig_loop_tick(struct dig_loop *const loop, const int64_t now_ns)
{
    assert(loop != NULL);
    take_offers(loop);
    struct dig_reading reading;
    for (int i = 0; i < DIG_READINGS_PER_TICK && dig_ring_pop(loop->ports.readings, &reading);
         i++) {
        struct dig_sample sample;
        if (dig_assembler_take(&loop->assembler, &reading, &sample)) {
            const bool estimated = take_sample(loop, &sample, reading.time_ns, now_ns);
            exchange_digs(loop);
            if (estimated) {
                share_estimate(loop);
            }
        }
    }
    exchange_digs(loop);
    loop->pulse.fresh =
        loop->sampled_ns > 0 && now_ns - loop->sampled_ns <= ns(loop->settings.stale_s);
    predict(loop, now_ns);
    look_ahead(loop, now_ns);

    loop->pulse.ticks++;
    loop->pulse.missing += loop->pulse.fresh ? 0 : 1;
    loop->pulse.time_ns   = now_ns;
    loop->pulse.drops     = loop->assembler.drops;
    loop->pulse.lost_digs = dig_estimator_lost(loop->estimator);
    dig_latest_put(loop->ports.pulse, &loop->pulse);
}

static int64_t clock_ns(const clockid_t clock)
{
    struct timespec t;
    (void)clock_gettime(clock, &t);
    return (int64_t)t.tv_sec * NS_PER_S + t.tv_nsec;
}

void dig_loop_run(struct dig_loop *const loop, const atomic_bool *const stop)
{
    assert(loop != NULL && stop != NULL);
    const int64_t period_ns = ns(loop->settings.tick_s);
    int64_t       due_ns    = clock_ns(CLOCK_MONOTONIC);
    while (!atomic_load_explicit(stop, memory_order_relaxed)) {
        const int64_t start_ns = clock_ns(CLOCK_MONOTONIC);
        const int64_t cpu_ns   = clock_ns(CLOCK_THREAD_CPUTIME_ID);
        if (start_ns - due_ns >= period_ns) {
            loop->pulse.overruns++;
            due_ns = start_ns;
        }
        dig_loop_tick(loop, start_ns);
        const double took_us = (double)(clock_ns(CLOCK_MONOTONIC) - start_ns) * 1e-3;
        const double cpu_us  = (double)(clock_ns(CLOCK_THREAD_CPUTIME_ID) - cpu_ns) * 1e-3;

        loop->pulse.worst_tick_us     = fmax(loop->pulse.worst_tick_us, took_us);
        loop->pulse.worst_tick_cpu_us = fmax(loop->pulse.worst_tick_cpu_us, cpu_us);
        due_ns += period_ns;
        const struct timespec deadline = { .tv_sec  = (time_t)(due_ns / NS_PER_S),
                                           .tv_nsec = (long)(due_ns % NS_PER_S) };
        (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, NULL);
    }
}
