// Test for estimator/track/recorded_dig.c: a gap in the samples of a dig is a hole in its path.

#include "estimator/track/recorded_dig.h"

#include "tests/made_table.h"
#include "tests/testlib.h"

static const double lambda = 4.0; // its time is twice the rig's: 0.32 s are a hole

TEST(samples_missing_in_a_dig_are_told_and_none_in_the_air_before)
{
    static struct dig_recorded_dig recording;
    const struct made_options      options               = { .relative_sd = 0.1, .packings = 3 };
    struct dig_curve_set *const    set                   = made_table(&options);
    const struct dig_wrench        wrench                = { .moment_valid = true };
    const struct dig_path_point    at                    = { 0.0, 0.0, 0.0 };
    const double                   still_rad[DIG_JOINTS] = { 0.0 };
    dig_recorded_dig_clear(&recording, set);
    dig_recorded_dig_add(&recording, set, lambda, 1000000000, &wrench, 0.0, 0.0, &at, still_rad);
    dig_recorded_dig_add(&recording, set, lambda, 2000000000, &wrench, 0.0, 0.0, &at, still_rad);
    assert_false(recording.missing);
    dig_recorded_dig_contact(&recording, &at);
    dig_recorded_dig_add(&recording, set, lambda, 2310000000, &wrench, 0.0, 0.0, &at, still_rad);
    assert_false(recording.missing);
    dig_recorded_dig_add(&recording, set, lambda, 2640000000, &wrench, 0.0, 0.0, &at, still_rad);
    dig_recorded_dig_add(&recording, set, lambda, 2650000000, &wrench, 0.0, 0.0, &at, still_rad);
    assert_true(recording.missing);
    dig_recorded_dig_clear(&recording, set);
    assert_false(recording.missing);
    made_table_destroy(set);
}
