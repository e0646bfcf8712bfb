// Tests for closed_loop/verdict/air_motion.c

#include "closed_loop/verdict/air_motion.h"

#include "core/units.h"
#include "tests/read.h"

static struct dig_machine machine;

static int read(void **state)
{
    (void)state;
    machine = read_machine("zx200_trench");
    return 0;
}

static const struct dig_correction nothing = { .delay_s = 0.0 };

static double sigmas(const enum dig_joint joint, const bool fast,
                     const struct dig_correction *const a, const struct dig_correction *const b)
{
    const struct dig_motion motion = { joint, fast };
    double                  told   = -1.0;
    assert_int_equal(dig_motion_sigmas(&machine, &motion, a, b, &told), DIG_OK);
    return told;
}

static struct dig_motion best(const struct dig_correction *const a,
                              const struct dig_correction *const b)
{
    struct dig_motion motion;
    double            told = -1.0;
    assert_int_equal(dig_motion_best(&machine, a, b, &motion, &told), DIG_OK);
    assert_true(told > 0.0);
    return motion;
}

TEST(what_differs_in_speed_alone_is_told_by_moving_that_joint_fast)
{
    for (int j = 0; j < DIG_JOINTS; j++) {
        struct dig_correction seal = { .delay_s = 0.0 };
        struct dig_correction oil  = { .delay_s = 0.0 };
        seal.friction[j]           = (struct dig_friction){ .coulomb_N = 3000.0 };
        oil.friction[j] = (struct dig_friction){ .coulomb_N = 3000.0, .viscous_Nspm = 1e5 };
        const struct dig_motion motion = best(&seal, &oil);
        assert_int_equal(motion.joint, j);
        assert_true(motion.fast);
        // Five times as fast: five times as much, but for angles that noise makes less sure.
        const double slow = sigmas((enum dig_joint)j, false, &seal, &oil);
        assert_close(sigmas((enum dig_joint)j, true, &seal, &oil) / slow, 5.0, 0.5);
        // Of a joint that is held it tells nothing.
        assert_close(sigmas((enum dig_joint)((j + 1) % DIG_JOINTS), true, &seal, &oil) / slow, 0.0,
                     1e-3);
    }
}

TEST(what_a_turning_bucket_alone_feels_is_told_by_turning_it_fast)
{
    const struct dig_correction heavy = { .link[DIG_JOINT_BUCKET] = { .inertia_kgm2 = 500.0 } };
    assert_true(best(&heavy, &nothing).fast);
    // Inertia asks for acceleration, which goes with the square of the speed.
    assert_close(sigmas(DIG_JOINT_BUCKET, true, &heavy, &nothing) /
                     sigmas(DIG_JOINT_BUCKET, false, &heavy, &nothing),
                 25.0, 5.0);
}

// A constant error of a pressure is one force more in every row of its drive, whatever moves: the
// readings of 20 s at 100 Hz average to 1 / sqrt(2000) of one's noise, or somewhat more, for slow
// errors of a sensor do not average and angles are not known exactly.
TEST(an_offset_is_as_many_sigmas_as_its_force_is_of_the_noise)
{
    struct dig_correction offset = { .delay_s = 0.0 };
    const double          Pa     = 3e4;
    const double          one_Pa = hypot(1e5, 2e5 / sqrt(12.0));

    const struct dig_cylinder *const arm = &machine.cylinder[DIG_JOINT_ARM];

    const double head_m2 = 0.25 * DIG_PI * arm->bore_m * arm->bore_m;
    const double rod_m2  = 0.25 * DIG_PI * (arm->bore_m * arm->bore_m - arm->rod_m * arm->rod_m);
    const double most    = Pa * head_m2 / (one_Pa * hypot(head_m2, rod_m2)) * sqrt(2000.0);
    offset.offset_Pa[DIG_JOINT_ARM][DIG_CHAMBER_HEAD] = Pa;
    const double slow = sigmas(DIG_JOINT_BUCKET, false, &offset, &nothing);
    assert_true(slow > 0.5 * most && slow <= 1.001 * most);
    // What differs in no motion is told by the slowest, which asks least of the machine.
    assert_false(best(&offset, &nothing).fast);
}

// The offset that comes nearest to a rocker drawn too short while the bucket is held is found by
// search: what is left of their difference shows where the linkage moves.
TEST(a_linkage_that_looks_like_an_offset_is_told_by_turning_the_bucket)
{
    const struct dig_correction rocker  = { .rocker_m = 0.01 };
    struct dig_correction       nearest = { .delay_s = 0.0 };
    double                      least   = 1e9;
    for (int k = -60; k <= 60; k++) {
        struct dig_correction offset                         = { .delay_s = 0.0 };
        offset.offset_Pa[DIG_JOINT_BUCKET][DIG_CHAMBER_HEAD] = 1e3 * k;
        const double left = sigmas(DIG_JOINT_ARM, false, &rocker, &offset);
        nearest           = left < least ? offset : nearest;
        least             = fmin(left, least);
    }
    assert_true(fabs(nearest.offset_Pa[DIG_JOINT_BUCKET][DIG_CHAMBER_HEAD]) < 5.9e4);
    assert_int_equal(best(&rocker, &nearest).joint, DIG_JOINT_BUCKET);
}

TEST(what_is_the_same_is_told_by_nothing)
{
    const struct dig_correction heavy = { .link[DIG_JOINT_BUCKET] = { .mass_kg = 100.0 } };
    struct dig_motion           motion;
    double                      told = -1.0;
    assert_close(sigmas(DIG_JOINT_ARM, true, &heavy, &heavy), 0.0, 0.0);
    assert_int_equal(dig_motion_best(&machine, &heavy, &heavy, &motion, &told), DIG_OK);
    assert_close(told, 0.0, 0.0);
}

TESTS_WITH(read, NULL)
