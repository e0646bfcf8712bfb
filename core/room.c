#include "core/room.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

enum { FIRST = 8 };

void *dig_room(void *const array, const size_t n, const size_t size)
{
    const bool   full = n == 0 || (n >= FIRST && (n & (n - 1)) == 0);
    const size_t room = n == 0 ? FIRST : 2 * n;
    if (!full) {
        return array;
    }
    return room <= SIZE_MAX / size ? realloc(array, room * size) : NULL;
}
