// Tests for closed_loop/recordings/alignment.c

#include "closed_loop/recordings/alignment.h"
#include "core/units.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

#define TOOTH_m 0.09
#define DUG_s   4.0

enum { ROWS_MAX = 4100 };

static double number[4 * ROWS_MAX + 1];
static double clean_way[ROWS_MAX];
static double way[ROWS_MAX];

// Down, along, and out with a curl: corners that smoothing cuts.
static const struct dig_trajectory dug = { "dug",
                                           -0.26,
                                           0.08,
                                           0.17,
                                           4,
                                           { { "in", 0.8, 0.03, -0.04, 0.0 },
                                             { "drag", 1.6, 0.0463, 0.0, 0.0 },
                                             { "turn", 0.8, 0.0, 0.0, 0.3 },
                                             { "out", 0.8, 0.0, 0.05, 0.1 } } };

// How poses are read: scattered, then in steps. 0: not.
struct sensor {
    double scatter_m, scatter_deg, step_m, step_deg;
};

static double stepped(const double value, const double step)
{
    return step > 0.0 ? step * round(value / step) : value;
}

// rest_s: the bucket waits in the middle of the dig.
static struct dig_recording drive(const double rate_Hz, const double rest_s,
                                  const struct sensor *const sensor, uint64_t seed)
{
    const size_t         rows = (size_t)((DUG_s + rest_s) * rate_Hz) + 1;
    struct dig_recording r    = { rows, calloc(rows, sizeof *r.row) };
    assert_true(rows <= ROWS_MAX);
    for (size_t i = 0; i < rows; i++) {
        const double          t_s  = (double)i / rate_Hz;
        const double          at_s = fmin(t_s, 2.0) + fmax(t_s - 2.0 - rest_s, 0.0);
        const struct dig_pose pose = dig_trajectory_pose(&dug, at_s);

        r.row[i].t_s = t_s;
        r.row[i].pin_x_m =
            stepped(pose.x_m + 3.0003 + sensor->scatter_m * model_normal(&seed), sensor->step_m);
        r.row[i].pin_z_m =
            stepped(pose.z_m - 1.0002 + sensor->scatter_m * model_normal(&seed), sensor->step_m);
        r.row[i].theta_deg =
            stepped(pose.theta_rad / DIG_RAD_PER_DEG + sensor->scatter_deg * model_normal(&seed),
                    sensor->step_deg);
        r.row[i].My_Nm = t_s;
    }
    return r;
}

static const struct sensor exact = { 0.0, 0.0, 0.0, 0.0 };

// How far the progress is from that of the exact path, at most.
static double progress_off(const double rate_Hz, const double rest_s,
                           const struct sensor *const sensor, const bool mended,
                           const uint64_t seed)
{
    struct dig_recording clean = drive(rate_Hz, rest_s, &exact, 0);
    struct dig_recording rough = drive(rate_Hz, rest_s, sensor, seed);
    if (mended) {
        dig_steady_path(&rough, TOOTH_m, number);
    }
    (void)dig_alignment_progress(&clean, TOOTH_m, clean_way);
    (void)dig_alignment_progress(&rough, TOOTH_m, way);
    double most = 0.0;
    for (size_t i = 0; i < rough.rows; i++) {
        most = fmax(most, fabs(way[i] - clean_way[i]));
    }
    dig_recording_finish(&clean);
    dig_recording_finish(&rough);
    return most;
}

TEST(noise_and_steps_of_the_path_move_no_row_along_it)
{
    static const struct sensor sensors[]  = { { 2e-4, 0.1, 0.0, 0.0 },
                                              { 6e-4, 0.3, 0.0, 0.0 },
                                              { 0.0, 0.0, 1e-3, 0.1 },
                                              { 0.0, 0.0, 2e-3, 0.5 },
                                              { 3e-4, 0.1, 1e-3, 0.2 } };
    static const double        rates_Hz[] = { 50.0, 200.0, 1000.0, 200.0 };
    for (size_t s = 0; s < sizeof sensors / sizeof sensors[0]; s++) {
        for (size_t r = 0; r < 4; r++) {
            const double rest_s = r == 3 ? 2.0 : 0.0;
            for (uint64_t seed = 1; seed < 6; seed++) {
                assert_true(progress_off(rates_Hz[r], rest_s, &sensors[s], false, seed) > 0.02);
                assert_true(progress_off(rates_Hz[r], rest_s, &sensors[s], true, seed) < 0.02);
            }
        }
    }
}

// With corners and a rest, at any rate.
TEST(an_exact_path_stays_as_it_is)
{
    static const double rates_Hz[] = { 20.0, 50.0, 200.0, 1000.0 };
    for (size_t r = 0; r < 4; r++) {
        const double         rest_s = r % 2 == 0 ? 2.0 : 0.0;
        struct dig_recording was    = drive(rates_Hz[r], rest_s, &exact, 0);
        struct dig_recording is     = drive(rates_Hz[r], rest_s, &exact, 0);
        dig_steady_path(&is, TOOTH_m, number);
        assert_memory_equal(is.row, was.row, was.rows * sizeof was.row[0]);
        dig_recording_finish(&was);
        dig_recording_finish(&is);
    }
}
