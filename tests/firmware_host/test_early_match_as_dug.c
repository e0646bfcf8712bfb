// Tests for what firmware_host/matching/early_match.c and fit.c make of a dig going on that is
// deeper than the table's: it is predicted as it is dug, or said to be off the table.

#include "firmware_host/matching/early_match.h"

#include "firmware_host/matching/fit.h"
#include "tests/testlib.h"
#include "tests/wires.h"

#include "tests/approach_table.h"

#include <math.h>
#include <stdlib.h>

#define TICK_NS 20000000LL

static const struct dig_approach cross[] = {
    { 0.8, 0.0 }, { 1.0, -5.0 * DIG_RAD_PER_DEG }, { 1.0, 5.0 * DIG_RAD_PER_DEG }, { 1.2, 0.0 }
};

enum { GRAVEL = 3, ACTUAL = 1 };

struct bench {
    struct dig_config      config;
    struct approach_table  table;
    struct wires           wires;
    struct dig_early_match early;
    struct dig_fit         fit;
    int64_t                time_ns;
    uint32_t               digs;
};

// A bench on which the gravel is known from a plain simple dig.
static struct bench *bench_create(void)
{
    struct bench *const b = calloc(1, sizeof *b);
    assert_non_null(b);
    approach_table_init(&b->table, CUBE_GRAVELS, 4, cross, approach_growing, 0.05, 3);
    struct dig_curve_set *const set = &b->table.cube.set;
    b->config                       = wires_config();
    wires_init(&b->wires);
    wires_init_fit(&b->wires, &b->config, set, &b->early, &b->fit);

    struct dig_observation simple = { .dig_count = 1, .first = 0.0, .last = 1.0 };
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        simple.moment_Nm[k] = (double)b->table.cube.curve[(size_t)2 * GRAVEL].mean[0][k];
        simple.sigma_Nm[k]  = 0.005;
    }
    dig_fit_take(&b->fit, &simple);
    assert_true(b->fit.track.valid && b->fit.track.match.nearest == GRAVEL);
    assert_false(b->fit.basis_as_dug);
    b->digs = 1;
    return b;
}

static void bench_destroy(struct bench *const b)
{
    free(b->fit.matcher.memory);
    free(b);
}

// What a tick tells of the bucket at a pose of the rig.
static void tell(struct bench *const b, const struct dig_pose pose, const double moment_Nm,
                 const enum dig_dig_phase phase, const double progress)
{
    struct dig_estimate e = wires_estimate(b->time_ns += TICK_NS, pose, moment_Nm, phase);
    e.dig_count           = b->digs;
    if (progress > 0.1) {
        e.trajectory = ACTUAL;
        e.progress   = progress;
    }
    (void)dig_ring_push(&b->wires.handoffs.estimates, &e);
    (void)dig_fit_once(&b->fit);
}

// Air, then the actual dig made so, up to a progress along the plain one. The tick has no depth: it
// takes the legs behind the first for what they are.
static void dig_until(struct bench *const b, const struct dig_approach made, const double until)
{
    const struct dig_trajectory dug     = approach_dug(ACTUAL, made);
    const struct dig_trajectory plain   = approach_dug(ACTUAL, dig_approach_plain());
    const double                plain_m = dig_trajectory_path_m(&plain, 0.09, 1e3);
    const double                own_m   = dig_trajectory_path_m(&dug, 0.09, 1e3);
    const double                factor  = approach_growing(made.depth, made.attack_rad);
    double                      at      = 0.0;
    for (int i = 0; i < 20; i++) {
        tell(b, dig_trajectory_pose(&dug, 0.0), 0.0, DIG_PHASE_AIR, 0.0);
    }
    for (double rig_s = 0.0; at < until; rig_s += 1e-9 * TICK_NS / sqrt(WIRES_LAMBDA)) {
        at = 1.0 - (own_m - dig_trajectory_path_m(&dug, 0.09, rig_s)) / plain_m;
        tell(b, dig_trajectory_pose(&dug, rig_s), approach_moment_Nm(GRAVEL, ACTUAL, rig_s, factor),
             rig_s < 0.2 ? DIG_PHASE_CONTACT : DIG_PHASE_DIG, at);
    }
}

static void end_dig(struct bench *const b)
{
    const struct dig_trajectory plain = approach_dug(ACTUAL, dig_approach_plain());
    b->digs++;
    tell(b, dig_trajectory_pose(&plain, 1e3), 0.0, DIG_PHASE_AIR, 0.0);
}

static struct dig_expected offered(struct bench *const b)
{
    const struct dig_prediction_basis *const basis = dig_latest_look(&b->wires.handoffs.basis);
    assert_non_null(basis);
    assert_true(basis->known);
    return basis->forecast.expected[ACTUAL];
}

// rms of the offered curve less the moment of a dig made so, over what is ahead.
static double off_Nm(const struct dig_expected *const expected, const struct dig_approach made)
{
    const struct dig_trajectory plain = approach_dug(ACTUAL, dig_approach_plain());
    double                      sum   = 0.0;
    for (size_t k = 130; k < DIG_CURVE_POINTS; k++) {
        const double t_s = dig_trajectory_time_s(&plain, 0.09, (double)k / (DIG_CURVE_POINTS - 1));
        const double true_Nm =
            approach_moment_Nm(GRAVEL, ACTUAL, t_s, approach_growing(made.depth, made.attack_rad));
        sum += pow((double)expected->curve.mean[0][k] - true_Nm, 2.0);
    }
    return sqrt(sum / (DIG_CURVE_POINTS - 130));
}

TEST(a_deep_dig_is_predicted_as_it_is_dug_and_the_next_one_plainly)
{
    struct bench *const       b      = bench_create();
    const struct dig_approach deep   = { 1.15, 0.0 };
    const struct dig_approach plain  = dig_approach_plain();
    const struct dig_expected before = offered(b);
    dig_until(b, deep, 0.5);
    assert_true(b->fit.basis_as_dug);
    const struct dig_expected now = offered(b);
    assert_true(now.valid && !now.off_table);
    assert_true(off_Nm(&now, deep) < 0.4 * off_Nm(&before, deep));
    assert_true(now.peak_Nm > 1.1 * before.peak_Nm);
    assert_close(now.approach.depth, 1.15, 0.1); // each gravel begins to resist in a way of its own
    assert_true(dig_approach_is_plain(&before.approach));
    end_dig(b);
    assert_false(b->fit.basis_as_dug);
    const struct dig_expected after = offered(b);
    assert_close(off_Nm(&after, plain), off_Nm(&before, plain), 1e-9);
    assert_true(dig_approach_is_plain(&after.approach));
    bench_destroy(b);
}

TEST(a_dig_deeper_than_any_of_the_table_is_off_it)
{
    struct bench *const b = bench_create();
    dig_until(b, (struct dig_approach){ 1.6, 0.0 }, 0.5);
    const struct dig_expected now = offered(b);
    assert_true(now.off_table && !now.valid);
    end_dig(b);
    const struct dig_expected after = offered(b);
    assert_true(after.valid && !after.off_table);
    bench_destroy(b);
}
