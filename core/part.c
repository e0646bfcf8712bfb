#include "core/part.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

FILE *dig_part_open(const char *const path)
{
    assert(path != NULL);
    if (unlink(path) != 0 && errno != ENOENT) {
        return NULL;
    }
    const int fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (fd < 0) {
        return NULL;
    }
    FILE *const file = fdopen(fd, "wb");
    if (file == NULL) {
        const int why = errno;
        (void)close(fd);
        (void)unlink(path);
        errno = why;
    }
    return file;
}
