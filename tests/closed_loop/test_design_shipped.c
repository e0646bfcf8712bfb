// What `digloop design` recommends on the tables that ship.

#include "closed_loop/design/design.h"
#include "tests/closed_loop/shipped_fixture.h"

#include <string.h>

// The design of a table without its effects. Of the product's gain, .02, 7200 simulated gravels
// leave .009 open.
static struct dig_design design_of(const char *const path, const size_t gravels,
                                   char recommended[DIG_NAME_SIZE], char reference[DIG_NAME_SIZE])
{
    struct dig_design design;
    shipped_load(path, NULL);
    assert_int_equal(dig_design_run(surface, scatter, gravels, 1, &design), DIG_OK);
    memcpy(recommended, set->trajectory[design.rank[0]].name, DIG_NAME_SIZE);
    memcpy(reference, set->trajectory[design.reference].name, DIG_NAME_SIZE);
    (void)shipped_teardown(NULL);
    return design;
}

TEST(the_products_recommended_dig_identifies_better_than_simple_a)
{
    char                    best[DIG_NAME_SIZE];
    char                    reference[DIG_NAME_SIZE];
    const struct dig_design d = design_of(PRODUCT, 7200, best, reference);
    assert_string_equal(best, "simpleB");
    assert_string_equal(reference, "simpleA");
    assert_true(d.confirmed);
    assert_true(d.gain_low > 0.0);
    assert_true(d.dig[d.rank[0]].error < d.dig[d.reference].error);
    assert_true(d.dig[d.rank[0]].target_error < d.dig[d.reference].target_error);
}

// Of the rig no other simple dig tells more, and none is said to.
TEST(the_rigs_simple_a_tells_most_already)
{
    char                    best[DIG_NAME_SIZE];
    char                    reference[DIG_NAME_SIZE];
    const struct dig_design d = design_of(RIG, 1200, best, reference);
    assert_string_equal(best, "simpleA");
    assert_string_equal(reference, "simpleA");
    assert_false(d.confirmed);
}
