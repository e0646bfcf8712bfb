// Tests for estimator/wrench/dynamics.c. The oracle is Lagrange's equation, differentiated
// numerically: energies from places found by the test's own chain of turns, no recursion, no
// forces.

#include "estimator/wrench/dynamics.h"

#include "tests/model_front.h"
#include "tests/testlib.h"

struct state {
    double q[DIG_JOINTS], v[DIG_JOINTS];
};

// Centre of mass of link k: pins one after the other.
static struct dig_vec2 place(const struct dig_machine *const m, const double q[DIG_JOINTS],
                             const int k)
{
    double x = 0.0, y = 0.0, phi = 0.0;
    for (int j = 0; j <= k; j++) {
        phi += q[j];
        const double along  = j == k ? m->link[j].com_m.x : m->link[j].length_m;
        const double beside = j == k ? m->link[j].com_m.y : 0.0;
        x += along * cos(phi) - beside * sin(phi);
        y += along * sin(phi) + beside * cos(phi);
    }
    return (struct dig_vec2){ x, y };
}

static double lagrangian_J(const struct dig_machine *const m, const struct state *const s,
                           const double pitch_rad)
{
    const double h   = 1e-5;
    double       sum = 0.0;
    for (int k = 0; k < DIG_JOINTS; k++) {
        double ahead[DIG_JOINTS], behind[DIG_JOINTS], turn = 0.0;
        for (int j = 0; j < DIG_JOINTS; j++) {
            ahead[j]  = s->q[j] + h * s->v[j];
            behind[j] = s->q[j] - h * s->v[j];
            turn += j <= k ? s->v[j] : 0.0;
        }
        const struct dig_vec2 a = place(m, ahead, k), b = place(m, behind, k),
                              c = place(m, s->q, k);
        const double vx = (a.x - b.x) / (2 * h), vy = (a.y - b.y) / (2 * h);
        sum += 0.5 * m->link[k].mass_kg * (vx * vx + vy * vy) +
               0.5 * m->link[k].inertia_kgm2 * turn * turn -
               m->link[k].mass_kg * 9.81 * (c.x * sin(pitch_rad) + c.y * cos(pitch_rad));
    }
    return sum;
}

static double momentum(const struct dig_machine *const m, struct state s, const int j,
                       const double pitch_rad)
{
    const double h = 1e-3;
    s.v[j] += h;
    const double more = lagrangian_J(m, &s, pitch_rad);
    s.v[j] -= 2 * h;
    return (more - lagrangian_J(m, &s, pitch_rad)) / (2 * h);
}

// What a drive must do about joint j: d/dt dL/dv_j - dL/dq_j.
static double needed_Nm(const struct dig_machine *const m, const struct state *const s,
                        const double a[DIG_JOINTS], const int j, const double pitch_rad)
{
    const double dt = 1e-3, h = 1e-4;
    struct state later = *s, before = *s;
    for (int k = 0; k < DIG_JOINTS; k++) {
        later.q[k] += dt * s->v[k] + 0.5 * dt * dt * a[k];
        before.q[k] += -dt * s->v[k] + 0.5 * dt * dt * a[k];
        later.v[k] += dt * a[k];
        before.v[k] -= dt * a[k];
    }
    struct state more = *s, less = *s;
    more.q[j] += h;
    less.q[j] -= h;
    return (momentum(m, later, j, pitch_rad) - momentum(m, before, j, pitch_rad)) / (2 * dt) -
           (lagrangian_J(m, &more, pitch_rad) - lagrangian_J(m, &less, pitch_rad)) / (2 * h);
}

TEST(moments_are_those_of_lagrange)
{
    const struct dig_machine m    = model_machine();
    uint64_t                 seed = 4;
    for (int i = 0; i < 200; i++) {
        struct state     s;
        struct dig_rates rates = { .velocity_sigma = 0.0 };
        for (int j = 0; j < DIG_JOINTS; j++) {
            s.q[j] =
                m.link[j].min_rad + (m.link[j].max_rad - m.link[j].min_rad) * model_uniform(&seed);
            s.v[j]                       = model_normal(&seed);
            rates.velocity_radps[j]      = s.v[j];
            rates.acceleration_radps2[j] = 2.0 * model_normal(&seed);
        }
        const double           pitch_rad = 0.1 * model_normal(&seed);
        const struct dig_front front     = dig_front_place(&m, s.q);
        double                 found[DIG_JOINTS];
        dig_dynamics_Nm(&m, &front, &rates, pitch_rad, found);
        for (int j = 0; j < DIG_JOINTS; j++) {
            const double truth = -needed_Nm(&m, &s, rates.acceleration_radps2, j, pitch_rad);
            assert_close(found[j], truth, 1e-4 * fabs(truth) + 2.0);
        }
    }
}

TEST(standing_still_it_is_the_weight)
{
    const struct dig_machine m             = model_machine();
    const double             q[DIG_JOINTS] = { 0.4, -1.4, -0.6 };
    const struct dig_front   front         = dig_front_place(&m, q);
    const struct dig_rates   still         = { .velocity_sigma = 0.0 };
    double                   moving[DIG_JOINTS], weight[DIG_JOINTS];
    dig_dynamics_Nm(&m, &front, &still, 0.05, moving);
    dig_statics_weight_Nm(&m, &front, 0.05, weight);
    for (int j = 0; j < DIG_JOINTS; j++) {
        assert_close(moving[j], weight[j], 1e-9 * fabs(weight[j]));
    }
}

TEST(the_inertia_is_symmetric_and_adds_up)
{
    const struct dig_machine m             = model_machine();
    const double             q[DIG_JOINTS] = { 0.2, -1.1, -0.9 };
    const struct dig_front   front         = dig_front_place(&m, q);
    double                   by[DIG_JOINTS][DIG_JOINTS];
    dig_dynamics_inertia_kgm2(&m, &front, by);
    struct dig_rates still = { .velocity_sigma = 0.0 }, turning = still;
    turning.acceleration_radps2[DIG_JOINT_ARM] = 3.0;
    double rest[DIG_JOINTS], moved[DIG_JOINTS];
    dig_dynamics_Nm(&m, &front, &still, 0.0, rest);
    dig_dynamics_Nm(&m, &front, &turning, 0.0, moved);
    for (int j = 0; j < DIG_JOINTS; j++) {
        assert_true(by[j][j] > 0.0);
        assert_close(rest[j] - moved[j], 3.0 * by[j][DIG_JOINT_ARM], 1e-6 * by[0][0]);
        for (int k = 0; k < DIG_JOINTS; k++) {
            assert_close(by[j][k], by[k][j], 1e-9 * by[0][0]);
        }
    }
}
