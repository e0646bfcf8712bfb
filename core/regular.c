#include "core/regular.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum dig_status dig_regular_open(const char *const path, FILE **const file,
                                 struct dig_error *const error)
{
    assert(path != NULL && file != NULL);
    struct stat found;
    FILE       *opened = NULL;
    const int   fd     = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd >= 0 && fstat(fd, &found) == 0) {
        if (!S_ISREG(found.st_mode)) {
            (void)close(fd);
            return dig_error_set(error, DIG_EINVAL, "%s: no regular file, expected one", path);
        }
        opened = fdopen(fd, "rb");
    }
    if (opened == NULL) {
        const int why = errno;
        if (fd >= 0) {
            (void)close(fd);
        }
        // NOLINTNEXTLINE(concurrency-mt-unsafe): messages for people, one thread
        return dig_error_set(error, DIG_EIO, "%s: %s", path, strerror(why));
    }
    *file = opened;
    return DIG_OK;
}

bool dig_regular_same(const char *const to, const char *const path)
{
    assert(to != NULL && path != NULL);
    struct stat written;
    struct stat read;
    if (lstat(to, &written) != 0) {
        return strcmp(to, path) == 0;
    }
    return S_ISREG(written.st_mode) && stat(path, &read) == 0 && read.st_dev == written.st_dev &&
           read.st_ino == written.st_ino;
}
