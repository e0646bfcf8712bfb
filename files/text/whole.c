// realpath() is X/Open's, not POSIX's.
#define _XOPEN_SOURCE 700 // NOLINT(bugprone-reserved-identifier)

#include "files/text/whole.h"

#include "core/part.h"
#include "core/regular.h"
#include "core/text.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define BYTES_MAX (256LL << 20)

enum dig_status dig_file_read(const char *const path, char **const text, size_t *const size,
                              struct dig_error *const error)
{
    assert(path != NULL && text != NULL && size != NULL);

    FILE           *file   = NULL;
    enum dig_status status = dig_regular_open(path, &file, error);
    if (status != DIG_OK) {
        return status;
    }
    struct stat found;
    if (fstat(fileno(file), &found) == 0 && found.st_size > BYTES_MAX) {
        (void)fclose(file);
        return dig_error_set(error, DIG_EINVAL, "%s: larger than 256 MiB, expected less", path);
    }
    // Up to a NUL, which no text holds, or to the end.
    size_t        room   = 1;
    char         *all    = calloc(1, room);
    const ssize_t length = all != NULL ? getdelim(&all, &room, '\0', file) : -1;
    const int     why    = errno;
    const bool    ended  = feof(file) != 0;
    status               = ferror(file) != 0 ? DIG_EIO : length < 0 && !ended ? DIG_ENOMEM : DIG_OK;
    (void)fclose(file);
    if (status != DIG_OK) {
        free(all);
        return dig_error_set(error, status, "%s: %s", path,
                             status == DIG_EIO ? strerror(why) : dig_status_str(status));
    }
    if (!ended) {
        const int line = dig_text_line(all, (size_t)length - 1);
        free(all);
        return dig_error_set(error, DIG_EINVAL, "%s:%d: a NUL byte, expected a text file", path,
                             line);
    }
    *text = all;
    *size = length > 0 ? (size_t)length : 0;
    return DIG_OK;
}

// The program's own output, under either of its names. Opened anew it would be cut, and renamed
// over it would be gone.
bool dig_out_is_stdout(const char *const path)
{
    return path != NULL && (strcmp(path, "-") == 0 || strcmp(path, "/dev/stdout") == 0);
}

// A link of the kernel's to a file that is open; any other could be somebody's.
static bool is_open_file(const char *const path)
{
    return strncmp(path, "/dev/fd/", 8) == 0 || strncmp(path, "/proc/self/fd/", 14) == 0 ||
           strcmp(path, "/dev/stderr") == 0;
}

static FILE *open_stdout(void)
{
    const int   fd   = dup(STDOUT_FILENO);
    FILE *const file = fd >= 0 ? fdopen(fd, "wb") : NULL;
    if (file == NULL && fd >= 0) {
        (void)close(fd);
        errno = EBADF; // open to be read alone, as dig_streams_begin() leaves one that was closed
    }
    return file;
}

// A pipe or a device. A pipe that nobody reads is not waited for.
static FILE *open_special(const char *const path)
{
    const int   fd   = open(path, O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    FILE *const file = fd >= 0 && fcntl(fd, F_SETFL, O_WRONLY) == 0 ? fdopen(fd, "wb") : NULL;
    if (file == NULL && fd >= 0) {
        (void)close(fd);
    }
    return file;
}

enum dig_status dig_out_open(struct dig_out *const out, const char *const path,
                             struct dig_error *const error)
{
    assert(out != NULL && path != NULL);

    *out = (struct dig_out){ 0 };

    // Nothing is written through a link of somebody's; one to a folder is refused as a folder is.
    const bool  kernels = is_open_file(path);
    struct stat named;
    struct stat target;
    const bool  linked = !kernels && lstat(path, &named) == 0 && S_ISLNK(named.st_mode);
    const bool  there  = stat(path, &target) == 0 && !(linked && !S_ISDIR(target.st_mode));
    char *const real   = there && kernels && S_ISREG(target.st_mode) ? realpath(path, NULL) : NULL;
    const int   length = snprintf(out->path, sizeof out->path, "%s", real != NULL ? real : path);
    free(real);
    if (length < 0 || (size_t)length + sizeof ".part" > sizeof out->path) {
        return dig_error_set(error, DIG_EINVAL, "%s: the name is too long", path);
    }

    if (dig_out_is_stdout(path)) {
        out->file = open_stdout();
    } else if (there && !S_ISREG(target.st_mode)) {
        out->file = open_special(out->path);
    } else {
        memcpy(out->part, out->path, (size_t)length);
        memcpy(out->part + length, ".part", sizeof ".part");
        out->file = dig_part_open(out->part);
    }
    if (out->file == NULL) {
        const int why = errno;
        out->part[0]  = '\0';
        return dig_error_set(error, DIG_EIO, "%s: %s", path, strerror(why));
    }
    return DIG_OK;
}

bool dig_out_begin(struct dig_out *const out, const char *const path, enum dig_status *const status,
                   struct dig_error *const error)
{
    assert(out != NULL && status != NULL);
    const bool asked = *status == DIG_OK && path != NULL;
    *status          = asked ? dig_out_open(out, path, error) : *status;
    return asked && *status == DIG_OK;
}

enum dig_status dig_out_commit(struct dig_out *const out, struct dig_error *const error)
{
    assert(out != NULL && out->file != NULL);

    // fsync refuses pipes and terminals, which have nothing to keep.
    const int failed = ferror(out->file) || fflush(out->file) != 0 ||
                       (out->part[0] != '\0' && fsync(fileno(out->file)) != 0);
    const int why        = errno;
    const int not_closed = fclose(out->file) != 0;
    out->file            = NULL;
    if (failed || not_closed) {
        dig_out_cancel(out);
        return dig_error_set(error, DIG_EIO, "%s: %s", out->path, strerror(failed ? why : errno));
    }
    if (out->part[0] != '\0' && rename(out->part, out->path) != 0) {
        const int rename_why = errno;
        dig_out_cancel(out);
        return dig_error_set(error, DIG_EIO, "%s: %s", out->path, strerror(rename_why));
    }
    out->part[0] = '\0';
    return DIG_OK;
}

enum dig_status dig_out_end(struct dig_out *const out, const enum dig_status put_status,
                            struct dig_error *const error)
{
    if (put_status == DIG_OK) {
        return dig_out_commit(out, error);
    }
    dig_out_cancel(out);
    return put_status;
}

void dig_out_cancel(struct dig_out *const out)
{
    if (out->file != NULL) {
        (void)fclose(out->file);
        out->file = NULL;
    }
    if (out->part[0] != '\0') {
        (void)unlink(out->part);
        out->part[0] = '\0';
    }
}

struct dig_c_locale dig_c_locale_enter(void)
{
    // "C" always exists; should memory be out all the same, the user's locale stays.
    struct dig_c_locale locale = { .c = newlocale(LC_ALL_MASK, "C", (locale_t)0) };
    if (locale.c != (locale_t)0) {
        locale.before = uselocale(locale.c);
    }
    return locale;
}

void dig_c_locale_leave(struct dig_c_locale *const locale)
{
    if (locale->c != (locale_t)0) {
        (void)uselocale(locale->before);
        freelocale(locale->c);
        locale->c = (locale_t)0;
    }
}
