// Tests for closed_loop/air/row_sigma.c

#include "closed_loop/air/row_sigma.h"

#include "core/chance.h"
#include "core/units.h"
#include "tests/testlib.h"

#include <math.h>

// A joint that swings from one stand to another, read at 100 Hz; blocks of 8 points.
enum { ROWS = 240, POINTS = 8, SWINGS = 120 };

static double           time_s[ROWS];
static double           exact_rad[ROWS * DIG_JOINTS];
static double           read_rad[ROWS * DIG_JOINTS];
static struct dig_rates exact[ROWS];
static struct dig_rates read[ROWS];

static double swing(const double range_rad, const double part)
{
    return range_rad * part * part * part * (10.0 - 15.0 * part + 6.0 * part * part);
}

// The boom is read in steps and with noise; rows [gap, gap + 20) are lost. Returns how many rows.
static size_t record(const struct dig_machine *const machine, const size_t gap,
                     uint64_t *const chance)
{
    const double range_rad = 0.1 + 0.35 * dig_chance_uniform(chance);
    const double begin_rad = dig_chance_uniform(chance);
    const double step_rad  = machine->angle_step_rad;
    size_t       n         = 0;
    for (size_t i = 0; i < ROWS; i++) {
        if (i >= gap && i < gap + 20) {
            continue;
        }
        const double rad = begin_rad + swing(range_rad, (double)i / ROWS);
        const double off = machine->angle_sigma_rad * dig_chance_normal(chance);

        time_s[n]                  = 0.01 * (double)i;
        exact_rad[DIG_JOINTS * n]  = rad;
        read_rad[DIG_JOINTS * n++] = step_rad * round((rad + off) / step_rad);
    }
    const double sigma_rad = hypot(step_rad / sqrt(12.0), machine->angle_sigma_rad);
    dig_rates_centred(n, time_s, exact_rad, DIG_AIR_KERNEL_HALF_s, sigma_rad, exact);
    dig_rates_centred(n, time_s, read_rad, DIG_AIR_KERNEL_HALF_s, sigma_rad, read);
    return n;
}

// rms of what blocks' mean accelerations are off by over the sigma that is said of them, of blocks
// in which the boom is so fast.
static double off_over_sigma(const double step_rad, const double sigma_rad, const size_t gap,
                             const double least_radps, const double most_radps)
{
    const struct dig_machine machine = { .angle_step_rad = step_rad, .angle_sigma_rad = sigma_rad };
    uint64_t                 chance  = 11;
    double                   sum     = 0.0;
    double                   blocks  = 0.0;
    for (int s = 0; s < SWINGS; s++) {
        const size_t n = record(&machine, gap, &chance);
        for (size_t first = 12; first + 2 * POINTS + 14 < n; first += 10) {
            struct dig_air_point point[POINTS];
            double               off = 0.0;
            for (size_t p = 0; p < POINTS; p++) {
                const size_t i = first + (5 * p) / 2; // 25 ms apart
                point[p].rates = read[i];
                off += read[i].acceleration_radps2[0] - exact[i].acceleration_radps2[0];
            }
            double       variance[DIG_JOINTS];
            const double speed_radps = fabs(exact[first + 9].velocity_radps[0]);
            dig_turn_variance(&machine, point, POINTS, variance);
            if (speed_radps >= least_radps && speed_radps < most_radps) {
                sum += pow(off / POINTS, 2.0) / variance[0];
                blocks += 1.0;
            }
        }
    }
    assert_true(blocks >= 30.0);
    return sqrt(sum / blocks);
}

TEST(what_white_noise_makes_of_accelerations_is_known)
{
    assert_close(off_over_sigma(1e-6, 1e-3, ROWS, 0.0, 1.0), 1.0, 0.15);
}

TEST(what_steps_make_of_accelerations_is_known_at_any_speed)
{
    static const double steps_deg[] = { 0.1, 0.2, 0.3, 0.5 };
    static const double speeds[]    = { 0.005, 0.02, 0.05, 0.1, 0.2, 0.5 };
    for (size_t s = 0; s < 4; s++) {
        for (size_t v = 0; v < 5; v++) {
            const double off = off_over_sigma(steps_deg[s] * DIG_RAD_PER_DEG, 2e-4, ROWS, speeds[v],
                                              speeds[v + 1]);
            assert_true(off > 0.6 && off < 1.6);
        }
    }
}

// Where rows are lost in bursts, parabolas know less.
TEST(what_is_lost_makes_accelerations_less_sure)
{
    for (size_t gap = 60; gap <= 120; gap += 20) {
        assert_close(off_over_sigma(1e-6, 1e-3, gap, 0.0, 1.0), 1.0, 0.25);
        assert_close(off_over_sigma(2e-3, 2e-4, gap, 0.0, 1.0), 1.0, 0.25);
    }
}
