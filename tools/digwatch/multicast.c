// Groups are joined by BSD's names, not POSIX's.
#define _DEFAULT_SOURCE // NOLINT(bugprone-reserved-identifier)

#include "tools/digwatch/multicast.h"

#include <arpa/inet.h>
#include <assert.h>
#include <errno.h>
#include <netinet/in.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#define SCHEME       "udpm://"
#define ADDRESS_SIZE 32
#define BUFFER_MOST  (1L << 30)

struct network {
    struct sockaddr_in group;
    long               buffer; // bytes that the kernel keeps for us; 0: as it likes
};

// A whole number that ends where the text does, or at one of ends.
static bool read_number(const char *const text, const long most, const char *const ends,
                        long *const number, const char **const behind)
{
    char      *end  = NULL;
    const long read = strtol(text, &end, 10);
    if (text[0] < '0' || text[0] > '9' || read > most ||
        (*end != '\0' && strchr(ends, *end) == NULL)) {
        return false;
    }
    *number = read;
    *behind = end;
    return true;
}

// ADDRESS, or ADDRESS:PORT; *behind is what follows.
static bool read_group(const char *const text, struct network *const network,
                       const char **const behind)
{
    char         address[ADDRESS_SIZE] = "239.255.76.67";
    long         port                  = 7667;
    const size_t length                = strcspn(text, ":?");
    if (length >= sizeof address) {
        return false;
    }
    if (length > 0) {
        memcpy(address, text, length);
        address[length] = '\0';
    }
    *behind = text + length;
    if (text[length] == ':' && !read_number(text + length + 1, UINT16_MAX, "?", &port, behind)) {
        return false;
    }
    network->group.sin_family = AF_INET;
    network->group.sin_port   = htons((uint16_t)port);
    return inet_pton(AF_INET, address, &network->group.sin_addr) == 1 &&
           IN_MULTICAST(ntohl(network->group.sin_addr.s_addr));
}

static bool read_url(const char *const url, struct network *const network)
{
    static const char ttl[]    = "ttl=";
    static const char buffer[] = "recv_buf_size=";
    const char       *c        = url + strlen(SCHEME);
    if (strncmp(url, SCHEME, strlen(SCHEME)) != 0 || !read_group(c, network, &c)) {
        return false;
    }
    while (*c == '?' || *c == '&') {
        long sends;
        c++;
        const bool known =
            strncmp(c, ttl, strlen(ttl)) == 0
                ? read_number(c + strlen(ttl), 255, "&", &sends, &c)
                : strncmp(c, buffer, strlen(buffer)) == 0 &&
                      read_number(c + strlen(buffer), BUFFER_MOST, "&", &network->buffer, &c);
        if (!known) {
            return false;
        }
    }
    return *c == '\0';
}

// Others on this machine hear the same group.
static bool join(const int fd, const struct network *const network)
{
    const int            yes        = 1;
    const int            size       = (int)network->buffer;
    const struct ip_mreq membership = { .imr_multiaddr = network->group.sin_addr };
    if (size > 0) {
        (void)setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
    }
    return setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
           bind(fd, (const struct sockaddr *)&network->group, sizeof network->group) == 0 &&
           setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0;
}

enum dig_status digwatch_multicast_open(const char *const url, int *const fd,
                                        struct dig_error *const error)
{
    assert(url != NULL && fd != NULL);
    struct network network = { .buffer = 0 };
    if (!read_url(url, &network)) {
        return dig_error_set(error, DIG_EINVAL,
                             "LCM %s: no such URL, expected udpm://GROUP:PORT with ?ttl= and "
                             "&recv_buf_size= or without",
                             url);
    }
    const int opened = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (opened < 0 || !join(opened, &network)) {
        const int why = errno;
        if (opened >= 0) {
            (void)close(opened);
        }
        // NOLINTNEXTLINE(concurrency-mt-unsafe): messages for people, one thread
        return dig_error_set(error, DIG_EIO,
                             "LCM %s: %s (a multicast route is needed: ip route add 239.255.76.67 "
                             "dev lo)",
                             url, strerror(why));
    }
    *fd = opened;
    return DIG_OK;
}
