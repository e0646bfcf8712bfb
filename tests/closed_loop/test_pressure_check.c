// Tests for closed_loop/machine_digs/recording_faults.c, in recordings of a simulated machine's
// digs.

#include "closed_loop/machine_digs/recording_faults.h"

#include "closed_loop/machine_digs/machine_dig.h"
#include "closed_loop/machine_digs/observe_machine.h"
#include "tests/closed_loop/machine_campaign.h"

static struct dig_machine_recording scaled(const double by)
{
    const struct fault           none = { .dry_N = 0.0 };
    struct dig_machine_recording r    = record(0, 0, &none, 1);
    for (size_t i = 0; i < r.rows; i++) {
        for (size_t s = DIG_SIGNAL_BOOM_HEAD_Pa; s <= DIG_SIGNAL_BUCKET_ROD_Pa; s++) {
            r.row[i].value[s] *= by;
        }
    }
    return r;
}

TEST(pressures_in_another_unit_are_refused_as_that)
{
    static const double unit[] = { 1e-3, 1e-5, 1e-6, 1.0 / 6894.76 };
    for (size_t i = 0; i < sizeof unit / sizeof unit[0]; i++) {
        struct dig_machine_recording r     = scaled(unit[i]);
        struct dig_error             error = { "" };
        struct dig_machine_dig       dig   = { .samples = 42 };
        struct dig_observed_digs     digs  = { .seen = 42 };
        assert_int_equal(dig_machine_dig_make(&machine, set, &r, MADE_SIMPLE_A, &dig, &error),
                         DIG_EINVAL);
        assert_contains(error.text, "expected Pa, not bar or MPa");
        assert_int_equal(dig.samples, 42);
        error.text[0] = '\0';
        assert_int_equal(dig_observe_machine(&machine, NULL, set, &r, &digs, &error), DIG_EINVAL);
        assert_contains(error.text, "expected Pa, not bar or MPa");
        assert_int_equal(digs.seen, 42);
        dig_machine_recording_finish(&r);
    }
}

// Nor a tenth of what a dig reads, or a fifth where the bucket's pressures alone are recorded:
// these are far from where it begins. A recording without pressures has no unit.
TEST(pascals_are_not_refused)
{
    struct dig_machine_recording r     = scaled(0.1);
    struct dig_error             error = { "" };
    assert_ok(dig_pressure_check(&machine, &r, &error), error);
    for (size_t i = 0; i < r.rows; i++) {
        for (size_t s = DIG_SIGNAL_BOOM_HEAD_Pa; s <= DIG_SIGNAL_BUCKET_ROD_Pa; s++) {
            r.row[i].valid[s] = s >= DIG_SIGNAL_BUCKET_HEAD_Pa;
            r.row[i].value[s] *= 2.0;
        }
    }
    assert_ok(dig_pressure_check(&machine, &r, &error), error);
    for (size_t i = 0; i < r.rows; i++) {
        r.row[i].valid[DIG_SIGNAL_BUCKET_HEAD_Pa] = false;
        r.row[i].valid[DIG_SIGNAL_BUCKET_ROD_Pa]  = false;
    }
    assert_ok(dig_pressure_check(&machine, &r, &error), error);
    dig_machine_recording_finish(&r);
}

TEST(pressures_that_no_valve_holds_are_refused_and_spikes_are_not)
{
    struct dig_machine_recording r     = scaled(10.0);
    struct dig_error             error = { "" };
    assert_int_equal(dig_pressure_check(&machine, &r, &error), DIG_EINVAL);
    assert_contains(error.text, "opens its relief valve");
    dig_machine_recording_finish(&r);
    r = scaled(1.0);
    for (size_t i = 0; i < r.rows; i += 200) {
        r.row[i].value[DIG_SIGNAL_BUCKET_HEAD_Pa] = 1e9;
    }
    assert_ok(dig_pressure_check(&machine, &r, &error), error);
    dig_machine_recording_finish(&r);
}

// One chamber may well rest at the tank's pressure.
TEST(a_drive_whose_sensors_are_dead_is_refused)
{
    struct dig_machine_recording r     = scaled(1.0);
    struct dig_error             error = { "" };
    for (size_t i = 0; i < r.rows; i++) {
        r.row[i].value[DIG_SIGNAL_BUCKET_ROD_Pa] = 2e6;
    }
    assert_ok(dig_pressure_check(&machine, &r, &error), error);
    for (size_t i = 0; i < r.rows; i++) {
        r.row[i].value[DIG_SIGNAL_BUCKET_HEAD_Pa] = 0.0;
    }
    assert_int_equal(dig_pressure_check(&machine, &r, &error), DIG_EINVAL);
    assert_contains(error.text, "bucket_head_Pa and bucket_rod_Pa never change");
    dig_machine_recording_finish(&r);
}

TESTS_WITH(build, tear_down)
