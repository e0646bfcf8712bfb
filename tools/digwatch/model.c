#include "tools/digwatch/model.h"

#include "core/name.h"
#include "core/text.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const struct digwatch_slot no_slot = { (double)NAN, (double)NAN, (double)NAN };

// Times between which differences can be taken.
static bool is_time(const int64_t time_ns)
{
    return time_ns >= 0 && time_ns <= (int64_t)1 << 62;
}

static void take_name(char name[DIG_NAME_SIZE], const char *const said)
{
    (void)snprintf(name, DIG_NAME_SIZE, "%s",
                   dig_name_ok(said) && strlen(said) < DIG_NAME_SIZE ? said : "");
}

static bool begins_dig(const int phase)
{
    return phase == 1 || phase == 2;
}

static bool has_expired(const struct digwatch_model *const m, const int64_t expires_ns,
                        const int64_t estimate_ns)
{
    // Times of messages may be any: their difference need not be an int64_t.
    const double since_ns = 1e3 * ((double)m->time_us - (double)m->health_us);
    const double now_ns =
        m->any_health ? (double)m->health.time_ns + since_ns : (double)estimate_ns;
    return now_ns > (double)expires_ns;
}

// What the last prediction says of this place; NaN where it says nothing.
static void predict_here(const struct digwatch_model *const m, struct digwatch_estimate *const e)
{
    const struct digwatch_prediction *const p = &m->prediction;
    e->predicted_Nm = e->predicted_sigma_Nm = (double)NAN;
    if (p->valid && !has_expired(m, p->expires_ns, e->time_ns) &&
        strcmp(e->trajectory, p->curve.trajectory) == 0) {
        (void)dig_predicted_curve_at(&p->curve, e->progress, &e->predicted_Nm,
                                     &e->predicted_sigma_Nm);
    }
}

static void clear_slots(struct digwatch_model *const m)
{
    for (size_t i = 0; i < DIGWATCH_SLOTS; i++) {
        m->slot[i] = no_slot;
    }
}

// The mean of one more value.
static void average(double *const mean, const double value, const int n)
{
    if (isfinite(value)) {
        *mean = isfinite(*mean) ? *mean + (value - *mean) / n : value;
    }
}

static void add_to_slots(struct digwatch_model *const m, const struct digwatch_estimate *const e)
{
    const int64_t index = e->time_ns / DIGWATCH_SLOT_ns;
    if (!m->any_estimate || index < m->slot_index || index >= m->slot_index + DIGWATCH_SLOTS) {
        clear_slots(m);
        m->slot_index = index;
        m->slot_rows  = 0;
    }
    for (; m->slot_index < index; m->slot_rows = 0) {
        m->slot[++m->slot_index % DIGWATCH_SLOTS] = no_slot;
    }
    struct digwatch_slot *const slot = &m->slot[index % DIGWATCH_SLOTS];
    // Of a sender whose clock stands still a slot never ends.
    m->slot_rows += m->slot_rows < INT_MAX ? 1 : 0;
    average(&slot->measured_Nm, e->moment_valid ? e->moment_Nm : (double)NAN, m->slot_rows);
    average(&slot->predicted_Nm, e->predicted_Nm, m->slot_rows);
    average(&slot->sigma_Nm, e->predicted_sigma_Nm, m->slot_rows);
}

// A dig ends with the soil; what it was wrong by stands until the next one ends.
static void add_error(struct digwatch_model *const m, const struct digwatch_estimate *const e)
{
    const bool was = m->any_estimate && begins_dig(m->estimate.phase);
    if (was && !begins_dig(e->phase)) {
        m->before = m->now.whole2 > 0.0 ? m->now : m->before;
        m->now    = (struct digwatch_error){ 0 };
    }
    if (begins_dig(e->phase) && e->moment_valid && isfinite(e->predicted_Nm)) {
        const double wrong = e->moment_Nm - e->predicted_Nm;
        m->now.wrong2 += wrong * wrong;
        m->now.whole2 += e->moment_Nm * e->moment_Nm;
    }
}

static void take_estimate(void *const context, const int64_t time_us,
                          const digsight_estimate_t *const said)
{
    struct digwatch_model *const m = context;
    (void)time_us;
    if (!is_time(said->time_ns)) {
        return;
    }
    struct digwatch_estimate e = {
        .moment_valid = said->moment_valid != 0 && fabs(said->moment_Nm) <= DIG_MOMENT_MOST_Nm,
        .time_ns      = said->time_ns,
        .moment_Nm    = said->moment_Nm,
        .sigma_Nm     = hypot(said->sigma_moment_Nm, said->geometry_sigma_moment_Nm),
        .phase        = said->phase,
        .motion       = said->motion,
        .progress = said->progress >= 0.0 && said->progress <= 1.0 ? said->progress : (double)NAN,
    };
    take_name(e.trajectory, said->trajectory);
    predict_here(m, &e);
    add_error(m, &e);
    add_to_slots(m, &e);
    m->estimate     = e;
    m->any_estimate = true;
}

static void take_match(void *const context, const int64_t time_us,
                       const digsight_match_t *const said)
{
    struct digwatch_model *const m = context;
    (void)time_us;
    (void)dig_matched_gravel_take(said, &m->match);
}

static void take_prediction(void *const context, const int64_t time_us,
                            const digsight_prediction_t *const said)
{
    struct digwatch_model *const m = context;
    (void)time_us;
    struct digwatch_prediction p = { .valid      = said->valid != 0,
                                     .outside    = said->outside != 0,
                                     .expires_ns = said->expires_ns };
    dig_text_copy(DIGWATCH_TEXT, p.reason, said->reason);
    if (p.valid && !dig_predicted_curve_take(said, &p.curve)) {
        return;
    }
    m->prediction = p;
}

static void take_health(void *const context, const int64_t time_us,
                        const digsight_health_t *const said)
{
    struct digwatch_model *const m = context;
    if (!is_time(said->time_ns)) {
        return;
    }
    struct digwatch_health h = {
        .time_ns        = said->time_ns,
        .frames         = said->frames,
        .digs           = said->digs,
        .matches        = said->matches,
        .aborted        = said->digs_aborted,
        .latency_p99_us = said->latency_p99_us,
        .realtime       = said->realtime != 0,
        .memory_locked  = said->memory_locked != 0,
    };
    dig_health_counts(said, h.count);
    for (size_t i = 0; i < DIG_HEALTH_COUNTERS; i++) {
        // The first message says what was before; so does one of a daemon that began anew.
        const bool grew = m->any_health && h.count[i] > m->health.count[i];
        h.grew_ns[i]    = grew ? h.time_ns : m->health.grew_ns[i];
    }
    dig_text_copy(DIGWATCH_TEXT, h.state, said->state);
    dig_text_copy(DIGWATCH_TEXT, h.input, said->input);
    dig_text_copy(DIGWATCH_TEXT, h.note, said->note);
    dig_text_copy(DIGWATCH_TEXT, h.missing, said->missing_signals);
    m->health     = h;
    m->health_us  = time_us;
    m->any_health = true;
}

void digwatch_model_init(struct digwatch_model *const model)
{
    assert(model != NULL);
    *model = (struct digwatch_model){ .time_us = 0 };
    clear_slots(model);
}

void digwatch_model_take(struct digwatch_model *const      model,
                         const struct dig_lcm_event *const event)
{
    assert(model != NULL && event != NULL);
    const struct dig_lcm_reader reader = { .context    = model,
                                           .estimate   = take_estimate,
                                           .match      = take_match,
                                           .prediction = take_prediction,
                                           .health     = take_health };
    model->time_us                     = event->time_us;
    if (dig_lcm_message_read(event, &reader) == DIG_OK) {
        model->messages++;
    } else {
        model->misread++;
        model->misread_us = event->time_us;
    }
}

struct digwatch_slot digwatch_model_slot(const struct digwatch_model *const model,
                                         const int64_t                      back)
{
    assert(model != NULL && back >= 0);
    const int64_t index = model->slot_index - back;
    return index < 0 || back >= DIGWATCH_SLOTS ? no_slot : model->slot[index % DIGWATCH_SLOTS];
}

bool digwatch_model_match_holds(const struct digwatch_model *const model)
{
    assert(model != NULL);
    return model->match.known &&
           !has_expired(model, model->match.expires_ns, model->estimate.time_ns);
}

bool digwatch_model_prediction_holds(const struct digwatch_model *const model)
{
    assert(model != NULL);
    return model->prediction.valid &&
           !has_expired(model, model->prediction.expires_ns, model->estimate.time_ns);
}

double digwatch_error(const struct digwatch_error *const error)
{
    assert(error != NULL);
    return error->whole2 > 0.0 ? sqrt(error->wrong2 / error->whole2) : (double)NAN;
}
