// Tests for estimator/wrench/correction.c and dig_wrench_correct() of wrench.c: samples of a
// machine that is not as its file says, made by virtual work, must give the true load back.

#include "estimator/wrench/correction.h"

#include "core/linkage.h"
#include "estimator/wrench/cylinder.h"
#include "estimator/wrench/wrench.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

static const double            pose[DIG_JOINTS] = { 0.35, -1.5, -0.8 };
static const struct model_load load             = { -20e3, 15e3, 12e3 };

static const struct dig_rates still = { .velocity_sigma = 0.0 };

static enum dig_status apply(const struct dig_machine *const file, const struct dig_correction c)
{
    static const struct dig_correction none;
    struct dig_corrected_machine       made;
    const enum dig_status              status = dig_correction_apply(file, &c, &made);
    assert_true(status != DIG_OK || made.corrects == (memcmp(&c, &none, sizeof c) != 0));
    return status;
}

static void expect_load(const struct dig_machine *const file, const struct dig_correction *const c,
                        const struct dig_sample *const sample, const struct dig_rates *const rates,
                        const double tolerance)
{
    const struct dig_machine corrected = dig_correction_machine(file, c);
    struct dig_wrench        w;
    struct dig_front         front;
    assert_int_equal(apply(file, *c), DIG_OK);
    assert_int_equal(dig_wrench_correct(&corrected, c, sample, rates,
                                        DIG_WITH_SIGMA | DIG_WITH_INERTIA, &w, &front),
                     DIG_OK);
    assert_true(w.moment_valid && w.force_valid);
    assert_close(w.My_Nm, load.M_Nm, tolerance);
    assert_close(w.Fx_N, -load.FX_N, tolerance);
    assert_close(w.Fz_N, load.FZ_N, tolerance);
}

// A sample of the true machine; what a joint's push is more than needed goes into its head side.
static struct dig_sample sample_of(const struct dig_machine *const truth,
                                   const double                    more_N[DIG_JOINTS])
{
    struct dig_sample sample = model_sample(truth, pose, 0.0, &load, 1e6, 1);
    for (int j = 0; j < DIG_JOINTS; j++) {
        const struct dig_cylinder *const c = &truth->cylinder[j];
        sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j] +=
            more_N[j] / (c->count * 0.25 * 3.14159265358979 * c->bore_m * c->bore_m);
    }
    return sample;
}

TEST(nothing_corrected_at_rest_is_the_plain_wrench)
{
    const struct dig_machine    machine = model_machine();
    const struct dig_correction none    = { .delay_s = 0.0 };
    const double                zero[3] = { 0.0 };
    const struct dig_sample     sample  = sample_of(&machine, zero);
    struct dig_wrench           plain, corrected;
    struct dig_front            front;
    assert_int_equal(dig_wrench_solve(&machine, &sample, &plain, &front), DIG_OK);
    assert_int_equal(dig_wrench_correct(&machine, &none, &sample, &still,
                                        DIG_WITH_SIGMA | DIG_WITH_INERTIA, &corrected, &front),
                     DIG_OK);
    assert_close(corrected.My_Nm, plain.My_Nm, 1e-6);
    assert_close(corrected.Fx_N, plain.Fx_N, 1e-6);
    assert_close(corrected.sigma_Fz_N, plain.sigma_Fz_N, 1e-6 * plain.sigma_Fz_N);
    expect_load(&machine, &none, &sample, &still, 0.1);
}

TEST(offsets_and_gains_are_taken_off)
{
    const struct dig_machine machine = model_machine();
    const double             zero[3] = { 0.0 };
    struct dig_sample        sample  = sample_of(&machine, zero);
    struct dig_correction    c       = { .delay_s = 0.0 };
    for (int j = 0; j < DIG_JOINTS; j++) {
        for (int s = 0; s < DIG_CHAMBERS; s++) {
            c.offset_Pa[j][s] = 1e5 * (j + 1) - 3e5 * s;
            c.gain[j][s]      = 0.02 * (s + 1) - 0.01 * j;
            double *const at  = &sample.value[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j + s];
            *at               = c.offset_Pa[j][s] + (1.0 + c.gain[j][s]) * *at;
        }
    }
    expect_load(&machine, &c, &sample, &still, 0.1);
}

TEST(another_bucket_payload_and_linkage_are_taken_off)
{
    const struct dig_machine    file = model_machine();
    const struct dig_correction c    = {
           .link[DIG_JOINT_BUCKET] = { 40.0, { 12.0, -5.0 }, 3.0 },
           .payload                = { 60.0, { 4.0, 2.0 }, 0.0 },
           .rocker_m               = 0.01,
           .link_m                 = -0.008,
           .ear_m                  = { 0.004, -0.006 },
           .rocker_pin_m           = { -0.005, 0.003 },
           .base_m                 = { { 0.01, 0.0 }, { 0.0, 0.02 }, { -0.01, 0.01 } },
           .eye_m                  = { { 0.0, 0.01 }, { -0.01, 0.0 }, { 0.0, 0.0 } },
    };
    // The true machine, put together here: first moments add up.
    struct dig_machine     truth  = file;
    struct dig_link *const bucket = &truth.link[DIG_JOINT_BUCKET];
    const double           m0     = bucket->mass_kg;
    const struct dig_vec2  at     = { bucket->com_m.x, bucket->com_m.y };
    bucket->mass_kg               = m0 + 100.0;
    const double mx               = m0 * at.x + 40.0 * at.x + 12.0;
    const double my               = m0 * at.y + 40.0 * at.y - 5.0;
    bucket->com_m.x               = (mx + 60.0 * mx / (m0 + 40.0) + 4.0) / bucket->mass_kg;
    bucket->com_m.y               = (my + 60.0 * my / (m0 + 40.0) + 2.0) / bucket->mass_kg;
    truth.four_bar.rocker_m += 0.01;
    truth.four_bar.link_m -= 0.008;
    truth.four_bar.ear_m.x += 0.004;
    truth.four_bar.ear_m.y -= 0.006;
    truth.four_bar.rocker_pin_m.x -= 0.005;
    truth.four_bar.rocker_pin_m.y += 0.003;
    truth.cylinder[0].base_m.x += 0.01;
    truth.cylinder[1].base_m.y += 0.02;
    truth.cylinder[2].base_m.x -= 0.01;
    truth.cylinder[2].base_m.y += 0.01;
    truth.cylinder[0].eye_m.y += 0.01;
    truth.cylinder[1].eye_m.x -= 0.01;
    const double            zero[3] = { 0.0 };
    const struct dig_sample sample  = sample_of(&truth, zero);
    expect_load(&file, &c, &sample, &still, 0.5);
}

// A base pin that is not where the file has it makes every length another one. Where the drive
// meets its stops is known by the lengths as the file draws them, before and after.
TEST(moved_pins_leave_the_stops_where_they_are)
{
    struct dig_machine          machine = model_machine();
    const double                zero[3] = { 0.0 };
    const struct dig_correction moved   = { .base_m[DIG_JOINT_ARM] = { 0.0, 0.06 } };
    const struct dig_sample     sample  = sample_of(&machine, zero);
    struct dig_lever            lever;
    assert_int_equal(dig_lever_solve(&machine, DIG_JOINT_ARM, pose[DIG_JOINT_ARM], &lever), DIG_OK);
    struct dig_cylinder *const arm = &machine.cylinder[DIG_JOINT_ARM];
    for (int at_stop = 0; at_stop <= 1; at_stop++) {
        const double      clear_m = (at_stop ? 0.5 : 2.0) * DIG_CYLINDER_STOP_MARGIN_m;
        struct dig_wrench w;
        struct dig_front  front;
        arm->min_length_m                  = lever.length_m - clear_m;
        arm->max_length_m                  = lever.length_m + clear_m;
        const struct dig_machine corrected = dig_correction_machine(&machine, &moved);
        assert_int_equal(dig_wrench_correct(&corrected, &moved, &sample, &still,
                                            DIG_WITH_SIGMA | DIG_WITH_INERTIA, &w, &front),
                         DIG_OK);
        assert_true(w.moment_valid);
        assert_int_equal(w.force_valid, !at_stop);
    }
}

TEST(friction_is_taken_off_in_both_directions)
{
    const struct dig_machine machine = model_machine();
    for (int way = -1; way <= 1; way += 2) {
        struct dig_rates      rates = still;
        struct dig_correction c     = { .delay_s = 0.0 };
        double                more_N[DIG_JOINTS], pushes[DIG_JOINTS];
        model_pushes_N(&machine, pose, 0.0, &load, pushes);
        for (int j = 0; j < DIG_JOINTS; j++) {
            // No inertia: velocities alone, so small that nothing else comes of them.
            const double slope      = model_slope_m(&machine, (enum dig_joint)j, pose[j]);
            const double v          = way * 0.02;
            rates.velocity_radps[j] = v / slope;
            c.friction[j] = (struct dig_friction){ 900.0 + 100.0 * j, 2e4, 0.0, 0.0, 0.03 };
            // loss = (dry + share |push|) sign + viscous v, with push = needed + loss.
            const double even = 900.0 + 100.0 * j + 2e4 * 0.02;
            const double sign = way * (pushes[j] > 0.0 ? 1.0 : -1.0);
            more_N[j]         = way * (even + 0.03 * fabs(pushes[j])) / (1.0 - 0.03 * sign);
        }
        const struct dig_sample sample = sample_of(&machine, more_N);
        // 0.4 kN: what turns at these rates has centrifugal forces of its own.
        expect_load(&machine, &c, &sample, &rates, 400.0);
    }
}

TEST(noise_of_the_rates_widens_sigma)
{
    const struct dig_machine    machine = model_machine();
    const struct dig_correction none    = { .delay_s = 0.0 };
    const double                zero[3] = { 0.0 };
    const struct dig_sample     sample  = sample_of(&machine, zero);
    const struct dig_rates      noisy   = { .acceleration_sigma = 0.5 };
    struct dig_wrench           calm, shaken;
    struct dig_front            front;
    assert_int_equal(dig_wrench_correct(&machine, &none, &sample, &still,
                                        DIG_WITH_SIGMA | DIG_WITH_INERTIA, &calm, &front),
                     DIG_OK);
    assert_int_equal(dig_wrench_correct(&machine, &none, &sample, &noisy,
                                        DIG_WITH_SIGMA | DIG_WITH_INERTIA, &shaken, &front),
                     DIG_OK);
    // All joints' accelerations turn the bucket: each adds its part.
    uint64_t seed = 3;
    double   sum2 = 0.0;
    for (int i = 0; i < 4000; i++) {
        struct dig_rates r = still;
        for (int j = 0; j < DIG_JOINTS; j++) {
            r.acceleration_radps2[j] = 0.5 * model_normal(&seed);
        }
        struct dig_wrench w;
        assert_int_equal(dig_wrench_correct(&machine, &none, &sample, &r,
                                            DIG_WITH_SIGMA | DIG_WITH_INERTIA, &w, &front),
                         DIG_OK);
        sum2 += pow(w.My_Nm - calm.My_Nm, 2.0);
    }
    const double expected = hypot(calm.sigma_My_Nm, sqrt(sum2 / 4000));
    assert_close(shaken.sigma_My_Nm, expected, 0.05 * expected);
}

// Over all poses, of angles that are read badly: what lies a sigma away from a toggle or from a
// stretched arm is not told, with sigmas or without.
TEST(without_sigmas_the_same_is_told)
{
    enum { STEPS = 64 };
    struct dig_machine          rough = model_machine();
    const struct dig_correction c     = { .friction = { { .coulomb_N = 900.0 } } };
    const struct dig_rates rates = { .velocity_radps = { 0.1, -0.2, 0.3 }, .velocity_sigma = 0.01 };
    const double           zero[DIG_JOINTS] = { 0.0 };
    struct dig_sample      sample           = sample_of(&rough, zero);
    size_t                 spoilt           = 0;
    rough.four_bar.link_m *= 0.7; // it has a toggle, and no stop comes before it
    for (int j = 0; j < DIG_JOINTS; j++) {
        rough.cylinder[j].min_length_m = 0.0;
        rough.cylinder[j].max_length_m = 100.0;
    }
    for (size_t i = 0; i < (size_t)STEPS * STEPS; i++) {
        struct dig_wrench told[2], sharp;
        struct dig_front  front[2];
        sample.value[DIG_SIGNAL_ARM_rad]    = -2.8 + 3.0 * (double)(i / STEPS) / STEPS;
        sample.value[DIG_SIGNAL_BUCKET_rad] = -3.0 + 6.0 * (double)(i % STEPS) / STEPS;
        rough.angle_sigma_rad               = 1e-6;
        assert_int_equal(dig_wrench_correct(&rough, &c, &sample, &rates,
                                            DIG_WITH_SIGMA | DIG_WITH_INERTIA, &sharp, &front[0]),
                         DIG_OK);
        rough.angle_sigma_rad = 0.1;
        assert_int_equal(dig_wrench_correct(&rough, &c, &sample, &rates,
                                            DIG_WITH_SIGMA | DIG_WITH_INERTIA, &told[0], &front[0]),
                         DIG_OK);
        assert_int_equal(
            dig_wrench_correct(&rough, &c, &sample, &rates, DIG_WITH_INERTIA, &told[1], &front[1]),
            DIG_OK);
        assert_memory_equal(&front[0], &front[1], sizeof front[0]);
        assert_int_equal(told[0].moment_valid, told[1].moment_valid);
        assert_int_equal(told[0].force_valid, told[1].force_valid);
        assert_memory_equal(&told[0].My_Nm, &told[1].My_Nm, sizeof told[0].My_Nm);
        assert_memory_equal(&told[0].Fx_N, &told[1].Fx_N, sizeof told[0].Fx_N);
        assert_memory_equal(&told[0].Fz_N, &told[1].Fz_N, sizeof told[0].Fz_N);
        assert_true(fabs(told[1].sigma_My_Nm) + fabs(told[1].sigma_Fx_N) <= 0.0);
        spoilt |= sharp.moment_valid && !told[1].moment_valid ? 1U : 0U;
        spoilt |=
            sharp.force_valid && sharp.moment_valid && told[1].moment_valid && !told[1].force_valid
                ? 2U
                : 0U;
        spoilt |= told[1].force_valid ? 4U : 0U;
    }
    assert_int_equal(spoilt, 7);
}

TEST(what_cannot_be_is_refused)
{
    const struct dig_machine machine = model_machine();
#define APPLY(...) apply(&machine, (struct dig_correction){ __VA_ARGS__ })
    assert_int_equal(APPLY(.delay_s = (double)NAN), DIG_EINVAL);
    assert_int_equal(APPLY(.gain = { { -1.0 } }), DIG_EINVAL);
    assert_int_equal(APPLY(.link[DIG_JOINT_BUCKET] = { .mass_kg = -1e5 }), DIG_EINVAL);
    assert_int_equal(APPLY(.rocker_m = 5.0), DIG_EUNREACHABLE);
    assert_int_equal(APPLY(.offset_Pa = { { 1.0 } }), DIG_OK);
#undef APPLY
}
