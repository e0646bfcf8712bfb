#include "core/room.h"

#include <stdbool.h>
#include <stdlib.h>

enum { FIRST = 8 };

void *dig_room(void *const array, const size_t n, const size_t size)
{
    const bool full = n == 0 || (n >= FIRST && (n & (n - 1)) == 0);
    return full ? realloc(array, size * (n == 0 ? FIRST : 2 * n)) : array;
}
