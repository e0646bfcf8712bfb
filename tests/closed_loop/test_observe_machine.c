// Tests for closed_loop/machine_digs/observe_machine.c: machine recordings from the rig's machine
// (virtual work), against the force recordings they were made of.

#include "closed_loop/machine_digs/observe_machine.h"

#include "closed_loop/machine_digs/machine_dig.h"
#include "closed_loop/recordings/observe.h"
#include "core/units.h"
#include "estimator/estimator.h"
#include "tests/closed_loop/pitched_machine.h"
#include "tests/made_table.h"
#include "tests/read.h"
#include "tools/rig/motion/track.h"
#include "tools/rig/sensors.h"

#include <stdlib.h>
#include <string.h>

enum { DIGS = 2 };

static const char *const file[DIGS] = {
    "tests/data/reference/mu0.5_mur0.5_rho2500__simpleA.csv",
    "tests/data/reference/mu0.5_mur0.5_rho2500__actual.csv",
};

static struct dig_machine    machine;
static struct dig_rig_track  track;
static struct dig_curve_set *set;
static struct dig_measured   direct[DIGS]; // of the force recordings

// Both digs, moved so briskly in the air between them.
static void build_track(const double air_pace, struct dig_rig_track *const made)
{
    struct dig_recording         recording[DIGS];
    struct dig_error             error = { "" };
    struct dig_rig_track_options how   = dig_rig_track_options_default();
    how.placed   = true; // where digrig would put it: the search takes seconds
    how.pin_X_m  = 7.43;
    how.pin_Z_m  = -0.62;
    how.air_pace = air_pace;
    for (int d = 0; d < DIGS; d++) {
        recording[d] = read_recording(file[d]);
    }
    assert_ok(dig_rig_track_build(&machine, &how, DIGS, recording, made, &error), error);
    for (int d = 0; d < DIGS; d++) {
        dig_recording_finish(&recording[d]);
    }
}

static int build(void **state)
{
    (void)state;
    const struct made_options options = { .relative_sd = 0.1, .packings = 3 };
    struct dig_error          error   = { "" };
    set                               = made_table(&options);
    machine                           = read_machine("zx200_trench");
    for (int d = 0; d < DIGS; d++) {
        struct dig_recording recording = read_recording(file[d]);
        assert_ok(dig_observe_dig(set, &recording, &direct[d], &error), error);
        dig_recording_finish(&recording);
    }
    build_track(1.0, &track);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    made_table_destroy(set);
    dig_rig_track_finish(&track);
    return 0;
}

// By a machine that stands pitched by so much on ground that is pitched alike.
static struct dig_machine_recording record_along(const struct dig_rig_track *const along,
                                                 const double                      pitch_rad)
{
    struct dig_machine_recording r     = { along->rows, malloc(along->rows * sizeof *r.row) };
    struct dig_rig_noise         noise = dig_rig_noise_init(7);
    for (size_t i = 0; i < along->rows; i++) {
        const int64_t      time_ns = llround((double)i * along->step_s * 1e9) + 1;
        struct dig_rig_row row     = along->row[i];
        for (int j = 0; j < DIG_JOINTS && fabs(pitch_rad) > 0.0; j++) {
            push_more(&machine, &row, j, pitch_N(&machine, &row.joints, j, pitch_rad));
        }
        r.row[i] = dig_rig_sense(&machine, &row, time_ns, &noise);
        dig_rig_quantise(&machine, &r.row[i]);
        r.row[i].value[DIG_SIGNAL_PITCH_rad] = pitch_rad;
        r.row[i].valid[DIG_SIGNAL_PITCH_rad] = true;
    }
    return r;
}

static struct dig_machine_recording record(void)
{
    return record_along(&track, 0.0);
}

// Norm of the difference over that of the moment, where both were measured.
static double apart(const struct dig_observation *const a, const struct dig_measured *const b)
{
    double miss  = 0.0;
    double whole = 0.0;
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = k / (DIG_CURVE_POINTS - 1.0);
        if (at >= fmax(a->first, b->first) && at <= fmin(a->last, b->last)) {
            miss += pow(a->moment_Nm[k] - b->value[DIG_CHANNEL_MY_Nm][k], 2.0);
            whole += pow(b->value[DIG_CHANNEL_MY_Nm][k], 2.0);
        }
    }
    return sqrt(miss / whole);
}

static void expect_both(const struct dig_observed_digs *const digs)
{
    assert_int_equal(digs->digs, DIGS);
    assert_int_equal(digs->seen, DIGS);
    for (int d = 0; d < DIGS; d++) {
        const double wrong = apart(&digs->dig[d], &direct[d]);
        print_message("%s: %.4f apart, %.3f to %.3f\n", file[d], wrong, digs->dig[d].first,
                      digs->dig[d].last);
        assert_int_equal(digs->dig[d].trajectory, direct[d].trajectory);
        assert_int_equal(digs->dig[d].dig_count, d + 1);
        assert_true(digs->dig[d].first < 0.05 && digs->dig[d].last > 0.95);
        assert_true(wrong < 0.05); // a third of what another packing is away
    }
}

TEST(every_dig_is_found_and_resists_as_the_force_recording_says)
{
    struct dig_machine_recording r     = record();
    struct dig_observed_digs     digs  = { .digs = 0 };
    struct dig_error             error = { "" };
    assert_ok(dig_observe_machine(&machine, NULL, set, &r, &digs, &error), error);
    expect_both(&digs);
    dig_observed_digs_finish(&digs);

    // A bus that loses one sample in four.
    for (size_t i = 0; i < r.rows; i += 4) {
        r.row[i].valid[DIG_SIGNAL_BUCKET_HEAD_Pa] = false;
        r.row[i].value[DIG_SIGNAL_BUCKET_HEAD_Pa] = 0.0;
    }
    assert_int_equal(dig_observe_machine(&machine, NULL, set, &r, &digs, &error), DIG_OK);
    expect_both(&digs);
    dig_observed_digs_finish(&digs);
    dig_machine_recording_finish(&r);
}

// What a boom's inertia reads as is no ground.
TEST(a_boom_that_brakes_in_the_air_digs_nothing)
{
    const struct dig_machine light = machine;
    struct dig_rig_track     brisk;
    machine.link[DIG_JOINT_BUCKET].mass_kg *= 2.0;
    build_track(4.0, &brisk);
    struct dig_machine_recording r     = record_along(&brisk, 0.0);
    struct dig_observed_digs     digs  = { .digs = 0 };
    struct dig_error             error = { "" };
    assert_ok(dig_observe_machine(&machine, NULL, set, &r, &digs, &error), error);
    assert_int_equal(digs.seen, DIGS);
    expect_both(&digs);
    dig_observed_digs_finish(&digs);
    dig_machine_recording_finish(&r);
    dig_rig_track_finish(&brisk);
    machine = light;
}

// What was not measured is not made up: the other dig is whole.
TEST(a_dig_with_a_gap_is_seen_but_not_observed)
{
    struct dig_machine_recording r    = record();
    struct dig_observed_digs     digs = { .digs = 0 };
    for (size_t i = r.rows * 6 / 10; i < r.rows * 7 / 10; i++) {
        r.row[i].valid[DIG_SIGNAL_ARM_rad] = false;
    }
    assert_int_equal(dig_observe_machine(&machine, NULL, set, &r, &digs, NULL), DIG_OK);
    assert_int_equal(digs.seen, DIGS);
    assert_int_equal(digs.digs, 1);
    assert_int_equal(digs.dig[0].trajectory, direct[0].trajectory);
    dig_observed_digs_finish(&digs);
    dig_machine_recording_finish(&r);
}

// Norm of the difference of all that both measured over that of the second.
static double apart_of(const struct dig_observation *const a, const struct dig_observation *const b)
{
    double worst = 0.0;
    for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
        const double *const of_a = c == 0 ? a->moment_Nm : a->force_N[c - 1];
        const double *const of_b = c == 0 ? b->moment_Nm : b->force_N[c - 1];
        double              miss = 0.0, whole = 0.0;
        for (int k = 2; k + 2 < DIG_CURVE_POINTS; k++) {
            miss += pow(of_a[k] - of_b[k], 2.0);
            whole += pow(of_b[k], 2.0);
        }
        worst = fmax(worst, sqrt(miss / whole));
    }
    return worst;
}

// How far along which trajectory each dig was followed while it was dug, as the daemon's tick does.
static void expect_followed(const struct dig_machine_recording *const r)
{
    struct dig_estimator *const         e             = malloc(dig_estimator_size());
    const struct dig_estimator_settings settings      = dig_estimator_settings_default();
    struct dig_estimate                 now           = { .dig_count = 0 };
    double                              far[DIGS + 1] = { 0.0 };
    assert_int_equal(dig_estimator_init(e, &machine, set, &settings), DIG_OK);
    for (size_t i = 0; i < r->rows; i++) {
        if (dig_estimator_step(e, &r->row[i], &now) != DIG_OK || now.trajectory < 0) {
            continue;
        }
        assert_int_equal(now.trajectory, direct[now.dig_count].trajectory);
        far[now.dig_count] = fmax(far[now.dig_count], now.progress);
    }
    for (int d = 0; d < DIGS; d++) {
        print_message("followed for %.3f\n", far[d]);
        assert_true(far[d] > 0.95);
    }
    free(e);
}

// Finds both digs of a machine pitched by so much as a level one's, and follows them. Frees r.
static void expect_as_level(const double pitch_deg, struct dig_machine_recording *const r)
{
    struct dig_machine_recording level = record();
    struct dig_observed_digs     as    = { .digs = 0 };
    struct dig_observed_digs     digs  = { .digs = 0 };
    struct dig_error             error = { "" };
    assert_ok(dig_observe_machine(&machine, NULL, set, &level, &as, &error), error);
    assert_ok(dig_observe_machine(&machine, NULL, set, r, &digs, &error), error);
    expect_both(&digs);
    for (int d = 0; d < DIGS; d++) {
        print_message("%g deg: %.4f off\n", pitch_deg, apart_of(&digs.dig[d], &as.dig[d]));
        assert_true(digs.dig[d].forces && as.dig[d].forces);
        assert_true(apart_of(&digs.dig[d], &as.dig[d]) < 0.02);
    }
    expect_followed(r);
    dig_observed_digs_finish(&digs);
    dig_observed_digs_finish(&as);
    dig_machine_recording_finish(r);
    dig_machine_recording_finish(&level);
}

TEST(a_pitched_machine_digs_level_ground_as_a_level_one_does)
{
    for (double pitch_deg = -3.0; pitch_deg <= 3.0; pitch_deg += 6.0) {
        struct dig_machine_recording r = record();
        stand_pitched(&machine, pitch_deg * DIG_RAD_PER_DEG, &r);
        expect_as_level(pitch_deg, &r);
    }
}

// Then the path lies along its trajectory in the machine's frame.
TEST(a_machine_pitched_as_its_ground_digs_along_its_own_frame)
{
    for (double pitch_deg = -3.0; pitch_deg <= 3.0; pitch_deg += 6.0) {
        struct dig_machine_recording r = record_along(&track, pitch_deg * DIG_RAD_PER_DEG);
        expect_as_level(pitch_deg, &r);
    }
}

// Angles in steps of half a degree, or in steps and with noise: the path that they make is blurred,
// and lies as near another trajectory.
TEST(steps_and_noise_of_the_angles_hide_no_dig)
{
    static const double      rough_deg[][2] = { { 0.0, 0.5 }, { 0.15, 0.0 }, { 0.15, 0.5 } };
    const struct dig_machine as_filed       = machine;
    for (size_t i = 0; i < sizeof rough_deg / sizeof rough_deg[0]; i++) {
        machine.angle_sigma_rad            = rough_deg[i][0] * DIG_RAD_PER_DEG;
        machine.angle_step_rad             = rough_deg[i][1] * DIG_RAD_PER_DEG;
        struct dig_machine_recording r     = record();
        struct dig_observed_digs     digs  = { .digs = 0 };
        struct dig_error             error = { "" };
        assert_ok(dig_observe_machine(&machine, NULL, set, &r, &digs, &error), error);
        expect_both(&digs);
        dig_observed_digs_finish(&digs);
        dig_machine_recording_finish(&r);
        machine = as_filed;
    }
}

// Nothing depends on a sample in the air before the dig.
TEST(samples_without_forces_cost_the_moment_nothing)
{
    const struct dig_correction  none     = { .delay_s = 0.0 };
    struct dig_machine_recording r        = record();
    struct dig_measured          together = { .name = "" };
    struct dig_measured          alone    = { .name = "" };
    struct dig_machine_dig       dig;
    struct dig_error             error = { "" };
    assert_ok(dig_machine_dig_make(&machine, set, &r, 0, &dig, &error), error);
    assert_int_equal(
        dig_machine_dig_measure(&machine, set, &dig, &none, DIG_MEASURE_WITH_SIGMA, &together),
        DIG_OK);
    const size_t air = dig_machine_dig_sample_at(&dig, dig.time_s[dig.contact] - 0.8);
    dig.sample[air].valid[DIG_SIGNAL_BOOM_HEAD_Pa] = false;
    assert_int_equal(
        dig_machine_dig_measure(&machine, set, &dig, &none, DIG_MEASURE_WITH_SIGMA, &alone),
        DIG_OK);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        assert_true(together.measured[c] && alone.measured[c]);
        assert_memory_equal(together.value[c], alone.value[c], sizeof alone.value[c]);
        assert_memory_equal(together.sigma[c], alone.sigma[c], sizeof alone.sigma[c]);
    }
    // Where too few samples tell the forces the moment is measured without them, by all it has.
    for (size_t i = dig.contact; i < dig.end; i += 5) {
        dig.sample[i].valid[DIG_SIGNAL_BOOM_HEAD_Pa] = false;
    }
    assert_int_equal(
        dig_machine_dig_measure(&machine, set, &dig, &none, DIG_MEASURE_WITH_SIGMA, &alone),
        DIG_OK);
    assert_true(alone.measured[0] && !alone.measured[1] && !alone.measured[2]);
    assert_memory_equal(together.value[0], alone.value[0], sizeof alone.value[0]);
    assert_close(alone.value[1][DIG_CURVE_POINTS / 2], 0.0, 0.0);
    dig_machine_dig_finish(&dig);
    dig_machine_recording_finish(&r);
}

TEST(without_a_dig_it_is_refused_and_nothing_written)
{
    struct dig_machine_recording r    = record();
    const size_t                 rows = r.rows;
    struct dig_observed_digs     digs = { .seen = 42 };
    struct dig_error             error;

    r.rows = 200; // air
    assert_int_equal(dig_observe_machine(&machine, NULL, set, &r, &digs, &error), DIG_ENOMATCH);
    assert_contains(error.text, "digs in it: 0");

    // Broken off within the first dig: it has not ended.
    r.rows = rows / 4;
    assert_int_equal(dig_observe_machine(&machine, NULL, set, &r, &digs, &error), DIG_ENOMATCH);
    assert_int_equal(digs.seen, 42);
    assert_null(digs.dig);

    struct dig_machine broken = machine;
    broken.link[0].length_m   = -1.0;
    assert_int_equal(dig_observe_machine(&broken, NULL, set, &r, &digs, &error), DIG_EINVAL);
    assert_contains(error.text, machine.name);
    assert_int_equal(digs.seen, 42);
    dig_machine_recording_finish(&r);
    dig_observed_digs_finish(NULL);
}

TESTS_WITH(build, tear_down)
