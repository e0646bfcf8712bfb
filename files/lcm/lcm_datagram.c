#include "files/lcm/lcm_datagram.h"

#include <assert.h>
#include <string.h>

// Four bytes that name the layout, a number that counts up, the channel with its NUL, the message.
static const uint8_t short_message[4] = { 'L', 'C', '0', '2' };
enum { CHANNEL_AT = 8, CHANNEL_MOST = 63 };

bool dig_lcm_datagram(const uint8_t bytes[], const size_t size, struct dig_lcm_event *const event)
{
    assert(bytes != NULL && event != NULL);
    if (size < CHANNEL_AT || memcmp(bytes, short_message, sizeof short_message) != 0) {
        return false;
    }
    const uint8_t *const channel = bytes + CHANNEL_AT;
    const uint8_t *const end     = memchr(channel, '\0', size - CHANNEL_AT);
    if (end == NULL || end - channel > CHANNEL_MOST) {
        return false;
    }
    event->channel = (const char *)channel;
    event->data    = end + 1;
    event->size    = size - (size_t)(event->data - bytes);
    return true;
}
