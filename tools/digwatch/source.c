#include "tools/digwatch/source.h"

#include "files/lcm/lcm_log.h"

#include <assert.h>
#include <lcm/lcm.h>
#include <math.h>
#include <stdlib.h>

#define AT_ONCE  5000 // messages between two looks at the keyboard
#define QUEUE    2000 // messages that LCM keeps for us
#define PAUSE_us 10000000
#define CHANNELS "DIGSIGHT_(ESTIMATE|MATCH|PREDICTION|HEALTH)"

struct digwatch_source {
    lcm_t                       *lcm; // NULL: a log
    const struct digwatch_taker *taker;
    struct dig_lcm_log          *log;
    const struct dig_lcm_event  *next; // of the log; NULL: its end
    double                       speed, due_s;
};

static void hand_on(const lcm_recv_buf_t *const received, const char *const channel,
                    void *const context)
{
    const struct digwatch_source *const source = context;
    const struct dig_lcm_event          event  = { .time_us = received->recv_utime,
                                                   .channel = channel,
                                                   .size    = received->data_size,
                                                   .data    = received->data };
    source->taker->take(source->taker->context, &event);
}

enum dig_status digwatch_source_listen(const char *const url, struct digwatch_source **const source,
                                       struct dig_error *const error)
{
    assert(url != NULL && source != NULL);
    struct digwatch_source *const s            = calloc(1, sizeof *s);
    lcm_subscription_t           *subscription = NULL;
    if (s == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    s->due_s = INFINITY;
    s->lcm   = lcm_create(url);
    if (s->lcm != NULL) {
        subscription = lcm_subscribe(s->lcm, CHANNELS, hand_on, s);
    }
    if (subscription == NULL) {
        digwatch_source_close(s);
        return dig_error_set(error, DIG_EIO,
                             "LCM %s: no such network (a multicast route is needed: "
                             "ip route add 239.255.76.67 dev lo)",
                             url);
    }
    (void)lcm_subscription_set_queue_capacity(subscription, QUEUE);
    *source = s;
    return DIG_OK;
}

enum dig_status digwatch_source_play(const char *const path, const double speed,
                                     struct digwatch_source **const source,
                                     struct dig_error *const        error)
{
    assert(path != NULL && speed > 0.0 && source != NULL);
    struct digwatch_source *const s = calloc(1, sizeof *s);
    if (s == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    s->speed               = speed;
    enum dig_status status = dig_lcm_log_open(path, &s->log, error);
    if (status == DIG_OK) {
        status = dig_lcm_log_next(s->log, &s->next, error);
    }
    if (status != DIG_OK) {
        digwatch_source_close(s);
        return status;
    }
    *source = s;
    return DIG_OK;
}

// From one message of a log to the next; a clock that was set back takes no time.
static double pause_s(const int64_t from_us, const int64_t to_us)
{
    if (to_us <= from_us || from_us < 0) {
        return 0.0;
    }
    const int64_t pause_us = to_us - from_us;
    return 1e-6 * (double)(pause_us < PAUSE_us ? pause_us : PAUSE_us);
}

static enum dig_status read_log(struct digwatch_source *const s, const double now_s,
                                const struct digwatch_taker *const taker,
                                struct dig_error *const            error)
{
    // The first message is due now.
    s->due_s = s->due_s > 0.0 ? s->due_s : now_s;
    for (int n = 0; n < AT_ONCE && s->next != NULL && s->due_s <= now_s; n++) {
        const int64_t before_us = s->next->time_us;
        taker->take(taker->context, s->next);
        const enum dig_status status = dig_lcm_log_next(s->log, &s->next, error);
        if (status != DIG_OK) {
            s->next = NULL;
            return status;
        }
        s->due_s += s->next != NULL ? pause_s(before_us, s->next->time_us) / s->speed : 0.0;
    }
    return DIG_OK;
}

enum dig_status digwatch_source_read(struct digwatch_source *const source, const double now_s,
                                     const struct digwatch_taker *const taker,
                                     struct dig_error *const            error)
{
    assert(source != NULL && taker != NULL && taker->take != NULL);
    if (source->lcm == NULL) {
        return read_log(source, now_s, taker, error);
    }
    source->taker = taker;
    int n         = 0;
    while (n++ < AT_ONCE && lcm_handle_timeout(source->lcm, 0) > 0) {
    }
    return DIG_OK;
}

int digwatch_source_fd(const struct digwatch_source *const source)
{
    assert(source != NULL);
    return source->lcm != NULL ? lcm_get_fileno(source->lcm) : -1;
}

double digwatch_source_due_s(const struct digwatch_source *const source)
{
    assert(source != NULL);
    return digwatch_source_ended(source) ? (double)INFINITY : source->due_s;
}

bool digwatch_source_ended(const struct digwatch_source *const source)
{
    assert(source != NULL);
    return source->lcm == NULL && source->next == NULL;
}

void digwatch_source_close(struct digwatch_source *const source)
{
    if (source != NULL) {
        if (source->lcm != NULL) {
            lcm_destroy(source->lcm);
        }
        dig_lcm_log_close(source->log);
        free(source);
    }
}
