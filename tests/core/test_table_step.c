// Tests for core/table_step.c: told where beds were measured to move (docs/numerics/dem.md, "A step
// that heats"), and only there.

#include "core/table_step.h"
#include "tests/testlib.h"

#include <string.h>

static const struct dig_material rig = { 0.0075, 5e6, 0.2, 0.2, 2.0, 0.0 };

static const char *text_of(const struct dig_material *const grain, const double density_kgpm3,
                           const double step_s)
{
    static char                 text[DIG_TABLE_STEP_TEXT_SIZE];
    const struct dig_table_step step =
        dig_table_step_of(grain, DIG_NORMAL_HOOKE, density_kgpm3, step_s);
    memset(text, 'x', sizeof text);
    dig_table_step_text(&step, text);
    return text;
}

TEST(a_bed_that_was_seen_to_lie_still_is_passed)
{
    const double still_s[] = { 0.0, 30e-6, 50e-6, 62.5e-6 };
    for (size_t i = 0; i < 4; i++) {
        assert_string_equal(text_of(&rig, 2500.0, still_s[i]), "");
    }
    assert_string_equal(text_of(&rig, 1500.0, 38.7e-6), "");
}

TEST(a_bed_that_was_seen_to_move_is_told_with_its_gravel)
{
    const double moves_s[] = { 80e-6, 100e-6, 120e-6 };
    for (size_t i = 0; i < 3; i++) {
        assert_non_null(strstr(text_of(&rig, 2500.0, moves_s[i]), "gravel of 2500 kg/m3"));
    }
    assert_non_null(strstr(text_of(&rig, 1500.0, 62.5e-6), "gravel of 1500 kg/m3"));
    assert_non_null(strstr(text_of(&rig, 1500.0, 62.5e-6), "62.5 us"));
}

TEST(small_and_stiff_grains_bear_less)
{
    struct dig_material grain = rig;
    grain.diameter_m          = 0.5 * rig.diameter_m;
    assert_string_not_equal(text_of(&grain, 2500.0, 62.5e-6), "");
    grain          = rig;
    grain.young_Pa = 1.5e8;
    assert_string_not_equal(text_of(&grain, 2500.0, 62.5e-6), "");
}

TEST(springs_that_go_with_the_density_bear_the_same_step)
{
    struct dig_material grain = rig;
    grain.young_at_kgpm3      = 2500.0;
    assert_string_equal(text_of(&grain, 1500.0, 62.5e-6), "");
    assert_non_null(strstr(text_of(&grain, 1500.0, 80e-6), "gravel of 1500 kg/m3"));
}
