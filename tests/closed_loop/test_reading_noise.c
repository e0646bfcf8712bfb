#include "closed_loop/recordings/reading_noise.h"

#include "tests/model_front.h"
#include "tests/read.h"

#include <stdlib.h>
#include <string.h>

enum { ROWS = 20000 };

static struct dig_machine machine;

static int setup(void **state)
{
    (void)state;
    machine = read_machine("zx200_trench");
    return 0;
}

// A machine that moves, read by sensors of these sigmas: the arm's pressures, and all angles.
static struct dig_machine_recording record(const double arm_Pa, const double angle_rad)
{
    struct dig_machine_recording r    = { ROWS, calloc(ROWS, sizeof(struct dig_sample)) };
    uint64_t                     seed = 3;
    for (size_t i = 0; i < ROWS; i++) {
        const double t_s = 0.005 * (double)i;
        for (int s = 0; s < DIG_SIGNALS_NEEDED; s++) {
            r.row[i].value[s] = 0.8 * sin(0.9 * t_s + s) + angle_rad * model_normal(&seed);
        }
        for (int s = DIG_SIGNAL_BOOM_HEAD_Pa; s <= DIG_SIGNAL_BUCKET_ROD_Pa; s++) {
            const bool of_arm = s == DIG_SIGNAL_ARM_HEAD_Pa || s == DIG_SIGNAL_ARM_ROD_Pa;
            r.row[i].value[s] =
                8e6 + 3e6 * sin(0.7 * t_s + s) + (of_arm ? arm_Pa : 1e4) * model_normal(&seed);
        }
        r.row[i].time_ns = llround(t_s * 1e9);
        memset(r.row[i].valid, true, sizeof r.row[i].valid);
    }
    r.row[700].value[DIG_SIGNAL_ARM_HEAD_Pa] = (double)NAN;
    return r;
}

TEST(sensors_louder_than_the_file_are_believed)
{
    struct dig_machine_recording r   = record(5e5, 1.5e-3);
    struct dig_machine           was = machine;
    struct dig_machine           m   = machine;
    dig_reading_noise_raise(&m, 1, &r);
    // All that is seen, the step's share with it.
    assert_close(
        hypot(m.cylinder[DIG_JOINT_ARM].pressure_sigma_Pa, was.pressure_step_Pa / sqrt(12.0)), 5e5,
        2e4);
    assert_close(hypot(m.angle_sigma_rad, was.angle_step_rad / sqrt(12.0)), 1.5e-3, 6e-5);
    assert_close(m.cylinder[DIG_JOINT_BOOM].pressure_sigma_Pa,
                 was.cylinder[DIG_JOINT_BOOM].pressure_sigma_Pa, 0.0);
    dig_machine_recording_finish(&r);
}

TEST(quieter_ones_are_not)
{
    struct dig_machine_recording r = record(1e4, 1e-5);
    struct dig_machine           m = machine;
    dig_reading_noise_raise(&m, 1, &r);
    assert_close(m.angle_sigma_rad, machine.angle_sigma_rad, 0.0);
    for (int j = 0; j < DIG_JOINTS; j++) {
        assert_close(m.cylinder[j].pressure_sigma_Pa, machine.cylinder[j].pressure_sigma_Pa, 0.0);
    }
    dig_machine_recording_finish(&r);
}

TEST(readings_that_do_not_arrive_are_no_noise)
{
    struct dig_machine_recording r    = record(1e4, 1e-5);
    struct dig_machine           m    = machine;
    uint64_t                     seed = 5;
    for (size_t i = 0; i < r.rows; i++) {
        for (int s = 0; s < DIG_SIGNALS_NEEDED; s++) {
            if (fabs(model_normal(&seed)) > 2.0) {
                r.row[i].valid[s] = false;
                r.row[i].value[s] = 0.0;
            }
        }
    }
    dig_reading_noise_raise(&m, 1, &r);
    assert_close(m.angle_sigma_rad, machine.angle_sigma_rad, 0.0);
    for (int j = 0; j < DIG_JOINTS; j++) {
        assert_close(m.cylinder[j].pressure_sigma_Pa, machine.cylinder[j].pressure_sigma_Pa, 0.0);
    }
    dig_machine_recording_finish(&r);
}

// A force that grows and falls as grains cross the blade, over several rows each, read with noise
// of sigma; each reading stands in so many rows.
static double noise_read(const double sigma, const size_t in_rows)
{
    double  *value = calloc(ROWS, sizeof *value);
    uint64_t seed  = 7;
    double   knot  = 0.0;
    double   next  = 0.0;
    double   noise = 0.0;
    for (size_t i = 0; i < ROWS; i++) {
        const double within = (double)(i % 8) / 8.0;
        if (i % 8 == 0) {
            knot = next;
            next = model_normal(&seed);
        }
        noise    = sigma * model_normal(&seed);
        value[i] = knot + (next - knot) * within * within * (3.0 - 2.0 * within) + noise;
        if (i % in_rows != 0) {
            value[i] = value[i - 1];
        }
    }
    const double told = dig_reading_noise(ROWS, value);
    free(value);
    return told;
}

TEST(what_is_white_in_a_force_is_noise_and_what_grains_do_is_not)
{
    assert_true(noise_read(0.0, 1) < 0.07);
    assert_close(noise_read(0.2, 1), 0.2, 0.015);
    assert_close(noise_read(2.0, 1), 2.0, 0.05);
}

// Of four rows that hold one reading the mean is no better than that.
TEST(a_reading_that_stays_for_rows_counts_once)
{
    assert_close(noise_read(2.0, 4), 2.0 * sqrt(4.0), 0.2);
    const double still[6] = { 1.0, 1.0, 1.0, 1.0, 1.0, 1.0 };
    const double three[3] = { 0.0, 9.0, 0.0 };
    assert_close(dig_reading_noise(6, still), 0.0, 0.0);
    assert_close(dig_reading_noise(3, three), 0.0, 0.0);
    assert_close(dig_reading_noise(0, NULL), 0.0, 0.0);
}

TESTS_WITH(setup, NULL)
