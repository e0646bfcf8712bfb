// Tests for estimator/track/inertia.c: what a moving front without soil seems to resist with is all
// taken off, and what its seals may rub with is in the sigmas. The oracle is virtual work against
// Lagrange's equation.

#include "estimator/track/inertia.h"

#include "tests/estimator/lagrange.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <string.h>

enum { SAMPLES = 120, MIDDLE = SAMPLES / 2 };

static const double lambda = 4.0; // the machine's time is twice the table's
static const double tick_s = 0.01;

static struct dig_window window;

// Joints that start from q with v and keep accelerating.
static struct lagrange_state moved(const struct lagrange_state *const s, const double a[DIG_JOINTS],
                                   const double t_s)
{
    struct lagrange_state out = *s;
    for (int j = 0; j < DIG_JOINTS; j++) {
        out.q[j] += s->v[j] * t_s + 0.5 * a[j] * t_s * t_s;
        out.v[j] += a[j] * t_s;
    }
    return out;
}

// A window of samples that read nothing at all.
static void fill(const size_t samples, const double every_s, const struct lagrange_state *const s,
                 const double a[DIG_JOINTS])
{
    memset(&window, 0, sizeof window);
    window.open   = true;
    window.stride = 1;
    for (size_t i = 0; i < samples; i++) {
        struct dig_window_sample    sample = { .time_s     = (double)i * every_s / sqrt(lambda),
                                               .has_forces = true };
        const struct lagrange_state at = moved(s, a, ((double)i - (double)samples / 2) * every_s);
        memcpy(sample.joint_rad, at.q, sizeof sample.joint_rad);
        dig_window_add(&window, &sample);
    }
}

// What was taken off the middle sample, as a load on the bucket in the machine's frame.
static struct model_load taken(void)
{
    const double *const value = window.sample[MIDDLE].value;
    const double        cube  = pow(lambda, 3.0);
    return (struct model_load){ .FX_N = cube * value[DIG_CHANNEL_FX_N],
                                .FZ_N = -cube * value[DIG_CHANNEL_FZ_N],
                                .M_Nm = -lambda * cube * value[DIG_CHANNEL_MY_Nm] };
}

static struct dig_vec2 bucket_pin(const struct dig_machine *const m, const double q[DIG_JOINTS])
{
    const double boom_m = m->link[DIG_JOINT_BOOM].length_m, arm_m = m->link[DIG_JOINT_ARM].length_m;
    return (struct dig_vec2){ boom_m * cos(q[0]) + arm_m * cos(q[0] + q[1]),
                              boom_m * sin(q[0]) + arm_m * sin(q[0] + q[1]) };
}

// The virtual work of a load on the bucket, a radian of joint j.
static double work_Nm(const struct dig_machine *const m, const double q[DIG_JOINTS],
                      const struct model_load *const load, const int j)
{
    const double h     = 1e-5;
    double       up[3] = { q[0], q[1], q[2] };
    double       dn[3] = { q[0], q[1], q[2] };
    up[j] += h;
    dn[j] -= h;
    const struct dig_vec2 high = bucket_pin(m, up);
    const struct dig_vec2 low  = bucket_pin(m, dn);
    return load->FX_N * (high.x - low.x) / (2.0 * h) + load->FZ_N * (high.y - low.y) / (2.0 * h) +
           load->M_Nm;
}

TEST(a_front_that_moves_without_soil_is_left_with_nothing)
{
    const struct dig_machine m                = model_machine();
    static const double      rest[DIG_JOINTS] = { 0.0 };
    uint64_t                 seed             = 9;
    for (int trial = 0; trial < 30; trial++) {
        struct lagrange_state s = { .q = { 0.3, -1.2, -0.8 } };
        double                a[DIG_JOINTS];
        for (int j = 0; j < DIG_JOINTS; j++) {
            s.q[j] += 0.2 * (model_uniform(&seed) - 0.5);
            s.v[j] = 0.3 * model_normal(&seed);
            a[j]   = 0.5 * model_normal(&seed);
        }
        fill(SAMPLES, tick_s, &s, a);
        dig_inertia_take_off(&m, NULL, lambda, &window);
        const struct model_load     load  = taken();
        const struct lagrange_state still = { .q = { s.q[0], s.q[1], s.q[2] } };
        for (int j = 0; j < DIG_JOINTS; j++) {
            // A soil that did this work would have been seen by a balance at rest.
            const double work = work_Nm(&m, s.q, &load, j);
            const double more = lagrange_needed_Nm(&m, &s, a, j, 0.0) -
                                lagrange_needed_Nm(&m, &still, rest, j, 0.0);
            assert_close(work, -more, 1e-3 * fabs(more) + 5.0);
        }
    }
}

static const struct dig_friction stated[DIG_JOINTS] = { { .coulomb_N = 100.0 },
                                                        { .coulomb_N = 100.0 },
                                                        { .coulomb_N = 100.0 } };

// What friction of one drive adds to the middle sample, as a load on the bucket in the machine's
// frame.
static struct model_load rubbed(const enum dig_joint drive)
{
    const float *const rubs = window.sample[MIDDLE].rubs[drive];
    const double       cube = pow(lambda, 3.0);
    return (struct model_load){ .FX_N = -cube * (double)rubs[DIG_CHANNEL_FX_N],
                                .FZ_N = cube * (double)rubs[DIG_CHANNEL_FZ_N],
                                .M_Nm = lambda * cube * (double)rubs[DIG_CHANNEL_MY_Nm] };
}

// A soil that did what a hundredth of a drive's largest push does against its rod's motion would
// have been seen in its place.
TEST(friction_that_no_file_tells_is_in_the_sigma_with_its_direction)
{
    const struct dig_machine m    = model_machine();
    uint64_t                 seed = 4;
    for (int trial = 0; trial < 10; trial++) {
        static const double   a[DIG_JOINTS] = { 0.0 };
        struct lagrange_state s             = { .q = { 0.3, -1.2, -0.8 } };
        for (int j = 0; j < DIG_JOINTS; j++) {
            s.v[j] = 0.3 * (model_uniform(&seed) < 0.5 ? -1.0 : 1.0);
        }
        fill(SAMPLES, tick_s, &s, a);
        dig_inertia_take_off(&m, NULL, lambda, &window);
        for (int drive = 0; drive < DIG_JOINTS; drive++) {
            const struct dig_cylinder *const c    = &m.cylinder[drive];
            const struct model_load          load = rubbed((enum dig_joint)drive);
            const double slope_m = model_slope_m(&m, (enum dig_joint)drive, s.q[drive]);
            const double seal_N =
                0.01 * c->count * c->relief_Pa * 0.25 * 3.14159265 * c->bore_m * c->bore_m;
            for (int j = 0; j < DIG_JOINTS; j++) {
                const double work = work_Nm(&m, s.q, &load, j);
                const double is =
                    j == drive ? -seal_N * fabs(slope_m) * copysign(1.0, s.v[j]) : 0.0;
                assert_close(work, is, 1e-3 * fabs(is) + 0.5);
            }
        }
        assert_close((double)window.sample[MIDDLE].slow[DIG_CHANNEL_MY_Nm], 0.0, 0.0);
    }
}

// It is held by its bent seal: another number than while it moved, of the way it came last.
TEST(a_rod_that_stands_has_the_friction_of_its_last_way)
{
    const struct dig_machine m             = model_machine();
    static const double      a[DIG_JOINTS] = { 0.0 };
    for (int way = -1; way <= 1; way++) {
        const struct lagrange_state s = { .q = { 0.3, -1.2, -0.8 },
                                          .v = { 0.03 * way, 0.03 * way, 0.03 * way } };
        fill(SAMPLES, tick_s, &s, a);
        for (size_t i = MIDDLE - 30; i < window.count; i++) { // it stops well before the middle
            memcpy(window.sample[i].joint_rad, window.sample[MIDDLE - 30].joint_rad,
                   sizeof window.sample[i].joint_rad);
        }
        dig_inertia_take_off(&m, NULL, lambda, &window);
        const struct dig_window_sample *const moves  = &window.sample[MIDDLE - 50];
        const struct dig_window_sample *const stands = &window.sample[MIDDLE];
        for (int j = 0; j < DIG_JOINTS; j++) {
            const double moved = (double)moves->rubs[j][DIG_CHANNEL_FX_N];
            assert_close((double)stands->rubs[j][DIG_CHANNEL_FX_N], 0.0, 1e-9);
            assert_close((double)stands->rubs[DIG_JOINTS + j][DIG_CHANNEL_FX_N], moved,
                         0.05 * fabs(moved));
            assert_true(way == 0 ? fabs(moved) < 1e-9 : fabs(moved) > 0.1);
        }
    }
}

TEST(friction_that_a_model_tells_leaves_no_doubt)
{
    const struct dig_machine    m             = model_machine();
    static const double         a[DIG_JOINTS] = { 0.0 };
    const struct lagrange_state s = { .q = { 0.3, -1.2, -0.8 }, .v = { 0.1, 0.1, 0.1 } };
    fill(SAMPLES, tick_s, &s, a);
    dig_inertia_take_off(&m, stated, lambda, &window);
    const struct dig_window_sample *const middle = &window.sample[MIDDLE];
    assert_close((double)middle->slow[DIG_CHANNEL_MY_Nm], 0.0, 0.0);
    assert_close((double)middle->rubs[DIG_JOINT_BUCKET][DIG_CHANNEL_MY_Nm], 0.0, 0.0);
}

TEST(the_noise_of_the_rates_is_in_the_sigma)
{
    struct dig_machine          m             = model_machine();
    static const double         a[DIG_JOINTS] = { 0.0 };
    const struct lagrange_state s             = { .q = { 0.3, -1.2, -0.8 } };
    double                      sum[2]        = { 0.0 };
    uint64_t                    seed          = 2;
    m.angle_sigma_rad                         = 5e-4;
    m.angle_step_rad                          = 0.0;
    for (int trial = 0; trial < 200; trial++) {
        fill(SAMPLES, tick_s, &s, a);
        for (size_t i = 0; i < window.count; i++) {
            for (int j = 0; j < DIG_JOINTS; j++) {
                window.sample[i].joint_rad[j] += m.angle_sigma_rad * model_normal(&seed);
            }
        }
        dig_inertia_take_off(&m, stated, lambda, &window);
        const struct dig_window_sample *const middle = &window.sample[MIDDLE];
        sum[0] += pow(middle->value[DIG_CHANNEL_MY_Nm], 2.0);
        sum[1] += pow((double)middle->sigma[DIG_CHANNEL_MY_Nm], 2.0);
    }
    assert_close(sum[0] / sum[1], 1.0, 0.3); // three sigmas of 200
}

TEST(where_too_few_samples_tell_the_motion_nothing_is_taken_off)
{
    const struct dig_machine    m             = model_machine();
    static const double         a[DIG_JOINTS] = { 0.5, 0.5, 0.5 };
    const struct lagrange_state s             = { .q = { 0.3, -1.2, -0.8 } };
    double                      mass_kg       = 0.0;
    for (int j = 0; j < DIG_JOINTS; j++) {
        mass_kg += m.link[j].mass_kg;
    }
    fill(SAMPLES, 0.1, &s, a);
    dig_inertia_take_off(&m, NULL, lambda, &window);
    const struct dig_window_sample *const middle = &window.sample[MIDDLE];
    assert_close(middle->value[DIG_CHANNEL_FZ_N], 0.0, 0.0);
    const double unsure_N = 0.01 * 9.81 * mass_kg / pow(lambda, 3.0);
    assert_close((double)middle->sigma[DIG_CHANNEL_FZ_N], unsure_N, 1e-3);
    assert_close((double)middle->slow[DIG_CHANNEL_FZ_N], unsure_N, 1e-3);
    assert_close((double)middle->sigma[DIG_CHANNEL_MY_Nm], 0.0, 0.0);
}

TEST(a_force_sensor_has_its_inertia_off_already)
{
    struct dig_machine          m             = model_machine();
    static const double         a[DIG_JOINTS] = { 0.5, 0.5, 0.5 };
    const struct lagrange_state s             = { .q = { 0.3, -1.2, -0.8 } };
    m.sensor.fitted                           = true;
    fill(SAMPLES, tick_s, &s, a);
    dig_inertia_take_off(&m, NULL, lambda, &window);
    assert_close(window.sample[MIDDLE].value[DIG_CHANNEL_FZ_N], 0.0, 0.0);
}
