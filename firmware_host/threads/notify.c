#include "firmware_host/threads/notify.h"

#include <assert.h>
#include <errno.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

enum dig_status dig_notify(const char *const message)
{
    assert(message != NULL);
    const char *const name =
        getenv("NOTIFY_SOCKET"); // NOLINT(concurrency-mt-unsafe): never set here
    if (name == NULL) {
        return DIG_OK;
    }
    struct sockaddr_un address = { .sun_family = AF_UNIX };
    const size_t       length  = strlen(name);
    if ((name[0] != '/' && name[0] != '@') || length < 2 || length >= sizeof address.sun_path) {
        return DIG_EINVAL;
    }
    memcpy(address.sun_path, name, length);
    if (name[0] == '@') {
        address.sun_path[0] = '\0'; // an abstract socket
    }
    const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (fd < 0) {
        return DIG_EIO;
    }
    const socklen_t size = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length);
    const ssize_t   sent = sendto(fd, message, strlen(message), MSG_NOSIGNAL | MSG_DONTWAIT,
                                  (const struct sockaddr *)&address, size);
    const int       why  = errno;
    (void)close(fd);
    errno = why;
    return sent >= 0 ? DIG_OK : DIG_EIO;
}

int64_t dig_notify_watchdog_ns(void)
{
    const char *const text =
        getenv("WATCHDOG_USEC"); // NOLINT(concurrency-mt-unsafe): never set here
    if (text == NULL) {
        return 0;
    }
    char           *end = NULL;
    const long long us  = strtoll(text, &end, 10);
    return end != text && *end == '\0' && us > 0 && us < INT64_MAX / 1000 ? us * 500 : 0;
}
