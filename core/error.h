// An error in words for the person who must mend it. Libraries fill it and never print it;
// main programs print it once, where the error stops.

#ifndef DIG_CORE_ERROR_H
#define DIG_CORE_ERROR_H

#include "core/status.h"

#include <stdbool.h>

struct dig_error {
    char text[512]; // "FILE:LINE: key: what was found, what was expected"; "" when nothing failed
};

/// Fills *error (NULL is allowed and ignored) and returns status, so that a refusal is one line:
/// `return dig_error_set(error, DIG_EINVAL, "%s:%d: young_Pa: %g, expected > 0", …)`.
/// Text that does not fit is cut; a byte that is no printable character becomes '?'.
__attribute__((format(printf, 3, 4))) enum dig_status
dig_error_set(struct dig_error *error, enum dig_status status, const char *format, ...);

/// Puts what it is of, as printf() has it, and ": " before the text of a status that is a failure.
/// Returns status.
__attribute__((format(printf, 3, 4))) enum dig_status
dig_error_name(struct dig_error *error, enum dig_status status, const char *format, ...);

/// The conditions of a check, one behind the other. The first that does not hold is told, those
/// behind it say nothing: so a check reads as a list, and its status is asked once, at the end.
/// Zeroed but for error: all have held.
struct dig_conditions {
    enum dig_status   status; // DIG_EINVAL once one did not hold
    struct dig_error *error;  // of that one; NULL: nobody wants the words
};

/// Tells a condition that does not hold, as dig_error_set() does, where all before it have held.
/// What may only be looked at where they have, as a list that must not be too long, asks status.
__attribute__((format(printf, 3, 4))) void dig_require(struct dig_conditions *conditions,
                                                       bool holds, const char *format, ...);

#endif // DIG_CORE_ERROR_H
