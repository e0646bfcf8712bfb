// Tests for offline_dem/shapes/clump.c and rigid.h: mass and inertia against closed forms and a
// Monte Carlo estimate, free flight against conservation laws.

#include "core/chance.h"
#include "core/units.h"
#include "offline_dem/law/rigid.h"
#include "offline_dem/shapes/clump.h"
#include "tests/testlib.h"

#include <string.h>

static struct dig_clump_shape shape_of(const struct dig_clump *const clump)
{
    struct dig_clump_shape shape;
    assert_int_equal(dig_clump_shape_make(clump, &shape), DIG_OK);
    return shape;
}

TEST(one_sphere_in_another_is_a_sphere)
{
    const struct dig_clump clump   = { 2, { 3.0, 3.0 }, { 1.0, 1.0 }, { 0.0, 0.0 }, { 2.0, 1.0 } };
    const struct dig_clump_shape s = shape_of(&clump);
    assert_close(s.radius[0], 0.5, 1e-5);
    assert_close(s.bound, 0.5, 1e-5);
    for (int r = 0; r < 3; r++) {
        assert_close(s.at[0][r], 0.0, 1e-6);
        for (int c = 0; c < 3; c++) {
            assert_close(s.inertia[r][c], r == c ? 0.1 : 0.0, 1e-5);
            assert_close(s.inverse[r][c], r == c ? 10.0 : 0.0, 1e-3);
        }
    }
}

// Two spheres that touch: Steiner's theorem, no integral.
TEST(two_spheres_that_touch_obey_steiner)
{
    const struct dig_clump       clump = { 2, { 0.0 }, { -1.0, 1.0 }, { 0.0 }, { 1.0, 1.0 } };
    const struct dig_clump_shape s     = shape_of(&clump);
    const double                 r     = 0.5 / cbrt(2.0);
    assert_close(s.radius[0], r, 1e-5);
    assert_close(s.at[1][1], r, 1e-5);
    assert_close(s.inertia[1][1], 0.4 * r * r, 1e-5);
    assert_close(s.inertia[0][0], 1.4 * r * r, 1e-5);
    assert_close(s.inertia[2][2], 1.4 * r * r, 1e-5);
}

static bool holds(const struct dig_clump *const clump, const double p[3])
{
    for (size_t k = 0; k < clump->spheres; k++) {
        const double d[3] = { p[0] - clump->x[k], p[1] - clump->y[k], p[2] - clump->z[k] };
        if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < clump->radius[k] * clump->radius[k]) {
            return true;
        }
    }
    return false;
}

// Overlapping spheres of unlike size, off all axes: points thrown at random into the union.
TEST(an_overlapping_clump_has_the_inertia_of_the_union)
{
    const struct dig_clump clump = {
        3, { 0.0, 0.9, 0.3 }, { 0.0, 0.2, 0.8 }, { 0.0, -0.3, 0.5 }, { 1.0, 0.7, 0.6 }
    };
    const struct dig_clump_shape s      = shape_of(&clump);
    uint64_t                     random = 7;
    double                       n = 0.0, first[3] = { 0.0 }, second[3][3] = { { 0.0 } };
    const double                 throws = 400000.0;
    for (double i = 0.0; i < throws; i += 1.0) {
        const double p[3] = { dig_chance_between(&random, -1.5, 2.0),
                              dig_chance_between(&random, -1.5, 2.0),
                              dig_chance_between(&random, -1.5, 2.0) };
        if (holds(&clump, p)) {
            n += 1.0;
            for (int r = 0; r < 3; r++) {
                first[r] += p[r];
                for (int c = 0; c < 3; c++) {
                    second[r][c] += p[r] * p[c];
                }
            }
        }
    }
    const double unit  = cbrt(n / throws * 3.5 * 3.5 * 3.5 * 6.0 / DIG_PI);
    double       trace = 0.0;
    for (int r = 0; r < 3; r++) {
        trace += second[r][r] / n - first[r] / n * first[r] / n;
    }
    // Four standard errors of some 90,000 hits are 1.4 % of a second moment.
    for (int r = 0; r < 3; r++) {
        assert_close(s.at[0][r], -first[r] / n / unit, 0.01);
        for (int c = 0; c < 3; c++) {
            const double moment  = second[r][c] / n - first[r] / n * first[c] / n;
            const double inertia = ((r == c ? trace : 0.0) - moment) / (unit * unit);
            assert_close(s.inertia[r][c], inertia, 0.014 * trace / (unit * unit));
        }
    }
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            double product = 0.0;
            for (int k = 0; k < 3; k++) {
                product += s.inertia[r][k] * s.inverse[k][c];
            }
            assert_close(product, r == c ? 1.0 : 0.0, 1e-10);
        }
    }
}

TEST(the_way_a_clump_lies_is_found_from_its_spheres)
{
    const struct dig_clump clumps[] = {
        { 3, { 0.0, 0.9, 0.3 }, { 0.0, 0.2, 0.8 }, { 0.0, -0.3, 0.5 }, { 1.0, 0.7, 0.6 } },
        { 2, { -0.4, 0.4 }, { 0.0, 0.1 }, { 0.0, 0.2 }, { 1.0, 1.0 } },
        { 2, { 0.0, 0.0 }, { 0.0, 0.0 }, { -0.5, 0.5 }, { 1.0, 1.0 } },
    };
    uint64_t random = 3;
    for (int trial = 0; trial < 60; trial++) {
        const struct dig_clump_shape s    = shape_of(&clumps[trial % 3]);
        double                       q[4] = { 1.0, 0.0, 0.0, 0.0 };
        const double                 w[3] = { dig_chance_between(&random, -3.0, 3.0),
                                              dig_chance_between(&random, -3.0, 3.0),
                                              dig_chance_between(&random, -3.0, 3.0) };
        dig_rigid_integrate(q, w, 1.0, q);
        double at_m[DIG_CLUMP_MAX][3], rotation[3][3], found[4];
        for (size_t k = 0; k < s.spheres; k++) {
            dig_rigid_rotate(q, s.at[k], at_m[k]);
            for (int a = 0; a < 3; a++) {
                at_m[k][a] = 0.01 * at_m[k][a] + 0.3;
            }
        }
        dig_clump_orientation(&s, (const double(*)[3])at_m, rotation);
        dig_rigid_quaternion((const double(*)[3])rotation, found);
        for (size_t k = 0; k < s.spheres; k++) {
            double back[3];
            dig_rigid_rotate(found, s.at[k], back);
            for (int a = 0; a < 3; a++) {
                assert_close(0.01 * back[a] + 0.3, at_m[k][a], 1e-12);
            }
        }
    }
}

static struct dig_rigid free_body(void)
{
    return (struct dig_rigid){
        .mass_kg       = 2.0,
        .q             = { 1.0 },
        .l_Nms         = { 0.02, 1.0, 0.3 },
        .inverse_pkgm2 = { { 1.0, 0.0, 0.0 }, { 0.0, 0.5, 0.0 }, { 0.0, 0.0, 0.25 } },
    };
}

static double energy_J(const struct dig_rigid *const b)
{
    double l[3], sum = 0.0;
    dig_rigid_rotate_back(b->q, b->l_Nms, l);
    for (int k = 0; k < 3; k++) {
        sum += 0.5 * l[k] * l[k] * b->inverse_pkgm2[k][k];
    }
    return sum;
}

// Spun about the middle axis a body tumbles: energy and angular momentum stay, and halving the step
// makes the error a quarter.
TEST(a_tumbling_body_keeps_its_energy)
{
    static const double none[3]  = { 0.0, 0.0, 0.0 };
    double              error[2] = { 0.0, 0.0 };
    for (int fine = 0; fine < 2; fine++) {
        struct dig_rigid b       = free_body();
        const double     start   = energy_J(&b);
        const int        steps   = fine ? 8000 : 4000;
        const double     dt_s    = 40.0 / steps;
        bool             tumbled = false;
        for (int s = 0; s < steps; s++) {
            dig_rigid_step(&b, none, none, none, dt_s, dt_s);
            error[fine]       = fmax(error[fine], fabs(energy_J(&b) - start) / start);
            const double y[3] = { 0.0, 1.0, 0.0 };
            double       axis[3];
            dig_rigid_rotate(b.q, y, axis);
            tumbled = tumbled || axis[1] < 0.0;
        }
        assert_true(tumbled);
        assert_close(b.l_Nms[1], 1.0, 0.0);
    }
    assert_true(error[0] < 1e-3);
    assert_true(error[1] < 0.3 * error[0]);
}

// A sphere turns as its angular velocity says, whatever the step.
TEST(a_sphere_turns_evenly)
{
    static const double none[3] = { 0.0, 0.0, 0.0 };
    struct dig_rigid    b       = free_body();
    for (int k = 0; k < 3; k++) {
        b.inverse_pkgm2[k][k] = 2.0;
    }
    for (int s = 0; s < 10; s++) {
        dig_rigid_step(&b, none, none, none, 0.1, 0.1);
    }
    const double angle = 2.0 * sqrt(0.02 * 0.02 + 1.0 + 0.09);
    assert_close(fabs(b.q[0]), fabs(cos(0.5 * angle)), 1e-12);
    assert_close(b.w_radps[1], 2.0, 1e-12);
}
