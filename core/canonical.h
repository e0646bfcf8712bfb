// Canonical text: lines of `key=value` that a hash is taken of.

#ifndef DIG_CORE_CANONICAL_H
#define DIG_CORE_CANONICAL_H

#include <stddef.h>

/// Text being written. length is what all of it needs, and may exceed size: as with snprintf, what
/// does not fit is not written.
struct dig_canonical {
    char  *at;
    size_t size;
    size_t length;
};

__attribute__((format(printf, 2, 3))) void dig_canonical_add(struct dig_canonical *text,
                                                             const char           *format, ...);

#endif // DIG_CORE_CANONICAL_H
