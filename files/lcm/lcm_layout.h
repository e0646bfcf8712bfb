// Checks that an encoded LCM message is as long as its own counts say. LCM's generated decoders
// trust the lengths of strings and arrays in a message; a damaged log must not be trusted.

#ifndef DIG_FILES_LCM_LCM_LAYOUT_H
#define DIG_FILES_LCM_LCM_LAYOUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// True when data of this size is exactly what layout describes, field by field behind the 8 bytes
/// of the type's fingerprint:
///
///   8  an int64_t or a double            s  a string: length with its NUL, then the bytes
///   4  an int32_t; the arrays behind     D  an array of doubles, as many as the last 4 says
///      it have that many elements        B  an array of bytes, likewise
///   1  a byte or a boolean
///
/// Numbers are big-endian, as LCM has them. O(length of the layout).
bool dig_lcm_fits(const char *layout, const uint8_t data[], size_t size);

#endif // DIG_FILES_LCM_LCM_LAYOUT_H
