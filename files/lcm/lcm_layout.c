#include "files/lcm/lcm_layout.h"

#include <assert.h>

#define FINGERPRINT_BYTES 8

static int64_t int32_at(const uint8_t data[])
{
    const uint32_t bits = ((uint32_t)data[0] << 24) | ((uint32_t)data[1] << 16) |
                          ((uint32_t)data[2] << 8) | (uint32_t)data[3];
    return bits <= INT32_MAX ? (int64_t)bits : (int64_t)bits - ((int64_t)1 << 32);
}

// What the next field takes of the `left` bytes at data; false when its number cannot be. *count is
// how many elements the arrays that follow have.
static bool field_bytes(const char field, const uint8_t data[], const size_t left,
                        size_t *const count, size_t *const bytes)
{
    const int64_t number = left >= 4 ? int32_at(data) : -1;
    switch (field) {
    case '8': *bytes = 8; return true;
    case '1': *bytes = 1; return true;
    case 'D': *bytes = 8 * *count; return true;
    case 'B': *bytes = *count; return true;
    case '4':
        *bytes = 4;
        *count = number > 0 ? (size_t)number : 0;
        return number >= 0 && (size_t)number <= INT32_MAX / 8;
    case 's':
        // A string ends with its NUL, which its length counts.
        *bytes = 4 + (size_t)number;
        return number >= 1 && *bytes <= left && data[*bytes - 1] == '\0';
    default: assert(!"a layout has no such field"); return false;
    }
}

bool dig_lcm_fits(const char *const layout, const uint8_t data[], const size_t size)
{
    assert(layout != NULL && data != NULL);
    if (size < FINGERPRINT_BYTES) {
        return false;
    }
    size_t at    = FINGERPRINT_BYTES;
    size_t count = 0;
    for (const char *field = layout; *field != '\0'; field++) {
        size_t bytes = 0;
        if (!field_bytes(*field, data + at, size - at, &count, &bytes) || bytes > size - at) {
            return false;
        }
        at += bytes;
    }
    return at == size;
}
