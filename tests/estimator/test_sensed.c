// Tests for estimator/wrench/sensed.c: a rig's force sensor read by virtual work
// (tools/rig/motion/gauge.c), and back by a balance of forces.

#include "estimator/wrench/sensed.h"

#include "tests/made_table.h"
#include "tests/model_front.h"
#include "tests/read.h"
#include "tools/rig/motion/gauge.h"
#include "tools/rig/motion/track.h"
#include "tools/rig/sensors.h"

#include <stdlib.h>
#include <string.h>

static double between(uint64_t *const seed, const double low, const double high)
{
    return low + (high - low) * model_uniform(seed);
}

static struct dig_vec2 turned(const double rad, const double x, const double y)
{
    return (struct dig_vec2){ x * cos(rad) - y * sin(rad), x * sin(rad) + y * cos(rad) };
}

// A sample that holds everything, at rest.
static struct dig_sample resting(void)
{
    const struct dig_machine machine = read_machine("rig_sensor");
    const struct dig_rig_row row     = { .pose = { 0.3, 0.2, -1.4 }, .load = { 1.0, -2.0, 0.1 } };
    return dig_rig_sense(&machine, &row, 1, NULL);
}

// How a bucket moves that is at these poses, span_s apart: second differences.
static struct dig_rig_motion motion_of(const struct dig_machine *const machine,
                                       const struct dig_rig_pose pose[const 3], const double span_s)
{
    static const double   share[3] = { 1.0, -2.0, 1.0 };
    struct dig_rig_motion motion   = { .turn_radps2 = { 0.0 } };
    for (int k = 0; k < 3; k++) {
        const double          per_s2 = share[k] / (span_s * span_s);
        const struct dig_vec2 com =
            dig_rig_front_carried(machine, &pose[k]).com_m[DIG_JOINT_BUCKET];
        struct dig_vec2 *const sum = &motion.com_mps2[DIG_JOINT_BUCKET];
        *sum                       = dig_vec2_add_scaled(*sum, per_s2, com);
        motion.turn_radps2[DIG_JOINT_BUCKET] += per_s2 * pose[k].phi_rad;
    }
    return motion;
}

// The machine leans by a pitch: gravity is plumb in the world, all else is told in its own frame.
TEST(the_load_that_virtual_work_holds_is_found_again)
{
    uint64_t seed = 5;
    for (int trial = 0; trial < 300; trial++) {
        struct dig_machine machine = read_machine("rig_sensor");
        machine.sensor.place_m =
            (struct dig_vec2){ between(&seed, -0.1, 0.1), between(&seed, -0.1, 0.1) };
        machine.sensor.turn_rad      = between(&seed, -3.0, 3.0);
        const double          lean   = between(&seed, -0.3, 0.3);
        const double          phi    = between(&seed, -3.0, 3.0);
        const double          spin   = between(&seed, -2.0, 2.0);
        const double          alpha  = between(&seed, -30.0, 30.0);
        const struct dig_vec2 pin    = { between(&seed, -3.0, 3.0), between(&seed, -3.0, 3.0) };
        const double          soil[] = { between(&seed, -20.0, 20.0), between(&seed, -20.0, 20.0),
                                         between(&seed, -3.0, 3.0) };

        // Where the bucket was and will be, drawn in the world: parabolas in time.
        const double        h = 1e-4;
        struct dig_rig_pose world[3];
        for (int k = 0; k < 3; k++) {
            const double t = h * (k - 1);
            world[k] = (struct dig_rig_pose){ pin.x + 0.5 * 4.0 * t * t, pin.y - 0.5 * 3.0 * t * t,
                                              phi + lean + spin * t + 0.5 * alpha * t * t };
        }
        const struct dig_rig_motion motion = motion_of(&machine, world, h);
        const struct dig_vec2       force  = turned(lean, soil[0], soil[1]);
        const struct dig_rig_wrench load   = { force.x, force.y, soil[2] };
        const struct dig_rig_row    row    = {
                  .pose = { pin.x, pin.y, phi },
                  .load = dig_rig_gauge_read(&machine, &world[1], &motion, &load),
        };
        struct dig_sample sample             = dig_rig_sense(&machine, &row, 1, NULL);
        sample.value[DIG_SIGNAL_PITCH_rad]   = lean;
        const struct dig_sensed_motion moves = { .pin_mps2    = turned(-lean, 4.0, -3.0),
                                                 .turn_radps  = spin,
                                                 .turn_radps2 = alpha };
        struct dig_wrench              wrench;
        struct dig_front               front;
        assert_int_equal(dig_sensed_solve(&machine, &sample, &moves, &wrench, &front), DIG_OK);
        assert_true(wrench.moment_valid && wrench.force_valid);
        assert_close(wrench.Fx_N, -soil[0], 1e-5);
        assert_close(wrench.Fz_N, soil[1], 1e-5);
        assert_close(wrench.My_Nm, soil[2], 1e-5);
        assert_close(front.pin_m[DIG_JOINT_BUCKET].x, pin.x, 0.0);
        assert_close(front.pin_m[DIG_JOINT_BUCKET].y, pin.y, 0.0);
        assert_close(front.attitude_rad[DIG_JOINT_BUCKET], phi, 0.0);
    }
}

enum { DIGS = 2 };

struct run {
    struct dig_machine   machine;
    struct dig_recording recording[DIGS];
    struct dig_rig_track track;
};

static struct run start(const bool quasi_static)
{
    static const char *const files[DIGS] = {
        "tests/data/reference/mu0.5_mur0.5_rho2500__simpleA.csv",
        "tests/data/reference/mu0.5_mur0.5_rho2500__actual.csv"
    };
    struct dig_error             error   = { "" };
    struct run                   run     = { .machine = read_machine("rig_sensor") };
    struct dig_rig_track_options options = dig_rig_track_options_default();
    options.quasi_static                 = quasi_static;
    for (int d = 0; d < DIGS; d++) {
        run.recording[d] = read_recording(files[d]);
    }
    assert_ok(dig_rig_track_build(&run.machine, &options, DIGS, run.recording, &run.track, &error),
              error);
    return run;
}

static void finish(struct run *const run)
{
    for (int d = 0; d < DIGS; d++) {
        dig_recording_finish(&run->recording[d]);
    }
    dig_rig_track_finish(&run->track);
}

static int64_t row_ns(const struct run *const run, const size_t row)
{
    return (int64_t)(1e9 * run->track.step_s * (double)row) + 1;
}

TEST(without_noise_and_motion_the_recording_comes_back)
{
    const struct dig_sensed_motion still = { .turn_radps = 0.0 };
    struct run                     run   = start(true);
    double                         most  = 0.0;
    for (size_t i = 0; i < run.track.rows; i++) {
        const struct dig_rig_row *const row = &run.track.row[i];
        const struct dig_sample sample = dig_rig_sense(&run.machine, row, row_ns(&run, i), NULL);
        struct dig_wrench       w;
        struct dig_front        front;
        assert_int_equal(dig_sensed_solve(&run.machine, &sample, &still, &w, &front), DIG_OK);
        most = fmax(most, fabs(w.My_Nm - row->soil.M_Nm));
        most = fmax(most, fabs(w.Fx_N + row->soil.FX_N));
        most = fmax(most, fabs(w.Fz_N - row->soil.FZ_N));
    }
    print_message("largest error: %.2g N or Nm\n", most);
    assert_true(most < 1e-7);
    finish(&run);
}

// Noise, steps and the motion's inertia, taken off as the tick does it.
TEST(one_sigma_covers_two_thirds_of_each_part)
{
    static const char *const name[3]  = { "My", "Fx", "Fz" };
    struct run               run      = start(false);
    double                   in[3]    = { 0.0 };
    double                   miss2[3] = { 0.0 };
    double                   sigma[3] = { 0.0 };
    double                   all      = 0.0;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct dig_rig_noise    noise  = dig_rig_noise_init(seed);
        struct dig_rates_filter filter = { .window_s = 0.1 };
        for (size_t i = 0; i < run.track.rows; i++) {
            const struct dig_rig_row *const row = &run.track.row[i];
            struct dig_sample sample = dig_rig_sense(&run.machine, row, row_ns(&run, i), &noise);
            dig_rig_quantise(&run.machine, &sample);
            const struct dig_sensed_motion motion = dig_sensed_move(&filter, &run.machine, &sample);
            struct dig_wrench              w;
            struct dig_front               front;
            assert_int_equal(dig_sensed_solve(&run.machine, &sample, &motion, &w, &front), DIG_OK);
            if (fabs(row->soil.M_Nm) < 0.05) {
                continue; // in the air one pose and one rounding stand for seconds
            }
            const double off[3] = { w.My_Nm - row->soil.M_Nm, w.Fx_N + row->soil.FX_N,
                                    w.Fz_N - row->soil.FZ_N };
            const double one[3] = { w.sigma_My_Nm, w.sigma_Fx_N, w.sigma_Fz_N };
            for (int p = 0; p < 3; p++) {
                in[p] += fabs(off[p]) < one[p] ? 1.0 : 0.0;
                miss2[p] += off[p] * off[p];
                sigma[p] += one[p];
            }
            all += 1.0;
        }
    }
    assert_true(all > 5000.0);
    for (int p = 0; p < 3; p++) {
        const double rms = sqrt(miss2[p] / all);
        print_message("%s: %.1f %% within one sigma, mean sigma %.3f of the rms error\n", name[p],
                      100.0 * in[p] / all, sigma[p] / all / rms);
        assert_close(in[p] / all, 0.68, 0.05);
        assert_true(sigma[p] / all <= 1.2 * rms);
    }
    finish(&run);
}

TEST(what_does_not_average_down_is_the_rounding_that_stands)
{
    const struct dig_sensed_motion still   = { .turn_radps = 0.0 };
    struct dig_machine             machine = read_machine("rig_sensor");
    const struct dig_sample        sample  = resting();
    struct dig_wrench              dithered, bare;
    struct dig_front               front;
    assert_int_equal(dig_sensed_solve(&machine, &sample, &still, &dithered, &front), DIG_OK);
    machine.sensor.sigma_N = machine.sensor.sigma_Nm = machine.angle_sigma_rad = 0.0;
    assert_int_equal(dig_sensed_solve(&machine, &sample, &still, &bare, &front), DIG_OK);
    assert_true(dithered.slow_sigma_Fx_N < 0.01 * dithered.sigma_Fx_N);
    assert_close(bare.slow_sigma_Fx_N / bare.sigma_Fx_N, sqrt(6.0) / 3.14159265, 1e-6);
    assert_close(bare.sigma_Fz_N, machine.sensor.step_N / sqrt(12.0), 1e-9);
}

TEST(beyond_its_range_the_sensor_says_nothing)
{
    const struct dig_machine       machine = read_machine("rig_sensor");
    const struct dig_sensed_motion still   = { .turn_radps = 0.0 };
    const struct {
        enum dig_signal signal;
        double          limit;
    } ends[] = { { DIG_SIGNAL_SENSOR_FX_N, -machine.sensor.limit_N },
                 { DIG_SIGNAL_SENSOR_FZ_N, machine.sensor.limit_N },
                 { DIG_SIGNAL_SENSOR_MY_Nm, machine.sensor.limit_Nm } };
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        struct dig_sample sample = resting();
        struct dig_wrench w;
        struct dig_front  front;

        sample.value[ends[i].signal] = 0.98 * ends[i].limit;
        assert_int_equal(dig_sensed_solve(&machine, &sample, &still, &w, &front), DIG_OK);
        assert_true(w.moment_valid && w.force_valid);
        sample.value[ends[i].signal] = ends[i].limit;
        assert_int_equal(dig_sensed_solve(&machine, &sample, &still, &w, &front), DIG_OK);
        assert_false(w.moment_valid || w.force_valid);
        assert_close(w.My_Nm, 0.0, 0.0);
        assert_close(front.pin_m[DIG_JOINT_BUCKET].x, 0.3, 0.0);
    }
}

TEST(a_sample_that_lacks_anything_is_refused_untouched)
{
    const struct dig_machine       machine = read_machine("rig_sensor");
    const struct dig_sensed_motion still   = { .turn_radps = 0.0 };
    struct dig_wrench              w;
    struct dig_front               front;
    memset(&w, 0x5a, sizeof w);
    const struct dig_wrench untouched = w;
    for (int s = 0; s < DIG_SIGNALS; s++) {
        struct dig_sample sample = resting();
        if (!sample.valid[s]) {
            continue;
        }
        sample.valid[s] = false;
        assert_int_equal(dig_sensed_solve(&machine, &sample, &still, &w, &front),
                         s == DIG_SIGNAL_PITCH_rad ? DIG_OK : DIG_ESTALE);
        sample.valid[s] = true;
        sample.value[s] = (double)NAN;
        memcpy(&w, &untouched, sizeof w);
        assert_int_equal(dig_sensed_solve(&machine, &sample, &still, &w, &front), DIG_EINVAL);
        assert_memory_equal(&w, &untouched, sizeof w);
    }
}

// The estimator on the rig: both digs are found, and what it observes is what was recorded.
TEST(a_whole_run_gives_both_digs)
{
    const struct made_options           options   = { .relative_sd = 0.1, .packings = 3 };
    struct dig_curve_set *const         set       = made_table(&options);
    struct run                          run       = start(false);
    struct dig_rig_noise                noise     = dig_rig_noise_init(7);
    struct dig_estimator *const         estimator = malloc(dig_estimator_size());
    const struct dig_estimator_settings settings  = dig_estimator_settings_default();
    assert_int_equal(dig_estimator_init(estimator, &run.machine, set, &settings), DIG_OK);

    double truth_Nm = 0.0, found_Nm = 0.0;
    int    digs = 0;
    for (size_t i = 0; i < run.track.rows; i++) {
        struct dig_sample sample =
            dig_rig_sense(&run.machine, &run.track.row[i], row_ns(&run, i), &noise);
        dig_rig_quantise(&run.machine, &sample);
        struct dig_estimate    estimate;
        struct dig_observation o;
        assert_int_equal(dig_estimator_step(estimator, &sample, &estimate), DIG_OK);
        truth_Nm += run.track.row[i].soil.M_Nm;
        found_Nm += estimate.wrench.My_Nm;
        if (made_observed(estimator, set, &o)) {
            assert_true(digs < DIGS);
            assert_int_equal(o.trajectory, digs == 0 ? MADE_SIMPLE_A : MADE_ACTUAL);
            // Cut corners are all that is off the path.
            assert_true(o.forces && o.off_path_m < run.track.blend_off_m);
            assert_true(o.last - o.first > 0.95);
            digs++;
        }
    }
    assert_int_equal(digs, DIGS);
    assert_close(found_Nm / truth_Nm, 1.0, 1e-3);
    free(estimator);
    finish(&run);
    made_table_destroy(set);
}
