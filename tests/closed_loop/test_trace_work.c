// Tests for closed_loop/verdict/trace_work.c, on digs of the table that ships: how open depths are
// is told by the digs, and what a path tells is taken off.

#include "closed_loop/verdict/trace_work.h"

#include "closed_loop/model/approach_change.h"
#include "core/units.h"
#include "tables/load.h"
#include "tests/testlib.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TABLE "tables/product.sqlite"

enum { DIGS = 2 };

static const struct dig_gravel gravel = { { 0.6, 0.5, 2500 } };

static struct dig_curve_set *set;
static struct dig_measured   measured[DIGS];
static struct dig_trace_work work;
static struct dig_fitted     plain;

static int setup(void **state)
{
    (void)state;
    work         = (struct dig_trace_work){ .digs = DIGS, .measured = measured };
    work.surface = calloc(1, sizeof *work.surface);
    work.batch   = calloc(1, sizeof *work.batch);
    if (work.surface == NULL || work.batch == NULL || dig_table_load(TABLE, &set, NULL) != DIG_OK ||
        dig_response_surface_fit(set, work.surface) != DIG_OK ||
        dig_scatter_measure(TABLE, work.surface, &work.scatter, NULL) != DIG_OK ||
        dig_soil_create(work.surface, NULL, NULL, &work.soil) != DIG_OK) {
        return -1;
    }
    work.set = set;
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    free(work.soil);
    dig_scatter_destroy(work.scatter);
    free(work.surface);
    free(work.batch);
    dig_curve_set_destroy(set);
    return 0;
}

// A dig along each of two trajectories, without scatter, made so.
static void dig_so(const struct dig_approach approach[DIGS])
{
    static const char *const name[DIGS] = { "simpleA", "actual" };
    double                   place[DIG_AXES];
    dig_response_surface_place(work.surface, &gravel, place);
    memset(measured, 0, sizeof measured);
    for (size_t i = 0; i < DIGS; i++) {
        struct dig_measured *const dig = &measured[i];
        struct dig_added           added;
        const int                  t = dig_curve_set_find(set, name[i]);
        assert_true(t >= 0);
        assert_int_equal(dig_approach_added(set, (size_t)t, &gravel, &approach[i], NULL, &added),
                         DIG_OK);
        dig->trajectory = t;
        dig->pace       = 1.0;
        dig->last       = 1.0;
        dig_response_surface_curve(work.surface, (size_t)t, place, dig->value);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            dig->measured[c] = true;
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                dig->value[c][k] += added.value[c][k];
            }
        }
        work.fit[i] = true;
    }
}

static void make_batch(void)
{
    struct dig_error error = { "" };
    assert_ok(dig_trace_batch(&work, &plain, &error), error);
}

static void assert_gravel(void)
{
    const struct dig_gravel told = dig_response_surface_gravel(work.surface, plain.number);
    assert_close(told.value[DIG_AXIS_FRICTION], 0.6, 0.05);
    assert_close(told.value[DIG_AXIS_ROLLING], 0.5, 0.05);
    assert_close(told.value[DIG_AXIS_DENSITY_kgpm3], 2500.0, 80.0);
}

// Nobody tells where a machine's ground lies: its digs themselves say how far they are off.
TEST(depth_is_as_open_as_the_digs_want)
{
    static const struct dig_approach level[DIGS] = { { 1.0, 0.0 }, { 1.0, 0.0 } };
    static const struct dig_approach apart[DIGS] = { { 1.25, 0.0 }, { 0.75, 0.0 } };
    for (int off = 0; off < 2; off++) {
        dig_so(off != 0 ? apart : level);
        measured[0].depth_share = 1.0;
        measured[1].depth_share = 1.0;
        make_batch();
        print_message("share %g\n", measured[0].depth_share);
        assert_close(measured[0].depth_share, measured[1].depth_share, 0.0);
        assert_true(off != 0 ? measured[0].depth_share >= 0.5 : measured[0].depth_share < 0.2);
    }
}

TEST(what_a_path_tells_is_taken_off)
{
    static const struct dig_approach way[DIGS] = { { 1.2, 5.0 * DIG_RAD_PER_DEG },
                                                   { 0.8, -5.0 * DIG_RAD_PER_DEG } };
    dig_so(way);
    for (size_t i = 0; i < DIGS; i++) {
        measured[i].made = way[i];
    }
    make_batch();
    assert_gravel();
    for (size_t i = 0; i < DIGS; i++) {
        assert_true(dig_approach_is_same(&measured[i].taken_off, &way[i]));
        assert_true(measured[i].added.noise > 0.1);
    }
    // A second look takes off the same, not once more.
    const struct dig_measured once = measured[0];
    make_batch();
    double off2   = 0.0;
    double added2 = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        off2 += pow(measured[0].value[0][k] - once.value[0][k], 2.0);
        added2 += pow(once.added.value[0][k], 2.0);
    }
    assert_true(off2 < 0.1 * 0.1 * added2);
}

// A path is longer than the table's, too, where the recording begins in the air.
TEST(a_path_that_began_in_the_air_is_no_deeper_dig)
{
    static const struct dig_approach way[DIGS] = { { 1.0, 5.0 * DIG_RAD_PER_DEG }, { 1.0, 0.0 } };
    dig_so(way);
    measured[0].made = (struct dig_approach){ 1.25, way[0].attack_rad };
    measured[1].made = (struct dig_approach){ 1.25, 0.0 };
    make_batch();
    assert_gravel();
    assert_true(dig_approach_is_same(&measured[0].taken_off, &way[0]));
    assert_true(dig_approach_is_plain(&measured[1].taken_off));
}

TESTS_WITH(setup, teardown)
