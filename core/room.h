// Arrays that grow by one element at a time.

#ifndef DIG_CORE_ROOM_H
#define DIG_CORE_ROOM_H

#include <stddef.h>

/// The array of n elements of this size, malloc'ed or NULL, with room for one more. Asked before
/// every element it is given, it doubles now and then, and nothing but n need be kept. NULL: no
/// memory; the array is as it was.
void *dig_room(void *array, size_t n, size_t size);

#endif // DIG_CORE_ROOM_H
