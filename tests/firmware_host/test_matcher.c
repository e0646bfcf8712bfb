// Tests for firmware_host/matching/matcher.c

#include "firmware_host/matching/matcher.h"

#include "tests/made_table.h"
#include "tests/testlib.h"

static const struct made_options options = { .relative_sd = 0.15, .packings = 3 };

static struct dig_match match_by(struct dig_matcher *const matcher)
{
    const struct dig_gravel      gravel = { { 0.55, 0.3, 2200 } };
    const struct dig_observation dig    = made_observation(&gravel, MADE_SIMPLE_A, 0.0);
    struct dig_match             match;
    enum dig_status              refined;
    assert_int_equal(dig_matcher_match(matcher, 1, &dig, 2.5, 200, &match, &refined), DIG_OK);
    assert_int_equal(refined, DIG_OK);
    return match;
}

// The first entry that fits is another once the table has changed.
TEST(another_table_taken_up_is_the_one_that_is_matched)
{
    struct dig_curve_set *const set     = made_table(&options);
    struct dig_matcher          matcher = { .memory = NULL };
    dig_matcher_exchange(&matcher, set, 1.0);
    const int before = match_by(&matcher).nearest;

    struct dig_curve_set *const other                                   = made_table(&options);
    other->packings[(size_t)before * MADE_TRAJECTORIES + MADE_SIMPLE_A] = 0;
    dig_matcher_exchange(&matcher, other, 1.0);
    made_table_destroy(set);
    assert_int_not_equal(match_by(&matcher).nearest, before);

    free(matcher.memory);
    made_table_destroy(other);
}
