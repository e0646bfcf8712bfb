// Puts frames on a CAN bus that a daemon must not take for its machine's:
//   can_flood IFACE KIND RATE COUNT SEED ID…        IDs in hex, extended from 800 on; RATE frames a
//   second
// KIND: others   frames of any other identifier
//       lengths  frames of these with less data than they have, or none
//       fd       CAN FD frames of these, of up to 64 bytes
//       rtr      requests for these, which hold no data
//       error    error frames, as a controller makes them
//       second   a second sender of these, with data of its own
// Prints how many frames it sent.

#include "tests/fuzz/random.h"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { IDS = 16, PER_WAKE_Hz = 250, STANDARD_MAX = 0x7FF };

static struct {
    const char *kind;
    canid_t     id[IDS];
    size_t      ids;
} plan;

static canid_t framed(const unsigned long id)
{
    return (canid_t)id | (id > STANDARD_MAX ? CAN_EFF_FLAG : 0U);
}

static bool is_ours(const canid_t id)
{
    for (size_t i = 0; i < plan.ids; i++) {
        if (plan.id[i] == id) {
            return true;
        }
    }
    return false;
}

// The next frame and how many bytes of it go to the socket.
static size_t make(struct canfd_frame *const frame)
{
    memset(frame, 0, sizeof *frame);
    for (size_t i = 0; i < CANFD_MAX_DLEN; i++) {
        frame->data[i] = (uint8_t)next();
    }
    frame->can_id = plan.ids > 0 ? plan.id[below(plan.ids)] : 0;
    frame->len    = CAN_MAX_DLEN;
    switch (plan.kind[0]) {
    case 'o':
        do {
            frame->can_id = framed(below(2) == 0 ? below(STANDARD_MAX + 1) : below(CAN_EFF_MASK));
        } while (is_ours(frame->can_id));
        break;
    case 'l': frame->len = (uint8_t)below(CAN_MAX_DLEN); break;
    case 'f': {
        static const uint8_t lengths[] = { 0, 4, 8, 12, 16, 20, 24, 32, 48, 64 };
        frame->len                     = lengths[below(sizeof lengths)];
        return CANFD_MTU;
    }
    case 'r': frame->can_id |= CAN_RTR_FLAG; break;
    case 'e': frame->can_id = CAN_ERR_FLAG | (canid_t)(1U << below(10)); break;
    default: break; // second: as it is
    }
    return CAN_MTU;
}

static int open_bus(const char *const name)
{
    const int      on    = 1;
    const int      fd    = socket(PF_CAN, SOCK_RAW, CAN_RAW);
    const unsigned index = if_nametoindex(name);
    if (fd < 0 || index == 0) {
        return -1;
    }
    const struct sockaddr_can address = { .can_family = AF_CAN, .can_ifindex = (int)index };
    (void)setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on);
    // It hears nothing: what it does not read would fill its buffer.
    (void)setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, NULL, 0);
    return bind(fd, (const struct sockaddr *)&address, sizeof address) == 0 ? fd : -1;
}

int main(const int argc, char *argv[])
{
    if (argc < 6 || argc > 6 + IDS) {
        (void)fprintf(stderr, "usage: can_flood IFACE KIND RATE COUNT SEED ID...\n");
        return 2;
    }
    const long rate  = strtol(argv[3], NULL, 10);
    const long count = strtol(argv[4], NULL, 10);
    state            = strtoull(argv[5], NULL, 0);
    plan.kind        = argv[2];
    for (int i = 6; i < argc; i++) {
        plan.id[plan.ids++] = framed(strtoul(argv[i], NULL, 16));
    }
    const int fd = open_bus(argv[1]);
    if (fd < 0) {
        perror(argv[1]);
        return 1;
    }
    const struct timespec pause = { .tv_nsec = 1000000000L / PER_WAKE_Hz };
    long                  sent  = 0;
    struct timespec       began;
    (void)clock_gettime(CLOCK_MONOTONIC, &began);
    while (sent < count) {
        struct timespec now;
        (void)clock_gettime(CLOCK_MONOTONIC, &now);
        const double passed_s =
            (double)(now.tv_sec - began.tv_sec) + 1e-9 * (double)(now.tv_nsec - began.tv_nsec);
        for (long due = (long)(passed_s * (double)rate); sent < due && sent < count; sent++) {
            struct canfd_frame frame;
            const size_t       size = make(&frame);
            if (write(fd, &frame, size) != (ssize_t)size) {
                break; // the queue is full: a bus at its load
            }
        }
        (void)clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, NULL);
    }
    (void)printf("%ld\n", sent);
    return 0;
}
