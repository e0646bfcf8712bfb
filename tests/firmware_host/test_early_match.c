// Tests for firmware_host/matching/early_match.c, and for what the matcher makes of a dig that goes
// on

#include "firmware_host/matching/early_match.h"

#include "firmware_host/matching/fit.h"
#include "tests/made_table.h"
#include "tests/testlib.h"
#include "tests/wires.h"

#include <stdlib.h>
#include <string.h>

#define TICK_NS 20000000LL

static const struct made_options plain = { .relative_sd = 0.1, .packings = 5, .one_density = true };
static const struct dig_gravel   gravel = { { 0.6, 0.5, 2500 } };

struct bench {
    struct dig_config        config;
    struct dig_curve_set    *set;
    struct wires             wires;
    struct dig_recorded_dig *buffer;
    struct dig_early_match   early;
    struct dig_fit           fit;
    // what the tick would know
    int64_t                   time_ns;
    uint32_t                  digs_done;
    struct dig_live_recording live;
};

static struct bench *bench_create(void)
{
    struct bench *const b = calloc(1, sizeof *b);
    assert_non_null(b);
    b->set    = made_table(&plain);
    b->buffer = calloc(1, sizeof *b->buffer);
    b->config = wires_config();
    wires_init(&b->wires);
    wires_init_fit(&b->wires, &b->config, b->set, &b->early, &b->fit);
    dig_live_recording_clear(&b->live, b->set);
    return b;
}

static void bench_destroy(struct bench *const b)
{
    made_table_destroy(b->set);
    free(b->buffer);
    free(b);
}

// What a tick tells of the bucket at a pose of the rig.
static void tell(struct bench *const b, const struct dig_pose pose, const double moment_Nm,
                 const enum dig_dig_phase phase, const int trajectory, const double progress)
{
    struct dig_estimate e = wires_estimate(b->time_ns += TICK_NS, pose, moment_Nm, phase);
    e.dig_count           = b->digs_done;
    e.trajectory          = trajectory;
    e.progress            = progress;
    dig_live_recording_add(&b->live, b->set, WIRES_LAMBDA, &e);
    (void)dig_ring_push(&b->wires.handoffs.estimates, &e);
    (void)dig_fit_once(&b->fit);
}

// Air, then a dig up to a progress; samples between gap and gap + 0.1 do not come.
static void dig_until(struct bench *const b, const enum made_trajectory which, const double until,
                      const double gap)
{
    const struct dig_trajectory t        = made_trajectory(which);
    const double                whole_m  = dig_trajectory_path_m(&t, 0.09, 1e3);
    double                      progress = 0.0;
    for (int i = 0; i < 20; i++) {
        tell(b, dig_trajectory_pose(&t, 0.0), 0.0, DIG_PHASE_AIR, -1, (double)NAN);
    }
    for (double rig_s = 0.0; progress < until; rig_s += 1e-9 * TICK_NS / sqrt(WIRES_LAMBDA)) {
        progress = dig_trajectory_path_m(&t, 0.09, rig_s) / whole_m;
        if (progress > gap && progress < gap + 0.1) {
            b->time_ns += TICK_NS;
            continue;
        }
        tell(b, dig_trajectory_pose(&t, rig_s), made_moment_Nm(&gravel, which, progress, 0.0),
             progress < 0.05 ? DIG_PHASE_CONTACT : DIG_PHASE_DIG, progress < 0.2 ? -1 : (int)which,
             progress < 0.2 ? (double)NAN : progress);
    }
}

// The dig ends: with what was recorded of it, or lost.
static void end_dig(struct bench *const b, const enum made_trajectory which, const bool recorded)
{
    const struct dig_trajectory t = made_trajectory(which);
    if (recorded) {
        *b->buffer           = b->live.recording;
        b->buffer->dig_count = b->digs_done + 1;
        (void)dig_ring_push(&b->wires.handoffs.digs, &b->buffer);
    }
    b->digs_done++;
    tell(b, dig_trajectory_pose(&t, 1e3), 0.0, DIG_PHASE_AIR, -1, (double)NAN);
}

static double friction_width(const struct dig_match *const m)
{
    return m->high.value[DIG_AXIS_FRICTION] - m->low.value[DIG_AXIS_FRICTION];
}

// Takes the results that wait; returns how many, the first and the last.
static int results(struct bench *const b, struct dig_gravel_track *const first,
                   struct dig_gravel_track *const last)
{
    int                   n = 0;
    struct dig_fit_result result;
    while (dig_ring_pop(&b->wires.handoffs.results, &result)) {
        *first = n == 0 ? result.track : *first;
        *last  = result.track;
        n++;
    }
    return n;
}

TEST(a_dig_is_matched_while_it_goes_on)
{
    struct bench *const     b = bench_create();
    struct dig_gravel_track first, last;
    dig_until(b, MADE_SIMPLE_A, 0.33, 2.0);
    assert_int_equal(results(b, &first, &last), 0);
    assert_null(dig_latest_look(&b->wires.handoffs.basis));
    dig_until(b, MADE_SIMPLE_A, 0.9, 2.0);
    const int n = results(b, &first, &last);
    assert_true(n >= 4 && n <= 6);
    assert_true(first.valid && first.going_on && last.valid && last.going_on);
    assert_true(first.path_measured >= 0.3 && first.path_measured < 0.4);
    assert_true(last.path_measured > 0.7 && last.path_measured < 0.9);
    assert_true(friction_width(&first.match) > 1.3 * friction_width(&last.match));
    assert_true(first.match.low.value[0] <= gravel.value[0] &&
                first.match.high.value[0] >= gravel.value[0]);
    assert_int_equal(first.match.dig_count, 1);
    assert_int_equal(first.match.digs, 1);
    assert_true(first.expires_ns - first.time_ns == 30000000000LL);

    // Nothing else is known: it is predicted from, but not kept.
    const struct dig_prediction_basis *const basis = dig_latest_look(&b->wires.handoffs.basis);
    assert_non_null(basis);
    assert_true(basis->known && basis->forecast.expected[MADE_ACTUAL].valid);
    assert_true(basis->expires_ns == last.expires_ns);
    assert_false(b->fit.track.any);
    assert_int_equal(atomic_load(&b->fit.count.matches), 0);
    bench_destroy(b);
}

TEST(the_whole_dig_takes_its_place)
{
    struct bench *const     b = bench_create();
    struct dig_gravel_track first, last;
    dig_until(b, MADE_SIMPLE_A, 1.0, 2.0);
    (void)results(b, &first, &last);

    // Until it is over no one says how it ended.
    struct dig_observation going_on;
    assert_int_equal(dig_live_recording_observe(b->set, &b->config.estimator, NULL, NULL, &b->live,
                                                b->buffer, &going_on),
                     DIG_OK);
    assert_true(going_on.last > 0.95);
    assert_int_equal(going_on.ending, DIG_ENDING_OPEN);

    end_dig(b, MADE_SIMPLE_A, true);
    assert_int_equal(results(b, &first, &last), 1);
    assert_true(last.valid && !last.going_on);
    assert_true(last.path_measured > 0.99);
    assert_false(b->early.provisional.any);
    assert_int_equal(atomic_load(&b->fit.count.matches), 1);
    assert_int_equal(last.ending, DIG_ENDING_WHOLE);
    assert_int_equal(atomic_load(&b->fit.count.whole), 1);
    bench_destroy(b);
}

TEST(a_dig_with_samples_missing_is_counted_as_unknown)
{
    struct bench *const b = bench_create();
    dig_until(b, MADE_SIMPLE_A, 1.0, 0.5);
    end_dig(b, MADE_SIMPLE_A, true);
    assert_int_equal(atomic_load(&b->fit.count.seen), 1);
    assert_int_equal(atomic_load(&b->fit.count.matches), 0);
    assert_int_equal(atomic_load(&b->fit.count.whole), 0);
    assert_int_equal(atomic_load(&b->fit.count.aborted), 0);
    assert_int_equal(atomic_load(&b->fit.count.unknown), 1);
    bench_destroy(b);
}

TEST(a_dig_broken_off_takes_it_back)
{
    struct bench *const b = bench_create();
    for (int lost = 0; lost < 2; lost++) {
        struct dig_gravel_track first, last;
        dig_until(b, MADE_SIMPLE_A, 0.5, 2.0);
        assert_true(results(b, &first, &last) > 0 && last.valid);
        end_dig(b, MADE_SIMPLE_A, lost == 0);
        assert_int_equal(results(b, &first, &last), 1);
        assert_true(!last.valid && !last.going_on);
        assert_string_equal(last.wanted, "the simple dig cannot be matched: dig a simple dig");
        const struct dig_prediction_basis *const basis = dig_latest_look(&b->wires.handoffs.basis);
        assert_non_null(basis);
        assert_false(basis->known);
        assert_false(b->fit.track.any);
        if (lost == 0) {
            struct dig_recorded_dig *buffer;
            assert_true(dig_ring_pop(&b->wires.handoffs.spares, &buffer));
        }
    }
    bench_destroy(b);
}

// Of what is known from a whole dig nothing changes.
TEST(what_is_known_is_still_predicted_from)
{
    struct bench *const     b = bench_create();
    struct dig_gravel_track first, last;
    dig_until(b, MADE_SIMPLE_A, 1.0, 2.0);
    end_dig(b, MADE_SIMPLE_A, true);
    const struct dig_gravel_track before = b->fit.track;
    assert_true(before.valid);
    (void)results(b, &first, &last);
    (void)dig_latest_look(&b->wires.handoffs.basis);

    dig_until(b, MADE_SIMPLE_A, 0.5, 2.0);
    assert_true(results(b, &first, &last) >= 1);
    assert_true(last.going_on && last.valid);
    assert_null(dig_latest_look(&b->wires.handoffs.basis));
    end_dig(b, MADE_SIMPLE_A, false);
    assert_int_equal(results(b, &first, &last), 1);
    assert_true(last.valid && !last.going_on && last.time_ns == before.time_ns);
    assert_memory_equal(&b->fit.track.match, &before.match, sizeof before.match);
    bench_destroy(b);
}

TEST(what_cannot_identify_is_not_looked_at)
{
    struct dig_gravel_track first, last;
    for (int c = 0; c < 3; c++) {
        struct bench *const b      = bench_create();
        b->config.match_early_path = c == 1 ? 1.0 : 0.3;
        dig_until(b, c == 0 ? MADE_ACTUAL : MADE_SIMPLE_A, 0.9, c == 2 ? 0.21 : 2.0);
        assert_int_equal(results(b, &first, &last), 0);
        bench_destroy(b);
    }
}
