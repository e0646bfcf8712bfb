// The neighbour list against looking at every pair.

#include "core/chance.h"
#include "offline_dem/kernel/cell_grid.h"
#include "offline_dem/kernel/crew.h"
#include "offline_dem/kernel/neighbour.h"
#include "tests/dem_grains.h"
#include "tests/testlib.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define GRAINS 500

struct scatter {
    struct dig_grains grains;
    double            margin_m[GRAINS];
};

// Two radii, a few fast grains with wide margins, one thrown far away.
static struct scatter make_scatter(const uint64_t seed)
{
    uint64_t       random = seed;
    struct scatter s;
    double         x[GRAINS], y[GRAINS], z[GRAINS], r[GRAINS];
    for (size_t i = 0; i < GRAINS; i++) {
        x[i]          = dig_chance_between(&random, 0.0, 0.06);
        y[i]          = dig_chance_between(&random, -0.03, 0.03);
        z[i]          = dig_chance_between(&random, 0.0, 0.04);
        r[i]          = dig_chance_index(&random, 2) == 0 ? 0.003 : 0.005;
        s.margin_m[i] = i % 50 == 0 ? dig_chance_between(&random, 0.002, 0.02) : 0.0006;
    }
    x[7] = 12.0;
    assert_int_equal(dem_create_grains(GRAINS, x, y, z, r, 2500.0, &s.grains), DIG_OK);
    assert_int_equal(s.grains.types, 2);
    return s;
}

// The nearest of three images: y repeats after period_m, or not at all (0).
static double apart_in_y(const double dy_m, const double period_m)
{
    return fmin(fabs(dy_m), fmin(fabs(dy_m - period_m), fabs(dy_m + period_m)));
}

static bool is_near(const struct scatter *const s, const double period_m, const size_t i,
                    const size_t j)
{
    const double *const a = s->grains.motion[i].x_m;
    const double *const b = s->grains.motion[j].x_m;
    const double gap_m = hypot(hypot(a[0] - b[0], apart_in_y(a[1] - b[1], period_m)), a[2] - b[2]) -
                         s->grains.type[s->grains.type_of[i]].radius_m -
                         s->grains.type[s->grains.type_of[j]].radius_m;
    return gap_m < s->margin_m[i] + s->margin_m[j];
}

static void expect_all_pairs(const double period_m)
{
    for (uint64_t seed = 1; seed <= 5; seed++) {
        struct scatter        s    = make_scatter(seed);
        struct dig_neighbours list = { 0 };
        assert_int_equal(dig_neighbours_build(&s.grains, period_m, s.margin_m, NULL, &list),
                         DIG_OK);
        unsigned char *const seen = calloc((size_t)GRAINS * GRAINS, 1);
        assert_non_null(seen);
        for (size_t i = 0; i < GRAINS; i++) {
            for (uint32_t k = list.start[i]; k < list.start[i + 1]; k++) {
                const size_t j = list.other[k];
                seen[(i < j ? i : j) * GRAINS + (i < j ? j : i)]++;
            }
        }
        size_t pairs = 0;
        for (size_t i = 0; i < GRAINS; i++) {
            assert_int_equal(seen[i * GRAINS + i], 0);
            for (size_t j = i + 1; j < GRAINS; j++) {
                assert_int_equal(seen[i * GRAINS + j], is_near(&s, period_m, i, j));
                pairs += seen[i * GRAINS + j];
            }
        }
        assert_true(pairs > GRAINS);
        free(seen);
        dig_neighbours_finish(&list);
        dig_grains_finish(&s.grains);
    }
}

TEST(every_near_pair_is_listed_once_and_no_other)
{
    expect_all_pairs(0.0);
}

// The widest pairs reach over half the period: each is still listed once.
TEST(every_near_pair_across_the_sides_is_listed_once)
{
    expect_all_pairs(0.061);
}

TEST(any_crew_finds_the_same_list)
{
    struct scatter        s     = make_scatter(2);
    struct dig_neighbours alone = { 0 };
    struct dig_neighbours list  = { 0 };
    assert_int_equal(dig_neighbours_build(&s.grains, 0.061, s.margin_m, NULL, &alone), DIG_OK);
    for (size_t members = 2; members <= 5; members++) {
        struct dig_crew *crew = NULL;
        assert_int_equal(dig_crew_create(members, &crew), DIG_OK);
        for (int again = 0; again < 2; again++) {
            assert_int_equal(dig_neighbours_build(&s.grains, 0.061, s.margin_m, crew, &list),
                             DIG_OK);
            assert_memory_equal(list.start, alone.start, (GRAINS + 1) * sizeof *list.start);
            assert_memory_equal(list.other, alone.other, list.start[GRAINS] * sizeof *list.other);
        }
        dig_crew_destroy(crew);
    }
    dig_neighbours_finish(&alone);
    dig_neighbours_finish(&list);
    dig_grains_finish(&s.grains);
}

TEST(a_list_can_be_built_again_for_other_grains)
{
    struct dig_neighbours list = { 0 };
    struct scatter        s    = make_scatter(1);
    assert_int_equal(dig_neighbours_build(&s.grains, 0.0, s.margin_m, NULL, &list), DIG_OK);
    unsigned char drop[GRAINS] = { 0 };
    for (size_t i = 3; i < GRAINS; i++) {
        drop[i] = 1;
    }
    dig_grains_drop(&s.grains, drop);
    assert_int_equal(dig_neighbours_build(&s.grains, 0.0, s.margin_m, NULL, &list), DIG_OK);
    assert_int_equal(list.n, 3);
    assert_true(list.start[3] <= 3);
    dig_neighbours_finish(&list);
    dig_grains_finish(&s.grains);
}

TEST(the_order_is_a_permutation_along_the_cells)
{
    struct scatter s = make_scatter(3);
    uint32_t       order[GRAINS];
    bool           seen[GRAINS] = { false };
    assert_int_equal(dig_cell_grid_sort(&s.grains, 0.01, NULL, order), DIG_OK);
    double path_m = 0.0, unsorted_m = 0.0;
    for (size_t k = 0; k < GRAINS; k++) {
        assert_true(order[k] < GRAINS);
        assert_false(seen[order[k]]);
        seen[order[k]] = true;
        if (k > 0) {
            const double *const a = s.grains.motion[order[k - 1]].x_m;
            const double *const b = s.grains.motion[order[k]].x_m;
            const double *const c = s.grains.motion[k - 1].x_m;
            const double *const d = s.grains.motion[k].x_m;
            path_m += fmin(0.1, hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]));
            unsorted_m += fmin(0.1, hypot(hypot(c[0] - d[0], c[1] - d[1]), c[2] - d[2]));
        }
    }
    assert_true(path_m < 0.75 * unsorted_m);
    assert_int_equal(dig_grains_reorder(&s.grains, order, NULL), DIG_OK);
    for (size_t k = 0; k < GRAINS; k++) {
        assert_int_equal(s.grains.id[k], order[k]);
    }
    dig_grains_finish(&s.grains);
}

TEST(no_grains_make_an_empty_list)
{
    struct dig_grains     none = { 0 };
    struct dig_neighbours list = { 0 };
    assert_int_equal(dig_neighbours_build(&none, 0.0, NULL, NULL, &list), DIG_OK);
    assert_int_equal(list.start[0], 0);
    dig_neighbours_finish(&list);
    dig_neighbours_finish(&list);
    dig_neighbours_finish(NULL);
}

TEST(too_many_types_and_senseless_ones_are_refused)
{
    double                at[2] = { 0.0, 0.0 };
    const uint8_t         of[2] = { 0, 1 };
    struct dig_grain_type type[DIG_GRAIN_TYPES_MAX + 1];
    struct dig_grains     untouched = { .n = 77 };
    for (size_t k = 0; k <= DIG_GRAIN_TYPES_MAX; k++) {
        type[k] =
            (struct dig_grain_type){ .radius_m = 0.001, .mass_kg = 1e-5, .inertia_kgm2 = 1e-11 };
    }
    assert_int_equal(
        dig_grains_create(DIG_GRAIN_TYPES_MAX + 1, type, 2, at, at, at, of, &untouched),
        DIG_EINVAL);
    assert_int_equal(dig_grains_create(1, type, 2, at, at, at, of, &untouched), DIG_EINVAL);
    type[1].radius_m = -0.001;
    assert_int_equal(dig_grains_create(2, type, 2, at, at, at, of, &untouched), DIG_EINVAL);
    type[1].radius_m = 0.001;
    at[1]            = NAN;
    assert_int_equal(dig_grains_create(2, type, 2, at, at, at, of, &untouched), DIG_EINVAL);
    assert_int_equal(untouched.n, 77);
}
