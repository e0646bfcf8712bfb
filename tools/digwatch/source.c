#include "tools/digwatch/source.h"

#include "files/lcm/lcm_datagram.h"
#include "files/lcm/lcm_log.h"
#include "tools/digwatch/multicast.h"

#include <assert.h>
#include <math.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define AT_ONCE  5000 // messages between two looks at the keyboard
#define PAUSE_us 10000000

enum dig_status digwatch_source_listen(const char *const url, struct digwatch_source *const source,
                                       struct dig_error *const error)
{
    assert(url != NULL && source != NULL);
    struct digwatch_source made   = { .due_s = INFINITY };
    const enum dig_status  status = digwatch_multicast_open(url, &made.fd, error);
    if (status == DIG_OK) {
        *source = made;
    }
    return status;
}

enum dig_status digwatch_source_play(const char *const path, const double speed,
                                     struct digwatch_source *const source,
                                     struct dig_error *const       error)
{
    assert(path != NULL && speed > 0.0 && source != NULL);
    struct digwatch_source made   = { .fd = -1, .speed = speed };
    enum dig_status        status = dig_lcm_log_open(path, &made.log, error);
    if (status == DIG_OK) {
        status = dig_lcm_log_next(made.log, &made.next, error);
    }
    if (status != DIG_OK) {
        digwatch_source_close(&made);
        return status;
    }
    made.due_s = made.next != NULL ? 0.0 : (double)INFINITY; // 0: at the first reading
    *source    = made;
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
                                struct digwatch_model *const model, struct dig_error *const error)
{
    s->due_s = s->due_s > 0.0 ? s->due_s : now_s;
    for (int n = 0; n < AT_ONCE && s->next != NULL && s->due_s <= now_s; n++) {
        const int64_t before_us = s->next->time_us;
        digwatch_model_take(model, s->next);
        const enum dig_status status = dig_lcm_log_next(s->log, &s->next, error);
        if (status != DIG_OK) {
            s->next  = NULL;
            s->due_s = INFINITY;
            return status;
        }
        s->due_s +=
            s->next != NULL ? pause_s(before_us, s->next->time_us) / s->speed : (double)INFINITY;
    }
    return DIG_OK;
}

static int64_t wall_us(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_REALTIME, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

static void read_network(const int fd, struct digwatch_model *const model)
{
    uint8_t datagram[DIG_LCM_DATAGRAM_MOST];
    ssize_t size;
    for (int n = 0; n < AT_ONCE && (size = recv(fd, datagram, sizeof datagram, 0)) >= 0; n++) {
        struct dig_lcm_event event = { .time_us = wall_us() };
        if (dig_lcm_datagram(datagram, (size_t)size, &event) &&
            dig_lcm_message_is_known(event.channel)) {
            digwatch_model_take(model, &event);
        }
    }
}

enum dig_status digwatch_source_read(struct digwatch_source *const source, const double now_s,
                                     struct digwatch_model *const model,
                                     struct dig_error *const      error)
{
    assert(source != NULL && model != NULL);
    if (source->fd < 0) {
        return read_log(source, now_s, model, error);
    }
    read_network(source->fd, model);
    return DIG_OK;
}

bool digwatch_source_ended(const struct digwatch_source *const source)
{
    assert(source != NULL);
    return source->fd < 0 && source->next == NULL;
}

void digwatch_source_close(struct digwatch_source *const source)
{
    assert(source != NULL);
    if (source->fd >= 0) {
        (void)close(source->fd);
    }
    dig_lcm_log_close(source->log);
}
