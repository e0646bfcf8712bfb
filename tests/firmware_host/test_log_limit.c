// Tests for firmware_host/threads/log_limit.c. In the daemon: tests/system/daemon_talk.sh.

#include "firmware_host/threads/log_limit.h"

#include "tests/testlib.h"

#include <stdlib.h>

#define SECOND_ns 1000000000LL

TEST(a_burst_is_said_and_then_a_line_a_second)
{
    struct dig_log_limit talk = { .held = 0 };
    const int64_t        at   = 5000 * SECOND_ns;
    int                  said = 0;
    for (int i = 0; i < 1000; i++) {
        said += dig_log_limit_allows(&talk, at) ? 1 : 0;
    }
    assert_int_equal(said, 20);
    assert_int_equal(dig_log_limit_held(&talk), 980);
    assert_int_equal(dig_log_limit_held(&talk), 0);
    assert_false(dig_log_limit_allows(&talk, at + SECOND_ns - 1));
    assert_true(dig_log_limit_allows(&talk, at + SECOND_ns));
    assert_false(dig_log_limit_allows(&talk, at + SECOND_ns));
    assert_int_equal(dig_log_limit_held(&talk), 2);
}

// Lines at random times: in no span of time are there more than the burst and one a second, and
// each is said or counted.
TEST(no_span_of_time_has_more_lines_than_that)
{
    enum { LINES = 4000 };
    static int64_t       said_ns[LINES];
    struct dig_log_limit talk   = { .held = 0 };
    size_t               said   = 0;
    int64_t              held   = 0;
    int64_t              now_ns = 0;
    srand(1);
    for (int i = 0; i < LINES; i++) {
        const int64_t often_ns = i / 500 % 2 == 0 ? SECOND_ns / 50 : 3 * SECOND_ns;
        now_ns += rand() % often_ns;
        if (dig_log_limit_allows(&talk, now_ns)) {
            said_ns[said++] = now_ns;
        }
        held += i % 7 == 0 ? dig_log_limit_held(&talk) : 0;
    }
    assert_int_equal((int64_t)said + held + dig_log_limit_held(&talk), LINES);
    for (size_t a = 0; a < said; a++) {
        for (size_t b = a; b < said; b++) {
            const int64_t span_s = (said_ns[b] - said_ns[a]) / SECOND_ns;
            assert_true((int64_t)(b - a + 1) <= 20 + span_s);
        }
    }
    assert_true(said > 1500); // and what comes now and then is said
}

TEST(what_was_held_back_is_spoken_of_when_the_flood_is_over)
{
    struct dig_log_limit talk = { .held = 0 };
    for (int i = 0; i < 25; i++) {
        (void)dig_log_limit_allows(&talk, 100 * SECOND_ns);
    }
    assert_int_equal(dig_log_limit_held_before(&talk, 105 * SECOND_ns, false), 0);
    assert_int_equal(dig_log_limit_held_before(&talk, 105 * SECOND_ns + 1, false), 5);
    assert_int_equal(dig_log_limit_held_before(&talk, 200 * SECOND_ns, false), 0);
    for (int i = 0; i < 25; i++) {
        (void)dig_log_limit_allows(&talk, 200 * SECOND_ns);
    }
    assert_int_equal(dig_log_limit_held_before(&talk, 200 * SECOND_ns, true), 5);
}
