// Opens regular files only: a pipe without a writer, or a device, would block or never end.

#ifndef DIG_CORE_REGULAR_H
#define DIG_CORE_REGULAR_H

#include "core/error.h"

#include <stdbool.h>
#include <stdio.h>

/// Opens path for reading; *file is closed by the caller. DIG_EIO with errno's words when it cannot
/// be opened, DIG_EINVAL at once when it is a folder, a pipe, a socket or a device.
DIG_MUST_CHECK enum dig_status dig_regular_open(const char *path, FILE **file,
                                                struct dig_error *error);

/// Whether what is written to `to` is found at path: the same regular file, or the same name where
/// there is none yet. A link at `to` would be replaced (files/text/whole.h), so what it leads to is
/// another file.
bool dig_regular_same(const char *to, const char *path);

#endif // DIG_CORE_REGULAR_H
