// Tests for estimator/wrench/wrench.c

#include "estimator/wrench/wrench.h"

#include "core/linkage.h"
#include "core/units.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <string.h>

// A pose of a dig in front of the tracks, at random.
static void random_pose(uint64_t *const seed, const struct dig_machine *const machine,
                        double joint_rad[DIG_JOINTS])
{
    const double X_m     = 5.2 + 1.8 * model_uniform(seed);
    const double Z_m     = -1.6 + 0.9 * model_uniform(seed);
    const double phi_rad = (-130 + 70 * model_uniform(seed)) * DIG_RAD_PER_DEG;
    model_joints(machine, X_m, Z_m, phi_rad, joint_rad);
}

static struct model_load random_load(uint64_t *const seed)
{
    return (struct model_load){
        .FX_N = 12e3 * (model_uniform(seed) - 0.2),
        .FZ_N = 12e3 * (model_uniform(seed) - 0.5),
        .M_Nm = 30e3 * model_uniform(seed),
    };
}

static struct dig_wrench solve(const struct dig_machine *const machine,
                               const struct dig_sample *const  sample)
{
    struct dig_wrench wrench;
    struct dig_front  front;
    assert_int_equal(dig_wrench_solve(machine, sample, &wrench, &front), DIG_OK);
    return wrench;
}

TEST(the_load_that_virtual_work_holds_is_found_again)
{
    const struct dig_machine machine = model_machine();
    uint64_t                 seed    = 11;
    for (int trial = 0; trial < 300; trial++) {
        double joint_rad[DIG_JOINTS];
        random_pose(&seed, &machine, joint_rad);
        const struct model_load load      = random_load(&seed);
        const double            pitch_rad = 0.2 * (model_uniform(&seed) - 0.5);
        const struct dig_sample sample =
            model_sample(&machine, joint_rad, pitch_rad, &load, 1e6, 0);
        const struct dig_wrench wrench = solve(&machine, &sample);
        assert_true(wrench.moment_valid && wrench.force_valid);

        // The rig's x is the machine's -X; the moment is the same in both.
        assert_close(wrench.My_Nm, load.M_Nm, 0.05);
        assert_close(wrench.Fx_N, -load.FX_N, 0.05);
        assert_close(wrench.Fz_N, load.FZ_N, 0.05);
    }
}

TEST(a_missing_pitch_counts_as_level)
{
    const struct dig_machine machine     = model_machine();
    const double             joint_rad[] = { 0.2, -1.2, -0.7 };
    const struct model_load  load        = { 1e3, 2e3, 1e4 };
    struct dig_sample        sample      = model_sample(&machine, joint_rad, 0.0, &load, 1e6, 0);
    sample.valid[DIG_SIGNAL_PITCH_rad]   = false;
    sample.value[DIG_SIGNAL_PITCH_rad]   = 0.3;
    assert_close(solve(&machine, &sample).My_Nm, 1e4, 0.05);
}

// Errors divided by sigma over many digs' poses: as many within one as a normal error has.
// Quantisation is no noise for one pose; over poses and return pressures it is.
TEST(one_sigma_covers_two_thirds_with_the_zx200s_sensors)
{
    const struct {
        double pressure_step_Pa, pressure_sigma_Pa, angle_sigma_rad;
    } sensors[] = { { 2e5, 5e4, 2e-4 }, { 2e5, 2e5, 1e-3 }, { 2e5, 0.0, 0.0 }, { 0.0, 1e2, 4e-3 } };
    enum { TRIALS = 12000 };
    for (size_t s = 0; s < sizeof sensors / sizeof sensors[0]; s++) {
        struct dig_machine machine = model_machine();
        machine.pressure_step_Pa   = sensors[s].pressure_step_Pa;
        machine.angle_step_rad     = 4e-4;
        machine.angle_sigma_rad    = sensors[s].angle_sigma_rad;
        for (int j = 0; j < DIG_JOINTS; j++) {
            machine.cylinder[j].pressure_sigma_Pa = sensors[s].pressure_sigma_Pa;
        }
        uint64_t seed  = 5;
        int      told  = 0;
        int      in[3] = { 0 };
        double   z2[3] = { 0.0 };
        for (int trial = 0; trial < TRIALS; trial++) {
            double joint_rad[DIG_JOINTS];
            random_pose(&seed, &machine, joint_rad);
            const struct model_load load    = random_load(&seed);
            const double            back_Pa = 8e5 + 6e5 * model_uniform(&seed);
            struct dig_sample sample = model_sample(&machine, joint_rad, 0.0, &load, back_Pa, 0);
            model_sense(&machine, &sample, &seed);
            const struct dig_wrench w = solve(&machine, &sample);
            if (!w.force_valid) {
                continue;
            }
            told++;
            const double z[3] = { (w.My_Nm - load.M_Nm) / w.sigma_My_Nm,
                                  (w.Fx_N + load.FX_N) / w.sigma_Fx_N,
                                  (w.Fz_N - load.FZ_N) / w.sigma_Fz_N };
            for (int i = 0; i < 3; i++) {
                in[i] += fabs(z[i]) < 1.0 ? 1 : 0;
                z2[i] += z[i] * z[i];
            }
        }
        assert_true(told > TRIALS * 9 / 10);
        for (int i = 0; i < 3; i++) {
            assert_close((double)in[i] / told, 0.68, 0.05);
            assert_close(sqrt(z2[i] / told), 1.0, 0.04);
        }
    }
}

TEST(sigma_grows_as_the_arm_stretches_and_ends_in_no_force)
{
    struct dig_machine machine = model_machine();
    machine.pressure_step_Pa   = 2e5;
    machine.angle_step_rad     = 4e-4;

    const struct model_load load        = { 0.0, 0.0, 5e3 };
    const double            at_90_rad[] = { 0.2, -1.57, -0.5 };
    const double            at_32_rad[] = { 0.0, -0.56, -0.9 };
    const struct dig_sample bent        = model_sample(&machine, at_90_rad, 0.0, &load, 1e6, 0);
    const struct dig_sample stretched   = model_sample(&machine, at_32_rad, 0.0, &load, 1e6, 0);
    const double            bent_N      = solve(&machine, &bent).sigma_Fx_N;
    const double            stretched_N = solve(&machine, &stretched).sigma_Fx_N;
    assert_true(stretched_N > 1.3 * bent_N);

    // Straight, the two equations of arm and boom are one.
    const double      at_2_rad[] = { 0.0, -0.035, -0.9 };
    struct dig_sample straight   = bent;
    for (int j = 0; j < DIG_JOINTS; j++) {
        straight.value[DIG_SIGNAL_BOOM_rad + j] = at_2_rad[j];
    }
    assert_false(solve(&machine, &straight).force_valid);
}

TEST(relief_stop_and_toggle_clear_what_they_spoil)
{
    const struct dig_machine machine     = model_machine();
    const double             joint_rad[] = { 0.2, -1.2, -0.7 };
    const struct model_load  load        = { 1e3, 2e3, 1e4 };
    const struct dig_sample  sample      = model_sample(&machine, joint_rad, 0.0, &load, 1e6, 0);

    struct dig_sample boom_relief = sample, bucket_relief = sample;
    boom_relief.value[DIG_SIGNAL_BOOM_HEAD_Pa]     = 3.43e7;
    bucket_relief.value[DIG_SIGNAL_BUCKET_HEAD_Pa] = 3.43e7;
    assert_true(solve(&machine, &boom_relief).moment_valid);
    assert_false(solve(&machine, &boom_relief).force_valid);
    assert_false(solve(&machine, &bucket_relief).moment_valid);
    assert_false(solve(&machine, &bucket_relief).force_valid);
    assert_close(solve(&machine, &bucket_relief).My_Nm, 0.0, 0.0);

    struct dig_machine stopped = machine;
    stopped.cylinder[DIG_JOINT_BUCKET].max_length_m =
        model_cylinder_m(&machine, DIG_JOINT_BUCKET, -0.7) + 0.003;
    assert_false(solve(&stopped, &sample).moment_valid);
    stopped = machine;
    stopped.cylinder[DIG_JOINT_ARM].min_length_m =
        model_cylinder_m(&machine, DIG_JOINT_ARM, -1.2) - 0.003;
    assert_true(solve(&stopped, &sample).moment_valid);
    assert_false(solve(&stopped, &sample).force_valid);

    // Far outside its range the four-bar cannot close; the pin is known all the same.
    struct dig_sample open            = sample;
    open.value[DIG_SIGNAL_BUCKET_rad] = 2.5;
    struct dig_wrench wrench;
    struct dig_front  front;
    assert_int_equal(dig_wrench_solve(&machine, &open, &wrench, &front), DIG_OK);
    assert_false(wrench.moment_valid || wrench.force_valid);
    assert_close(front.pin_m[DIG_JOINT_BUCKET].x, 5.65 * cos(0.2) + 2.89 * cos(-1.0), 1e-9);
}

// The moment is the bucket's own balance: boom and arm hold their links up, whatever they push
// with.
TEST(the_buckets_pressures_alone_tell_the_moment_and_no_force)
{
    struct dig_machine machine = model_machine();
    machine.pressure_step_Pa   = 2e5;
    machine.angle_step_rad     = 4e-4;

    const double            joint_rad[] = { 0.2, -1.2, -0.7 };
    const struct model_load load        = { 1e3, 2e3, 1e4 };
    const struct dig_sample sample      = model_sample(&machine, joint_rad, 0.0, &load, 1e6, 0);
    const struct dig_wrench whole       = solve(&machine, &sample);
    assert_true(whole.moment_valid && whole.force_valid);
    for (int s = DIG_SIGNAL_BOOM_HEAD_Pa; s <= DIG_SIGNAL_ARM_ROD_Pa + 1; s++) {
        struct dig_sample bare = sample; // one missing, in the end all four
        for (int k = DIG_SIGNAL_BOOM_HEAD_Pa; k <= DIG_SIGNAL_ARM_ROD_Pa; k++) {
            if (k == s || s > DIG_SIGNAL_ARM_ROD_Pa) {
                bare.valid[k] = false;
                bare.value[k] = 0.0;
            }
        }
        const struct dig_wrench w = solve(&machine, &bare);
        assert_true(w.moment_valid);
        assert_close(w.My_Nm, whole.My_Nm, 1e-9 * fabs(whole.My_Nm));
        assert_close(w.sigma_My_Nm, whole.sigma_My_Nm, 1e-9 * whole.sigma_My_Nm);
        assert_false(w.force_valid);
        assert_close(w.Fx_N, 0.0, 0.0);
        assert_close(w.Fz_N, 0.0, 0.0);
    }
}

TEST(what_is_missing_or_no_number_is_refused_and_writes_nothing)
{
    const struct dig_machine machine     = model_machine();
    const double             joint_rad[] = { 0.2, -1.2, -0.7 };
    const struct model_load  load        = { 1e3, 2e3, 1e4 };
    const struct dig_sample  sample      = model_sample(&machine, joint_rad, 0.0, &load, 1e6, 0);

    struct dig_wrench wrench, before;
    struct dig_front  front, front_before;
    memset(&wrench, 0x5a, sizeof wrench);
    memset(&front, 0x5a, sizeof front);
    memcpy(&before, &wrench, sizeof before);
    memcpy(&front_before, &front, sizeof front_before);
    for (int s = 0; s < DIG_SIGNAL_TEMPERATURE_degC; s++) {
        struct dig_sample bad = sample;
        bad.value[s]          = s % 2 == 0 ? NAN : INFINITY;
        assert_int_equal(dig_wrench_solve(&machine, &bad, &wrench, &front), DIG_EINVAL);
        if (s < DIG_SIGNALS_NEEDED) {
            bad             = sample;
            bad.valid[s]    = false;
            const bool told = s >= DIG_SIGNAL_BOOM_HEAD_Pa && s <= DIG_SIGNAL_ARM_ROD_Pa;
            if (!told) {
                assert_int_equal(dig_wrench_solve(&machine, &bad, &wrench, &front), DIG_ESTALE);
            }
        }
    }
    assert_memory_equal(&wrench, &before, sizeof wrench);
    assert_memory_equal(&front, &front_before, sizeof front);
}
