// Tests for estimator/estimator.c: whole digs, from pressures to prediction.

#include "estimator/estimator.h"

#include "core/units.h"
#include "estimator/estimator_state.h"
#include "estimator/match.h"
#include "estimator/shadow.h"
#include "tests/made_table.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

// Counts allocations by standing in front of the C library's, which a sanitizer does already.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define COUNTS_ALLOCATIONS 0
static const size_t allocations = 0;
#else
#define COUNTS_ALLOCATIONS 1
static size_t allocations = 0;

void *__libc_malloc(size_t size);                // NOLINT: glibc's own names
void *__libc_calloc(size_t count, size_t size);  // NOLINT
void *__libc_realloc(void *memory, size_t size); // NOLINT

void *malloc(const size_t size)
{
    allocations++;
    return __libc_malloc(size);
}

void *calloc(const size_t count, const size_t size)
{
    allocations++;
    return __libc_calloc(count, size);
}

void *realloc(void *const memory, const size_t size)
{
    allocations++;
    return __libc_realloc(memory, size);
}
#endif

static const double lambda      = 10.0;
static const double tick_s      = 0.005;
static const double rig_tooth_m = 0.09;

static const struct made_options plain  = { .relative_sd = 0.1, .packings = 3 };
static const struct dig_gravel   gravel = { { 0.6, 0.5, 2500 } };

// How a dig is driven.
struct drive {
    enum made_trajectory which;
    double               stretch; // 2: half as fast as Froude has it
    double               pause_s; // machine time stood still at 45 % of the way
    double   back_s;   // rig time driven backwards at 60 % of the way, then again forwards
    double   until;    // progress at which the bucket is lifted out
    double   carry_Nm; // moment of the load afterwards
    double   drop;     // share of samples that arrive incomplete
    bool     sensors;  // the ZX200's steps and noise
    uint64_t seed;
};

static const struct drive calm = {
    .which = MADE_SIMPLE_A, .stretch = 1.0, .until = 1.0, .seed = 1
};

// One machine, one table, one estimator, and the digs driven through it.
struct bench {
    struct dig_machine     machine;
    struct dig_curve_set  *set;
    struct dig_estimator  *estimator;
    struct dig_raw        *spare; // NULL: digs are observed in the tick
    bool                   keeps; // does not give a finished dig back
    double                 time_s;
    size_t                 observations, steps_with_allocation;
    struct dig_shadow     *shadow; // NULL: none follows
    struct dig_observation observation;
    struct dig_estimate    estimate;
    // of the dig driven last
    struct dig_observation early[4]; // what the shadow saw at these progresses
    int                    earlies;
    int                    known_at_end;   // trajectory as it was told just before the end
    double                 known_from;     // true progress from which on it was told, and rightly
    double                 worst_progress; // largest error of progress from then on
    size_t                 predictions;
    double                 worst_prediction; // largest relative error ahead of the bucket
};

static struct bench *bench_create(const bool sensors)
{
    struct bench *const b = calloc(1, sizeof *b);
    b->machine            = model_machine();
    if (sensors) {
        b->machine.pressure_step_Pa = 2e5;
        b->machine.angle_step_rad   = 4e-4;
        b->machine.angle_sigma_rad  = 2e-4;
    }
    for (int j = 0; j < DIG_JOINTS; j++) {
        b->machine.cylinder[j].pressure_sigma_Pa = 5e4;
    }
    b->set                                       = made_table(&plain);
    b->estimator                                 = malloc(dig_estimator_size());
    const struct dig_estimator_settings settings = dig_estimator_settings_default();
    assert_int_equal(dig_estimator_init(b->estimator, &b->machine, b->set, &settings), DIG_OK);
    return b;
}

static void bench_destroy(struct bench *const b)
{
    made_table_destroy(b->set);
    free(b->estimator);
    free(b->spare);
    free(b->shadow);
    free(b);
}

// The dig that ended in this tick: observed in the tick, or handed out raw and observed beside it.
static bool take(struct bench *const b)
{
    if (b->spare == NULL) {
        return dig_estimator_take_dig(b->estimator, &b->observation);
    }
    struct dig_raw *const raw = dig_estimator_take_raw(b->estimator);
    if (raw == NULL) {
        return false;
    }
    assert_false(dig_estimator_take_dig(b->estimator, &b->observation));
    const struct dig_estimator_settings settings = dig_estimator_settings_default();
    const bool any = dig_raw_observe(b->set, &settings, raw, &b->observation) == DIG_OK;
    if (!b->keeps) {
        dig_estimator_lend(b->estimator, raw);
    }
    return any;
}

// The bucket at a rig pose, shifted up out of the ground, with the soil's moment; one tick.
static void tick(struct bench *const b, const struct dig_pose pose, const double up_m,
                 const double moment_Nm, const double drop, uint64_t *const seed)
{
    const double X_m = 7.9 - lambda * pose.x_m;
    const double Z_m = -2.75 + lambda * (pose.z_m + up_m);
    double       joint_rad[DIG_JOINTS];
    model_joints(&b->machine, X_m, Z_m, -0.5 * DIG_PI - pose.theta_rad, joint_rad);

    // Forces are those of the family: Fx -8, Fz 5 per Nm, both at rig scale.
    const struct model_load load = { .FX_N = 8.0 * moment_Nm / lambda,
                                     .FZ_N = 5.0 * moment_Nm / lambda,
                                     .M_Nm = moment_Nm };
    b->time_s += tick_s;
    struct dig_sample sample =
        model_sample(&b->machine, joint_rad, 0.0, &load, 0.95e6, (int64_t)(1e9 * b->time_s));
    if (b->machine.pressure_step_Pa > 0.0) {
        model_sense(&b->machine, &sample, seed);
    }
    const bool dropped = model_uniform(seed) < drop;
    if (dropped) {
        sample.valid[DIG_SIGNAL_BUCKET_HEAD_Pa] = false;
    }

    const size_t          before = allocations;
    const enum dig_status status = dig_estimator_step(b->estimator, &sample, &b->estimate);
    const bool            taken  = take(b);
    assert_int_equal(status, dropped ? DIG_ESTALE : DIG_OK);
    b->steps_with_allocation += allocations != before ? 1 : 0;
    b->observations += taken ? 1 : 0;
    if (b->shadow != NULL && !dropped) {
        dig_shadow_take(b->shadow, b->set, lambda, &b->estimate);
        assert_true(b->shadow->on ==
                    (!dig_estimator_is_idle(b->estimator) && b->estimate.phase != DIG_PHASE_AIR));
    }
}

static void look_ahead(struct bench *const b, const struct drive *const drive,
                       const double progress)
{
    if (b->estimate.trajectory < 0) {
        return;
    }
    b->known_at_end = b->estimate.trajectory;
    if (b->estimate.trajectory != (int)drive->which) {
        return;
    }
    b->known_from = isnan(b->known_from) ? progress : b->known_from;

    // On the first leg contact is all there is to tell the start by; its end tells the rest.
    if (progress > 0.4) {
        b->worst_progress = fmax(b->worst_progress, fabs(b->estimate.progress - progress));
    }

    struct dig_prediction p;
    const size_t          before = allocations;
    dig_estimator_predict(b->estimator, &p);
    b->steps_with_allocation += allocations != before ? 1 : 0;
    if (!p.valid) {
        return;
    }
    b->predictions++;
    double miss = 0.0, whole = 0.0;
    for (int i = 0; i < DIG_PREDICTION_POINTS; i++) {
        const double at =
            p.from_progress + (p.to_progress - p.from_progress) * i / (DIG_PREDICTION_POINTS - 1);
        const double truth_Nm = 1e4 * made_moment_Nm(&gravel, drive->which, at, 0.0);
        miss += pow(p.moment_Nm[i] - truth_Nm, 2.0);
        whole += truth_Nm * truth_Nm;
    }
    if (p.from_progress < 0.9) {
        b->worst_prediction = fmax(b->worst_prediction, sqrt(miss / whole));
    }
}

static void dig(struct bench *const b, struct drive drive)
{
    const struct dig_trajectory t          = made_trajectory(drive.which);
    const double                whole_m    = dig_trajectory_path_m(&t, rig_tooth_m, 1e3);
    const double                duration_s = dig_trajectory_duration_s(&t);
    const struct dig_pose       start      = dig_trajectory_pose(&t, 0.0);
    static const double         look_at[]  = { 0.3, 0.45, 0.6, 0.9 };
    b->earlies                             = 0;
    b->known_from                          = (double)NAN;
    b->known_at_end                        = -1;
    b->worst_progress                      = 0.0;
    b->worst_prediction                    = 0.0;
    b->predictions                         = 0;

    // Down through the air, turning a little.
    for (double left = 1.0; left > 0.0; left -= tick_s / 2.5) {
        struct dig_pose pose = start;
        pose.theta_rad -= 0.1 * left;
        pose.x_m -= 0.01 * left;
        tick(b, pose, 0.03 * left, 0.0, drive.drop, &drive.seed);
    }
    double rig_s = 0.0, paused_s = 0.0, backed_s = 0.0, progress = 0.0;
    while (rig_s < duration_s && progress < drive.until) {
        progress               = dig_trajectory_path_m(&t, rig_tooth_m, rig_s) / whole_m;
        const double moment_Nm = 1e4 * made_moment_Nm(&gravel, drive.which, progress, 0.0);
        tick(b, dig_trajectory_pose(&t, rig_s), 0.0, moment_Nm, drive.drop, &drive.seed);
        look_ahead(b, &drive, progress);
        if (b->shadow != NULL && b->earlies < 4 && progress >= look_at[b->earlies]) {
            const struct dig_estimator_settings settings = dig_estimator_settings_default();
            struct dig_raw *const               scratch  = calloc(1, sizeof *scratch);
            struct dig_observation *const       early    = &b->early[b->earlies++];
            if (dig_shadow_observe(b->set, &settings, b->shadow, scratch, early) != DIG_OK) {
                early->trajectory = -1;
            }
            free(scratch);
        }
        if (progress > 0.45 && paused_s < drive.pause_s) {
            paused_s += tick_s;
        } else if (progress > 0.6 && backed_s <= 0.0 && drive.back_s > 0.0) {
            while (backed_s < drive.back_s) { // the soil does not push back
                backed_s += tick_s / sqrt(lambda);
                tick(b, dig_trajectory_pose(&t, rig_s - backed_s), 0.0, 500.0, drive.drop,
                     &drive.seed);
            }
            rig_s -= backed_s;
        } else {
            rig_s += tick_s / sqrt(lambda) / drive.stretch;
        }
    }
    const struct dig_pose last = dig_trajectory_pose(&t, rig_s);
    for (double up = 0.0; up < 1.0; up += tick_s / 4.0) {
        tick(b, last, 0.04 * up, drive.carry_Nm, drive.drop, &drive.seed);
    }
    for (double down = 1.0; down > 0.0; down -= tick_s / 4.0) {
        tick(b, last, 0.04, drive.carry_Nm * fmax(2.0 * down - 1.0, 0.0), drive.drop, &drive.seed);
    }
}

// The family's moment as the paper smooths it: the mean over +-0.16 s of rig time, here by brute
// force, over the part of the window the dig covers. A dig driven slower covers less path
// meanwhile.
static double smoothed_Nm(const enum made_trajectory which, const double progress,
                          const double stretch, const double until)
{
    enum { POINTS = 200 };
    const struct dig_trajectory t       = made_trajectory(which);
    const double                whole_m = dig_trajectory_path_m(&t, rig_tooth_m, 1e3);
    const double                at_s    = dig_trajectory_time_s(&t, rig_tooth_m, progress);
    const double                from_s  = fmax(at_s - DIG_SMOOTH_HALF_s / stretch, 0.0);
    const double                end_s   = dig_trajectory_time_s(&t, rig_tooth_m, until);
    const double                to_s    = fmin(at_s + DIG_SMOOTH_HALF_s / stretch, end_s);
    double                      sum_Nm  = 0.0;
    for (int i = 0; i < POINTS; i++) {
        const double s = from_s + (to_s - from_s) * (i + 0.5) / POINTS;
        sum_Nm += made_moment_Nm(&gravel, which,
                                 dig_trajectory_path_m(&t, rig_tooth_m, s) / whole_m, 0.0);
    }
    return sum_Nm / POINTS;
}

// Relative distance of the observation from that over the points measured.
static double observation_error(const struct bench *const b, const double stretch,
                                const double until)
{
    double miss = 0.0, whole = 0.0;
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = k / 255.0;
        if (at >= b->observation.first && at <= b->observation.last) {
            const double truth =
                smoothed_Nm((enum made_trajectory)b->observation.trajectory, at, stretch, until);
            miss += pow(b->observation.moment_Nm[k] - truth, 2.0);
            whole += truth * truth;
        }
    }
    return sqrt(miss / whole);
}

// The family's forces are -8 and 5 times its moment; so must those observed be, everywhere.
static double worst_force(const struct bench *const b)
{
    static const double by[]  = { -8.0, 5.0 };
    double              worst = 0.0;
    for (int c = 0; c < 2; c++) {
        double largest = 0.0, off = 0.0;
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            const double expected_N = by[c] * b->observation.moment_Nm[k];
            largest                 = fmax(largest, fabs(expected_N));
            off                     = fmax(off, fabs(b->observation.force_N[c][k] - expected_N));
        }
        worst = fmax(worst, off / largest);
    }
    return worst;
}

static void every_kind_of_dig_is_observed_as_it_was(void **state)
{
    (void)state;
    const struct {
        const char  *name;
        struct drive drive;
        double       error;
    } cases[] = {
        { "simpleA", calm, 0.03 },
        { "simpleB", { .which = MADE_SIMPLE_B, .stretch = 1, .until = 1, .seed = 1 }, 0.03 },
        { "actual", { .which = MADE_ACTUAL, .stretch = 1, .until = 1, .seed = 1 }, 0.03 },
        { "slow", { .which = MADE_SIMPLE_A, .stretch = 2.5, .until = 1, .seed = 1 }, 0.03 },
        { "fast", { .which = MADE_ACTUAL, .stretch = 0.6, .until = 1, .seed = 1 }, 0.03 },
        { "paused",
          { .which = MADE_SIMPLE_A, .stretch = 1, .pause_s = 8, .until = 1, .seed = 1 },
          0.03 },
        { "stepped back",
          { .which = MADE_ACTUAL, .stretch = 1, .back_s = 0.2, .until = 1, .seed = 1 },
          0.07 }, // what was not felt while it went back is within the smoothing
        { "sensors",
          { .which = MADE_SIMPLE_A, .stretch = 1, .until = 1, .sensors = true, .seed = 2 },
          0.04 },
        { "all of it",
          { .which   = MADE_ACTUAL,
            .stretch = 1.7,
            .pause_s = 3,
            .until   = 1,
            .drop    = 0.2,
            .sensors = true,
            .seed    = 3 },
          0.03 },
        { "broken off", { .which = MADE_SIMPLE_A, .stretch = 1, .until = 0.7, .seed = 1 }, 0.03 },
    };
    // simpleB and actual are one until the first turns on (40 % of its way is the shared turn) and
    // the other drags.
    const double known_before[MADE_TRAJECTORIES] = { 0.2, 0.75, 0.35 };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct bench *const b = bench_create(cases[i].drive.sensors);
        dig(b, cases[i].drive);
        const double error = observation_error(b, cases[i].drive.stretch, cases[i].drive.until);
        print_message("%-12s: error %.4f, off path %.2f mm, %.3f to %.3f, known from %.3f, "
                      "progress within %.3f\n",
                      cases[i].name, error, 1e3 * b->observation.off_path_m, b->observation.first,
                      b->observation.last, b->known_from, b->worst_progress);
        assert_int_equal(b->observations, 1);
        assert_int_equal(b->observation.trajectory, cases[i].drive.which);
        assert_int_equal(b->observation.dig_count, 1);
        assert_true(error < cases[i].error);
        print_message("              forces within %.4f\n", worst_force(b));
        assert_true(b->observation.forces);
        assert_true(worst_force(b) < (cases[i].drive.sensors ? 0.1 : 0.001));
        assert_close(b->observation.first, 0.0, 0.0);
        assert_close(b->observation.last, cases[i].drive.until, 0.03);
        assert_true(b->observation.off_path_m < 0.001);
        assert_int_equal(b->known_at_end, cases[i].drive.which);
        assert_true(b->known_from < known_before[cases[i].drive.which]);
        assert_true(b->worst_progress < 0.03);
        bench_destroy(b);
    }
}

// What a dig looked like before it was over is what it turns out to have been, as far as it was
// dug; never a progress that no sample after it had smoothed. Which dig it is may not be known yet.
static void a_dig_going_on_is_observed_as_it_will_have_been(void **state)
{
    (void)state;
    const struct {
        struct drive drive;
        int          known_from;
    } cases[] = {
        { calm, 0 },
        { { .which = MADE_SIMPLE_A, .stretch = 2.5, .pause_s = 8, .until = 1, .seed = 1 }, 0 },
        { { .which   = MADE_ACTUAL,
            .stretch = 1.7,
            .pause_s = 3,
            .until   = 1,
            .drop    = 0.2,
            .sensors = true,
            .seed    = 3 },
          1 },
        { { .which = MADE_SIMPLE_B, .stretch = 1, .until = 1, .sensors = true, .seed = 1 }, 3 },
    };
    static const double share[] = { 0.3, 0.45, 0.6, 0.9 };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct drive *const drive = &cases[i].drive;
        struct bench *const       b     = bench_create(drive->sensors);
        b->shadow                       = calloc(1, sizeof *b->shadow);
        dig_shadow_forget(b->shadow, b->set);
        dig(b, *drive);
        assert_int_equal(b->observations, 1);
        assert_int_equal(b->earlies, 4);
        assert_false(b->shadow->on);
        for (int s = 0; s < 4; s++) {
            const struct dig_observation *const o = &b->early[s];
            if (s < cases[i].known_from) {
                continue;
            }
            assert_int_equal(o->trajectory, (int)drive->which);
            assert_int_equal(o->dig_count, 1);
            const struct dig_trajectory t = made_trajectory(drive->which);
            const double                half =
                share[s] - dig_trajectory_path_m(&t, rig_tooth_m,
                                                 dig_trajectory_time_s(&t, rig_tooth_m, share[s]) -
                                                     DIG_SMOOTH_HALF_s / drive->stretch) /
                               dig_trajectory_path_m(&t, rig_tooth_m, 1e3);
            print_message("case %zu, %.2f of the path: %.3f to %.3f, half a window is %.3f\n", i,
                          share[s], o->first, o->last, half);
            assert_true(o->last <= share[s] - half + 0.01 && o->last > share[s] - half - 0.03);
            double miss2 = 0.0, whole2 = 0.0;
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                if (k / 255.0 >= o->first && k / 255.0 <= o->last) {
                    miss2 += pow(o->moment_Nm[k] - b->observation.moment_Nm[k], 2.0);
                    whole2 += pow(b->observation.moment_Nm[k], 2.0);
                }
            }
            print_message("    off what it turned out to be by %.4f\n", sqrt(miss2 / whole2));
            assert_true(sqrt(miss2 / whole2) < 0.02);
        }
        bench_destroy(b);
    }
}

// The main job: one simple dig identifies, the actual dig is predicted ahead of the bucket.
static void a_simple_dig_predicts_the_actual_one(void **state)
{
    (void)state;
    struct bench *const b = bench_create(true);
    dig(b, (struct drive){ .which = MADE_SIMPLE_A, .stretch = 1, .until = 1, .seed = 5 });
    assert_int_equal(b->observations, 1);
    assert_int_equal(b->predictions, 0); // nothing is known yet

    struct dig_match match;
    assert_int_equal(dig_match_nearest(b->set, &b->observation, 2.5, &match), DIG_OK);
    assert_int_equal(dig_fit_refine(b->set, &b->observation, 500, &match), DIG_OK);
    assert_false(match.outside);
    const size_t before = allocations;
    dig_estimator_give_match(b->estimator, &match);
    assert_int_equal(allocations, before);

    dig(b, (struct drive){ .which = MADE_ACTUAL, .stretch = 1, .until = 1, .seed = 6 });
    assert_int_equal(b->observations, 2);
    assert_true(b->predictions > 1000);
    print_message("predicted ahead within %.3f\n", b->worst_prediction);
    assert_true(b->worst_prediction < 0.1);

    // Before a dig begins, each trajectory can be asked for whole.
    struct dig_prediction whole;
    dig_estimator_predict_whole(b->estimator, MADE_ACTUAL, &whole);
    assert_true(whole.valid);
    assert_close(whole.from_progress, 0.0, 0.0);
    for (int i = 0; i < DIG_PREDICTION_POINTS; i++) {
        const double at       = (double)i / (DIG_PREDICTION_POINTS - 1);
        const double truth_Nm = 1e4 * made_moment_Nm(&gravel, MADE_ACTUAL, at, 0.0);
        assert_close(whole.moment_Nm[i], truth_Nm, 0.05 * truth_Nm + 1.0);
        assert_true(whole.sigma_Nm[i] >= 0.09 * truth_Nm);
    }
    dig_estimator_predict_whole(b->estimator, MADE_TRAJECTORIES, &whole);
    assert_false(whole.valid);
    dig_estimator_predict_whole(b->estimator, -1, &whole);
    assert_false(whole.valid);

    // A match that is none takes the prediction back.
    match.valid = false;
    dig_estimator_give_match(b->estimator, &match);
    dig(b, (struct drive){ .which = MADE_ACTUAL, .stretch = 1, .until = 1, .seed = 7 });
    assert_int_equal(b->predictions, 0);
    bench_destroy(b);
}

static void a_load_carried_away_is_no_second_dig(void **state)
{
    (void)state;
    struct bench *const b = bench_create(true);
    dig(b, (struct drive){
               .which = MADE_ACTUAL, .stretch = 1, .until = 1, .carry_Nm = 4e3, .seed = 5 });
    assert_int_equal(b->observations, 1);
    assert_int_equal(b->estimate.dig_count, 1);
    assert_int_equal(b->estimate.phase, DIG_PHASE_AIR);
    assert_int_equal(b->estimate.trajectory, -1);
    bench_destroy(b);
}

static void a_scrape_is_counted_but_not_matched(void **state)
{
    (void)state;
    struct bench *const   b     = bench_create(false);
    const struct dig_pose level = { 0.1, 0.18, 1.2 }; // curled in, none of the trajectories
    uint64_t              seed  = 4;
    for (int i = 0; i < 3000; i++) {
        struct dig_pose pose = level;
        pose.x_m += 1e-5 * i;
        tick(b, pose, 0.0, i > 500 && i < 2000 ? 8e3 : 0.0, 0.0, &seed);
        assert_int_equal(b->estimate.trajectory, -1);
    }
    assert_int_equal(b->estimate.dig_count, 1);
    assert_int_equal(b->observations, 0);
    bench_destroy(b);
}

static void no_tick_allocates(void **state)
{
    (void)state;
    if (!COUNTS_ALLOCATIONS) {
        print_message("SKIP: a sanitizer owns malloc, allocations are counted without it\n");
        skip();
    }
    const size_t before = allocations;
    free(malloc(1)); // the count itself works
    assert_true(allocations > before);

    struct bench *const b = bench_create(true);
    dig(b, (struct drive){ .which = MADE_ACTUAL, .stretch = 4, .until = 1, .seed = 5 });
    assert_int_equal(b->observations, 1);
    assert_int_equal(b->steps_with_allocation, 0);
    bench_destroy(b);
}

// Slower than the window holds: every other sample is kept, and again.
static void a_dig_longer_than_the_window_is_still_observed(void **state)
{
    (void)state;
    struct bench *const b = bench_create(false);
    dig(b, (struct drive){ .which = MADE_SIMPLE_A, .stretch = 24, .until = 1, .seed = 5 });
    assert_int_equal(b->observations, 1);
    assert_true(observation_error(b, 24.0, 1.0) < 0.01);
    bench_destroy(b);
}

// Handed out raw and observed beside the tick, every dig is what it was within.
static void a_dig_handed_out_raw_is_observed_the_same(void **state)
{
    (void)state;
    const struct drive drives[] = {
        { .which = MADE_SIMPLE_A, .stretch = 1, .until = 1, .sensors = true, .seed = 2 },
        { .which = MADE_ACTUAL, .stretch = 1, .until = 1, .sensors = true, .seed = 3 },
        { .which = MADE_SIMPLE_A, .stretch = 1, .until = 0.7, .sensors = true, .seed = 4 },
    };
    struct bench *const inside = bench_create(true), *const beside = bench_create(true);
    beside->spare = calloc(1, dig_raw_size());
    assert_non_null(beside->spare);
    dig_estimator_lend(beside->estimator, beside->spare);
    for (size_t i = 0; i < sizeof drives / sizeof drives[0]; i++) {
        dig(inside, drives[i]);
        dig(beside, drives[i]);
        assert_int_equal(beside->observations, i + 1);
        assert_memory_equal(&inside->observation, &beside->observation, sizeof inside->observation);
    }
    assert_int_equal(dig_estimator_lost(beside->estimator), 0);
    assert_int_equal(beside->steps_with_allocation, 0);

    // The one who took the last dig keeps it: the next goes into no memory, and is counted.
    beside->keeps = true;
    dig(beside, drives[0]);
    dig(beside, drives[0]);
    assert_int_equal(beside->observations, 4);
    assert_int_equal(dig_estimator_lost(beside->estimator), 1);
    bench_destroy(inside);
    // The last raw dig taken is one of the estimator's own or the spare: both are freed.
    bench_destroy(beside);
}

static void bad_samples_are_refused_and_change_nothing(void **state)
{
    (void)state;
    struct bench *const     b           = bench_create(false);
    const double            joint_rad[] = { 0.2, -1.2, -0.7 };
    const struct model_load load        = { 1e3, 2e3, 1e4 };
    const struct dig_sample good =
        model_sample(&b->machine, joint_rad, 0.0, &load, 1e6, 1000000000);
    struct dig_estimate estimate;
    assert_int_equal(dig_estimator_step(b->estimator, &good, &estimate), DIG_OK);
    assert_close(estimate.wrench.My_Nm, 1e4, 0.05);

    struct dig_estimator *const copy = malloc(dig_estimator_size());
    struct dig_estimate         before;
    memcpy(copy, b->estimator, dig_estimator_size());
    before                   = estimate;
    struct dig_sample bad[4] = { good, good, good, good };
    for (int i = 0; i < 4; i++) {
        bad[i].time_ns += 5000000;
    }
    bad[0].time_ns                         = good.time_ns; // twice the same
    bad[1].time_ns                         = good.time_ns - 1;
    bad[2].valid[DIG_SIGNAL_BOOM_rad]      = false;
    bad[3].value[DIG_SIGNAL_BUCKET_ROD_Pa] = NAN;
    assert_int_equal(dig_estimator_step(b->estimator, &bad[0], &estimate), DIG_ESTALE);
    assert_int_equal(dig_estimator_step(b->estimator, &bad[1], &estimate), DIG_ESTALE);
    assert_int_equal(dig_estimator_step(b->estimator, &bad[2], &estimate), DIG_ESTALE);
    assert_int_equal(dig_estimator_step(b->estimator, &bad[3], &estimate), DIG_EINVAL);
    assert_true(estimate.time_ns == before.time_ns && estimate.phase == before.phase);
    assert_close(estimate.wrench.My_Nm, before.wrench.My_Nm, 0.0);
    assert_close(estimate.wrench.sigma_Fz_N, before.wrench.sigma_Fz_N, 0.0);
    assert_close(estimate.pin_Z_m, before.pin_Z_m, 0.0);
    assert_memory_equal(b->estimator, copy, dig_estimator_size());
    free(copy);
    bench_destroy(b);
}

// Samples no machine could give, wandering and jumping: nothing that is no number comes out, and a
// good dig afterwards is observed as if nothing had been.
static void whatever_comes_in_only_numbers_go_out(void **state)
{
    (void)state;
    struct bench *const b      = bench_create(true);
    uint64_t            seed   = 31;
    struct dig_sample   sample = { .time_ns = 1 };
    for (int s = 0; s < DIG_SIGNALS; s++) {
        sample.valid[s] = true;
    }
    const int samples = getenv("DIG_TEST_QUICK") != NULL ? 20000 : 200000;
    for (int i = 0; i < samples; i++) {
        sample.time_ns += model_uniform(&seed) < 0.001 ? 60000000000 : 5000000;
        for (int s = 0; s < DIG_SIGNALS_NEEDED; s++) {
            const bool   angle = s < DIG_SIGNAL_BOOM_HEAD_Pa;
            const double step  = (angle ? 0.01 : 1e5) * model_normal(&seed);
            const bool   jump  = model_uniform(&seed) < 2e-4;
            const double most  = angle ? 3.0 : 4e7;
            sample.value[s] =
                jump ? most * (2.0 * model_uniform(&seed) - 1.0) : sample.value[s] + step;
            sample.value[s] = fmin(fmax(sample.value[s], angle ? -most : 0.0), most);
        }
        struct dig_estimate    e;
        struct dig_observation o;
        assert_int_equal(dig_estimator_step(b->estimator, &sample, &e), DIG_OK);
        assert_true(isfinite(e.wrench.My_Nm) && isfinite(e.wrench.sigma_My_Nm));
        assert_true(isfinite(e.wrench.Fx_N) && isfinite(e.wrench.sigma_Fx_N));
        assert_true(isfinite(e.pin_X_m) && isfinite(e.phi_rad));
        assert_true(e.trajectory < 0 || (e.progress >= 0.0 && e.progress <= 1.0));
        if (dig_estimator_take_dig(b->estimator, &o)) {
            for (int k = 0; k < DIG_CURVE_POINTS; k++) {
                assert_true(isfinite(o.moment_Nm[k]) && o.sigma_Nm[k] >= 0.0);
            }
        }
    }

    b->time_s = 1e-9 * (double)sample.time_ns;
    dig(b, (struct drive){ .which = MADE_SIMPLE_A, .stretch = 1, .until = 1, .seed = 5 });
    assert_int_equal(b->observations, 1);
    assert_true(observation_error(b, 1.0, 1.0) < 0.04);
    bench_destroy(b);
}

static void init_refuses_what_cannot_work_and_writes_nothing(void **state)
{
    (void)state;
    struct bench *const                 b    = bench_create(false);
    const struct dig_estimator_settings good = dig_estimator_settings_default();
    const size_t                        size = dig_estimator_size();
    unsigned char *const                raw  = malloc(size);
    memset(raw, 0x5a, size);
    struct dig_estimator *const e = (struct dig_estimator *)(void *)raw;

    struct dig_machine machine = b->machine;
    machine.link[0].length_m   = NAN;
    assert_int_equal(dig_estimator_init(e, &machine, b->set, &good), DIG_EINVAL);
    machine                 = b->machine;
    machine.four_bar.link_m = 0.2;
    assert_int_equal(dig_estimator_init(e, &machine, b->set, &good), DIG_EUNREACHABLE);
    struct dig_curve_set set = *b->set;
    set.tooth_m              = 0.0;
    assert_int_equal(dig_estimator_init(e, &b->machine, &set, &good), DIG_EINVAL);
    set                      = *b->set;
    set.trajectory[1].phases = 0;
    assert_int_equal(dig_estimator_init(e, &b->machine, &set, &good), DIG_EINVAL);

    struct dig_estimator_settings bad[] = { good, good, good, good, good, good, good };
    bad[0].tick_s                       = 0.0;
    bad[1].contact_sigmas               = NAN;
    bad[2].contact_hold_s               = -1.0;
    bad[3].exit_hold_s                  = 1e9;
    bad[4].air_bias_s                   = -0.1;
    bad[5].path_limit_m                 = 0.0;
    bad[6].outside_floors               = 0.5;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        const char *reason = NULL;
        assert_int_equal(dig_estimator_settings_check(&bad[i], &reason), DIG_EINVAL);
        assert_non_null(reason);
        assert_int_equal(dig_estimator_init(e, &b->machine, b->set, &bad[i]), DIG_EINVAL);
    }
    for (size_t i = 0; i < size; i++) {
        assert_int_equal(raw[i], 0x5a);
    }
    free(raw);
    bench_destroy(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_dig_is_observed_as_it_was),
        cmocka_unit_test(a_dig_going_on_is_observed_as_it_will_have_been),
        cmocka_unit_test(a_simple_dig_predicts_the_actual_one),
        cmocka_unit_test(a_load_carried_away_is_no_second_dig),
        cmocka_unit_test(a_scrape_is_counted_but_not_matched),
        cmocka_unit_test(no_tick_allocates),
        cmocka_unit_test(a_dig_handed_out_raw_is_observed_the_same),
        cmocka_unit_test(a_dig_longer_than_the_window_is_still_observed),
        cmocka_unit_test(bad_samples_are_refused_and_change_nothing),
        cmocka_unit_test(whatever_comes_in_only_numbers_go_out),
        cmocka_unit_test(init_refuses_what_cannot_work_and_writes_nothing),
    };
    return cmocka_run_group_tests_name("estimator", tests, NULL, NULL);
}
