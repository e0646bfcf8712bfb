// A message of one of the daemon's channels: checked, decoded, handed on. From a log or from the
// network it may hold anything.

#ifndef DIG_FILES_LCM_LCM_MESSAGE_H
#define DIG_FILES_LCM_LCM_MESSAGE_H

#include "core/status.h"

#include "messages/digsight_estimate_t.h"
#include "messages/digsight_health_t.h"
#include "messages/digsight_match_t.h"
#include "messages/digsight_prediction_t.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// A sample_t's fields for dig_lcm_fits().
#define DIG_LCM_SAMPLE_LAYOUT "884DB"

/// As it came, before anything of it is believed.
struct dig_lcm_event {
    uint64_t       number;  // in its log
    int64_t        time_us; // wall clock of who received it
    const char    *channel;
    size_t         size;
    const uint8_t *data;
};

/// What to do with each kind of message; NULL: passed over. Messages are valid during the call
/// only. time_us is the event's.
struct dig_lcm_reader {
    void *context;
    void (*estimate)(void *context, int64_t time_us, const digsight_estimate_t *message);
    void (*match)(void *context, int64_t time_us, const digsight_match_t *message);
    void (*prediction)(void *context, int64_t time_us, const digsight_prediction_t *message);
    void (*health)(void *context, int64_t time_us, const digsight_health_t *message);
};

/// True of the channels that dig_lcm_message_read() does not pass over.
bool dig_lcm_message_is_known(const char *channel);

/// Hands the event's message on. DIG_ESCHEMA, and nothing is called: it is of another version of
/// its type, or its lengths cannot be. Other channels, and kinds that the reader does not want, are
/// passed over. Numbers and texts in a message may be any.
DIG_MUST_CHECK enum dig_status dig_lcm_message_read(const struct dig_lcm_event  *event,
                                                    const struct dig_lcm_reader *reader);

#endif // DIG_FILES_LCM_LCM_MESSAGE_H
