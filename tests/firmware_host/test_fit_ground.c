// Tests for firmware_host/matching/fit.c: which digs are of one ground, to be matched together, and
// when what is known is known no longer.

#include "tests/firmware_host/fit_bench.h"

// Digs that identify nothing watch the ground: as predicted it is the same; two in a row that are
// not, and it counts as another.
TEST(ground_that_changed_is_no_longer_known)
{
    struct bench *const b = bench_of_two_digs();
    bench_dig(b, 3, 0, 1.0);
    assert_true(b->fit.track.valid);
    for (int i = 0; i < 5; i++) {
        bench_dig(b, 3, 1, 1.0);
        assert_true(b->fit.track.valid);
        assert_true(b->fit.track.drift < 1.0);
    }
    const double factor[] = { 1.5, 1.0, 1.5, 1.5 };
    for (int i = 0; i < 4; i++) {
        bench_dig(b, 3, 1, factor[i]);
        assert_true((b->fit.track.drift > 3.0) == (factor[i] > 1.0));
        assert_true(b->fit.track.valid == (i < 3));
    }
    const struct dig_prediction_basis *const basis = dig_latest_look(&b->wires.handoffs.basis);
    assert_non_null(basis);
    assert_false(basis->known);
    assert_true(basis->expires_ns > 0);
    struct dig_fit_result result;
    while (dig_ring_pop(&b->wires.handoffs.results, &result)) {
    }
    assert_false(result.track.valid);
    assert_string_equal(result.track.wanted, "the ground has changed: dig a simple dig");

    // A simple dig, and it is known again.
    bench_dig(b, 5, 0, 1.0);
    assert_true(b->fit.track.valid);
    assert_int_equal(b->fit.track.match.nearest, 5);
    free(b);
}

static double friction_width(const struct dig_match *const m)
{
    return m->high.value[DIG_AXIS_FRICTION] - m->low.value[DIG_AXIS_FRICTION];
}

// How far factor times a gravel is from what is predicted of it, in floors.
static double drift_of(struct bench *const b, const int gravel, const double factor)
{
    const struct dig_gravel_track before = b->fit.track;
    bench_dig(b, gravel, 1, factor);
    const double          drift = b->fit.track.drift;
    struct dig_fit_result result;
    b->fit.track = before;
    while (dig_ring_pop(&b->wires.handoffs.results, &result)) {
    }
    return drift;
}

TEST(simple_digs_of_one_ground_are_matched_together)
{
    struct bench *const b      = bench_create();
    double              before = INFINITY;
    for (int i = 1; i <= 10; i++) {
        bench_dig(b, 5, 0, i % 2 == 0 ? 1.01 : 0.99);
        const struct dig_match *const m    = &b->fit.track.match;
        const size_t                  digs = i < DIG_POOL_MAX ? (size_t)i : DIG_POOL_MAX;
        assert_int_equal(m->digs, digs);
        assert_int_equal(m->nearest, 5);
        assert_true(i > 4 || friction_width(m) < before);
        assert_true(isnan(b->fit.track.drift) == (i == 1));
        before = friction_width(m);
    }
    assert_int_equal(atomic_load(&b->fit.count.matches), 10);
    free(b);
}

// Of several that agreed, one that differs is doubted; the second, or one far off, begins anew.
TEST(a_simple_dig_that_differs_is_doubted_first)
{
    struct bench *const b = bench_of_two_digs();
    for (int i = 0; i < 3; i++) {
        bench_dig(b, 5, 0, 1.0);
    }
    double factor = 1.0;
    while (drift_of(b, 5, factor) < 4.0) {
        factor += 0.01;
    }
    assert_true(drift_of(b, 5, factor) < 6.0);
    struct dig_fit_result result;
    bench_dig(b, 5, 0, factor);
    while (dig_ring_pop(&b->wires.handoffs.results, &result)) {
    }
    assert_true(result.track.valid);
    assert_int_equal(result.track.match.digs, 3);
    assert_true(result.track.drift > 3.0);
    assert_string_equal(result.track.wanted,
                        "a simple dig differed from those before: dig another");
    bench_dig(b, 5, 0, 1.0);
    assert_int_equal(b->fit.track.match.digs, 4);
    assert_string_equal(b->fit.track.wanted, "");

    bench_dig(b, 5, 0, factor);
    assert_int_equal(b->fit.track.match.digs, 4);
    bench_dig(b, 5, 0, factor);
    assert_int_equal(b->fit.track.match.digs, 1);
    assert_true(isnan(b->fit.track.drift));
    assert_int_equal(b->fit.pool.digs, 1);
    assert_close(b->fit.pool.dig[0].moment_Nm[100], factor * bench_moment_Nm(5, 100), 1e-12);

    // Of one against one the younger counts; and so does one that is far off.
    bench_dig(b, 5, 0, 1.0);
    bench_dig(b, 5, 0, 1.0);
    bench_dig(b, 5, 0, 1.0);
    assert_true(b->fit.track.match.digs >= 2);
    bench_dig(b, 0, 0, 0.5);
    assert_int_equal(b->fit.track.match.digs, 1);
    free(b);
}

TEST(a_ground_given_up_is_not_matched_with_the_next)
{
    struct bench *const b = bench_of_two_digs();
    bench_dig(b, 5, 0, 1.0);
    bench_dig(b, 5, 0, 1.0);
    bench_dig(b, 5, 1, 2.0);
    bench_dig(b, 5, 1, 2.0);
    assert_false(b->fit.track.valid);
    bench_dig(b, 5, 0, 1.0);
    assert_true(b->fit.track.valid);
    assert_int_equal(b->fit.track.match.digs, 1);
    free(b);
}

TEST(a_gravel_that_is_too_old_is_no_longer_known)
{
    struct bench *const b = bench_create();
    bench_dig(b, 3, 0, 1.0);
    assert_false(dig_fit_once(&b->fit));
    assert_true(b->fit.track.valid);
    (void)dig_latest_look(&b->wires.handoffs.basis);
    b->fit.track.expires_ns -= dig_ns(b->fit.track_settings.expires_s);
    assert_false(dig_fit_once(&b->fit));
    assert_false(b->fit.track.valid);
    const struct dig_prediction_basis *const basis = dig_latest_look(&b->wires.handoffs.basis);
    assert_non_null(basis);
    assert_false(basis->known);
    free(b);
}
