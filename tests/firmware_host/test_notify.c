// Tests for firmware_host/threads/notify.c

#include "firmware_host/threads/notify.h"

#include "tests/scratch.h"

#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>

static int listen_at(const char *const name, const size_t length)
{
    struct sockaddr_un address = { .sun_family = AF_UNIX };
    memcpy(address.sun_path, name, length);
    const int fd = socket(AF_UNIX, SOCK_DGRAM, 0);
    assert_true(fd >= 0);
    assert_int_equal(bind(fd, (struct sockaddr *)&address,
                          (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length)),
                     0);
    return fd;
}

static void check_heard(const int fd, const char *const expected)
{
    char          text[64];
    const ssize_t got = recv(fd, text, sizeof text, MSG_DONTWAIT);
    assert_int_equal(got, strlen(expected));
    assert_memory_equal(text, expected, strlen(expected));
}

TEST(a_message_reaches_the_manager_s_socket)
{
    const char *const path = scratch_path("socket");
    const int         fd   = listen_at(path, strlen(path));
    assert_int_equal(setenv("NOTIFY_SOCKET", path, 1), 0);
    assert_int_equal(dig_notify("READY=1"), DIG_OK);
    check_heard(fd, "READY=1");
    assert_int_equal(close(fd), 0);

    // No one listens any more: an error, no signal, no wait.
    assert_int_equal(dig_notify("WATCHDOG=1"), DIG_EIO);
}

TEST(an_abstract_socket_works_too)
{
    char name[64];
    (void)snprintf(name, sizeof name, "@digsight_test_%d", (int)getpid());
    assert_int_equal(setenv("NOTIFY_SOCKET", name, 1), 0);
    const size_t length = strlen(name);
    name[0]             = '\0';
    const int fd        = listen_at(name, length);
    assert_int_equal(dig_notify("STOPPING=1"), DIG_OK);
    check_heard(fd, "STOPPING=1");
    assert_int_equal(close(fd), 0);
}

TEST(without_a_manager_nothing_happens)
{
    assert_int_equal(unsetenv("NOTIFY_SOCKET"), 0);
    assert_int_equal(dig_notify("READY=1"), DIG_OK);
    assert_int_equal(setenv("NOTIFY_SOCKET", "relative", 1), 0);
    assert_int_equal(dig_notify("READY=1"), DIG_EINVAL);
    char name[200];
    memset(name, 'x', sizeof name);
    name[0]               = '/';
    name[sizeof name - 1] = '\0';
    assert_int_equal(setenv("NOTIFY_SOCKET", name, 1), 0);
    assert_int_equal(dig_notify("READY=1"), DIG_EINVAL);
}

TEST(the_watchdog_is_fed_at_half_its_time)
{
    assert_int_equal(unsetenv("WATCHDOG_USEC"), 0);
    assert_int_equal(dig_notify_watchdog_ns(), 0);
    assert_int_equal(setenv("WATCHDOG_USEC", "5000000", 1), 0);
    assert_true(dig_notify_watchdog_ns() == 2500000000);
    assert_int_equal(setenv("WATCHDOG_USEC", "soon", 1), 0);
    assert_int_equal(dig_notify_watchdog_ns(), 0);
}

TESTS_WITH(scratch_setup, scratch_teardown)
