// Tests for firmware_host/bus/frame_watch.c

#include "firmware_host/bus/frame_watch.h"

#include "tests/testlib.h"

#define MS 1000000LL

static const struct dig_frame_settings counted = { .counter_mod = 16 };
static const struct dig_frame_settings cyclic  = { .cycle_s = 0.010 };

TEST(a_counter_that_skips_tells_how_many_were_missed)
{
    struct dig_frame_watch w         = { 0 };
    const uint64_t         counter[] = { 3, 4, 6, 9, 15, 0, 1, 4 };
    for (int i = 0; i < 8; i++) {
        assert_true(dig_frame_watch_take(&w, &counted, 10 * MS * i, counter[i]));
    }
    assert_int_equal(w.missed, 0 + 1 + 2 + 5 + 0 + 0 + 2);
    assert_int_equal(w.repeated, 0);
}

TEST(a_frame_again_or_from_before_is_dropped)
{
    struct dig_frame_watch w = { 0 };
    assert_true(dig_frame_watch_take(&w, &counted, 0, 7));
    assert_false(dig_frame_watch_take(&w, &counted, 1 * MS, 7));
    assert_false(dig_frame_watch_take(&w, &counted, 2 * MS, 6));
    assert_false(dig_frame_watch_take(&w, &counted, 3 * MS, 5));
    assert_true(dig_frame_watch_take(&w, &counted, 4 * MS, 8));
    assert_int_equal(w.repeated, 3);
    assert_int_equal(w.missed, 0);
}

// Every tenth frame lost, with jitter of a third of the cycle and a clock 100 ppm fast.
TEST(a_cycle_tells_what_did_not_come)
{
    struct dig_frame_watch w    = { 0 };
    int                    lost = 0;
    for (int64_t i = 0; i < 10000; i++) {
        const int64_t jitter_ns = (i * 7919 % 67 - 33) * MS / 10;
        if (i % 10 == 7 && i < 9900) {
            lost++;
            continue;
        }
        assert_true(dig_frame_watch_take(&w, &cyclic, i * (10 * MS - 1000) + jitter_ns, 0));
    }
    assert_int_equal(w.missed, lost);
}

// A host that stalls delivers late but all: nothing was missed.
TEST(a_burst_after_a_pause_pays_back)
{
    struct dig_frame_watch w = { 0 };
    for (int64_t i = 0; i < 3000; i++) {
        const int64_t due_ns  = i * 10 * MS;
        const bool    stalled = i >= 1000 && i < 1300;
        assert_true(dig_frame_watch_take(&w, &cyclic,
                                         stalled ? 1300 * 10 * MS + (i - 1300) * 1000 : due_ns, 0));
    }
    assert_int_equal(w.missed, 0);
}

TEST(without_counter_and_cycle_all_frames_are_taken)
{
    struct dig_frame_watch          w       = { 0 };
    const struct dig_frame_settings nothing = { 0 };
    for (int64_t i = 0; i < 10; i++) {
        assert_true(dig_frame_watch_take(&w, &nothing, i % 3 * MS, (uint64_t)i % 2));
    }
    assert_int_equal(w.missed + w.repeated, 0);
}
