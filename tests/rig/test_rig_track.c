// Tests for tools/rig/motion/track.c, placement.c and state.c

#include "tools/rig/motion/track.h"

#include "core/units.h"
#include "tests/read.h"

#include <string.h>

#define SIMPLE "tests/data/reference/mu0.5_mur0.5_rho2500__simpleA.csv"
#define ACTUAL "tests/data/reference/mu0.5_mur0.5_rho2500__actual.csv"
#define STIFF  "tests/data/reference/mu0.9_mur0.9_rho2500__actual.csv"

static struct dig_rig_track build(const struct dig_machine *const           machine,
                                  const struct dig_rig_track_options *const options,
                                  const size_t recordings, const struct dig_recording *const from)
{
    struct dig_rig_track track;
    struct dig_error     error = { "" };
    assert_int_equal(dig_rig_track_build(machine, options, recordings, from, &track, &error),
                     DIG_OK);
    return track;
}

TEST(simple_then_actual_fit_the_trench_machine_below_relief)
{
    const struct dig_machine           machine = read_machine("zx200_trench");
    const struct dig_rig_track_options options = dig_rig_track_options_default();
    struct dig_recording recording[2]          = { read_recording(SIMPLE), read_recording(ACTUAL) };
    struct dig_rig_track track                 = build(&machine, &options, 2, recording);

    assert_true(track.nearest.share > 0.1);
    double most_Pa = 0.0;
    double least   = 1e9;
    for (size_t i = 0; i < track.rows; i++) {
        for (int j = 0; j < DIG_JOINTS; j++) {
            const struct dig_rig_row *const row = &track.row[i];
            assert_true(row->joints.rad[j] > machine.link[j].min_rad);
            assert_true(row->joints.rad[j] < machine.link[j].max_rad);
            most_Pa = fmax(most_Pa, fmax(row->pressures.head_Pa[j], row->pressures.rod_Pa[j]));
            least   = fmin(least, fmin(row->pressures.head_Pa[j], row->pressures.rod_Pa[j]));
        }
    }
    assert_true(most_Pa < 20e6);
    assert_true(least >= machine.cylinder[0].back_Pa);
    dig_rig_track_finish(&track);
    dig_recording_finish(&recording[0]);
    dig_recording_finish(&recording[1]);
}

TEST(stiffest_reference_dig_fits_the_trench_machine)
{
    const struct dig_machine           machine   = read_machine("zx200_trench");
    const struct dig_rig_track_options options   = dig_rig_track_options_default();
    struct dig_recording               recording = read_recording(STIFF);
    struct dig_rig_track               track     = build(&machine, &options, 1, &recording);
    dig_rig_track_finish(&track);
    dig_recording_finish(&recording);
}

// The rows carry the recording: time, force and moment scaled, whatever the air around it.
TEST(soil_of_the_track_is_the_recording_s_at_scale)
{
    const struct dig_machine     machine   = read_machine("zx200_trench");
    struct dig_rig_track_options options   = dig_rig_track_options_default();
    struct dig_recording         recording = read_recording(SIMPLE);
    options.air                            = false;
    options.blend                          = false;
    options.rate_Hz                        = 1000.0;
    struct dig_rig_track track             = build(&machine, &options, 1, &recording);
    for (size_t r = 100; r < 500; r += 37) {
        const struct dig_force_row *const row = &recording.row[r];
        const double                      t_s = sqrt(10.0) * (row->t_s - recording.row[0].t_s);
        const size_t                      i   = (size_t)lround(t_s / track.step_s);
        // Between two samples of 5 ms the force is straight; half a millisecond of it is slack.
        const double slack_N = 1000.0 * fabs(recording.row[r + 1].Fx_N - row->Fx_N) +
                               1000.0 * fabs(row->Fx_N - recording.row[r - 1].Fx_N) + 1.0;
        assert_close(track.row[i].soil.FX_N, -1000.0 * row->Fx_N, 0.05 * slack_N);
        assert_close(track.row[i].pose.phi_rad, (-90.0 - row->theta_deg) * DIG_RAD_PER_DEG, 1e-6);
    }
    dig_rig_track_finish(&track);
    dig_recording_finish(&recording);
}

// What the cylinders and the soil put in, the links have as height and speed: the whole run in one
// sum, with none of the differences the pushes were made of.
TEST(cylinders_and_soil_do_the_work_that_lifts_and_moves_the_links)
{
    const struct dig_machine     machine   = read_machine("zx200_trench");
    struct dig_rig_track_options options   = dig_rig_track_options_default();
    struct dig_recording         recording = read_recording(SIMPLE);
    options.rate_Hz                        = 1000.0;
    struct dig_rig_track track             = build(&machine, &options, 1, &recording);

    double work_J  = 0.0; // of cylinders and soil
    double turned  = 0.0; // all work without its sign, as a measure
    double first_J = 0.0;
    double worst_J = 0.0;
    double most_J  = 0.0; // of kinetic energy, so that it is known to be looked at
    for (size_t i = 1; i + 1 < track.rows; i++) {
        const struct dig_rig_row *const row = &track.row[i];
        for (int j = 0; j < DIG_JOINTS && i > 1; j++) {
            const struct dig_cylinder *const c = &machine.cylinder[j];
            double                           length_m[2];
            double                           push_N = 0.0;
            for (int k = 0; k < 2; k++) {
                const struct dig_rig_row *const at = &track.row[i - 1 + (size_t)k];
                assert_int_equal(dig_rig_cylinder_m(&machine, (enum dig_joint)j, at->joints.rad[j],
                                                    &length_m[k]),
                                 DIG_OK);
                push_N += 0.5 * c->count *
                          (at->pressures.head_Pa[j] * dig_cylinder_head_m2(c) -
                           at->pressures.rod_Pa[j] * dig_cylinder_rod_m2(c));
            }
            work_J += push_N * (length_m[1] - length_m[0]);
            turned += fabs(push_N * (length_m[1] - length_m[0]));
        }
        if (i > 1) {
            const struct dig_rig_row *const was = &track.row[i - 1];
            work_J +=
                0.5 * (row->soil.FX_N + was->soil.FX_N) * (row->pose.X_m - was->pose.X_m) +
                0.5 * (row->soil.FZ_N + was->soil.FZ_N) * (row->pose.Z_m - was->pose.Z_m) +
                0.5 * (row->soil.M_Nm + was->soil.M_Nm) * (row->pose.phi_rad - was->pose.phi_rad);
        }

        const struct dig_rig_front here     = dig_rig_front_at(&machine, &row->joints);
        const struct dig_rig_front was      = dig_rig_front_at(&machine, &track.row[i - 1].joints);
        const struct dig_rig_front next     = dig_rig_front_at(&machine, &track.row[i + 1].joints);
        const double               span_s   = 2.0 * track.step_s;
        double                     height_J = 0.0;
        double                     speed_J  = 0.0;
        for (int j = 0; j < DIG_JOINTS; j++) {
            const struct dig_vec2 moved   = dig_vec2_sub(next.com_m[j], was.com_m[j]);
            const double          v_mps   = dig_vec2_norm(moved) / span_s;
            const double          w_radps = (next.attitude_rad[j] - was.attitude_rad[j]) / span_s;
            height_J += machine.link[j].mass_kg * 9.81 * here.com_m[j].y;
            speed_J += 0.5 * machine.link[j].mass_kg * v_mps * v_mps +
                       0.5 * machine.link[j].inertia_kgm2 * w_radps * w_radps;
        }
        first_J = i == 1 ? height_J + speed_J : first_J;
        most_J  = fmax(most_J, speed_J);
        worst_J = fmax(worst_J, fabs(work_J - (height_J + speed_J - first_J)));
    }
    assert_true(most_J > 100.0);
    assert_true(turned > 1e3);
    assert_true(worst_J < 0.005 * most_J);
    dig_rig_track_finish(&track);
    dig_recording_finish(&recording);
}

static void refuse(const struct dig_machine *const machine, const char *const path,
                   const struct dig_rig_track_options *const options,
                   const enum dig_status expected, const char *const word, const char *const other)
{
    struct dig_recording recording = read_recording(path);
    struct dig_rig_track track     = { .rows = 42 };
    struct dig_error     error     = { "" };
    assert_int_equal(dig_rig_track_build(machine, options, 1, &recording, &track, &error),
                     expected);
    assert_int_equal(track.rows, 42);
    assert_contains(error.text, word);
    assert_contains(error.text, other);
    dig_recording_finish(&recording);
}

TEST(dig_beyond_a_relief_pressure_is_refused_with_cylinder_peak_and_limit)
{
    struct dig_machine                 machine   = read_machine("zx200_trench");
    const struct dig_rig_track_options options   = dig_rig_track_options_default();
    machine.cylinder[DIG_JOINT_BUCKET].relief_Pa = 3e6;
    refuse(&machine, ACTUAL, &options, DIG_EINVAL, "bucket cylinder:", "relief 3.0 MPa");
}

TEST(dig_that_lifts_or_tips_the_machine_is_refused)
{
    struct dig_machine                 machine = read_machine("zx200_trench");
    const struct dig_rig_track_options options = dig_rig_track_options_default();
    machine.weight_N                           = 1e3;
    refuse(&machine, ACTUAL, &options, DIG_EINVAL, "machine tipped over its", "kNm");

    // Tracks so wide that nothing tips, front so light that the soil carries it all.
    machine.tip_front_X_m = 500.0;
    machine.tip_rear_X_m  = -500.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        machine.link[j].mass_kg = 10.0;
    }
    refuse(&machine, ACTUAL, &options, DIG_EINVAL, "machine lifted", "all weighs 1.3 kN");
}

TEST(standard_bucket_is_refused_as_more_than_the_machine_has)
{
    const struct dig_machine           machine = read_machine("zx200");
    const struct dig_rig_track_options options = dig_rig_track_options_default();
    refuse(&machine, ACTUAL, &options, DIG_EINVAL, "zx200 cannot do this dig", "");
}

TEST(dig_out_of_reach_is_refused)
{
    struct dig_machine                 machine = read_machine("zx200_trench");
    const struct dig_rig_track_options options = dig_rig_track_options_default();
    // Within reach of the links, but not of the arm's own range.
    machine.link[DIG_JOINT_ARM].max_rad = machine.link[DIG_JOINT_ARM].min_rad + 0.01;
    refuse(&machine, SIMPLE, &options, DIG_EUNREACHABLE, "arm joint:", "limit");

    machine = read_machine("zx200_trench");
    machine.cylinder[DIG_JOINT_ARM].max_length_m =
        machine.cylinder[DIG_JOINT_ARM].min_length_m + 0.01;
    refuse(&machine, SIMPLE, &options, DIG_EUNREACHABLE, "arm cylinder:", "limit");
}

// Which margin is left of a pose is counted by hand for a front of one heavy bucket.
TEST(ground_limits_are_those_of_a_beam_on_two_edges)
{
    struct dig_machine machine = read_machine("zx200_trench");
    for (int j = 0; j < DIG_JOINTS; j++) {
        machine.link[j].mass_kg = 1e-3;
    }
    machine.weight_N                  = 100e3;
    machine.weight_X_m                = 0.0;
    machine.tip_front_X_m             = 2.0;
    machine.tip_rear_X_m              = -2.0;
    machine.boom_foot_Z_m             = 2.0;
    const struct dig_rig_pose   pose  = { 6.0, -1.0, -1.5 };
    const struct dig_rig_motion still = { .turn_radps2 = { 0.0 } };
    // 100 kN hold 200 kNm about either edge; 20 kN up at 8 m from the rear edge take 160, 10 kN of
    // push 1 m above the ground give 10 back, a moment of 30 kNm takes the rest but 20.
    const struct dig_rig_wrench soil = { 10e3, 20e3, 30e3 };
    struct dig_rig_state        found;
    assert_int_equal(dig_rig_state_solve(&machine, &pose, &still, &soil, &found), DIG_OK);
    assert_int_equal(found.nearest.limit, DIG_RIG_LIMIT_TIP);
    assert_string_equal(found.nearest.end, "rear");
    assert_close(found.nearest.share, 20.0 / 200.0, 1e-4);
}
