#include "files/lcm_layout.h"

#include <assert.h>

#define FINGERPRINT_BYTES 8

static int64_t int32_at(const uint8_t data[])
{
    const uint32_t bits = ((uint32_t)data[0] << 24) | ((uint32_t)data[1] << 16) |
                          ((uint32_t)data[2] << 8) | (uint32_t)data[3];
    return bits <= INT32_MAX ? (int64_t)bits : (int64_t)bits - ((int64_t)1 << 32);
}

bool dig_lcm_fits(const char *const layout, const uint8_t data[], const size_t size)
{
    assert(layout != NULL && data != NULL);
    size_t at    = FINGERPRINT_BYTES;
    size_t count = 0;
    for (const char *field = layout; *field != '\0'; field++) {
        if (at > size) {
            return false;
        }
        const size_t left = size - at;
        size_t       need = 0;
        switch (*field) {
        case '8': need = 8; break;
        case '1': need = 1; break;
        case '4':
        case 's': {
            if (left < 4) {
                return false;
            }
            const int64_t number = int32_at(data + at);
            if (number < 0 || number > (int64_t)size) {
                return false;
            }
            need = 4;
            if (*field == '4') {
                count = (size_t)number;
                break;
            }
            // A string ends with its NUL, which its length counts.
            need += (size_t)number;
            if (number < 1 || need > left || data[at + need - 1] != '\0') {
                return false;
            }
            break;
        }
        case 'D': need = 8 * count; break;
        case 'B': need = count; break;
        default: assert(!"a layout has no such field"); return false;
        }
        if (need > left) {
            return false;
        }
        at += need;
    }
    return at == size;
}
