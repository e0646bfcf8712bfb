// Tests for firmware_host/matching/fit.c with a table dug at several depths and attacks.

#include "firmware_host/matching/fit.h"

#include "tests/approach_table.h"
#include "tests/scratch.h"
#include "tests/wires.h"

#include <stdlib.h>

struct bench {
    struct dig_config      config;
    struct approach_table  table;
    struct wires           wires;
    struct dig_early_match early;
    struct dig_fit         fit;
};

static struct bench *bench_create(void)
{
    static const struct dig_approach way[] = { { 0.8, 0.0 }, { 1.0, 0.1 }, { 1.2, 0.0 } };
    struct bench *const              b     = calloc(1, sizeof *b);
    assert_non_null(b);
    approach_table_init(&b->table, CUBE_GRAVELS, 3, way, approach_growing, 0.05, 3);
    b->config = wires_config();
    wires_init(&b->wires);
    wires_init_fit(&b->wires, &b->config, &b->table.cube.set, &b->early, &b->fit);
    return b;
}

static void bench_destroy(struct bench *const b)
{
    free(b->fit.matcher.memory);
    free(b);
}

static void dig_deep(struct bench *const b, const size_t gravel, const size_t t, const double depth,
                     const double told)
{
    static uint32_t             count;
    const struct dig_trajectory dug = approach_dug(t, (struct dig_approach){ depth, 0.0 });
    struct dig_curve            curve;
    approach_curve(gravel, t, &dug, approach_growing(depth, 0.0), 0.05, &curve);
    struct dig_observation dig = { .dig_count  = ++count,
                                   .trajectory = (int)t,
                                   .made       = { told, 0.02 },
                                   .approach   = { told, 0.0 },
                                   .first      = 0.0,
                                   .last       = 1.0 };
    for (int p = 0; p < DIG_CURVE_POINTS; p++) {
        dig.moment_Nm[p] = (double)curve.mean[DIG_CHANNEL_MY_Nm][p];
        dig.sigma_Nm[p]  = 0.005;
    }
    dig_fit_take(&b->fit, &dig);
}

TEST(digs_of_different_depths_are_matched_together)
{
    struct bench *const b = bench_create();
    dig_deep(b, 5, 0, 0.9, 0.9);
    dig_deep(b, 5, 0, 1.15, 1.15);
    dig_deep(b, 5, 0, 1.0, 1.0);
    assert_true(b->fit.track.valid);
    assert_int_equal(b->fit.pool.digs, 3); // none was a stranger to what the others let expect
    assert_int_equal(b->fit.track.match.digs, 3);
    assert_int_equal(b->fit.track.match.nearest, 5);
    assert_true(b->fit.track.match.distance < 0.02);
    assert_int_equal(b->fit.track.differed, 0);

    // The same digs taken for plain ones contradict each other.
    b->fit.track = (struct dig_gravel_track){ .any = false };
    dig_deep(b, 5, 0, 0.8, 1.0);
    dig_deep(b, 5, 0, 1.2, 1.0);
    assert_true(b->fit.pool.digs < 2 || b->fit.track.match.distance > 0.1);
    bench_destroy(b);
}

TEST(a_deep_dig_is_no_sign_of_other_ground)
{
    struct bench *const b = bench_create();
    dig_deep(b, 2, 0, 1.0, 1.0);
    assert_true(b->fit.track.valid);
    for (int i = 0; i < 3; i++) {
        dig_deep(b, 2, 1, 1.2, 1.2);
        assert_true(b->fit.track.valid);
        assert_true(b->fit.track.drift < 1.0);
    }
    dig_deep(b, 2, 1, 1.2, 1.0); // taken for a plain one it is
    assert_true(b->fit.track.drift > 1.5);
    bench_destroy(b);
}

// Of the youngest dig; after a restart, too.
TEST(how_it_was_made_is_known_with_the_gravel)
{
    struct bench *const b = bench_create(), *const again = bench_create();
    for (int i = 0; i < 2; i++) {
        struct bench *const one = i == 0 ? b : again;
        (void)snprintf(one->config.match_state.text, sizeof one->config.match_state.text, "%s",
                       scratch_path("deep.json"));
        memset(one->table.cube.set.scene_hash, 'a', 64);
    }
    dig_deep(b, 5, 0, 0.9, 0.9);
    dig_deep(b, 5, 0, 1.15, 1.15);
    dig_fit_restore(&again->fit);
    assert_true(again->fit.track.restored);
    for (int i = 0; i < 2; i++) {
        const struct dig_gravel_track *const k = &(i == 0 ? b : again)->fit.track;
        assert_close(k->made.depth, 1.15, 1e-9);
        assert_close(k->made.attack_rad, 0.02, 1e-9);
        assert_close(k->matched.depth, 1.15, 1e-9);
        assert_close(k->matched.attack_rad, 0.0, 1e-9);
    }
    bench_destroy(b);
    bench_destroy(again);
}

TESTS_WITH(scratch_setup, scratch_teardown)
