#include "files/lcm_log.h"

#include "files/lcm_layout.h"
#include "messages/digsight_sample_t.h"

#include <assert.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
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

// One event as it stands in the file: 28 bytes of header, then channel, then data. Data are kept of
// our channels only, whose messages are short.
#define HEADER_BYTES  28
#define CHANNEL_BYTES 256
#define DATA_BYTES    16384
#define OURS          "DIGSIGHT_"

struct event {
    uint64_t number;
    int64_t  time_us;
    char     channel[CHANNEL_BYTES];
    int      size;
    uint8_t  data[DATA_BYTES];
};

// A log being read, and where it stands.
struct reading {
    const char       *path;
    struct event      event;
    struct dig_error *error;
};

static enum dig_status open_log(const struct reading *const r, FILE **const opened)
{
    FILE *const file = fopen(r->path, "rb");
    if (file == NULL) {
        // NOLINTNEXTLINE(concurrency-mt-unsafe): messages for people, one thread
        return dig_error_set(r->error, DIG_EIO, "%s: %s", r->path, strerror(errno));
    }
    if (!dig_lcm_log_is(r->path)) {
        (void)fclose(file);
        (void)dig_error_set(r->error, DIG_EINVAL,
                            "%s:1: does not begin with ED A1 DA 01, expected an LCM event log",
                            r->path);
        return DIG_EINVAL;
    }
    *opened = file;
    return DIG_OK;
}

static uint64_t big_endian(const uint8_t bytes[], const size_t count)
{
    uint64_t value = 0;
    for (size_t i = 0; i < count; i++) {
        value = (value << 8) | bytes[i];
    }
    return value;
}

static enum dig_status refuse_damage(const struct reading *const r, const long at)
{
    return dig_error_set(r->error, DIG_EINVAL, "%s: damaged at byte %ld, expected an event",
                         r->path, at);
}

// *any becomes false at the end, which may also lie within an event: a logger that was killed.
static enum dig_status next_event(FILE *const file, struct reading *const r, bool *const any)
{
    struct event *const e  = &r->event;
    const long          at = ftell(file);
    uint8_t             header[HEADER_BYTES];
    if (fread(header, 1, sizeof header, file) < sizeof header) {
        *any = false;
        return DIG_OK;
    }
    const uint64_t channel_size = big_endian(header + 20, 4);
    const uint64_t size         = big_endian(header + 24, 4);
    if (memcmp(header, sync_word, sizeof sync_word) != 0 || channel_size < 1 ||
        channel_size >= CHANNEL_BYTES || size > INT32_MAX) {
        return refuse_damage(r, at);
    }
    if (fread(e->channel, 1, (size_t)channel_size, file) < channel_size) {
        *any = false;
        return DIG_OK;
    }
    e->channel[channel_size] = '\0';
    e->number                = big_endian(header + 4, 8);
    e->time_us               = (int64_t)big_endian(header + 12, 8);
    e->size                  = (int)size;
    if (strncmp(e->channel, OURS, strlen(OURS)) != 0) {
        *any = fseek(file, (long)size, SEEK_CUR) == 0;
        return DIG_OK;
    }
    if (size > DATA_BYTES) {
        return refuse_damage(r, at);
    }
    *any = fread(e->data, 1, (size_t)size, file) == size;
    return DIG_OK;
}

static enum dig_status refuse_message(const struct reading *const r,
                                      const struct event *const   event)
{
    return dig_error_set(r->error, DIG_ESCHEMA,
                         "%s: event %" PRIu64 ": %.40s is of another version of its type, expected "
                         "the one of this build (messages/*.lcm)",
                         r->path, event->number, event->channel);
}

// The fields of messages/*.lcm, in their order; files/lcm_layout.h says what the letters mean.
static const char sample_layout[]     = "884DB";
static const char estimate_layout[]   = "881188888888814s888ss1888";
static const char match_layout[]      = "88114ss4888888888888888818s4DDDs848118888s1s148888";
static const char prediction_layout[] = "8818s48884DDDD88188ss88DD";
static const char health_layout[]     = "88sss1188888888888844888888888888884DDss8s444";

#define TIME_MOST_ns ((int64_t)1 << 62) // of which differences can be taken
#define ROWS_MAX     ((size_t)1 << 25)  // nine hours at a kilohertz

struct rows {
    size_t             count, room;
    struct dig_sample *row;
};

// As many as samples had before there were force sensors; what came after is added at the end.
static const int32_t least_signals = DIG_SIGNAL_TEMPERATURE_degC + 1;

// One DIGSIGHT_SAMPLE as the next row.
static enum dig_status add_row(const struct reading *const r, const struct event *const event,
                               struct rows *const rows)
{
    digsight_sample_t message;
    if (!dig_lcm_fits(sample_layout, event->data, (size_t)event->size) ||
        digsight_sample_t_decode(event->data, 0, event->size, &message) < 0) {
        return refuse_message(r, event);
    }
    enum dig_status status = DIG_OK;
    if (message.signals < least_signals || message.signals > DIG_SIGNALS) {
        status = dig_error_set(r->error, DIG_EINVAL,
                               "%s: event %" PRIu64 ": %d signals, expected %d to %d", r->path,
                               event->number, message.signals, least_signals, DIG_SIGNALS);
    } else if (message.time_ns < 0 || message.time_ns > TIME_MOST_ns) {
        status = dig_error_set(r->error, DIG_EINVAL,
                               "%s: event %" PRIu64 ": time_ns %" PRId64 ", expected 0 to 2^62",
                               r->path, event->number, message.time_ns);
    } else if (rows->count > 0 && message.time_ns <= rows->row[rows->count - 1].time_ns) {
        // A repetition, or a second daemon's: a recording ascends.
    } else {
        if (rows->count >= ROWS_MAX) {
            digsight_sample_t_decode_cleanup(&message);
            return dig_error_set(r->error, DIG_EINVAL, "%s: more than %zu samples, expected fewer",
                                 r->path, ROWS_MAX);
        }
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
        for (int i = 0; i < message.signals; i++) {
            sample.valid[i] = message.valid[i] != 0 && isfinite(message.value[i]);
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
    FILE           *file   = NULL;
    enum dig_status status = open_log(&r, &file);
    if (status != DIG_OK) {
        return status;
    }
    for (bool any = true; status == DIG_OK && any;) {
        status = next_event(file, &r, &any);
        if (status == DIG_OK && any && strcmp(r.event.channel, "DIGSIGHT_SAMPLE") == 0) {
            status = add_row(&r, &r.event, &rows);
        }
    }
    (void)fclose(file);
    if (status == DIG_OK && rows.count < 2) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%s: %zu samples on DIGSIGHT_SAMPLE, expected at least 2", path,
                               rows.count);
    }
    if (status != DIG_OK || rows.row == NULL) {
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
                                          const struct event *const              event,            \
                                          const struct dig_lcm_log_reader *const reader)           \
    {                                                                                              \
        digsight_##type##_t message;                                                               \
        if (reader->type == NULL) {                                                                \
            return DIG_OK;                                                                         \
        }                                                                                          \
        if (!dig_lcm_fits(type##_layout, event->data, (size_t)event->size) ||                      \
            digsight_##type##_t_decode(event->data, 0, event->size, &message) < 0) {               \
            return refuse_message(r, event);                                                       \
        }                                                                                          \
        reader->type(reader->context, event->time_us, &message);                                   \
        digsight_##type##_t_decode_cleanup(&message);                                              \
        return DIG_OK;                                                                             \
    }

HAND_ON(estimate)
HAND_ON(match)
HAND_ON(prediction)
HAND_ON(health)

static enum dig_status hand_on(const struct reading *const r, const struct event *const event,
                               const struct dig_lcm_log_reader *const reader)
{
    static const struct {
        const char *channel;
        enum dig_status (*hand_on)(const struct reading *, const struct event *,
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
    FILE           *file   = NULL;
    enum dig_status status = open_log(&r, &file);
    if (status != DIG_OK) {
        return status;
    }
    for (bool any = true; status == DIG_OK && any;) {
        status = next_event(file, &r, &any);
        if (status == DIG_OK && any) {
            status = hand_on(&r, &r.event, reader);
        }
    }
    (void)fclose(file);
    return status;
}
