// Tests for tools/rig/bus/wire.c: what each fault makes of a stream of frames.

#include "tools/rig/bus/wire.h"

#include "tests/testlib.h"

#define FRAMES 10000

struct sink {
    size_t                   count;
    struct dig_rig_can_frame frame[2 * FRAMES];
    double                   at_s[2 * FRAMES], now_s;
};

static void take(void *const context, const struct dig_rig_can_frame *const frame)
{
    struct sink *const sink    = context;
    sink->at_s[sink->count]    = sink->now_s;
    sink->frame[sink->count++] = *frame;
}

static unsigned number_of(const struct dig_rig_can_frame *const frame)
{
    return frame->data[0] | (unsigned)frame->data[1] << 8;
}

// A frame each 10 ms, numbered, through one fault.
static struct dig_rig_wire play(struct sink *const sink, const char *const text)
{
    struct dig_rig_wire   wire   = { .random = 7 };
    struct dig_rig_faults faults = { .faults = 0 };
    assert_int_equal(dig_rig_fault_add(text, &faults, NULL), DIG_OK);
    *sink = (struct sink){ 0 };
    for (unsigned i = 0; i < FRAMES; i++) {
        const struct dig_rig_can_frame frame = { .id   = 1,
                                                 .data = { (uint8_t)i, (uint8_t)(i >> 8) } };
        sink->now_s                          = 0.01 * i;
        dig_rig_wire_put(&wire, &faults, sink->now_s, &frame, take, sink);
    }
    return wire;
}

static struct sink sink;

TEST(a_share_is_dropped_and_the_rest_goes_through)
{
    const struct dig_rig_wire wire = play(&sink, "drop=0.1@10:50");
    assert_int_equal(sink.count + wire.dropped, FRAMES);
    assert_in_range(wire.dropped, 430, 570);
    for (size_t i = 1; i < sink.count; i++) {
        assert_true(number_of(&sink.frame[i]) > number_of(&sink.frame[i - 1]));
        assert_true(sink.at_s[i] <= 10.0 || sink.at_s[i] >= 60.0 ||
                    number_of(&sink.frame[i]) < number_of(&sink.frame[i - 1]) + 6);
    }
}

TEST(a_share_is_doubled)
{
    const struct dig_rig_wire wire = play(&sink, "duplicate=0.2@0");
    assert_int_equal(sink.count, FRAMES + wire.doubled);
    assert_in_range(wire.doubled, 1800, 2200);
}

TEST(a_share_is_overtaken_by_the_next)
{
    const struct dig_rig_wire wire      = play(&sink, "reorder=0.2@0");
    size_t                    backwards = 0;
    for (size_t i = 1; i < sink.count; i++) {
        backwards += number_of(&sink.frame[i]) < number_of(&sink.frame[i - 1]) ? 1 : 0;
    }
    assert_in_range(sink.count, FRAMES - 1, FRAMES);
    assert_int_equal(backwards, wire.overtaken);
    assert_in_range(wire.overtaken, 1000, 2200);
}

TEST(a_damaged_frame_has_one_bit_flipped)
{
    const struct dig_rig_wire wire    = play(&sink, "corrupt=0.1@0");
    size_t                    damaged = 0;
    assert_int_equal(sink.count, FRAMES);
    for (unsigned i = 0; i < FRAMES; i++) {
        const uint8_t good[8] = { (uint8_t)i, (uint8_t)(i >> 8) };
        int           bits    = 0;
        for (int b = 0; b < 64; b++) {
            bits += ((good[b / 8] ^ sink.frame[i].data[b / 8]) >> b % 8) & 1;
        }
        assert_in_range(bits, 0, 1);
        damaged += (size_t)bits;
    }
    assert_int_equal(damaged, wire.damaged);
    assert_in_range(damaged, 900, 1100);
}

TEST(frames_held_back_come_in_bursts_and_all_of_them)
{
    (void)play(&sink, "delay=0.1@10:50");
    assert_int_equal(sink.count, FRAMES);
    size_t bursts = 0;
    for (size_t i = 1; i < sink.count; i++) {
        assert_int_equal(number_of(&sink.frame[i]), number_of(&sink.frame[i - 1]) + 1);
        bursts += sink.at_s[i] > sink.at_s[i - 1] + 0.05 ? 1 : 0;
    }
    assert_in_range(bursts, 430, 510); // every 0.1 s and a frame
}
