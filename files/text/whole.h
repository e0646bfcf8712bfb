// Whole files: read at once, written all or not at all. And the C locale, so that a decimal point
// is a point whatever the user's language.

#ifndef DIG_FILES_TEXT_WHOLE_H
#define DIG_FILES_TEXT_WHOLE_H

#include "core/error.h"

#include <limits.h>
#include <locale.h>
#include <stdbool.h>
#include <stdio.h>

/// Reads all of path into *text (malloc, with a NUL behind *size bytes). DIG_EIO with errno's words
/// when it cannot be read, DIG_EINVAL when it is no regular file, is larger than 256 MiB, or holds
/// a NUL byte, which no text does.
DIG_MUST_CHECK enum dig_status dig_file_read(const char *path, char **text, size_t *size,
                                             struct dig_error *error);

/// A file being written. It stands beside the target as PATH.part until dig_out_commit(), so that
/// no half file is ever taken for a whole one. "-" and /dev/stdout are the program's output;
/// another target that is no regular file (a pipe that somebody reads, a device) is written
/// directly. A link is replaced, and what it points to stays as it is; only those of /dev/fd, which
/// are the kernel's, are followed.
struct dig_out {
    FILE *file;
    char  path[PATH_MAX]; // of the file itself
    char  part[PATH_MAX]; // "" when written directly
};

DIG_MUST_CHECK enum dig_status dig_out_open(struct dig_out *out, const char *path,
                                            struct dig_error *error);

/// Flushes to the disk and renames. On failure nothing is left behind.
DIG_MUST_CHECK enum dig_status dig_out_commit(struct dig_out *out, struct dig_error *error);

/// Ends what was written with put_status: commits where it is DIG_OK, else cancels and returns it.
DIG_MUST_CHECK enum dig_status dig_out_end(struct dig_out *out, enum dig_status put_status,
                                           struct dig_error *error);

/// For one of several results: opens path where it is asked for (not NULL) and *status is DIG_OK.
/// False: nothing is to be written, or *status says why not.
bool dig_out_begin(struct dig_out *out, const char *path, enum dig_status *status,
                   struct dig_error *error);

/// True for "-" and /dev/stdout; false for another path and for NULL.
bool dig_out_is_stdout(const char *path);

/// Closes and removes what was written. Harmless after a commit and on a zeroed struct.
void dig_out_cancel(struct dig_out *out);

/// Numbers are read and written with a decimal point between these two, in this thread.
struct dig_c_locale {
    locale_t c, before;
};
struct dig_c_locale dig_c_locale_enter(void);
void                dig_c_locale_leave(struct dig_c_locale *locale);

#endif // DIG_FILES_TEXT_WHOLE_H
