// Tests for closed_loop/recordings/observe.c

#include "closed_loop/recordings/observe.h"

#include "core/chance.h"
#include "core/entry_set.h"
#include "core/units.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

static struct dig_curve_set two_digs(void)
{
    return (struct dig_curve_set){
        .tooth_m       = 0.09,
        .smooth_half_s = 0.16,
        .trajectories  = 2,
        .trajectory    = { { "short",
                             -0.26,
                             0.08,
                             0.17,
                             2,
                             { { "in", 0.6, 0.025, -0.0436, 0.0 },
                               { "drag", 2.0, 0.0463, 0.0, 0.0 } } },
                           { "curl",
                             -0.52,
                             0.09,
                             0.16,
                             2,
                             { { "in", 0.8, 0.03, -0.04, 0.0 }, { "turn", 2.0, 0.0, 0.0, 0.3 } } } },
    };
}

// A dig along trajectory t, somewhere else in space and `slower` times slower, whose moment is
// `moment` of the path travelled.
static struct dig_recording drive(const struct dig_trajectory *const t, const double slower,
                                  double (*const moment)(double time_s))
{
    const double         end_s = dig_trajectory_duration_s(t) * slower;
    const size_t         rows  = (size_t)(end_s / 0.005) + 1;
    struct dig_recording r     = { rows, calloc(rows, sizeof *r.row) };
    for (size_t i = 0; i < rows; i++) {
        const double          t_s  = (double)i * end_s / (double)(rows - 1);
        const struct dig_pose pose = dig_trajectory_pose(t, t_s / slower);
        r.row[i]                   = (struct dig_force_row){ .t_s       = 5.0 + t_s,
                                                             .pin_x_m   = pose.x_m + 1.0,
                                                             .pin_z_m   = pose.z_m - 2.0,
                                                             .theta_deg = pose.theta_rad / DIG_RAD_PER_DEG,
                                                             .My_Nm     = moment(t_s / slower) };
    }
    return r;
}

static double slow_wave(const double time_s)
{
    return 2.0 + sin(0.8 * time_s);
}

// Which the smoothing takes a third of.
static double quick_wave(const double time_s)
{
    return 2.0 + sin(9.0 * time_s);
}

// Whatever the pace and the place, the dig is recognised and its moment stands where the path says.
TEST(pace_and_place_do_not_matter)
{
    const struct dig_curve_set set       = two_digs();
    const double               paces[]   = { 1.0, 1.7, 0.6 };
    const double               blur_most = 0.02; // of +-0.16 s on a wave of 7.9 s and its ends
    for (int t = 0; t < 2; t++) {
        for (size_t p = 0; p < 3; p++) {
            struct dig_recording r = drive(&set.trajectory[t], paces[p], slow_wave);
            struct dig_measured  o;
            assert_int_equal(dig_observe_dig(&set, &r, &o, NULL), DIG_OK);
            assert_int_equal(o.trajectory, t);
            assert_true(o.off_path_m < 1e-4);
            // Within a smoothing window of the ends the mean is one-sided and says something else.
            const double end_s = dig_trajectory_duration_s(&set.trajectory[t]);
            for (int k = 0; k < DIG_CURVE_POINTS; k += 9) {
                const double time_s = dig_trajectory_time_s(&set.trajectory[t], set.tooth_m,
                                                            k / (DIG_CURVE_POINTS - 1.0));
                if (time_s > 0.3 && time_s < end_s - 0.3) {
                    assert_close(o.value[DIG_CHANNEL_MY_Nm][k], slow_wave(time_s), blur_most);
                }
            }
            dig_recording_finish(&r);
        }
    }
}

// A dig is smoothed over as much of its path as the table's, however fast it was.
TEST(a_fast_dig_is_read_as_the_tables)
{
    const struct dig_curve_set set      = two_digs();
    static const double        slower[] = { 1.0 / 3.0, 2.0 };
    struct dig_measured        plain;
    struct dig_measured        o;
    for (int t = 0; t < 2; t++) {
        struct dig_recording r = drive(&set.trajectory[t], 1.0, quick_wave);
        assert_int_equal(dig_observe_dig(&set, &r, &plain, NULL), DIG_OK);
        dig_recording_finish(&r);
        for (size_t p = 0; p < 2; p++) {
            r = drive(&set.trajectory[t], slower[p], quick_wave);
            assert_int_equal(dig_observe_dig(&set, &r, &o, NULL), DIG_OK);
            assert_close(o.pace * slower[p], 1.0, 0.01);
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                assert_close(o.value[0][k], plain.value[0][k], 0.02);
            }
            dig_recording_finish(&r);
        }
    }
}

// However roughly its poses are read, a dig is recognised and stands where it was.
TEST(a_path_in_steps_or_with_noise_is_read_as_an_exact_one)
{
    const struct dig_curve_set set       = two_digs();
    static const double        step_m[]  = { 0.0, 0.002 };
    static const double        noise_m[] = { 0.0004, 0.0 };
    uint64_t                   chance    = 3;
    struct dig_measured        plain;
    struct dig_measured        o;
    for (int t = 0; t < 2; t++) {
        struct dig_recording r = drive(&set.trajectory[t], 1.0, slow_wave);
        assert_int_equal(dig_observe_dig(&set, &r, &plain, NULL), DIG_OK);
        dig_recording_finish(&r);
        for (int rough = 0; rough < 2; rough++) {
            r = drive(&set.trajectory[t], 1.0, slow_wave);
            for (size_t i = 0; i < r.rows; i++) {
                double *const pin_m[2] = { &r.row[i].pin_x_m, &r.row[i].pin_z_m };
                for (int axis = 0; axis < 2; axis++) {
                    *pin_m[axis] += noise_m[rough] * dig_chance_normal(&chance);
                    if (step_m[rough] > 0.0) {
                        *pin_m[axis] = step_m[rough] * round(*pin_m[axis] / step_m[rough]);
                    }
                }
            }
            assert_int_equal(dig_observe_dig(&set, &r, &o, NULL), DIG_OK);
            assert_int_equal(o.trajectory, t);
            assert_close(o.pace, 1.0, 0.03);
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                assert_close(o.value[0][k], plain.value[0][k], 0.04);
            }
            dig_recording_finish(&r);
        }
    }
}

// The table of two digs, the first of which was made deeper and with the bucket turned, too; with
// depths in metres of the trajectory's own.
static struct dig_curve_set dug_otherwise(struct dig_entry_set *const others)
{
    static struct dig_entry entry[]    = { { .approach = { 1.2, 0.0 } },
                                           { .approach = { 1.0, 0.1 } } };
    static int              packings[] = { 1, 0, 1, 0 };
    *others                            = (struct dig_entry_set){ .trajectories = 2,
                                                                 .depth_m      = { 0.02616, 0.032 },
                                                                 .entries      = 2,
                                                                 .entry        = entry,
                                                                 .packings     = packings };
    struct dig_curve_set set           = two_digs();
    set.approaches                     = others;
    return set;
}

static struct dig_recording drive_so(const struct dig_curve_set *const set, const size_t t,
                                     const double depth, const double attack_rad)
{
    const struct dig_approach approach = { depth, attack_rad };
    struct dig_trajectory     dug;
    assert_int_equal(dig_approach_apply(&set->trajectory[t], 0.09, set->approaches->depth_m[t],
                                        &approach, &dug, NULL),
                     DIG_OK);
    return drive(&dug, 1.3, slow_wave);
}

TEST(depth_and_attack_of_a_dig_are_told_where_the_table_has_them)
{
    struct dig_entry_set       others;
    const struct dig_curve_set set = dug_otherwise(&others);
    struct dig_measured        o;
    struct dig_recording       r = drive_so(&set, 0, 1.1, 0.03);
    assert_int_equal(dig_observe_as_dug(&set, &r, &o, NULL), DIG_OK);
    assert_int_equal(o.trajectory, 0);
    assert_close(o.approach.depth, 1.1, 1e-3);
    assert_close(o.approach.attack_rad, 0.03, 1e-4);
    assert_true(o.off_path_m < 1e-4);
    // Over the plain path the attack is told all the same; the depth counts as distance.
    assert_int_equal(dig_observe_dig(&set, &r, &o, NULL), DIG_OK);
    assert_true(dig_approach_is_plain(&o.approach));
    assert_close(o.made.attack_rad, 0.03, 1e-3);
    assert_close(o.made.depth, 1.0, 0.0);
    assert_true(o.off_path_m < 1e-3);
    dig_recording_finish(&r);

    // Of the other trajectory the table has nothing but the plain dig.
    r = drive_so(&set, 1, 1.05, 0.0);
    assert_int_equal(dig_observe_as_dug(&set, &r, &o, NULL), DIG_OK);
    assert_int_equal(o.trajectory, 1);
    assert_true(dig_approach_is_plain(&o.approach));
    dig_recording_finish(&r);
}

// The second trajectory is the first with the bucket turned by less than the table was dug so.
TEST(of_trajectories_that_differ_by_a_turn_the_nearer_is_told)
{
    const struct dig_approach turned = { 1.0, 0.03 };
    struct dig_entry_set      others;
    struct dig_curve_set      set = dug_otherwise(&others);
    struct dig_measured       o;
    assert_int_equal(dig_approach_apply(&set.trajectory[0], 0.09, others.depth_m[0], &turned,
                                        &set.trajectory[1], NULL),
                     DIG_OK);
    struct dig_recording r = drive(&set.trajectory[1], 1.3, slow_wave);
    assert_int_equal(dig_observe_dig(&set, &r, &o, NULL), DIG_OK);
    assert_int_equal(o.trajectory, 1);
    assert_close(o.made.attack_rad, 0.0, 1e-3);
    assert_int_equal(dig_observe_as_dug(&set, &r, &o, NULL), DIG_OK);
    assert_int_equal(o.trajectory, 1);
    dig_recording_finish(&r);
}

TEST(what_lies_beyond_the_table_is_distance)
{
    struct dig_entry_set       others;
    const struct dig_curve_set set = dug_otherwise(&others);
    struct dig_measured        o   = { .pace = 42.0 };
    struct dig_error           e   = { "" };
    struct dig_recording       r   = drive_so(&set, 0, 1.3, 0.0);
    assert_int_equal(dig_observe_as_dug(&set, &r, &o, &e), DIG_OK);
    assert_close(o.made.depth, 1.3, 1e-3);
    assert_close(o.approach.depth, 1.2, 1e-3);
    assert_close(o.off_path_m, 0.1 * 0.02616, 5e-5);
    dig_recording_finish(&r);

    o = (struct dig_measured){ .pace = 42.0 };
    r = drive_so(&set, 0, 1.4, 0.0); // 0.2 of 26 mm is more than a twentieth of 90 mm
    assert_int_equal(dig_observe_as_dug(&set, &r, &o, &e), DIG_ENOMATCH);
    assert_non_null(strstr(e.text, "nearest is \"short\", 0.058 bucket lengths away"));
    assert_close(o.pace, 42.0, 0.0);
    dig_recording_finish(&r);
}

TEST(a_path_of_another_kind_is_refused_and_writes_nothing)
{
    const struct dig_curve_set  set = two_digs();
    const struct dig_trajectory up  = { "up", 0.0, 0.0, 0.0, 1, { { "up", 2.0, 0.0, 0.1, 0.0 } } };
    const struct dig_trajectory still = { "still", 0.0, 0.0,
                                          0.0,     1,   { { "still", 2.0, 0.0, 0.0, 0.0 } } };
    struct dig_measured         o     = { .trajectory = 42 };
    struct dig_error            e     = { "" };
    struct dig_recording        r1 = drive(&up, 1.0, slow_wave), r2 = drive(&still, 1.0, slow_wave);
    assert_int_equal(dig_observe_dig(&set, &r1, &o, &e), DIG_ENOMATCH);
    assert_non_null(strstr(e.text, "expected"));
    assert_int_equal(dig_observe_dig(&set, &r2, &o, &e), DIG_EINVAL);
    r2.rows = 1;
    assert_int_equal(dig_observe_dig(&set, &r2, &o, &e), DIG_EINVAL);
    assert_int_equal(o.trajectory, 42);
    dig_recording_finish(&r1);
    dig_recording_finish(&r2);
}

static double straight(const double time_s)
{
    return 3.0 * time_s;
}

// What readings of noise are off by after smoothing is what is said of them, in the middle and at
// the ends, where less is averaged.
TEST(noise_of_the_rows_is_known_after_smoothing)
{
    enum { TIMES = 300 };
    const struct dig_curve_set set = two_digs();
    struct dig_recording       r   = drive(&set.trajectory[0], 1.0, slow_wave);
    struct dig_measured        clean;
    struct dig_measured        o;
    const size_t               at[]      = { 0, 60, 128, DIG_CURVE_POINTS - 1 };
    double                     off2[4]   = { 0.0 };
    double                     sigma2[4] = { 0.0 };
    uint64_t                   seed      = 11;
    assert_int_equal(dig_observe_dig(&set, &r, &clean, NULL), DIG_OK);
    for (int n = 0; n < TIMES; n++) {
        for (size_t i = 0; i < r.rows; i++) {
            r.row[i].My_Nm = slow_wave(r.row[i].t_s - 5.0) + 0.5 * dig_chance_normal(&seed);
        }
        assert_int_equal(dig_observe_dig(&set, &r, &o, NULL), DIG_OK);
        for (size_t i = 0; i < 4; i++) {
            off2[i] += pow(o.value[0][at[i]] - clean.value[0][at[i]], 2.0);
            sigma2[i] += pow(o.sigma[0][at[i]], 2.0);
            assert_true(clean.sigma[0][at[i]] < 1e-4);
            assert_close(o.sigma[1][at[i]], 0.0, 0.0);
        }
    }
    for (size_t i = 0; i < 4; i++) {
        assert_close(off2[i] / sigma2[i], 1.0, 4.0 * sqrt(2.0 / TIMES));
    }
    assert_close(sigma2[1] / TIMES, 0.5 * 0.5 * 0.005 / 0.32, 0.1 * 0.5 * 0.5 * 0.005 / 0.32);
    dig_recording_finish(&r);
}

// Rows [from, to) lack a channel.
static void lose(struct dig_recording *const r, const size_t from, const size_t to,
                 const bool moment)
{
    for (size_t i = from; i < to; i++) {
        *(moment ? &r->row[i].My_Nm : &r->row[i].Fx_N) = (double)NAN;
    }
}

// A moving average of a straight line is the line, whichever of its samples are there.
TEST(short_gaps_are_bridged_by_what_lies_about_them)
{
    const struct dig_curve_set set = two_digs();
    struct dig_recording       r   = drive(&set.trajectory[0], 1.0, straight);
    struct dig_measured        whole, holed;
    assert_int_equal(dig_observe_dig(&set, &r, &whole, NULL), DIG_OK);
    for (size_t i = 1; i < r.rows; i += 3) {
        lose(&r, i, i + 1, true);
    }
    lose(&r, 200, 228, true);
    lose(&r, 0, 10, false);
    assert_int_equal(dig_observe_dig(&set, &r, &holed, NULL), DIG_OK);
    assert_true(holed.measured[DIG_CHANNEL_FX_N]);
    const double end_s = dig_trajectory_duration_s(&set.trajectory[0]);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        const double time_s =
            dig_trajectory_time_s(&set.trajectory[0], set.tooth_m, k / (DIG_CURVE_POINTS - 1.0));
        if (time_s > 0.2 && time_s < end_s - 0.2) {
            assert_close(holed.value[DIG_CHANNEL_MY_Nm][k], straight(time_s), 1e-3);
            assert_close(whole.value[DIG_CHANNEL_MY_Nm][k], straight(time_s), 1e-3);
        }
    }
    dig_recording_finish(&r);
}

TEST(a_long_gap_is_not_measured_and_of_the_moment_refused)
{
    const struct dig_curve_set set       = two_digs();
    struct dig_error           e         = { "" };
    struct dig_measured        o         = { .pace = 42.0 };
    const size_t               gaps[][2] = { { 0, 40 }, { 200, 240 }, { 481, 521 }, { 0, 521 } };
    for (size_t g = 0; g < 4; g++) {
        struct dig_recording r = drive(&set.trajectory[0], 1.0, slow_wave);
        assert_int_equal(r.rows, 521);
        lose(&r, gaps[g][0], gaps[g][1], false);
        assert_int_equal(dig_observe_dig(&set, &r, &o, NULL), DIG_OK);
        assert_true(o.measured[DIG_CHANNEL_MY_Nm] && o.measured[DIG_CHANNEL_FZ_N]);
        assert_false(o.measured[DIG_CHANNEL_FX_N]);
        assert_close(o.value[DIG_CHANNEL_FX_N][100], 0.0, 0.0);

        o.pace = 42.0;
        lose(&r, gaps[g][0], gaps[g][1], true);
        assert_int_equal(dig_observe_dig(&set, &r, &o, &e), DIG_EINVAL);
        assert_non_null(strstr(e.text,
                               "My_Nm is missing for longer than 0.16 s at the table's pace, "
                               "expected"));
        assert_close(o.pace, 42.0, 0.0);
        dig_recording_finish(&r);
    }
}

// Of 50 Hz a recording may lack 20 ms; of one that lacks more what the smoothing reaches beyond is
// not told.
TEST(a_recording_cut_short_tells_what_it_has)
{
    const struct dig_curve_set set = two_digs();
    struct dig_recording       r   = drive(&set.trajectory[0], 1.0, straight);
    struct dig_measured        whole, cut;
    assert_int_equal(dig_observe_dig(&set, &r, &whole, NULL), DIG_OK);
    assert_close(whole.first, 0.0, 0.0);
    assert_close(whole.last, 1.0, 0.0);
    assert_close(whole.pace, 1.0, 1e-3);
    r.rows -= 4;
    assert_int_equal(dig_observe_dig(&set, &r, &cut, NULL), DIG_OK);
    assert_close(cut.last, 1.0, 0.0);
    assert_close(cut.pace, 1.0, 5e-3);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close(cut.value[0][k], whole.value[0][k], 0.008);
    }
    r.rows -= 16;
    assert_int_equal(dig_observe_dig(&set, &r, &cut, NULL), DIG_OK);
    // 0.1 s and 0.16 s of 0.0463 m/s, of 0.03016 m and 0.0926 m.
    assert_close(cut.last, 1.0 - 0.26 * 0.0463 / 0.12276, 0.01);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        const bool told = k / (DIG_CURVE_POINTS - 1.0) <= cut.last;
        assert_close(cut.value[0][k], told ? whole.value[0][k] : 0.0, told ? 0.008 : 0.0);
    }
    dig_recording_finish(&r);
}

// A bucket that waits in the soil, or goes now fast and now slowly, is as far on its path as one
// that does not.
TEST(rest_and_haste_within_the_dig_do_not_matter)
{
    const struct dig_curve_set set    = two_digs();
    struct dig_recording       r      = drive(&set.trajectory[0], 1.0, quick_wave);
    struct dig_recording       uneven = { r.rows + 600, calloc(r.rows + 600, sizeof *uneven.row) };
    struct dig_measured        whole, seen;
    double                     t_s = 0.0;
    for (size_t i = 0; i < uneven.rows; i++) {
        const size_t rested = i < r.rows / 2 ? 0 : (i < r.rows / 2 + 600 ? i - r.rows / 2 : 600);
        uneven.row[i]       = r.row[i - rested];
        uneven.row[i].t_s   = t_s += 0.005 * (1.0 + 0.8 * sin(0.02 * (double)i));
    }
    assert_int_equal(dig_observe_dig(&set, &r, &whole, NULL), DIG_OK);
    assert_int_equal(dig_observe_dig(&set, &uneven, &seen, NULL), DIG_OK);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close(seen.value[0][k], whole.value[0][k], 1e-9);
    }
    dig_recording_finish(&r);
    dig_recording_finish(&uneven);
}

// A bucket that waits before and after its dig was not slower for it.
TEST(rest_before_and_after_is_no_pace)
{
    const struct dig_curve_set set  = two_digs();
    struct dig_recording       r    = drive(&set.trajectory[1], 0.8, slow_wave);
    struct dig_recording       rest = { r.rows + 400, calloc(r.rows + 400, sizeof *rest.row) };
    struct dig_measured        whole, rested;
    for (size_t i = 0; i < rest.rows; i++) {
        const size_t of = i < 200 ? 0 : (i < r.rows + 200 ? i - 200 : r.rows - 1);
        rest.row[i]     = r.row[of];
        rest.row[i].t_s = 0.005 * (double)i;
        rest.row[i].pin_x_m += i % 2 == 0 ? 2e-5 : 0.0;
    }
    assert_int_equal(dig_observe_dig(&set, &r, &whole, NULL), DIG_OK);
    assert_int_equal(dig_observe_dig(&set, &rest, &rested, NULL), DIG_OK);
    assert_close(whole.pace, 1.25, 5e-3);
    assert_close(rested.pace, whole.pace, 5e-3);
    dig_recording_finish(&r);
    dig_recording_finish(&rest);
}

// The bucket came down along its first phase, or went on along its last, for longer than the
// trajectory says.
TEST(what_lies_beyond_the_trajectory_is_left_out)
{
    const struct dig_curve_set set    = two_digs();
    struct dig_trajectory      longer = set.trajectory[0];
    longer.phase[0].duration_s += 0.1;
    longer.phase[1].duration_s += 0.15;
    struct dig_recording r = drive(&set.trajectory[0], 1.0, slow_wave);
    struct dig_recording l = drive(&longer, 1.0, slow_wave);
    struct dig_measured  whole, more;
    for (size_t i = 0; i < l.rows; i++) {
        l.row[i].My_Nm = slow_wave(l.row[i].t_s - 5.0 - 0.1);
    }
    assert_int_equal(dig_observe_dig(&set, &r, &whole, NULL), DIG_OK);
    assert_int_equal(dig_observe_dig(&set, &l, &more, NULL), DIG_OK);
    assert_close(more.pace, 1.0, 5e-3);
    assert_true(more.off_path_m < 1e-4);
    assert_close(more.first, 0.0, 0.0);
    assert_close(more.last, 1.0, 0.0);
    for (int k = 0; k < DIG_CURVE_POINTS; k++) {
        assert_close(more.value[0][k], whole.value[0][k], 0.01);
    }
    dig_recording_finish(&r);
    dig_recording_finish(&l);
}

// closed_loop/recordings/force_check.c
TEST(a_moment_in_kilonewton_metres_is_refused)
{
    struct dig_curve_set    set    = two_digs();
    int                     dug[2] = { 1, 0 };
    struct dig_curve *const curve  = calloc(2, sizeof *curve);
    struct dig_measured     m      = { .trajectory = 0 };
    struct dig_error        error  = { "" };
    struct dig_recording    r      = drive(&set.trajectory[0], 1.0, slow_wave);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        curve[0].mean[DIG_CHANNEL_MY_Nm][k] = 2.0F;
    }
    set.entries  = 1;
    set.packings = dug;
    set.curve    = curve;
    assert_ok(dig_observe_dig(&set, &r, &m, &error), error);
    for (size_t i = 0; i < r.rows; i++) {
        r.row[i].My_Nm *= 1e-3;
    }
    assert_int_equal(dig_observe_dig(&set, &r, &m, &error), DIG_EINVAL);
    assert_contains(error.text, "My_Nm");
    assert_contains(error.text, "not kN m");
    free(curve);
    dig_recording_finish(&r);
}
