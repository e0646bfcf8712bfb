// Tests for tools/rig/bus/fault.c

#include "tools/rig/bus/fault.h"

#include "tests/testlib.h"

static struct dig_rig_fault parse(const char *const text)
{
    struct dig_rig_fault fault;
    assert_int_equal(dig_rig_fault_parse(text, &fault, NULL), DIG_OK);
    return fault;
}

TEST(every_kind_is_read_with_its_time)
{
    assert_int_equal(parse("not-available@1").kind, DIG_RIG_FAULT_NOT_AVAILABLE);
    assert_int_equal(parse("nan@1").kind, DIG_RIG_FAULT_NOT_AVAILABLE);
    assert_int_equal(parse("frozen@1").kind, DIG_RIG_FAULT_FROZEN);
    assert_int_equal(parse("missing@1").kind, DIG_RIG_FAULT_MISSING);
    assert_int_equal(parse("out-of-range@1").kind, DIG_RIG_FAULT_OUT_OF_RANGE);
    assert_int_equal(parse("stuck-pressures@1").kind, DIG_RIG_FAULT_STUCK_PRESSURES);
    assert_int_equal(parse("stuck-angles@1").kind, DIG_RIG_FAULT_STUCK_ANGLES);
    assert_int_equal(parse("slow=2@1").kind, DIG_RIG_FAULT_SLOW);
    assert_int_equal(parse("far@1:2").kind, DIG_RIG_FAULT_FAR);
    assert_int_equal(parse("far-silent@1:2").kind, DIG_RIG_FAULT_FAR_SILENT);
    assert_close(parse("drop=0.25@1:2").amount, 0.25, 0.0);
    assert_close(parse("drop=0.25@1:2").end_s, 3.0, 0.0);
    assert_close(parse("frozen@5.5:2").begin_s, 5.5, 0.0);
    assert_close(parse("frozen@5.5:2").end_s, 7.5, 0.0);
    assert_true(isinf(parse("frozen@0").end_s));
}

TEST(nonsense_is_refused_and_writes_nothing)
{
    static const char *const bad[] = { "",           "frozen",      "frozen@",      "frozen@x",
                                       "frozen@-1",  "frozen@1:",   "frozen@1:0",   "frozen@1:-2",
                                       "frozen@1x",  "frozen@1:2x", "froze@1",      "frozen2@1",
                                       "@1",         "drop@1",      "drop=@1",      "drop=0@1",
                                       "drop=1.5@1", "drop=x@1",    "frozen=0.1@1", "drop=0.1",
                                       "frozen@nan", "frozen@inf",  "frozen@1:nan" };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct dig_rig_fault fault = { .begin_s = 42.0 };
        struct dig_error     error = { "" };
        assert_int_equal(dig_rig_fault_parse(bad[i], &fault, &error), DIG_EINVAL);
        assert_close(fault.begin_s, 42.0, 0.0);
        assert_true(error.text[0] != '\0');
    }
}

TEST(fault_is_on_from_its_begin_to_just_before_its_end)
{
    const struct dig_rig_fault faults[] = { parse("frozen@1:2"), parse("missing@2") };
    assert_false(dig_rig_fault_is_on(2, faults, DIG_RIG_FAULT_FROZEN, 0.999));
    assert_true(dig_rig_fault_is_on(2, faults, DIG_RIG_FAULT_FROZEN, 1.0));
    assert_true(dig_rig_fault_is_on(2, faults, DIG_RIG_FAULT_FROZEN, 2.999));
    assert_false(dig_rig_fault_is_on(2, faults, DIG_RIG_FAULT_FROZEN, 3.0));
    assert_false(dig_rig_fault_is_on(2, faults, DIG_RIG_FAULT_MISSING, 1.5));
    assert_true(dig_rig_fault_is_on(2, faults, DIG_RIG_FAULT_MISSING, 1e6));
    assert_false(dig_rig_fault_is_on(0, faults, DIG_RIG_FAULT_MISSING, 1e6));
}

TEST(samples_are_spoiled_only_while_the_fault_lasts)
{
    const struct dig_rig_fault faults[] = { parse("nan@1:1"), parse("out-of-range@3:1") };
    struct dig_sample          good     = { .value = { 0.5, -1.0, -0.5, 5e6 } };
    for (int s = 0; s < DIG_SIGNALS; s++) {
        good.valid[s] = true;
    }
    struct dig_sample sample = good;
    dig_rig_fault_spoil(2, faults, 0.5, &sample);
    assert_memory_equal(&sample, &good, sizeof good);

    dig_rig_fault_spoil(2, faults, 1.5, &sample);
    for (int s = 0; s < DIG_SIGNALS; s++) {
        assert_false(sample.valid[s]);
    }

    sample = good;
    dig_rig_fault_spoil(2, faults, 3.5, &sample);
    assert_true(dig_sample_is_complete(&sample));
    assert_close(sample.value[DIG_SIGNAL_BOOM_rad], 12.0, 0.0);
    assert_close(sample.value[DIG_SIGNAL_BUCKET_ROD_Pa], 60e6, 0.0);
}
