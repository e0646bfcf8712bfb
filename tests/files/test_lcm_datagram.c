// Tests for files/lcm/lcm_datagram.c

#include "files/lcm/lcm_datagram.h"

#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

// The datagram stands in memory of its own size, so that a read beyond it is seen by a sanitizer.
static bool takes(const void *const bytes, const size_t size, struct dig_lcm_event *const event,
                  size_t *const data_at)
{
    uint8_t *const datagram = malloc(size + 1);
    assert_non_null(datagram);
    memcpy(datagram, bytes, size);
    uint8_t *const own = realloc(datagram, size > 0 ? size : 1);
    assert_non_null(own);
    struct dig_lcm_event read  = { .number = 7 };
    const bool           taken = dig_lcm_datagram(own, size, &read);
    if (taken) {
        assert_true(read.data >= own && read.data + read.size == own + size);
        assert_int_equal(read.channel[strlen(read.channel)], '\0');
        *data_at = (size_t)(read.data - own);
    } else {
        assert_null(read.channel);
        assert_null(read.data);
        assert_int_equal(read.number, 7);
    }
    free(own);
    *event = read;
    return taken;
}

TEST(a_short_message_is_its_channel_and_what_follows)
{
    static const char    whole[] = "LC02\0\0\0\5DIGSIGHT_HEALTH\0data";
    struct dig_lcm_event event;
    size_t               at = 0;
    assert_true(takes(whole, sizeof whole - 1, &event, &at));
    assert_int_equal(event.size, 4);
    assert_int_equal(at, 24);
    // Cut anywhere: with the channel's end it is a message with less, without it is none.
    for (size_t size = 0; size < sizeof whole - 1; size++) {
        assert_int_equal(takes(whole, size, &event, &at), size >= 24);
        assert_true(size < 24 || event.size == size - 24);
    }
}

TEST(what_has_no_end_or_is_a_part_is_no_message)
{
    static char          bytes[60000];
    struct dig_lcm_event event;
    size_t               at = 0;
    memset(bytes, 'A', sizeof bytes);
    memcpy(bytes, "LC02", 4);
    assert_false(takes(bytes, sizeof bytes, &event, &at)); // a channel to the datagram's end
    bytes[8 + 64] = '\0';
    assert_false(takes(bytes, sizeof bytes, &event, &at));
    bytes[8 + 63] = '\0';
    assert_true(takes(bytes, sizeof bytes, &event, &at));
    // A fragment, whose offset and size would have to be believed; and noise.
    memcpy(bytes, "LC03", 4);
    assert_false(takes(bytes, sizeof bytes, &event, &at));
    memcpy(bytes, "LC01", 4);
    assert_false(takes(bytes, sizeof bytes, &event, &at));
}
