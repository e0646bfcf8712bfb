#include "closed_loop/model/soil_fit.h"

#include "tests/testlib.h"

#include <math.h>
#include <string.h>

// Two gravels at 1 and 2 magnitudes of a half and one; a quarter of one gravel alone.
static const struct dig_soil_at beds_at[] = {
    { 0.5, 1.0 }, { 1.0, 1.0 }, { 0.5, 2.0 }, { 1.0, 2.0 }, { 0.25, 1.0 }
};

static struct dig_soil_template choose(const size_t beds)
{
    struct dig_soil_template template;
    memset(&template, 0, sizeof template);
    dig_soil_terms_choose(beds, beds_at, &template);
    return template;
}

TEST(two_gravels_bend_at_their_magnitudes_and_one_does_not)
{
    const struct dig_soil_template t = choose(5);
    assert_int_equal(t.powers, 2);
    assert_int_equal(t.knots, 3);
    assert_close(t.knot[0], 0.0, 0.0);
    assert_close(t.knot[1], 0.5, 0.0);
    assert_close(t.knot[2], 1.0, 0.0);
    assert_int_equal(t.terms, 2 * (2 + 3));
}

// At the stronger gravel, where s is 1: every shape stands twice.
TEST(hats_are_straight_between_magnitudes_and_go_on_beyond)
{
    static const struct {
        double u, half, one; // where, and the two hats there
    } known[]                        = { { 0.0, 0.0, 0.0 },  { 0.25, 0.5, 0.0 }, { 0.5, 1.0, 0.0 },
                                         { 0.75, 0.5, 0.5 }, { 1.0, 0.0, 1.0 },  { 1.5, -1.0, 2.0 } };
    const struct dig_soil_template t = choose(5);
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        double term[DIG_SOIL_TERMS] = { 0.0 };
        dig_soil_terms(&t, &(struct dig_soil_at){ known[i].u, 2.0 }, term);
        for (size_t p = 0; p < 2; p++) {
            assert_close(term[p], known[i].u, 1e-15);
            assert_close(term[2 + p], known[i].u * known[i].u, 1e-15);
            assert_close(term[4 + p], 0.0, 0.0); // where it is absent
            assert_close(term[6 + p], known[i].half, 1e-15);
            assert_close(term[8 + p], known[i].one, 1e-15);
        }
    }
}

TEST(a_gravel_changes_no_more_far_beyond_the_strongest)
{
    const struct dig_soil_template t = choose(5);
    double                         far[DIG_SOIL_TERMS], farther[DIG_SOIL_TERMS];
    memset(far, 0, sizeof far);
    memset(farther, 0, sizeof farther);
    dig_soil_terms(&t, &(struct dig_soil_at){ 1.0, 10.0 }, far);
    dig_soil_terms(&t, &(struct dig_soil_at){ 1.0, 20.0 }, farther);
    assert_memory_equal(far, farther, sizeof far);
    assert_true(far[1] > 1.0);
}

TEST(one_bed_is_a_straight_line)
{
    const struct dig_soil_template t = choose(1);
    assert_int_equal(t.terms, 1);
    double term[DIG_SOIL_TERMS] = { 0.0 };
    dig_soil_terms(&t, &(struct dig_soil_at){ 0.3, 7.0 }, term);
    assert_close(term[0], 0.3, 0.0);
}
