// Tests for files/lcm/health_text.c

#include "files/lcm/health_text.h"

#include "firmware_host/publish/publish.h"
#include "tests/testlib.h"

#include <string.h>

// Each field of trouble, filled with a number of its own.
TEST(each_counter_is_the_field_it_is_named_after)
{
    const digsight_health_t  h      = { .overruns              = 1,
                                        .dropped_malformed     = 2,
                                        .dropped_nan           = 3,
                                        .dropped_not_available = 4,
                                        .dropped_out_of_range  = 5,
                                        .dropped_frozen        = 6,
                                        .reconnects            = 7,
                                        .lost                  = 8,
                                        .dropped_checksum      = 9,
                                        .dropped_repeated      = 10,
                                        .dropped_jump          = 11,
                                        .dropped_stuck         = 12,
                                        .missed                = 13,
                                        .error_frames          = 14,
                                        .bus_offs              = 15,
                                        .timeouts              = 16,
                                        .unsent                = 17,
                                        .reloads_refused       = 18,
                                        .without_force         = 19 };
    static const char *const name[] = { "overruns",
                                        "dropped_malformed",
                                        "dropped_nan",
                                        "dropped_not_available",
                                        "dropped_out_of_range",
                                        "dropped_frozen",
                                        "reconnects",
                                        "lost",
                                        "dropped_checksum",
                                        "dropped_repeated",
                                        "dropped_jump",
                                        "dropped_stuck",
                                        "missed",
                                        "error_frames",
                                        "bus_offs",
                                        "timeouts",
                                        "unsent",
                                        "reloads_refused",
                                        "without_force" };
    assert_int_equal(sizeof name / sizeof name[0], DIG_HEALTH_COUNTERS);
    int64_t count[DIG_HEALTH_COUNTERS];
    dig_health_counts(&h, count);
    for (size_t i = 0; i < DIG_HEALTH_COUNTERS; i++) {
        assert_in_range(count[i], 1, DIG_HEALTH_COUNTERS);
        assert_string_equal(dig_health_counter_text(i)->name, name[count[i] - 1]);
    }
}

TEST(each_counter_and_state_says_what_is_wrong_and_what_to_do)
{
    for (size_t i = 0; i < DIG_HEALTH_COUNTERS; i++) {
        const struct dig_health_text *const text = dig_health_counter_text(i);
        assert_in_range(strlen(text->what), 10, 70);
        assert_in_range(strlen(text->todo), 10, 110);
    }
    static const char *const states[] = { DIG_STATE_STARTING, DIG_STATE_WAITING,
                                          DIG_STATE_STOPPING };
    for (size_t i = 0; i < 3; i++) {
        assert_non_null(dig_health_state_text(states[i]));
        assert_string_equal(dig_health_state_text(states[i])->name, states[i]);
    }
    assert_null(dig_health_state_text(DIG_STATE_RUNNING));
    assert_null(dig_health_state_text("anything"));
}
