#include "files/lcm_log.h"

#include "messages/digsight_sample_t.h"

#include <assert.h>
#include <errno.h>
#include <inttypes.h>
#include <lcm/eventlog.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const unsigned char sync_word[4] = { 0xED, 0xA1, 0xDA, 0x01 };

bool dig_lcm_log_is(const char *const path)
{
    assert(path != NULL);
    unsigned char begin[sizeof sync_word];
    FILE *const   file = fopen(path, "rb");
    if (file == NULL) {
        return false;
    }
    const bool is =
        fread(begin, sizeof begin, 1, file) == 1 && memcmp(begin, sync_word, sizeof sync_word) == 0;
    (void)fclose(file);
    return is;
}

// A log being read, and where it stands.
struct reading {
    const char       *path;
    lcm_eventlog_t   *log;
    struct dig_error *error;
};

static enum dig_status open_log(struct reading *const r)
{
    FILE *const file = fopen(r->path, "rb");
    if (file == NULL) {
        // NOLINTNEXTLINE(concurrency-mt-unsafe): messages for people, one thread
        return dig_error_set(r->error, DIG_EIO, "%s: %s", r->path, strerror(errno));
    }
    (void)fclose(file);
    if (!dig_lcm_log_is(r->path)) {
        return dig_error_set(r->error, DIG_EINVAL,
                             "%s:1: does not begin with ED A1 DA 01, expected an LCM event log",
                             r->path);
    }
    r->log = lcm_eventlog_create(r->path, "r");
    return r->log != NULL ? DIG_OK
                          : dig_error_set(r->error, DIG_EIO, "%s: cannot be read", r->path);
}

// After the last event: a log that was cut off ends like one that was closed; one that is damaged
// does not reach its end.
static enum dig_status check_end(const struct reading *const r)
{
    return feof(r->log->f) != 0
               ? DIG_OK
               : dig_error_set(r->error, DIG_EINVAL, "%s: damaged near byte %ld, expected an event",
                               r->path, ftell(r->log->f));
}

static enum dig_status refuse_message(const struct reading *const       r,
                                      const lcm_eventlog_event_t *const event)
{
    return dig_error_set(r->error, DIG_ESCHEMA,
                         "%s: event %" PRId64 ": %.40s is of another version of its type, expected "
                         "the one of this build (messages/*.lcm)",
                         r->path, event->eventnum, event->channel);
}

struct rows {
    size_t             count, room;
    struct dig_sample *row;
};

// One DIGSIGHT_SAMPLE as the next row.
static enum dig_status add_row(const struct reading *const       r,
                               const lcm_eventlog_event_t *const event, struct rows *const rows)
{
    digsight_sample_t message;
    if (digsight_sample_t_decode(event->data, 0, event->datalen, &message) < 0) {
        return refuse_message(r, event);
    }
    enum dig_status status = DIG_OK;
    if (message.signals != DIG_SIGNALS) {
        status =
            dig_error_set(r->error, DIG_EINVAL, "%s: event %" PRId64 ": %d signals, expected %d",
                          r->path, event->eventnum, message.signals, DIG_SIGNALS);
    } else if (rows->count > 0 && message.time_ns <= rows->row[rows->count - 1].time_ns) {
        // A repetition, or a second daemon's: a recording ascends.
    } else {
        if (rows->count == rows->room) {
            const size_t             room  = rows->room == 0 ? 1024 : 2 * rows->room;
            struct dig_sample *const grown = realloc(rows->row, room * sizeof *grown);
            if (grown == NULL) {
                digsight_sample_t_decode_cleanup(&message);
                return dig_error_set(r->error, DIG_ENOMEM, "%s: no memory", r->path);
            }
            rows->row  = grown;
            rows->room = room;
        }
        struct dig_sample sample = { .time_ns = message.time_ns };
        for (size_t i = 0; i < DIG_SIGNALS; i++) {
            sample.valid[i] = message.valid[i] != 0;
            sample.value[i] = sample.valid[i] ? message.value[i] : 0.0;
        }
        rows->row[rows->count++] = sample;
    }
    digsight_sample_t_decode_cleanup(&message);
    return status;
}

enum dig_status dig_lcm_log_read(const char *const                   path,
                                 struct dig_machine_recording *const recording,
                                 struct dig_error *const             error)
{
    assert(path != NULL && recording != NULL);
    struct reading  r      = { .path = path, .error = error };
    struct rows     rows   = { 0 };
    enum dig_status status = open_log(&r);
    if (status != DIG_OK) {
        return status;
    }
    lcm_eventlog_event_t *event = NULL;
    while (status == DIG_OK && (event = lcm_eventlog_read_next_event(r.log)) != NULL) {
        if (strcmp(event->channel, "DIGSIGHT_SAMPLE") == 0) {
            status = add_row(&r, event, &rows);
        }
        lcm_eventlog_free_event(event);
    }
    if (status == DIG_OK) {
        status = check_end(&r);
    }
    lcm_eventlog_destroy(r.log);
    if (status == DIG_OK && rows.count < 2) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%s: %zu samples on DIGSIGHT_SAMPLE, expected at least 2", path,
                               rows.count);
    }
    if (status != DIG_OK) {
        free(rows.row);
        return status;
    }
    const int64_t start_ns = rows.row[0].time_ns;
    for (size_t i = 0; i < rows.count; i++) {
        rows.row[i].time_ns -= start_ns;
    }
    *recording = (struct dig_machine_recording){ .rows = rows.count, .row = rows.row };
    return DIG_OK;
}

// Decodes an event of one type and calls what wants it.
#define HAND_ON(type)                                                                              \
    static enum dig_status hand_on_##type(const struct reading *const            r,                \
                                          const lcm_eventlog_event_t *const      event,            \
                                          const struct dig_lcm_log_reader *const reader)           \
    {                                                                                              \
        digsight_##type##_t message;                                                               \
        if (reader->type == NULL) {                                                                \
            return DIG_OK;                                                                         \
        }                                                                                          \
        if (digsight_##type##_t_decode(event->data, 0, event->datalen, &message) < 0) {            \
            return refuse_message(r, event);                                                       \
        }                                                                                          \
        reader->type(reader->context, event->timestamp, &message);                                 \
        digsight_##type##_t_decode_cleanup(&message);                                              \
        return DIG_OK;                                                                             \
    }

HAND_ON(estimate)
HAND_ON(match)
HAND_ON(prediction)
HAND_ON(health)

static enum dig_status hand_on(const struct reading *const            r,
                               const lcm_eventlog_event_t *const      event,
                               const struct dig_lcm_log_reader *const reader)
{
    static const struct {
        const char *channel;
        enum dig_status (*hand_on)(const struct reading *, const lcm_eventlog_event_t *,
                                   const struct dig_lcm_log_reader *);
    } kinds[] = {
        { "DIGSIGHT_ESTIMATE", hand_on_estimate },
        { "DIGSIGHT_MATCH", hand_on_match },
        { "DIGSIGHT_PREDICTION", hand_on_prediction },
        { "DIGSIGHT_HEALTH", hand_on_health },
    };
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (strcmp(event->channel, kinds[i].channel) == 0) {
            return kinds[i].hand_on(r, event, reader);
        }
    }
    return DIG_OK;
}

enum dig_status dig_lcm_log_each(const char *const                      path,
                                 const struct dig_lcm_log_reader *const reader,
                                 struct dig_error *const                error)
{
    assert(path != NULL && reader != NULL);
    struct reading  r      = { .path = path, .error = error };
    enum dig_status status = open_log(&r);
    if (status != DIG_OK) {
        return status;
    }
    lcm_eventlog_event_t *event = NULL;
    while (status == DIG_OK && (event = lcm_eventlog_read_next_event(r.log)) != NULL) {
        status = hand_on(&r, event, reader);
        lcm_eventlog_free_event(event);
    }
    if (status == DIG_OK) {
        status = check_end(&r);
    }
    lcm_eventlog_destroy(r.log);
    return status;
}
