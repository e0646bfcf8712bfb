#include "files/lcm/lcm_log.h"

#include "core/regular.h"
#include "core/room.h"
#include "files/lcm/lcm_layout.h"
#include "messages/digsight_sample_t.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const unsigned char sync_word[4] = { 0xED, 0xA1, 0xDA, 0x01 };

// Reads its first bytes.
static bool begins_as_log(FILE *const file)
{
    unsigned char begin[sizeof sync_word];
    return fread(begin, sizeof begin, 1, file) == 1 &&
           memcmp(begin, sync_word, sizeof sync_word) == 0;
}

bool dig_lcm_log_is(const char *const path)
{
    assert(path != NULL);
    FILE *file = NULL;
    if (dig_regular_open(path, &file, NULL) != DIG_OK) {
        return false;
    }
    const bool is = begins_as_log(file);
    (void)fclose(file);
    return is;
}

// One event as it stands in the file: 28 bytes of header, then channel, then data. Data are kept of
// our channels only, whose messages are short.
#define HEADER_BYTES  28
#define CHANNEL_BYTES 256
#define DATA_BYTES    16384
#define OURS          "DIGSIGHT_"

struct dig_lcm_log {
    const char          *path;
    FILE                *file;
    struct dig_lcm_event event;
    char                 channel[CHANNEL_BYTES];
    uint8_t              data[DATA_BYTES];
};

enum dig_status dig_lcm_log_open(const char *const path, struct dig_lcm_log **const opened,
                                 struct dig_error *const error)
{
    assert(path != NULL && opened != NULL);
    FILE                 *file   = NULL;
    const enum dig_status status = dig_regular_open(path, &file, error);
    if (status != DIG_OK) {
        return status;
    }
    if (!begins_as_log(file) || fseek(file, 0, SEEK_SET) != 0) {
        (void)fclose(file);
        return dig_error_set(error, DIG_EINVAL,
                             "%s:1: does not begin with ED A1 DA 01, expected an LCM event log",
                             path);
    }
    struct dig_lcm_log *const log = malloc(sizeof *log);
    if (log == NULL) {
        (void)fclose(file);
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory", path);
    }
    log->path  = path;
    log->file  = file;
    log->event = (struct dig_lcm_event){ .channel = log->channel, .data = log->data };
    *opened    = log;
    return DIG_OK;
}

void dig_lcm_log_close(struct dig_lcm_log *const log)
{
    if (log != NULL) {
        (void)fclose(log->file);
        free(log);
    }
}

static uint64_t big_endian(const uint8_t bytes[], const size_t count)
{
    uint64_t value = 0;
    for (size_t i = 0; i < count; i++) {
        value = (value << 8) | bytes[i];
    }
    return value;
}

static enum dig_status refuse_damage(const struct dig_lcm_log *const log, const long at,
                                     struct dig_error *const error)
{
    return dig_error_set(error, DIG_EINVAL, "%s: damaged at byte %ld, expected an event", log->path,
                         at);
}

enum dig_status dig_lcm_log_next(struct dig_lcm_log *const          log,
                                 const struct dig_lcm_event **const next,
                                 struct dig_error *const            error)
{
    assert(log != NULL && next != NULL);
    struct dig_lcm_event *const e  = &log->event;
    const long                  at = ftell(log->file);
    uint8_t                     header[HEADER_BYTES];
    if (fread(header, 1, sizeof header, log->file) < sizeof header) {
        *next = NULL;
        return DIG_OK;
    }
    const uint64_t channel_size = big_endian(header + 20, 4);
    const uint64_t size         = big_endian(header + 24, 4);
    if (memcmp(header, sync_word, sizeof sync_word) != 0 || channel_size < 1 ||
        channel_size >= CHANNEL_BYTES || size > INT32_MAX) {
        return refuse_damage(log, at, error);
    }
    if (fread(log->channel, 1, (size_t)channel_size, log->file) < channel_size) {
        *next = NULL;
        return DIG_OK;
    }
    log->channel[channel_size] = '\0';
    e->number                  = big_endian(header + 4, 8);
    e->time_us                 = (int64_t)big_endian(header + 12, 8);
    e->size                    = 0;
    if (strncmp(log->channel, OURS, strlen(OURS)) != 0) {
        *next = fseek(log->file, (long)size, SEEK_CUR) == 0 ? e : NULL;
        return DIG_OK;
    }
    if (size > DATA_BYTES) {
        return refuse_damage(log, at, error);
    }
    e->size = (size_t)size;
    *next   = fread(log->data, 1, e->size, log->file) == e->size ? e : NULL;
    return DIG_OK;
}

enum dig_status dig_lcm_log_walk(const char *const path,
                                 enum dig_status (*const take)(void                       *context,
                                                               const struct dig_lcm_log   *log,
                                                               const struct dig_lcm_event *event,
                                                               struct dig_error           *error),
                                 void *const context, struct dig_error *const error)
{
    assert(path != NULL && take != NULL);
    struct dig_lcm_log         *log    = NULL;
    const struct dig_lcm_event *event  = NULL;
    enum dig_status             status = dig_lcm_log_open(path, &log, error);
    if (status != DIG_OK) {
        return status;
    }
    do {
        status = dig_lcm_log_next(log, &event, error);
        if (status == DIG_OK && event != NULL) {
            status = take(context, log, event, error);
        }
    } while (status == DIG_OK && event != NULL);
    dig_lcm_log_close(log);
    return status;
}

static enum dig_status refuse_message(const struct dig_lcm_log *const log,
                                      struct dig_error *const         error)
{
    return dig_error_set(error, DIG_ESCHEMA,
                         "%s: event %" PRIu64 ": %.40s is of another version of its type, expected "
                         "the one of this build (messages/*.lcm)",
                         log->path, log->event.number, log->channel);
}

#define TIME_MOST_ns ((int64_t)1 << 62) // of which differences can be taken
#define ROWS_MAX     ((size_t)1 << 25)  // nine hours at a kilohertz

// As many as samples had before there were force sensors; what came after is added at the end.
static const int32_t least_signals = DIG_SIGNAL_TEMPERATURE_degC + 1;

// A message as the next row.
static enum dig_status add_row(struct dig_machine_recording *const to,
                               const digsight_sample_t *const message, const char *const path,
                               struct dig_error *const error)
{
    if (to->rows >= ROWS_MAX) {
        return dig_error_set(error, DIG_EINVAL, "%s: more than %zu samples, expected fewer", path,
                             ROWS_MAX);
    }
    struct dig_sample *const grown = dig_room(to->row, to->rows, sizeof *grown);
    if (grown == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory", path);
    }
    to->row                  = grown;
    struct dig_sample sample = { .time_ns = message->time_ns };
    for (int i = 0; i < message->signals; i++) {
        sample.valid[i] = message->valid[i] != 0 && isfinite(message->value[i]);
        sample.value[i] = sample.valid[i] ? message->value[i] : 0.0;
    }
    to->row[to->rows++] = sample;
    return DIG_OK;
}

static enum dig_status take_sample(void *const context, const struct dig_lcm_log *const log,
                                   const struct dig_lcm_event *const event,
                                   struct dig_error *const           error)
{
    struct dig_machine_recording *const to = context;
    digsight_sample_t                   message;
    if (strcmp(event->channel, "DIGSIGHT_SAMPLE") != 0) {
        return DIG_OK;
    }
    if (!dig_lcm_fits(DIG_LCM_SAMPLE_LAYOUT, event->data, event->size) ||
        digsight_sample_t_decode(event->data, 0, (int)event->size, &message) < 0) {
        return refuse_message(log, error);
    }
    enum dig_status status = DIG_OK;
    if (message.signals < least_signals || message.signals > DIG_SIGNALS) {
        status =
            dig_error_set(error, DIG_EINVAL, "%s: event %" PRIu64 ": %d signals, expected %d to %d",
                          log->path, event->number, message.signals, least_signals, DIG_SIGNALS);
    } else if (message.time_ns < 0 || message.time_ns > TIME_MOST_ns) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%s: event %" PRIu64 ": time_ns %" PRId64 ", expected 0 to 2^62",
                               log->path, event->number, message.time_ns);
    } else if (to->rows == 0 || message.time_ns > to->row[to->rows - 1].time_ns) {
        // Else a repetition, or a second daemon's: a recording ascends.
        status = add_row(to, &message, log->path, error);
    }
    digsight_sample_t_decode_cleanup(&message);
    return status;
}

enum dig_status dig_lcm_log_read(const char *const                   path,
                                 struct dig_machine_recording *const recording,
                                 struct dig_error *const             error)
{
    assert(path != NULL && recording != NULL);
    struct dig_machine_recording read   = { .rows = 0 };
    enum dig_status              status = dig_lcm_log_walk(path, take_sample, &read, error);
    if (status == DIG_OK && read.rows < 2) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%s: %zu samples on DIGSIGHT_SAMPLE, expected at least 2", path,
                               read.rows);
    }
    if (status != DIG_OK || read.row == NULL) {
        dig_machine_recording_finish(&read);
        return status;
    }
    const int64_t start_ns = read.row[0].time_ns;
    for (size_t i = 0; i < read.rows; i++) {
        read.row[i].time_ns -= start_ns;
    }
    *recording = read;
    return DIG_OK;
}

static enum dig_status hand_on(void *const context, const struct dig_lcm_log *const log,
                               const struct dig_lcm_event *const event,
                               struct dig_error *const           error)
{
    const struct dig_lcm_reader *const *const reader = context;
    return dig_lcm_message_read(event, *reader) == DIG_OK ? DIG_OK : refuse_message(log, error);
}

enum dig_status dig_lcm_log_each(const char *const path, const struct dig_lcm_reader *reader,
                                 struct dig_error *const error)
{
    assert(reader != NULL);
    return dig_lcm_log_walk(path, hand_on, &reader, error);
}
