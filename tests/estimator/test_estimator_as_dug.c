// Tests for estimator/estimator.c with a table dug at several depths and attacks: how a dig was
// made is told from what a machine measures of it, and beyond the table it is none of its digs.

#include "core/units.h"
#include "estimator/approach/approach_slots.h"
#include "estimator/approach/live_recording.h"
#include "estimator/match/depth.h"
#include "tests/testlib.h"
#include "tests/wires.h"

#include "tests/approach_table.h"

#include <stdlib.h>

#define TICK_NS 20000000LL

static const struct dig_approach cross[] = {
    { 0.8, 0.0 }, { 1.0, -5.0 * DIG_RAD_PER_DEG }, { 1.0, 5.0 * DIG_RAD_PER_DEG }, { 1.2, 0.0 }
};

// What is fitted to vertices is so far off the table: contact is noticed a few samples late.
static const double least_off_m = 1e-3;

struct bench {
    struct approach_table     table;
    struct dig_live_recording shadow;
    struct dig_recorded_dig   scratch;
    int64_t                   time_ns;
};

static struct bench *bench_create(void)
{
    struct bench *const b = calloc(1, sizeof *b);
    assert_non_null(b);
    approach_table_init(&b->table, CUBE_GRAVELS, 4, cross, approach_growing, 0.05, 3);
    dig_live_recording_clear(&b->shadow, &b->table.cube.set);
    return b;
}

static void tell(struct bench *const b, const struct dig_pose pose, const double moment_Nm,
                 const enum dig_dig_phase phase)
{
    const struct dig_estimate e = wires_estimate(b->time_ns += TICK_NS, pose, moment_Nm, phase);
    dig_live_recording_add(&b->shadow, &b->table.cube.set, WIRES_LAMBDA, &e);
}

// The bucket comes down along its first leg, as it goes on in the soil, and makes the dig.
static enum dig_status dig(struct bench *const b, const size_t t, const struct dig_approach made,
                           struct dig_observation *const seen)
{
    const struct dig_estimator_settings settings = dig_estimator_settings_default();
    const struct dig_trajectory         dug      = approach_dug(t, made);
    const double                        step_s   = 1e-9 * TICK_NS / sqrt(WIRES_LAMBDA);
    const double                        factor   = approach_growing(made.depth, made.attack_rad);
    struct dig_pose                     pose     = dig_trajectory_pose(&dug, 0.0);
    for (double before_s = 0.5; before_s > 0.0; before_s -= step_s) {
        struct dig_pose above = pose;
        above.x_m -= dug.phase[0].vx_mps * before_s;
        above.z_m -= dug.phase[0].vz_mps * before_s;
        tell(b, above, 0.0, DIG_PHASE_AIR);
    }
    for (double t_s = 0.0; t_s < dig_trajectory_duration_s(&dug); t_s += step_s) {
        tell(b, dig_trajectory_pose(&dug, t_s), approach_moment_Nm(3, t, t_s, factor),
             t_s < 0.1 ? DIG_PHASE_CONTACT : DIG_PHASE_DIG);
    }
    const struct dig_curve_set *const set = &b->table.cube.set;
    enum dig_status                   status =
        dig_live_recording_observe(set, &settings, NULL, NULL, &b->shadow, &b->scratch, seen);
    if (status == DIG_OK) {
        struct dig_approach_error error[2];
        void *const               memory = malloc(dig_depth_fit_size(set));
        dig_approach_error_measure(set, 0, &error[0]);
        dig_approach_error_measure(set, 1, &error[1]);
        status = dig_depth_fit(set, error, settings.path_limit_m, memory, seen);
        free(memory);
    }
    return status;
}

TEST(depth_and_attack_are_told_where_the_table_was_dug_so)
{
    static const double at[][2] = {
        { 1.0, 0.0 }, { 0.85, 0.0 }, { 1.15, 0.0 }, { 1.05, 2.0 }, { 0.95, -3.0 }
    };
    for (size_t i = 0; i < sizeof at / sizeof at[0]; i++) {
        const struct dig_approach made = { at[i][0], at[i][1] * DIG_RAD_PER_DEG };
        struct dig_observation    seen;
        struct bench *const       b = bench_create();
        assert_int_equal(dig(b, 0, made, &seen), DIG_OK);
        print_message("depth %.2f: %.3f, attack %.1f: %.2f deg, %.2f mm off\n", made.depth,
                      seen.made.depth, at[i][1], seen.made.attack_rad / DIG_RAD_PER_DEG,
                      1e3 * seen.off_path_m);
        assert_close(seen.made.depth, made.depth, 0.05);
        assert_close(seen.made.attack_rad, made.attack_rad, 0.3 * DIG_RAD_PER_DEG);
        assert_true(dig_approach_is_same(&seen.made, &seen.approach));
        assert_true(seen.off_path_m < least_off_m);
        free(b);
    }
}

// The soil is looked for from half as deep again as the table was dug: what lies beyond is seen, is
// distance, and at more than path_limit_m the dig is none of the table's.
TEST(a_dig_deeper_than_the_table_is_told_so_and_matched_at_its_edge)
{
    static const double beyond[] = { 1.3, 1.4, 1.45 };
    for (size_t i = 0; i < sizeof beyond / sizeof beyond[0]; i++) {
        struct dig_observation seen;
        struct bench *const    b = bench_create();
        assert_int_equal(dig(b, 0, (struct dig_approach){ beyond[i], 0.0 }, &seen), DIG_OK);
        print_message("depth %.2f: %.3f, matched at %.3f, %.2f mm off\n", beyond[i],
                      seen.made.depth, seen.approach.depth, 1e3 * seen.off_path_m);
        assert_close(seen.made.depth, beyond[i], 0.06);
        assert_close(seen.approach.depth, 1.2, 1e-6);
        assert_close(seen.off_path_m, (seen.made.depth - 1.2) * APPROACH_m, least_off_m);
        free(b);
    }
    for (double depth = 1.6; depth < 2.5; depth += 0.4) {
        struct dig_observation seen;
        struct bench *const    b = bench_create();
        assert_int_equal(dig(b, 0, (struct dig_approach){ depth, 0.0 }, &seen), DIG_ENOMATCH);
        free(b);
    }
}

TEST(a_table_dug_in_one_way_tells_no_depth)
{
    struct dig_observation seen;
    struct bench *const    b     = bench_create();
    b->table.cube.set.approaches = NULL;
    assert_int_equal(dig(b, 0, dig_approach_plain(), &seen), DIG_OK);
    assert_close(seen.made.depth, 0.0, 0.0);
    assert_true(dig_approach_is_plain(&seen.approach));
    free(b);
}
