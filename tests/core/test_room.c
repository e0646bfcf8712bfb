// Tests for core/room.c.

#include "core/room.h"

#include "tests/testlib.h"

#include <stdint.h>
#include <stdlib.h>

TEST(there_is_always_room_for_one_more)
{
    enum { MANY = 5000 };
    int   *number = NULL;
    size_t moved  = 0;
    for (size_t n = 0; n < MANY; n++) {
        int *const grown = dig_room(number, n, sizeof *number);
        assert_non_null(grown);
        moved += grown != number ? 1 : 0;
        number    = grown;
        number[n] = (int)n; // the sanitizer tells what lies outside
    }
    for (size_t n = 0; n < MANY; n++) {
        assert_int_equal(number[n], n);
    }
    assert_true(moved < 16);
    free(number);
}

TEST(without_memory_the_array_stays)
{
    int *const number = dig_room(NULL, 0, sizeof *number);
    assert_non_null(number);
    number[0] = 7;
    // More than can be counted: 16 of this size would be 16 bytes.
    assert_null(dig_room(number, 8, SIZE_MAX / 16 + 2));
    assert_int_equal(number[0], 7);
    free(number);
}
