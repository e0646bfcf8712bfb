// Tests for tools/digwatch/multicast.c: which URLs are networks. What comes over one is tested by
// tests/system/digwatch.sh.

#include "tools/digwatch/multicast.h"

#include "tests/testlib.h"

#include <fcntl.h>
#include <string.h>
#include <unistd.h>

TEST(what_is_no_url_of_a_group_is_refused_and_opens_nothing)
{
    static const char *const bad[] = {
        "",
        "udpm",
        "udpm:/239.255.76.67",
        "tcpq://127.0.0.1:7700",
        "file:///tmp/x",
        "udpm://127.0.0.1:7667", // no group
        "udpm://host:7667",
        "udpm://239.255.76.67:",
        "udpm://239.255.76.67:65536",
        "udpm://239.255.76.67:-1",
        "udpm://239.255.76.67: 7667",
        "udpm://239.255.76.67:7667/",
        "udpm://239.255.76.67:7667?",
        "udpm://239.255.76.67:7667?ttl=",
        "udpm://239.255.76.67:7667?ttl=256",
        "udpm://239.255.76.67:7667?ttl=1x",
        "udpm://239.255.76.67:7667?ttl=1&",
        "udpm://239.255.76.67:7667?recv_buf_size=9999999999",
        "udpm://239.255.76.67:7667?other=1",
        "udpm://239.255.76.67.239.255.76.67.239.255.76.67:7667",
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        int              fd    = 42;
        struct dig_error error = { "" };
        if (digwatch_multicast_open(bad[i], &fd, &error) != DIG_EINVAL) {
            fail_msg("%s: taken", bad[i]);
        }
        assert_int_equal(fd, 42);
        assert_contains(error.text, "expected udpm://");
    }
}

// With a route to the group or without one: it is joined, or said why not.
TEST(a_group_is_joined_or_it_is_said_why_not)
{
    static const char *const good[] = {
        "udpm://",
        "udpm://:7667",
        "udpm://239.255.76.67",
        "udpm://239.255.76.67:7667",
        "udpm://239.255.76.67:7667?ttl=0",
        "udpm://239.255.76.67:7667?ttl=1&recv_buf_size=400000",
        "udpm://?recv_buf_size=1000",
    };
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        int                   fd     = -1;
        struct dig_error      error  = { "" };
        const enum dig_status status = digwatch_multicast_open(good[i], &fd, &error);
        assert_true(status == DIG_OK || status == DIG_EIO);
        assert_int_equal(fd >= 0, status == DIG_OK);
        if (status == DIG_OK) {
            assert_true((fcntl(fd, F_GETFL) & O_NONBLOCK) != 0);
            assert_int_equal(close(fd), 0);
        } else {
            assert_contains(error.text, "route");
        }
    }
}
