// Kernel time stamps and drop counts are Linux', not POSIX'.
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier)

#include "firmware_host/bus/can_message.h"

#include "core/units.h"

#include <assert.h>
#include <string.h>

void dig_can_filters(const struct dig_signal_map *const map,
                     struct can_filter                  filter[const DIG_GROUPS_MAX])
{
    assert(map != NULL && map->groups <= DIG_GROUPS_MAX && filter != NULL);
    for (size_t i = 0; i < map->groups; i++) {
        const bool extended = map->group[i].extended;
        filter[i]           = (struct can_filter){
                      .can_id   = map->group[i].id | (extended ? CAN_EFF_FLAG : 0),
                      .can_mask = CAN_EFF_FLAG | CAN_RTR_FLAG | (extended ? CAN_EFF_MASK : CAN_SFF_MASK),
        };
    }
}

static int64_t to_ns(const struct timespec *const t)
{
    return (int64_t)t->tv_sec * DIG_NS_PER_S + t->tv_nsec;
}

// The ancillary data of that kind; NULL: none.
static const void *ancillary(struct msghdr *const message, const int kind)
{
    for (struct cmsghdr *c = CMSG_FIRSTHDR(message); c != NULL; c = CMSG_NXTHDR(message, c)) {
        if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == kind) {
            return CMSG_DATA(c);
        }
    }
    return NULL;
}

int64_t dig_can_stamp_ns(struct msghdr *const message, const struct timespec *const wall,
                         const int64_t now_ns)
{
    assert(message != NULL && wall != NULL);
    const void *const bytes = ancillary(message, SCM_TIMESTAMPNS);
    if (bytes == NULL) {
        return now_ns;
    }
    struct timespec stamp;
    memcpy(&stamp, bytes, sizeof stamp);
    const int64_t age_ns = to_ns(wall) - to_ns(&stamp);
    return age_ns >= 0 && age_ns < DIG_NS_PER_S ? now_ns - age_ns : now_ns;
}

uint32_t dig_can_dropped(struct msghdr *const message, const uint32_t before)
{
    assert(message != NULL);
    const void *const bytes = ancillary(message, SO_RXQ_OVFL);
    uint32_t          count = before;
    if (bytes != NULL) {
        memcpy(&count, bytes, sizeof count);
    }
    return count;
}
