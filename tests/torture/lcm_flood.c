// Floods an LCM multicast group with what is no message of ours: lcm_flood GROUP PORT SECONDS SEED
// [RATE]
//
// In turn: noise of any length; the magic of a short message with a channel without end, or one of
// our channels and noise behind it; fragments of a long message that never comes whole, with
// numbers and sizes that lie. RATE datagrams a second, or as fast as it can. Prints how many it
// sent.

#include "tests/fuzz/random.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { BYTES = 1400, KINDS = 4, BETWEEN_CLOCKS = 256 };

#define MAGIC_SHORT 0x4c433032U
#define MAGIC_LONG  0x4c433033U

static size_t put(uint8_t at[], const uint32_t value, const size_t bytes)
{
    for (size_t i = 0; i < bytes; i++) {
        at[i] = (uint8_t)(value >> (8 * (bytes - 1 - i)));
    }
    return bytes;
}

static size_t channel(uint8_t at[])
{
    static const char *const names[] = { "DIGSIGHT_SAMPLE", "DIGSIGHT_ESTIMATE", "DIGSIGHT_MATCH",
                                         "DIGSIGHT_PREDICTION", "DIGSIGHT_HEALTH" };
    const char *const        name    = names[below(sizeof names / sizeof names[0])];
    memcpy(at, name, strlen(name) + 1);
    return strlen(name) + 1;
}

static size_t make(uint8_t datagram[BYTES])
{
    const size_t size = below(BYTES);
    for (size_t i = 0; i < BYTES; i++) {
        datagram[i] = (uint8_t)next();
    }
    size_t used = 0;
    switch (below(KINDS)) {
    case 0: break;
    case 1:
        used = put(datagram, MAGIC_SHORT, 4);
        memset(datagram + used, 'A', BYTES - used);
        break;
    case 2:
        used = put(datagram, MAGIC_SHORT, 4);
        used += put(datagram + used, (uint32_t)next(), 4);
        used += channel(datagram + used);
        break;
    default:
        used = put(datagram, MAGIC_LONG, 4);
        used += put(datagram + used, (uint32_t)below(16), 4);
        used += put(datagram + used, (uint32_t)next(), 4);           // of the whole message
        used += put(datagram + used, (uint32_t)next(), 4);           // offset
        used += put(datagram + used, (uint32_t)below(65536), 2);     // fragment
        used += put(datagram + used, 1 + (uint32_t)below(65535), 2); // of so many
        used += channel(datagram + used);
        break;
    }
    return used > size ? used : size;
}

int main(const int argc, char *argv[])
{
    if (argc != 5 && argc != 6) {
        (void)fprintf(stderr, "usage: lcm_flood GROUP PORT SECONDS SEED [RATE]\n");
        return 2;
    }
    state                        = strtoull(argv[4], NULL, 0);
    const struct sockaddr_in to  = { .sin_family = AF_INET,
                                     .sin_port   = htons((uint16_t)atoi(argv[2])),
                                     .sin_addr   = { inet_addr(argv[1]) } };
    const unsigned char      ttl = 0;
    const int                fd  = socket(AF_INET, SOCK_DGRAM, 0);
    (void)setsockopt(fd, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
    const struct timespec pause = { .tv_nsec = argc == 6 ? 999999999L / atoi(argv[5]) : 0 };
    long                  sent  = 0;
    const time_t          end   = time(NULL) + atoi(argv[3]);
    while (sent % BETWEEN_CLOCKS != 0 || time(NULL) < end) {
        uint8_t      datagram[BYTES];
        const size_t size = make(datagram);
        (void)sendto(fd, datagram, size, 0, (const struct sockaddr *)&to, sizeof to);
        sent++;
        if (pause.tv_nsec > 0) {
            (void)nanosleep(&pause, NULL);
        }
    }
    (void)printf("%ld\n", sent);
    return 0;
}
