// Tests for firmware_host/bus/can_message.c, with messages as recvmsg() would fill them.

// Kernel time stamps and drop counts are Linux', not POSIX'.
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier)

#include "firmware_host/bus/can_message.h"

#include "tests/testlib.h"

#include <string.h>

#define S 1000000000LL

struct message {
    struct msghdr header;
    _Alignas(struct cmsghdr) unsigned char control[128];
};

static void empty(struct message *const m)
{
    memset(m, 0, sizeof *m);
    m->header.msg_control = m->control;
}

static void put(struct message *const m, const int level, const int kind, const void *const data,
                const size_t size)
{
    struct cmsghdr *const c = (struct cmsghdr *)(void *)(m->control + m->header.msg_controllen);
    c->cmsg_level           = level;
    c->cmsg_type            = kind;
    c->cmsg_len             = CMSG_LEN(size);
    memcpy(CMSG_DATA(c), data, size);
    m->header.msg_controllen += CMSG_SPACE(size);
}

static void put_stamp(struct message *const m, const time_t s, const long ns)
{
    const struct timespec stamp = { s, ns };
    put(m, SOL_SOCKET, SCM_TIMESTAMPNS, &stamp, sizeof stamp);
}

TEST(a_stamp_is_put_back_by_its_age)
{
    static const struct {
        time_t  s;
        long    ns;
        int64_t age_ns;
    } stamps[]                 = { { 1700000000, 500000000, 0 },
                                   { 1700000000, 499999999, 1 },
                                   { 1700000000, 300000000, S / 5 },
                                   { 1699999999, 900000000, 3 * S / 5 }, // over the second
                                   { 1699999999, 500000001, S - 1 } };
    const struct timespec wall = { 1700000000, 500000000 };
    for (size_t i = 0; i < sizeof stamps / sizeof stamps[0]; i++) {
        struct message m;
        empty(&m);
        put_stamp(&m, stamps[i].s, stamps[i].ns);
        assert_int_equal(dig_can_stamp_ns(&m.header, &wall, 42 * S), 42 * S - stamps[i].age_ns);
    }
}

// The wall clock was set between the stamp and now.
TEST(a_stamp_of_another_hour_is_the_time_of_reading)
{
    static const struct timespec stamps[] = { { 1700003600, 500000000 },   // set back by an hour
                                              { 1699996400, 500000000 },   // or on
                                              { 1700000000, 500000001 },   // by a nanosecond
                                              { 1699999999, 500000000 } }; // by a second
    const struct timespec        wall     = { 1700000000, 500000000 };
    for (size_t i = 0; i < sizeof stamps / sizeof stamps[0]; i++) {
        struct message m;
        empty(&m);
        put_stamp(&m, stamps[i].tv_sec, stamps[i].tv_nsec);
        assert_int_equal(dig_can_stamp_ns(&m.header, &wall, 42 * S), 42 * S);
    }
}

TEST(without_a_stamp_it_is_the_time_of_reading)
{
    const struct timespec wall  = { 1700000000, 500000000 };
    const struct timespec other = { 1700000000, 0 };
    struct message        m;
    empty(&m);
    assert_int_equal(dig_can_stamp_ns(&m.header, &wall, 42 * S), 42 * S);
    put(&m, SOL_SOCKET, SCM_RIGHTS, &other, sizeof other);
    put(&m, SOL_SOCKET + 1, SCM_TIMESTAMPNS, &other, sizeof other);
    assert_int_equal(dig_can_stamp_ns(&m.header, &wall, 42 * S), 42 * S);
}

TEST(the_count_of_frames_without_room_is_read_beside_a_stamp)
{
    const uint32_t count = 4000000007U;
    struct message m;
    empty(&m);
    assert_true(dig_can_dropped(&m.header, 5) == 5);
    put_stamp(&m, 1700000000, 0);
    assert_true(dig_can_dropped(&m.header, 5) == 5);
    put(&m, SOL_SOCKET, SO_RXQ_OVFL, &count, sizeof count);
    assert_true(dig_can_dropped(&m.header, 5) == count);
}

// As the kernel applies a filter (Documentation/networking/can.rst).
static bool passes(const struct can_filter *const filter, const size_t count, const uint32_t id)
{
    bool any = false;
    for (size_t i = 0; i < count; i++) {
        any = any || (id & filter[i].can_mask) == (filter[i].can_id & filter[i].can_mask);
    }
    return any;
}

TEST(only_data_frames_of_the_map_pass_in_their_own_format)
{
    struct dig_signal_map map = { .kind = DIG_MAP_CAN, .groups = 2 };
    map.group[0].id           = 0x18FF7DE8;
    map.group[0].extended     = true;
    map.group[1].id           = 0x123;
    struct can_filter filter[DIG_GROUPS_MAX];
    dig_can_filters(&map, filter);
    assert_true(passes(filter, 2, 0x18FF7DE8 | CAN_EFF_FLAG));
    assert_true(passes(filter, 2, 0x123));
    for (int bit = 0; bit < 29; bit++) {
        assert_false(passes(filter, 2, (0x18FF7DE8U ^ 1U << bit) | CAN_EFF_FLAG));
        assert_false(bit < 11 && passes(filter, 2, 0x123U ^ 1U << bit));
    }
    assert_false(passes(filter, 2, 0x18FF7DE8 | CAN_EFF_FLAG | CAN_RTR_FLAG));
    assert_false(passes(filter, 2, 0x123 | CAN_RTR_FLAG));
    assert_false(passes(filter, 2, 0x123 | CAN_EFF_FLAG));
    assert_false(passes(filter, 2, 0x18FF7DE8 & CAN_SFF_MASK));
}
