#include "firmware_host/tick/loop.h"

#include "core/units.h"

#include <assert.h>
#include <math.h>
#include <time.h>

const char *dig_prediction_state_str(const enum dig_prediction_state state)
{
    static const char *const words[DIG_PREDICTION_STATES] = {
        [DIG_PREDICTION_VALID]         = "",
        [DIG_PREDICTION_NO_GRAVEL]     = "no gravel known",
        [DIG_PREDICTION_EXPIRED]       = "the gravel known has expired",
        [DIG_PREDICTION_STALE]         = "no fresh samples",
        [DIG_PREDICTION_NO_TRAJECTORY] = "which dig it is cannot be told yet",
        [DIG_PREDICTION_OFF_TABLE]     = "off the table",
        [DIG_PREDICTION_DIG_OVER]      = "the dig is over",
    };
    return (unsigned)state < DIG_PREDICTION_STATES ? words[state] : "";
}

void dig_loop_init(struct dig_loop *const loop, const struct dig_loop_settings *const settings,
                   struct dig_handoffs *const handoffs, struct dig_estimator *const estimator)
{
    assert(loop != NULL && settings != NULL && handoffs != NULL && estimator != NULL);
    *loop = (struct dig_loop){ .settings        = *settings,
                               .handoffs        = handoffs,
                               .estimator       = estimator,
                               .set             = settings->set,
                               .published_state = DIG_PREDICTION_NO_GRAVEL,
                               .tick_status     = { .generation = 1 } };
    atomic_store(&loop->generation, 1);
    dig_assembler_init(&loop->assembler, &settings->assembler);
}

// Steps the estimator by a sample that gives the moment; records the sample in any case. True when
// there is an estimate.
static bool take_sample(struct dig_loop *const loop, const struct dig_sample *const sample,
                        const int64_t arrived_ns, const int64_t now_ns)
{
    struct dig_record record = { .sample     = *sample,
                                 .arrived_ns = arrived_ns,
                                 .expires_ns = now_ns + dig_ns(loop->settings.stale_s) };
    if (dig_sample_has_moment(sample) &&
        dig_estimator_step(loop->estimator, sample, &loop->estimate) == DIG_OK) {
        loop->sampled_ns       = now_ns;
        loop->tick_status.digs = loop->estimate.dig_count;
        record.estimate        = loop->estimate;
        record.has_estimate    = true;
    }
    loop->tick_status.lost += dig_ring_push(&loop->handoffs->records, &record) ? 0 : 1;
    return record.has_estimate;
}

// Hands out the finished dig and lends memory for the next. The ring has room for all of it.
static void exchange_digs(struct dig_loop *const loop)
{
    struct dig_recorded_dig *recording = dig_estimator_take_recording(loop->estimator);
    if (recording != NULL) {
        (void)dig_ring_push(&loop->handoffs->digs, &recording);
    }
    if (dig_estimator_wants_spare(loop->estimator) &&
        dig_ring_pop(&loop->handoffs->spares, &recording)) {
        dig_estimator_lend(loop->estimator, recording);
    }
}

// Takes a new forecast at once, another table and machine only between two digs.
static void take_basis(struct dig_loop *const loop)
{
    const struct dig_prediction_basis *const basis = dig_latest_look(&loop->handoffs->basis);
    if (basis != NULL && basis->generation == loop->tick_status.generation) {
        loop->basis = basis;
        dig_estimator_set_forecast(loop->estimator, basis->known ? &basis->forecast : NULL);
    }
    if (!dig_estimator_is_idle(loop->estimator)) {
        return;
    }
    const struct dig_prediction_basis *const table = dig_latest_look(&loop->handoffs->table);
    if (table != NULL) {
        dig_estimator_set_table(loop->estimator, table->set);
        dig_estimator_set_machine(loop->estimator, &table->machine);
        dig_estimator_set_forecast(loop->estimator, table->known ? &table->forecast : NULL);
        loop->set                    = table->set;
        loop->basis                  = table;
        loop->tick_status.generation = table->generation;
        atomic_store(&loop->generation, table->generation);
        loop->estimate.trajectory = -1;
        loop->next_dig_trajectory = 0;
    }
}

static void publish_prediction(struct dig_loop *const loop, const int64_t now_ns,
                               const double lifetime_s)
{
    struct dig_prediction_record *const      record = &loop->published;
    const struct dig_prediction_basis *const basis  = loop->basis;
    record->time_ns                                 = loop->estimate.time_ns;
    record->expires_ns                              = now_ns + dig_ns(lifetime_s);
    record->generation                              = loop->tick_status.generation;
    record->dig_count                               = basis != NULL ? basis->dig_count : 0;
    record->outside = basis != NULL && basis->known && basis->outside;
    dig_latest_put(&loop->handoffs->predictions, record);
}

// Whether anything can be predicted, whatever is dug.
static enum dig_prediction_state basis_state(const struct dig_loop *const loop,
                                             const int64_t                now_ns)
{
    if (!loop->tick_status.fresh) {
        return DIG_PREDICTION_STALE;
    }
    if (loop->basis == NULL || (!loop->basis->known && loop->basis->expires_ns == 0)) {
        return DIG_PREDICTION_NO_GRAVEL;
    }
    return loop->basis->known && now_ns < loop->basis->expires_ns ? DIG_PREDICTION_VALID
                                                                  : DIG_PREDICTION_EXPIRED;
}

// In the air, predicts the table's digs one trajectory after the other. Not in a tick that has just
// published the end of a dig: the slot holds one record.
static void predict_next_dig(struct dig_loop *const loop, const int64_t now_ns)
{
    const int trajectories = (int)loop->set->trajectories;
    if (trajectories == 0 || loop->estimate.phase != DIG_PHASE_AIR ||
        loop->predicted_ns == now_ns ||
        now_ns - loop->next_dig_ns < dig_ns(loop->settings.next_dig_s) ||
        basis_state(loop, now_ns) != DIG_PREDICTION_VALID) {
        return;
    }
    loop->next_dig_trajectory = (loop->next_dig_trajectory + 1) % trajectories;
    dig_estimator_predict_trajectory(loop->estimator, loop->next_dig_trajectory,
                                     &loop->published.prediction);
    loop->published.state = DIG_PREDICTION_VALID;
    if (loop->published.prediction.valid) {
        loop->next_dig_ns = now_ns;
        publish_prediction(loop, now_ns, 2.0 * loop->settings.next_dig_s * trajectories);
    }
}

// Predicts the dig in progress; the state says why there is no prediction.
static enum dig_prediction_state predict_dig(struct dig_loop *const loop, const int64_t now_ns)
{
    const enum dig_prediction_state basis = basis_state(loop, now_ns);
    if (loop->estimate.phase == DIG_PHASE_AIR) {
        return DIG_PREDICTION_DIG_OVER;
    }
    if (basis != DIG_PREDICTION_VALID) {
        return basis;
    }
    dig_estimator_predict(loop->estimator, &loop->published.prediction);
    if (loop->published.prediction.valid) {
        return DIG_PREDICTION_VALID;
    }
    return dig_estimator_is_off_table(loop->estimator) ? DIG_PREDICTION_OFF_TABLE
                                                       : DIG_PREDICTION_NO_TRAJECTORY;
}

// Publishes predictions of the dig in progress; a reason for having none is published once.
static void publish_dig(struct dig_loop *const loop, const int64_t now_ns)
{
    if (now_ns - loop->predicted_ns < dig_ns(loop->settings.prediction_s)) {
        return;
    }
    loop->published.prediction.valid      = false;
    const enum dig_prediction_state state = predict_dig(loop, now_ns);
    if (state != DIG_PREDICTION_VALID && state == loop->published_state) {
        return;
    }
    const bool nothing_to_end =
        state == DIG_PREDICTION_DIG_OVER && loop->published_state != DIG_PREDICTION_VALID;
    loop->published_state = state;
    if (nothing_to_end) {
        return;
    }
    loop->published.state = state;
    loop->predicted_ns    = now_ns;
    publish_prediction(loop, now_ns, 2.0 * loop->settings.prediction_s);
}

void dig_loop_tick(struct dig_loop *const loop, const int64_t now_ns)
{
    assert(loop != NULL);
    take_basis(loop);
    struct dig_reading reading;
    for (int i = 0; i < DIG_READINGS_PER_TICK && dig_ring_pop(&loop->handoffs->readings, &reading);
         i++) {
        struct dig_sample sample;
        if (dig_assembler_take(&loop->assembler, &reading, &sample)) {
            const bool estimated = take_sample(loop, &sample, reading.time_ns, now_ns);
            exchange_digs(loop);
            // After the digs: a reader that finds the end of a dig here finds its recording there.
            if (estimated) {
                (void)dig_ring_push(&loop->handoffs->estimates, &loop->estimate);
            }
        }
    }
    exchange_digs(loop);
    loop->tick_status.fresh =
        loop->sampled_ns > 0 && now_ns - loop->sampled_ns <= dig_ns(loop->settings.stale_s);
    publish_dig(loop, now_ns);
    predict_next_dig(loop, now_ns);

    loop->tick_status.ticks++;
    loop->tick_status.missing += loop->tick_status.fresh ? 0 : 1;
    loop->tick_status.time_ns   = now_ns;
    loop->tick_status.drops     = loop->assembler.drops;
    loop->tick_status.lost_digs = dig_estimator_lost_digs(loop->estimator);
    dig_latest_put(&loop->handoffs->tick_status, &loop->tick_status);
}

static int64_t clock_ns(const clockid_t clock)
{
    struct timespec t;
    (void)clock_gettime(clock, &t);
    return (int64_t)t.tv_sec * DIG_NS_PER_S + t.tv_nsec;
}

void dig_loop_run(struct dig_loop *const loop, const atomic_bool *const stop)
{
    assert(loop != NULL && stop != NULL);
    const int64_t period_ns = dig_ns(loop->settings.tick_s);
    int64_t       due_ns    = clock_ns(CLOCK_MONOTONIC);
    while (!atomic_load_explicit(stop, memory_order_relaxed)) {
        const int64_t start_ns = clock_ns(CLOCK_MONOTONIC);
        const int64_t cpu_ns   = clock_ns(CLOCK_THREAD_CPUTIME_ID);
        const double  late_us  = (double)(start_ns - due_ns) * 1e-3;
        if (start_ns - due_ns >= period_ns) {
            loop->tick_status.overruns++;
            due_ns = start_ns;
        }
        loop->tick_status.worst_late_us = fmax(loop->tick_status.worst_late_us, late_us);
        dig_loop_tick(loop, start_ns);
        const double took_us = (double)(clock_ns(CLOCK_MONOTONIC) - start_ns) * 1e-3;
        const double cpu_us  = (double)(clock_ns(CLOCK_THREAD_CPUTIME_ID) - cpu_ns) * 1e-3;

        loop->tick_status.worst_tick_us     = fmax(loop->tick_status.worst_tick_us, took_us);
        loop->tick_status.worst_tick_cpu_us = fmax(loop->tick_status.worst_tick_cpu_us, cpu_us);
        due_ns += period_ns;
        const struct timespec deadline = { .tv_sec  = (time_t)(due_ns / DIG_NS_PER_S),
                                           .tv_nsec = (long)(due_ns % DIG_NS_PER_S) };
        (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, NULL);
    }
}
