// Tests for tools/rig/bus/fault.c

#include "tools/rig/bus/fault.h"

#include "tests/testlib.h"

static void add(struct dig_rig_faults *const faults, const char *const text)
{
    assert_int_equal(dig_rig_fault_add(text, faults, NULL), DIG_OK);
}

static struct dig_rig_fault parse(const char *const text)
{
    struct dig_rig_faults faults = { .faults = 0 };
    add(&faults, text);
    return faults.fault[0];
}

TEST(every_kind_is_read_with_its_time)
{
    assert_int_equal(parse("not-available@1").kind, DIG_RIG_FAULT_NOT_AVAILABLE);
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
        struct dig_rig_faults faults = { .fault = { { .begin_s = 42.0 } } };
        struct dig_error      error  = { "" };
        assert_int_equal(dig_rig_fault_add(bad[i], &faults, &error), DIG_EINVAL);
        assert_int_equal(faults.faults, 0);
        assert_close(faults.fault[0].begin_s, 42.0, 0.0);
        assert_true(error.text[0] != '\0');
    }
}

TEST(fault_is_on_from_its_begin_to_just_before_its_end)
{
    struct dig_rig_faults faults = { .faults = 0 };
    assert_close(dig_rig_fault_amount(&faults, DIG_RIG_FAULT_MISSING, 1e6), 0.0, 0.0);
    add(&faults, "frozen@1:2");
    add(&faults, "missing@2");
    add(&faults, "drop=0.25@4");
    assert_close(dig_rig_fault_amount(&faults, DIG_RIG_FAULT_FROZEN, 0.999), 0.0, 0.0);
    assert_close(dig_rig_fault_amount(&faults, DIG_RIG_FAULT_FROZEN, 1.0), 1.0, 0.0);
    assert_close(dig_rig_fault_amount(&faults, DIG_RIG_FAULT_FROZEN, 2.999), 1.0, 0.0);
    assert_close(dig_rig_fault_amount(&faults, DIG_RIG_FAULT_FROZEN, 3.0), 0.0, 0.0);
    assert_close(dig_rig_fault_amount(&faults, DIG_RIG_FAULT_MISSING, 1.5), 0.0, 0.0);
    assert_close(dig_rig_fault_amount(&faults, DIG_RIG_FAULT_MISSING, 1e6), 1.0, 0.0);
    assert_close(dig_rig_fault_amount(&faults, DIG_RIG_FAULT_DROP, 4.0), 0.25, 0.0);
}

TEST(samples_are_spoiled_only_while_the_fault_lasts)
{
    struct dig_rig_faults faults = { .faults = 0 };
    add(&faults, "not-available@1:1");
    add(&faults, "out-of-range@3:1");
    struct dig_sample good = { .value = { 0.5, -1.0, -0.5, 5e6 } };
    for (int s = 0; s < DIG_SIGNALS; s++) {
        good.valid[s] = true;
    }
    struct dig_sample sample = good;
    dig_rig_fault_spoil(&faults, 0.5, &sample);
    assert_memory_equal(&sample, &good, sizeof good);

    dig_rig_fault_spoil(&faults, 1.5, &sample);
    for (int s = 0; s < DIG_SIGNALS; s++) {
        assert_false(sample.valid[s]);
    }

    sample = good;
    dig_rig_fault_spoil(&faults, 3.5, &sample);
    assert_true(dig_sample_is_complete(&sample));
    assert_close(sample.value[DIG_SIGNAL_BOOM_rad], 12.0, 0.0);
    assert_close(sample.value[DIG_SIGNAL_BUCKET_ROD_Pa], 60e6, 0.0);
}

TEST(there_are_no_more_than_sixteen)
{
    struct dig_rig_faults faults = { .faults = 0 };
    struct dig_error      error  = { "" };
    for (int i = 0; i < DIG_RIG_FAULTS_MAX; i++) {
        add(&faults, "frozen@1:2");
    }
    assert_int_equal(dig_rig_fault_add("frozen@1:2", &faults, &error), DIG_EINVAL);
    assert_string_equal(error.text, "--fault: more than 16");
}
