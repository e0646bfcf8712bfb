// SocketCAN, receiving only: this file holds no call that could put a frame on the bus.

// Kernel time stamps and struct ifreq are Linux', not POSIX'.
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier)

#include "firmware_host/bus/can_message.h"
#include "firmware_host/bus/input.h"
#include "firmware_host/bus/signal_map.h"

#include <assert.h>
#include <errno.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define WAIT_ms 100

struct can_source {
    char                         interface[IFNAMSIZ];
    const struct dig_signal_map *map;
    int                          fd;
    uint32_t                     dropped; // frames the socket had no room for, since it was opened
    bool                         off;     // the controller left the bus, and nothing came since
};

static enum dig_status refuse(const struct dig_input *const input, const char *const what,
                              struct dig_error *const error)
{
    // NOLINTNEXTLINE(concurrency-mt-unsafe): messages for people, one thread
    return dig_error_set(error, DIG_EIO, "%s: %s: %s", input->name, what, strerror(errno));
}

static int set_filters(const int fd, const struct dig_signal_map *const map)
{
    struct can_filter    filter[DIG_GROUPS_MAX];
    const can_err_mask_t errors = CAN_ERR_MASK;
    const int            off    = 0;
    const int            on     = 1;
    dig_can_filters(map, filter);
    if (setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, filter,
                   (socklen_t)(map->groups * sizeof filter[0])) != 0 ||
        setsockopt(fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors) != 0 ||
        setsockopt(fd, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, &off, sizeof off) != 0) {
        return -1;
    }
    // A kernel without time stamps sends none; the time of reading is used then.
    (void)setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
    // Nor do counts of what it had no room for.
    (void)setsockopt(fd, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
    return 0;
}

static enum dig_status open_can(struct dig_input *const input, struct dig_error *const error)
{
    struct can_source *const s  = input->source;
    const int                fd = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
    if (fd < 0) {
        return refuse(input, "no SocketCAN", error);
    }
    struct ifreq request = { 0 };
    memcpy(request.ifr_name, s->interface, sizeof request.ifr_name);
    if (set_filters(fd, s->map) != 0 || ioctl(fd, SIOCGIFINDEX, &request) != 0) {
        const enum dig_status status = refuse(input, "cannot be opened", error);
        (void)close(fd);
        return status;
    }
    const struct sockaddr_can address = { .can_family  = AF_CAN,
                                          .can_ifindex = request.ifr_ifindex };
    if (bind(fd, (const struct sockaddr *)&address, sizeof address) != 0) {
        const enum dig_status status = refuse(input, "cannot be bound", error);
        (void)close(fd);
        return status;
    }
    if (ioctl(fd, SIOCGIFFLAGS, &request) == 0 && (request.ifr_flags & IFF_UP) == 0) {
        errno                        = ENETDOWN;
        const enum dig_status status = refuse(input, "cannot be read", error);
        (void)close(fd);
        return status;
    }
    // Where the kernel knows how, the socket itself gives up sending.
    (void)shutdown(fd, SHUT_WR);
    s->fd      = fd;
    s->dropped = 0;
    return DIG_OK;
}

// Error frames of the controller. A daemon that only listens cannot restart a bus; the interface's
// restart-ms does. It logs, counts, and continues when frames come again.
static void take_error(struct dig_input *const input, const struct can_frame *const frame)
{
    struct can_source *const s   = input->source;
    const bool               off = (frame->can_id & CAN_ERR_BUSOFF) != 0;
    atomic_fetch_add(&input->errors, 1);
    if (off && !s->off) {
        atomic_fetch_add(&input->bus_offs, 1);
        struct dig_error error;
        (void)dig_error_set(&error, DIG_EIO,
                            "%s: bus off (ip link set … type can restart-ms 100 lets it come back "
                            "by itself)",
                            input->name);
        dig_input_log(input, &error);
    }
    s->off = s->off || off;
}

static void take_frame(struct dig_input *const input, const struct can_frame *const frame,
                       const int64_t time_ns)
{
    struct can_source *const s = input->source;
    if ((frame->can_id & CAN_ERR_FLAG) != 0) {
        take_error(input, frame);
        return;
    }
    const bool         extended = (frame->can_id & CAN_EFF_FLAG) != 0;
    const uint32_t     id       = frame->can_id & (extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    const int          group    = dig_signal_map_group(s->map, id, extended);
    struct dig_reading reading;
    enum dig_status    status = group < 0 ? DIG_EINVAL : DIG_OK;
    if (status == DIG_OK) {
        status = dig_signal_map_frame(s->map, (unsigned)group, frame->can_dlc, frame->data, time_ns,
                                      &reading);
    }
    if (status != DIG_OK) {
        atomic_fetch_add(status == DIG_ESTALE ? &input->checksum : &input->malformed, 1);
        return;
    }
    if (s->off) {
        s->off = false;
        dig_input_log(input, NULL);
    }
    atomic_fetch_add(&input->frames, 1);
    dig_input_put(input, &reading);
}

static enum dig_status read_can(struct dig_input *const input, struct dig_error *const error)
{
    struct can_source *const s     = input->source;
    struct pollfd            ready = { .fd = s->fd, .events = POLLIN };
    const int                any   = poll(&ready, 1, WAIT_ms);
    if (any == 0 || (any < 0 && errno == EINTR)) {
        return DIG_OK;
    }
    struct can_frame frame        = { 0 };
    char             control[128] = { 0 };
    struct iovec     data         = { .iov_base = &frame, .iov_len = sizeof frame };
    struct msghdr    message      = {
                .msg_iov = &data, .msg_iovlen = 1, .msg_control = control, .msg_controllen = sizeof control
    };
    const ssize_t got = recvmsg(s->fd, &message, MSG_DONTWAIT);
    if (got < 0) {
        return errno == EAGAIN || errno == EINTR ? DIG_OK : refuse(input, "cannot be read", error);
    }
    // The daemon's own delay made the socket overflow: lost, as readings are that find no room.
    const uint32_t dropped = dig_can_dropped(&message, s->dropped);
    atomic_fetch_add(&input->overflow, (long long)(uint32_t)(dropped - s->dropped));
    s->dropped = dropped;
    if (got != (ssize_t)sizeof frame) {
        atomic_fetch_add(&input->malformed, 1);
        return DIG_OK;
    }
    struct timespec wall;
    (void)clock_gettime(CLOCK_REALTIME, &wall);
    take_frame(input, &frame, dig_can_stamp_ns(&message, &wall, dig_input_now_ns()));
    return DIG_OK;
}

static void close_can(struct dig_input *const input)
{
    struct can_source *const s = input->source;
    (void)close(s->fd);
    s->fd = -1;
}

static const struct dig_input_ops ops = { open_can, read_can, close_can, NULL };

enum dig_status dig_input_can_create(struct dig_input *const input, const char *const interface,
                                     const struct dig_signal_map *const map)
{
    assert(input != NULL && interface != NULL && map != NULL);
    if (map->kind != DIG_MAP_CAN || strlen(interface) >= IFNAMSIZ) {
        return DIG_EINVAL;
    }
    struct can_source *const s = calloc(1, sizeof *s);
    if (s == NULL) {
        return DIG_ENOMEM;
    }
    (void)snprintf(s->interface, sizeof s->interface, "%s", interface);
    s->map        = map;
    s->fd         = -1;
    input->ops    = &ops;
    input->source = s;
    (void)snprintf(input->name, sizeof input->name, "can %.15s", interface);
    return DIG_OK;
}
