#include "core/streams.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void dig_streams_begin(void)
{
    for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; fd++) {
        // The wrong way round, so that nothing is read or written in silence.
        if (fcntl(fd, F_GETFD) < 0 &&
            open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY) != fd) {
            _exit(EXIT_FAILURE);
        }
    }
}

int dig_streams_end(const char *const program, const int code)
{
    assert(program != NULL);
    const int failed = ferror(stdout);
    errno            = 0;
    if (fclose(stdout) == 0 && failed == 0) {
        return code;
    }
    (void)fprintf(stderr, "%s: standard output: %s\n", program,
                  errno != 0 ? strerror(errno) : "not all was written");
    return code != EXIT_SUCCESS ? code : EXIT_FAILURE;
}
