// Tests for tools/digreport/shift_dig.c: digs whose numbers are worked out by hand.

#include "tools/digreport/shift_dig.h"

#include "tests/blank_messages.h"
#include "tests/testlib.h"

#include <string.h>

static char actual[] = "actual";

static struct digreport_dig_track track;
static struct digreport_dig       dig;

static int fresh(void **state)
{
    (void)state;
    digreport_track_finish(&track);
    track = (struct digreport_dig_track){ .half_s = 0.05 };
    dig   = (struct digreport_dig){ .number = -1 };
    return 0;
}

static digsight_estimate_t estimate_at(const int64_t time_ms, const int8_t phase,
                                       const double moment_Nm)
{
    digsight_estimate_t e = blank_estimate();
    e.time_ns             = time_ms * 1000000;
    e.phase               = phase;
    e.moment_valid        = 1;
    e.force_valid         = 1;
    e.moment_Nm           = moment_Nm;
    e.progress            = (double)NAN;
    return e;
}

static bool take(const digsight_estimate_t *const e)
{
    bool finished = false;
    assert_int_equal(digreport_track_estimate(&track, e->time_ns / 1000, e, &finished, &dig),
                     DIG_OK);
    return finished;
}

// Of "actual" from 0 to 1, 2000 N·m throughout with sigma 100.
static void predict(const int32_t gravel_of_dig)
{
    double                moment[DIG_PREDICTED_POINTS];
    double                sigma[DIG_PREDICTED_POINTS];
    digsight_prediction_t p = blank_prediction(actual, 2000.0, 2000.0, 100.0, moment, sigma);
    p.dig_count             = gravel_of_dig;
    p.peak_Nm               = 2100.0;
    p.peak_sigma_Nm         = 90.0;
    p.energy_J              = 5000.0;
    p.energy_sigma_J        = 300.0;
    digreport_track_prediction(&track, &p);
}

// Two seconds at 1000 N·m, every 100 ms, from 1 s on; known as "actual" from 2 s on.
static bool dig_two_seconds(const int32_t gravel_of_dig)
{
    digsight_estimate_t e = estimate_at(900, 0, 0.0);
    assert_false(take(&e));
    for (int64_t ms = 1000; ms <= 3000; ms += 100) {
        e = estimate_at(ms, ms < 1200 ? 1 : 2, 1000.0);
        if (ms >= 2000) {
            e.trajectory = actual;
            e.progress   = (double)(ms - 1000) / 2000.0;
        }
        assert_false(take(&e));
        if (ms == 2000) {
            predict(gravel_of_dig);
        }
    }
    e = estimate_at(3100, 3, 500.0); // exit: not part of it
    assert_false(take(&e));
    e           = estimate_at(3200, 0, 0.0);
    e.dig_count = 1;
    return take(&e);
}

TEST_WITH(a_dig_is_from_contact_to_exit, fresh, NULL)
{
    assert_true(dig_two_seconds(0));
    assert_int_equal(dig.number, 1);
    assert_int_equal(dig.time_us, 1000000);
    assert_close(dig.duration_s, 2.0, 1e-9);
    assert_string_equal(dig.trajectory, "actual");
    assert_close(dig.peak_Nm, 1000.0, 1e-9);
}

// 1000 measured where 2000 +- 100 was predicted: off by 1000 of 1000, floor 100 of 1000.
TEST_WITH(the_error_is_that_of_the_first_prediction_made_in_the_dig, fresh, NULL)
{
    assert_true(dig_two_seconds(0));
    assert_close(dig.error, 1.0, 1e-9);
    assert_close(dig.noise_floor, 0.1, 1e-9);
    assert_close(dig.predicted_peak_Nm, 2100.0, 0.0);
    assert_close(dig.predicted_energy_sigma_J, 300.0, 0.0);
}

TEST_WITH(a_prediction_from_the_dig_itself_does_not_judge_it, fresh, NULL)
{
    assert_true(dig_two_seconds(1)); // this dig will be number 1
    assert_true(isnan(dig.error) && isnan(dig.noise_floor) && isnan(dig.predicted_peak_Nm) &&
                isnan(dig.predicted_energy_J));
}

// The pin goes by 2 m against the soil's 300 N in x, down 1 m against 500 N, and curls by 0.5 rad
// against 1000 N·m: 600 + 500 + 500 J.
TEST_WITH(energy_is_the_work_on_the_soil, fresh, NULL)
{
    const int n = 11;
    for (int i = 0; i < n; i++) {
        const double        part = i / 10.0;
        digsight_estimate_t e    = estimate_at(1000 + 100 * i, 2, 1000.0);
        e.force_x_N              = -300.0; // against the drag towards the cab, which is -X
        e.force_z_N              = 500.0;
        e.pin_X_m                = 8.0 - 2.0 * part;
        e.pin_Z_m                = 1.0 - part;
        e.bucket_phi_rad         = remainder(3.3 - 0.5 * part, 6.283185307179586); // over the seam
        assert_false(take(&e));
    }
    digsight_estimate_t e = estimate_at(2100, 3, 0.0);
    e.dig_count           = 1;
    assert_true(take(&e));
    assert_close(dig.energy_J, 1600.0, 1e-6);

    // Without a force once there is none.
    (void)fresh(NULL);
    e = estimate_at(1000, 2, 1000.0);
    assert_false(take(&e));
    e             = estimate_at(1100, 2, 1000.0);
    e.force_valid = 0;
    assert_false(take(&e));
    e           = estimate_at(1200, 3, 0.0);
    e.dig_count = 1;
    assert_true(take(&e));
    assert_true(isnan(dig.energy_J));
    assert_close(dig.peak_Nm, 1000.0, 1e-9);
}

// 0, 0, 900, 0, 0 every 40 ms, averaged over +-50 ms: 300 at most.
TEST_WITH(the_peak_is_that_of_the_moving_average, fresh, NULL)
{
    for (int i = 0; i < 5; i++) {
        const digsight_estimate_t e = estimate_at(1000 + 40 * i, 2, i == 2 ? 900.0 : 0.0);
        assert_false(take(&e));
    }
    digsight_estimate_t e = estimate_at(1300, 3, 0.0);
    e.dig_count           = 1;
    assert_true(take(&e));
    assert_close(dig.peak_Nm, 300.0, 1e-9);
}

TEST_WITH(a_contact_that_is_lost_is_no_dig, fresh, NULL)
{
    digsight_estimate_t e = estimate_at(1000, 1, 1000.0);
    assert_false(take(&e));
    e = estimate_at(1100, 1, 1000.0);
    assert_false(take(&e));
    e = estimate_at(1200, 0, 0.0);
    assert_false(take(&e));
    e           = estimate_at(1300, 0, 0.0);
    e.dig_count = 1; // a dig whose estimates did not come
    assert_false(take(&e));
}

TEST_WITH(numbers_and_names_of_others_are_not_taken, fresh, NULL)
{
    static const double moments[] = { (double)NAN, (double)INFINITY, -1e12, 1000.0, 1000.0 };
    char                name[]    = "<script>";
    digsight_estimate_t e;
    for (int i = 0; i < 5; i++) {
        e            = estimate_at(1000 + 100 * i, 2, moments[i]);
        e.trajectory = name;
        e.pin_X_m    = (double)NAN;
        assert_false(take(&e));
    }
    e           = estimate_at(INT64_MIN / 1000000, 3, 0.0);
    e.dig_count = INT32_MAX;
    assert_true(take(&e));
    assert_string_equal(dig.trajectory, "");
    assert_close(dig.peak_Nm, 1000.0, 1e-9);
    assert_close(dig.duration_s, 0.1, 1e-9);
    assert_true(isnan(dig.energy_J));
    // Times that go back, and as far as they can.
    static const int64_t times[] = { 5000, 1000, INT64_MIN / 1000000, INT64_MAX / 1000000, 0 };
    for (int i = 0; i < 5; i++) {
        e           = estimate_at(times[i], 2, 1000.0);
        e.dig_count = INT32_MAX;
        assert_false(take(&e));
    }
    e           = estimate_at(0, 0, 0.0);
    e.dig_count = INT32_MIN;
    assert_true(take(&e));
}

static int finish_all(void **state)
{
    (void)state;
    digreport_track_finish(&track);
    return 0;
}

TESTS_WITH(NULL, finish_all)
