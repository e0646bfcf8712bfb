// Tests for tools/digwatch/source.c: when the messages of a log are handed on.

#include "tools/digwatch/source.h"

#include "tests/blank_messages.h"
#include "tests/logged.h"
#include "tests/scratch.h"

LOG_TYPE(health)

static void put(lcm_eventlog_t *const log, const int64_t time_us)
{
    const digsight_health_t h = blank_health();
    log_health(log, "DIGSIGHT_HEALTH", time_us, &h);
}

// At twice its speed: a second takes half of one, an hour five seconds, a clock set back nothing.
TEST(a_log_is_played_at_its_speed_without_its_pauses)
{
    static const int64_t  times_us[] = { 5000000, 6000000, 3606000000, 1000, INT64_MIN, INT64_MAX };
    lcm_eventlog_t *const log        = lcm_eventlog_create(scratch_path("day.lcm"), "w");
    for (size_t i = 0; i < 6; i++) {
        put(log, times_us[i]);
    }
    lcm_eventlog_destroy(log);

    struct digwatch_source source;
    const char *const      path = scratch_path("day.lcm");
    assert_int_equal(digwatch_source_play(path, 2.0, &source, NULL), DIG_OK);
    assert_int_equal(source.fd, -1);
    static const struct {
        double now_s;
        int    taken;
        double due_s;
    } steps[]                   = { { 100.0, 1, 100.5 },
                                    { 100.4, 1, 100.5 },
                                    { 100.5, 2, 105.5 },
                                    { 105.5, 6, (double)INFINITY } };
    struct digwatch_model model = { .messages = 0 };
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
        assert_false(digwatch_source_ended(&source));
        assert_int_equal(digwatch_source_read(&source, steps[i].now_s, &model, NULL), DIG_OK);
        assert_int_equal(model.messages, steps[i].taken);
        assert_true(source.due_s >= steps[i].due_s - 1e-9 && source.due_s <= steps[i].due_s + 1e-9);
    }
    assert_true(digwatch_source_ended(&source));
    digwatch_source_close(&source);
}

TEST(a_source_that_is_none_is_refused_and_writes_nothing)
{
    struct digwatch_source source = { .fd = 77 };
    struct dig_error       error  = { "" };
    assert_int_equal(digwatch_source_play(scratch_path("none.lcm"), 1.0, &source, &error), DIG_EIO);
    assert_contains(error.text, "none.lcm: No such file");
    assert_int_equal(digwatch_source_listen("nonsense://", &source, &error), DIG_EINVAL);
    assert_contains(error.text, "LCM nonsense://: no such URL");
    assert_int_equal(source.fd, 77);
}

TESTS_WITH(scratch_setup, scratch_teardown)
