#include "tools/rig/bus/serve_can.h"

#include <errno.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum dig_status dig_rig_can_open(const char *const interface, int *const fd,
                                 struct dig_error *const error)
{
    const int s = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
    if (s < 0) {
        return dig_error_set(error, DIG_EIO, "%s: no SocketCAN in this kernel: %s", interface,
                             strerror(errno));
    }
    const unsigned index = if_nametoindex(interface);
    if (index == 0) {
        const int why = errno;
        (void)close(s);
        return dig_error_set(error, DIG_EIO, "%s: no such CAN interface: %s", interface,
                             strerror(why));
    }
    // No filter at all: nothing is received.
    const struct sockaddr_can address = { .can_family = AF_CAN, .can_ifindex = (int)index };
    if (setsockopt(s, SOL_CAN_RAW, CAN_RAW_FILTER, NULL, 0) != 0 ||
        bind(s, (const struct sockaddr *)&address, sizeof address) != 0) {
        const int why = errno;
        (void)close(s);
        return dig_error_set(error, DIG_EIO, "%s: not usable as CAN interface: %s", interface,
                             strerror(why));
    }
    *fd = s;
    return DIG_OK;
}

enum dig_status dig_rig_can_send(const int fd, const struct dig_rig_can_frame *const frame)
{
    struct can_frame out = { .can_id = frame->id | CAN_EFF_FLAG, .can_dlc = sizeof frame->data };
    memcpy(out.data, frame->data, sizeof frame->data);
    if (write(fd, &out, sizeof out) == (ssize_t)sizeof out) {
        return DIG_OK;
    }
    return errno == EAGAIN || errno == ENOBUFS || errno == EINTR ? DIG_ESTALE : DIG_EIO;
}

void dig_rig_can_close(const int fd)
{
    if (fd >= 0) {
        (void)close(fd);
    }
}
