// What moves a front: Lagrange's equation, differentiated numerically. Energies are of places found
// by a chain of turns: no recursion, no forces.

#ifndef DIG_TESTS_ESTIMATOR_LAGRANGE_H
#define DIG_TESTS_ESTIMATOR_LAGRANGE_H

#include "core/machine.h"
#include "core/vec2.h"

#include <math.h>

struct lagrange_state {
    double q[DIG_JOINTS], v[DIG_JOINTS];
};

// Centre of mass of link k: pins one after the other.
static inline struct dig_vec2 lagrange_place(const struct dig_machine *const m,
                                             const double q[DIG_JOINTS], const int k)
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

static inline double lagrangian_J(const struct dig_machine *const    m,
                                  const struct lagrange_state *const s, const double pitch_rad)
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
        const struct dig_vec2 a = lagrange_place(m, ahead, k), b = lagrange_place(m, behind, k),
                              c = lagrange_place(m, s->q, k);
        const double vx = (a.x - b.x) / (2 * h), vy = (a.y - b.y) / (2 * h);
        sum += 0.5 * m->link[k].mass_kg * (vx * vx + vy * vy) +
               0.5 * m->link[k].inertia_kgm2 * turn * turn -
               m->link[k].mass_kg * 9.81 * (c.x * sin(pitch_rad) + c.y * cos(pitch_rad));
    }
    return sum;
}

static inline double lagrange_momentum(const struct dig_machine *const m, struct lagrange_state s,
                                       const int j, const double pitch_rad)
{
    const double h = 1e-3;
    s.v[j] += h;
    const double more = lagrangian_J(m, &s, pitch_rad);
    s.v[j] -= 2 * h;
    return (more - lagrangian_J(m, &s, pitch_rad)) / (2 * h);
}

// What a drive must do about joint j: d/dt dL/dv_j - dL/dq_j.
static inline double lagrange_needed_Nm(const struct dig_machine *const    m,
                                        const struct lagrange_state *const s,
                                        const double a[DIG_JOINTS], const int j,
                                        const double pitch_rad)
{
    const double          dt = 1e-3, h = 1e-4;
    struct lagrange_state later = *s, before = *s;
    for (int k = 0; k < DIG_JOINTS; k++) {
        later.q[k] += dt * s->v[k] + 0.5 * dt * dt * a[k];
        before.q[k] += -dt * s->v[k] + 0.5 * dt * dt * a[k];
        later.v[k] += dt * a[k];
        before.v[k] -= dt * a[k];
    }
    struct lagrange_state more = *s, less = *s;
    more.q[j] += h;
    less.q[j] -= h;
    return (lagrange_momentum(m, later, j, pitch_rad) -
            lagrange_momentum(m, before, j, pitch_rad)) /
               (2 * dt) -
           (lagrangian_J(m, &more, pitch_rad) - lagrangian_J(m, &less, pitch_rad)) / (2 * h);
}

#endif // DIG_TESTS_ESTIMATOR_LAGRANGE_H
