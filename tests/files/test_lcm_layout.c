// Tests for files/lcm/lcm_layout.c

#include "files/lcm/lcm_layout.h"

#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

enum { FINGERPRINT = 8 };

// The message stands in memory of its own size, so that a read beyond it is seen by a sanitizer.
static bool fits(const char *const layout, const uint8_t body[], const size_t size)
{
    uint8_t *const message = calloc(1, FINGERPRINT + size);
    assert_non_null(message);
    if (size > 0) {
        memcpy(message + FINGERPRINT, body, size);
    }
    const bool yes = dig_lcm_fits(layout, message, FINGERPRINT + size);
    free(message);
    return yes;
}

TEST(scalars_take_their_bytes_and_no_more)
{
    const uint8_t body[32] = { 0 };
    assert_true(fits("", body, 0));
    assert_true(fits("814", body, 13));
    assert_false(fits("814", body, 12));
    assert_false(fits("814", body, 14));
    assert_false(dig_lcm_fits("", body, 7)); // not even a fingerprint
}

TEST(arrays_are_as_long_as_the_number_before_them)
{
    uint8_t body[64] = { 0, 0, 0, 2 };
    assert_true(fits("4D", body, 4 + 16));
    assert_true(fits("4DB1", body, 4 + 16 + 2 + 1));
    assert_false(fits("4D", body, 4 + 8));
    assert_false(fits("4D", body, 4 + 24));
    body[3] = 0;
    assert_true(fits("4D", body, 4));
}

// What LCM's own decoders would walk over: negative counts, and counts whose bytes overflow an int.
TEST(counts_that_cannot_be_are_refused)
{
    uint8_t       body[64]    = { 0 };
    const uint8_t counts[][4] = { { 0xff, 0xff, 0xff, 0xff },
                                  { 0x80, 0x00, 0x00, 0x00 },
                                  { 0x20, 0x00, 0x00, 0x00 },
                                  { 0x7f, 0xff, 0xff, 0xff } };
    for (size_t i = 0; i < 4; i++) {
        memcpy(body, counts[i], 4);
        assert_false(fits("4", body, 4)); // with nothing behind it
        assert_false(fits("4D", body, 20));
        assert_false(fits("4B", body, 20));
        assert_false(fits("s", body, 20));
    }
}

TEST(strings_end_with_the_nul_they_count)
{
    const uint8_t two[]     = { 0, 0, 0, 3, 'h', 'i', 0, 0, 0, 0, 1, 0 };
    const uint8_t open[]    = { 0, 0, 0, 2, 'h', 'i' };
    const uint8_t nothing[] = { 0, 0, 0, 0 };
    assert_true(fits("ss", two, sizeof two));
    assert_false(fits("s", two, 6));
    assert_false(fits("s", open, sizeof open));
    assert_false(fits("s", nothing, sizeof nothing));
}
