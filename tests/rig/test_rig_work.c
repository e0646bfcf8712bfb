// Tests for tools/rig/motion/work.c

#include "tools/rig/motion/work.h"

#include "core/units.h"
#include "tests/read.h"

#include <complex.h>

#define J CMPLX(0.0, 1.0) // I of <complex.h> is a float

static double complex of(const struct dig_vec2 v)
{
    return v.x + J * v.y;
}

static double cross(const double complex a, const double complex b)
{
    return cimag(conj(a) * b);
}

// Free-body statics, written from a drawing: cut the front apart and balance each piece. Bucket
// about its pin gives the thrust of the link; the knuckle M gives the rod; arm with bucket about
// the arm pin, and the whole front about the boom foot, give the other two, whose inner forces
// cancel.
static void free_body(const struct dig_machine *const m, const double q[3],
                      const struct dig_rig_wrench *const soil, double push_N[3])
{
    const double complex boom   = cexp(J * q[0]);
    const double complex arm    = cexp(J * (q[0] + q[1]));
    const double complex bucket = cexp(J * (q[0] + q[1] + q[2]));
    const double complex A      = m->link[0].length_m * boom;    // arm pin
    const double complex Q      = A + m->link[1].length_m * arm; // bucket pin
    const double complex F      = soil->FX_N + J * soil->FZ_N;
    const double complex com[3] = { of(m->link[0].com_m) * boom, A + of(m->link[1].com_m) * arm,
                                    Q + of(m->link[2].com_m) * bucket };
    double complex       weight[3];
    for (int k = 0; k < 3; k++) {
        weight[k] = -J * 9.81 * m->link[k].mass_kg;
    }

    // Bucket: moments about Q of soil, weight and the link's thrust at K.
    const double complex N = A + of(m->four_bar.rocker_pin_m) * arm;
    const double complex K = Q + of(m->four_bar.ear_m) * bucket;
    const double complex G = A + of(m->cylinder[2].base_m) * arm;
    const double         d = cabs(K - N);
    const double         x = (d * d + m->four_bar.rocker_m * m->four_bar.rocker_m -
                      m->four_bar.link_m * m->four_bar.link_m) /
                     (2.0 * d);
    const double complex n = (K - N) / d;
    const double complex M =
        N + n * (x + J * sqrt(m->four_bar.rocker_m * m->four_bar.rocker_m - x * x));
    const double complex along  = (K - M) / cabs(K - M);
    const double         moment = soil->M_Nm + cross(com[2] - Q, weight[2]);
    const double         thrust = -moment / cross(K - Q, along); // pushes K away from M

    // Knuckle M: rod, link and rocker in balance; crossed with the rocker's direction it drops out.
    const double complex rod    = (M - G) / cabs(M - G);
    const double complex rocker = (M - N) / cabs(M - N);
    push_N[2]                   = thrust * cross(rocker, along) / cross(rocker, rod);

    // Arm with bucket about the arm pin.
    const double complex eye_a  = A + of(m->cylinder[1].eye_m) * arm;
    const double complex base_a = of(m->cylinder[1].base_m) * boom;
    const double complex rod_a  = (eye_a - base_a) / cabs(eye_a - base_a);
    const double         load_a =
        soil->M_Nm + cross(Q - A, F) + cross(com[1] - A, weight[1]) + cross(com[2] - A, weight[2]);
    push_N[1] = -load_a / cross(eye_a - A, rod_a);

    // Everything about the boom foot.
    const double complex eye_b = of(m->cylinder[0].eye_m) * boom;
    const double complex rod_b =
        (eye_b - of(m->cylinder[0].base_m)) / cabs(eye_b - of(m->cylinder[0].base_m));
    const double load_b = soil->M_Nm + cross(Q, F) + cross(com[0], weight[0]) +
                          cross(com[1], weight[1]) + cross(com[2], weight[2]);
    push_N[0] = -load_b / cross(eye_b, rod_b);
}

TEST(pushes_are_those_of_free_body_statics)
{
    const struct dig_machine machine    = read_machine("zx200_trench");
    const double             poses[][3] = {
                    { 0.2, -1.0, -0.5 },
                    { 0.5, -2.2, -1.8 },
                    { -0.4, -0.7, 0.4 },
                    { 0.9, -1.5, 0.0 },
    };
    const struct dig_rig_wrench loads[] = {
        { 0.0, 0.0, 0.0 },
        { 38e3, 33e3, 41e3 },
        { -10e3, -3e3, -5e3 },
        { 79e3, -12e3, 56e3 },
    };
    for (size_t p = 0; p < sizeof poses / sizeof poses[0]; p++) {
        for (size_t l = 0; l < sizeof loads / sizeof loads[0]; l++) {
            const struct dig_rig_joints joints = { .rad = { poses[p][0], poses[p][1],
                                                            poses[p][2] } };
            const struct dig_rig_motion still  = { .turn_radps2 = { 0.0 } };
            struct dig_rig_pushes       pushes;
            double                      expected_N[3];
            assert_int_equal(dig_rig_work_solve(&machine, &joints, &still, &loads[l], &pushes),
                             DIG_OK);
            free_body(&machine, poses[p], &loads[l], expected_N);
            for (int j = 0; j < DIG_JOINTS; j++) {
                assert_close(pushes.N[j], expected_N[j], 1e-6 * (1e4 + fabs(expected_N[j])));
            }
        }
    }
}

// In a lift that accelerates upwards with g everything weighs twice, and nothing else changes.
TEST(acceleration_upwards_by_g_doubles_the_weight)
{
    const struct dig_machine    machine = read_machine("zx200_trench");
    const struct dig_rig_joints joints  = { .rad = { 0.3, -1.2, -0.6 } };
    const struct dig_rig_wrench none    = { 0.0, 0.0, 0.0 };
    const struct dig_rig_motion still   = { .turn_radps2 = { 0.0 } };
    const struct dig_rig_motion up      = { .com_mps2 = {
                                                { 0.0, 9.81 }, { 0.0, 9.81 }, { 0.0, 9.81 } } };
    struct dig_rig_pushes       once;
    struct dig_rig_pushes       twice;
    assert_int_equal(dig_rig_work_solve(&machine, &joints, &still, &none, &once), DIG_OK);
    assert_int_equal(dig_rig_work_solve(&machine, &joints, &up, &none, &twice), DIG_OK);
    for (int j = 0; j < DIG_JOINTS; j++) {
        assert_close(twice.N[j], 2.0 * once.N[j], 1e-6 * fabs(once.N[j]));
    }
}

// A bucket spun up about its own centre of mass costs inertia times angular acceleration.
TEST(turning_the_bucket_faster_costs_its_inertia)
{
    const struct dig_machine    machine = read_machine("zx200_trench");
    const struct dig_rig_joints joints  = { .rad = { 0.3, -1.2, -0.6 } };
    const struct dig_rig_wrench none    = { 0.0, 0.0, 0.0 };
    const struct dig_rig_wrench moment  = { 0.0, 0.0, -machine.link[2].inertia_kgm2 * 3.0 };
    const struct dig_rig_motion still   = { .turn_radps2 = { 0.0 } };
    const struct dig_rig_motion spun    = { .turn_radps2 = { 0.0, 0.0, 3.0 } };
    struct dig_rig_pushes       a;
    struct dig_rig_pushes       b;
    assert_int_equal(dig_rig_work_solve(&machine, &joints, &spun, &none, &a), DIG_OK);
    assert_int_equal(dig_rig_work_solve(&machine, &joints, &still, &moment, &b), DIG_OK);
    for (int j = 0; j < DIG_JOINTS; j++) {
        assert_close(a.N[j], b.N[j], 1e-6 * (1e3 + fabs(b.N[j])));
    }
}

TEST(pressures_push_the_piston_with_the_force_asked_for)
{
    const struct dig_machine machine = read_machine("zx200_trench");
    for (double push_N = -4e5; push_N <= 4e5; push_N += 1e4) {
        const struct dig_rig_pushes pushes = { .N = { push_N, push_N, push_N } };
        struct dig_rig_pressures    found;
        dig_rig_work_pressures(&machine, &pushes, &found);
        for (int j = 0; j < DIG_JOINTS; j++) {
            const struct dig_cylinder *const c    = &machine.cylinder[j];
            const double                     head = DIG_PI / 4.0 * c->bore_m * c->bore_m;
            const double                     ring = head - DIG_PI / 4.0 * c->rod_m * c->rod_m;
            assert_close(c->count * (found.head_Pa[j] * head - found.rod_Pa[j] * ring), push_N,
                         1e-6);
            assert_true(found.head_Pa[j] >= c->back_Pa && found.rod_Pa[j] >= c->back_Pa);
            // One side carries, the other holds the back pressure.
            assert_close(fmin(found.head_Pa[j], found.rod_Pa[j]), c->back_Pa, 1e-6);
        }
    }
}

TEST(pressures_do_not_jump_where_push_turns_to_pull)
{
    const struct dig_machine         machine = read_machine("zx200_trench");
    const struct dig_cylinder *const c       = &machine.cylinder[DIG_JOINT_BOOM];
    const double             switch_N = c->count * c->back_Pa * DIG_PI / 4.0 * c->rod_m * c->rod_m;
    struct dig_rig_pressures before;
    struct dig_rig_pressures after;
    const struct dig_rig_pushes less = { .N = { switch_N - 1e-3, 0.0, 0.0 } };
    const struct dig_rig_pushes more = { .N = { switch_N + 1e-3, 0.0, 0.0 } };
    dig_rig_work_pressures(&machine, &less, &before);
    dig_rig_work_pressures(&machine, &more, &after);
    assert_close(before.head_Pa[0], after.head_Pa[0], 1.0);
    assert_close(before.rod_Pa[0], after.rod_Pa[0], 1.0);
    assert_close(after.head_Pa[0], c->back_Pa, 1.0);
}

TEST(cylinder_without_leverage_is_refused_and_writes_nothing)
{
    struct dig_machine          machine = read_machine("zx200_trench");
    const struct dig_rig_joints joints  = { .rad = { 0.3, -1.2, -0.6 } };
    const struct dig_rig_wrench none    = { 0.0, 0.0, 0.0 };
    const struct dig_rig_motion still   = { .turn_radps2 = { 0.0 } };
    struct dig_rig_pushes       pushes  = { .N = { 42.0, 42.0, 42.0 } };

    // A boom cylinder whose ends and the boom foot lie in one line only pulls at the foot.
    machine.cylinder[DIG_JOINT_BOOM].base_m = (struct dig_vec2){ -cos(0.3), -sin(0.3) };
    machine.cylinder[DIG_JOINT_BOOM].eye_m  = (struct dig_vec2){ 2.0, 0.0 };
    assert_int_equal(dig_rig_work_solve(&machine, &joints, &still, &none, &pushes),
                     DIG_EUNREACHABLE);
    assert_close(pushes.N[0], 42.0, 0.0);
}
