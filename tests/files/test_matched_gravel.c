// Tests for files/lcm/matched_gravel.c

#include "files/lcm/matched_gravel.h"

#include "tests/testlib.h"

#include <math.h>

static char untold[] = "rolling, density_kgpm3";
static char wanted[] = "\033[2Ja dig";

static digsight_match_t match(void)
{
    return (digsight_match_t){ .valid                 = 1,
                               .untold                = untold,
                               .wanted                = wanted,
                               .friction              = 0.5,
                               .rolling               = 0.2,
                               .density_kgpm3         = 2600.0,
                               .friction_low          = 0.4,
                               .friction_high         = 0.6,
                               .nearest_density_kgpm3 = 2500.0,
                               .digs                  = 3 };
}

TEST(a_gravel_is_taken_with_its_interval_and_its_words)
{
    digsight_match_t          m = match();
    struct dig_matched_gravel g;
    assert_true(dig_matched_gravel_take(&m, &g));
    assert_true(g.known && !g.outside && !g.forces && !g.going_on && g.digs == 3);
    assert_close(g.gravel.value[DIG_AXIS_DENSITY_kgpm3], 2600.0, 0.0);
    assert_close(g.low.value[0], 0.4, 0.0);
    assert_close(g.high.value[0], 0.6, 0.0);
    assert_close(g.nearest.value[DIG_AXIS_DENSITY_kgpm3], 2500.0, 0.0);
    assert_string_equal(g.untold, "rolling, density_kgpm3");
    assert_string_equal(g.untold_words, "rolling, density");
    assert_string_equal(g.wanted, "?[2Ja dig");
    m.valid    = 0; // what it would be then says nothing
    m.friction = (double)NAN;
    assert_true(dig_matched_gravel_take(&m, &g));
    assert_false(g.known);
}

TEST(what_is_no_gravel_is_refused_and_writes_nothing)
{
    static const double none[] = { (double)NAN, (double)INFINITY, -1e6, 1e300 };
    for (size_t i = 0; i < 4 * sizeof none / sizeof none[0]; i++) {
        digsight_match_t m          = match();
        double *const    place[]    = { &m.rolling, &m.density_low_kgpm3, &m.friction_high,
                                        &m.nearest_rolling };
        *place[i / 4]               = none[i % 4];
        struct dig_matched_gravel g = { .digs = 42 };
        assert_false(dig_matched_gravel_take(&m, &g));
        assert_int_equal(g.digs, 42);
    }
}
