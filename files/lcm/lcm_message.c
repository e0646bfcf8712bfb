#include "files/lcm/lcm_message.h"

#include "files/lcm/lcm_layout.h"

#include <assert.h>
#include <string.h>

// The fields of messages/*.lcm, in their order; files/lcm/lcm_layout.h says what the letters mean.
static const char estimate_layout[]   = "881188888888814s888ss1888";
static const char match_layout[]      = "88114ss4888888888888888818s4DDDs848118888s1s148888";
static const char prediction_layout[] = "8818s48884DDDD88188ss88DD";
static const char health_layout[]     = "88sss1188888888888844888888888888884DDss8s4448";

// Decodes an event of one type and calls what wants it.
#define HAND_ON(type)                                                                              \
    static enum dig_status hand_on_##type(const struct dig_lcm_event *const  event,                \
                                          const struct dig_lcm_reader *const reader)               \
    {                                                                                              \
        digsight_##type##_t message;                                                               \
        if (reader->type == NULL) {                                                                \
            return DIG_OK;                                                                         \
        }                                                                                          \
        if (!dig_lcm_fits(type##_layout, event->data, event->size) ||                              \
            digsight_##type##_t_decode(event->data, 0, (int)event->size, &message) < 0) {          \
            return DIG_ESCHEMA;                                                                    \
        }                                                                                          \
        reader->type(reader->context, event->time_us, &message);                                   \
        digsight_##type##_t_decode_cleanup(&message);                                              \
        return DIG_OK;                                                                             \
    }

HAND_ON(estimate)
HAND_ON(match)
HAND_ON(prediction)
HAND_ON(health)

static const struct kind {
    const char *channel;
    enum dig_status (*hand_on)(const struct dig_lcm_event *, const struct dig_lcm_reader *);
} kinds[] = {
    { "DIGSIGHT_ESTIMATE", hand_on_estimate },
    { "DIGSIGHT_MATCH", hand_on_match },
    { "DIGSIGHT_PREDICTION", hand_on_prediction },
    { "DIGSIGHT_HEALTH", hand_on_health },
};

// NULL: of another channel.
static const struct kind *kind_of(const char *const channel)
{
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (strcmp(channel, kinds[i].channel) == 0) {
            return &kinds[i];
        }
    }
    return NULL;
}

bool dig_lcm_message_is_known(const char *const channel)
{
    assert(channel != NULL);
    return kind_of(channel) != NULL;
}

enum dig_status dig_lcm_message_read(const struct dig_lcm_event *const  event,
                                     const struct dig_lcm_reader *const reader)
{
    assert(event != NULL && reader != NULL);
    const struct kind *const kind = kind_of(event->channel);
    return kind != NULL ? kind->hand_on(event, reader) : DIG_OK;
}
