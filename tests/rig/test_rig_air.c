// Tests for tools/rig/motion/air.c

#include "tools/rig/motion/air.h"

#include "core/units.h"
#include "tests/read.h"
#include "tools/rig/motion/track.h"

#include <stdio.h>
#include <string.h>

static const char *const shipped[] = { "mini_1t8", "mini_2t8",     "zx120",      "crawler_14t",
                                       "zx200",    "zx200_trench", "crawler_36t" };
#define SHIPPED (sizeof shipped / sizeof shipped[0])

static struct dig_rig_track move(const struct dig_machine *const machine)
{
    const struct dig_rig_track_options how = dig_rig_track_options_default();
    struct dig_rig_track               track;
    struct dig_error                   error = { "" };
    if (dig_rig_track_build_air(machine, &how, &track, &error) != DIG_OK) {
        fail_msg("%s: %s", machine->name, error.text);
    }
    return track;
}

TEST(every_machine_moves_each_joint_through_most_of_its_range_in_free_air)
{
    for (size_t m = 0; m < SHIPPED; m++) {
        const struct dig_machine machine = read_machine(shipped[m]);
        struct dig_rig_track     track   = move(&machine);
        const double             s       = track.step_s * (double)track.rows;
        assert_true(s > 45.0 && s < 90.0);
        for (int j = 0; j < DIG_JOINTS; j++) {
            double low = 1e9, high = -1e9;
            for (size_t i = 0; i < track.rows; i++) {
                low  = fmin(low, track.row[i].joints.rad[j]);
                high = fmax(high, track.row[i].joints.rad[j]);
            }
            const double range = machine.link[j].max_rad - machine.link[j].min_rad;
            assert_close((high - low) / range, 0.7, 1e-6);
            assert_close((low - machine.link[j].min_rad) / range, 0.15, 1e-6);
        }
        for (size_t i = 0; i < track.rows; i++) {
            assert_close(track.row[i].soil.FX_N, 0.0, 0.0);
            assert_close(track.row[i].soil.FZ_N, 0.0, 0.0);
            assert_close(track.row[i].soil.M_Nm, 0.0, 0.0);
        }
        dig_rig_track_finish(&track);
    }
}

// By differences of the rows: half a radian a second, and no jump of the acceleration.
TEST(it_moves_slowly_and_smoothly)
{
    const struct dig_machine machine = read_machine("zx200");
    struct dig_rig_track     track   = move(&machine);
    double                   fastest = 0.0, hardest = 0.0;
    for (size_t i = 2; i < track.rows; i++) {
        for (int j = 0; j < DIG_JOINTS; j++) {
            const double a = track.row[i - 2].joints.rad[j], b = track.row[i - 1].joints.rad[j],
                         c = track.row[i].joints.rad[j];
            fastest        = fmax(fastest, fabs(c - b) / track.step_s);
            hardest        = fmax(hardest, fabs(c - 2.0 * b + a) / (track.step_s * track.step_s));
        }
    }
    assert_true(fastest > 0.45 && fastest < 0.501);
    assert_true(hardest < 0.81);
    dig_rig_track_finish(&track);
}

TEST(a_bucket_on_a_force_sensor_is_refused)
{
    const struct dig_machine           machine = read_machine("rig_sensor");
    const struct dig_rig_track_options how     = dig_rig_track_options_default();
    struct dig_rig_track               track   = { .rows = 42 };
    struct dig_error                   error   = { "" };
    assert_int_equal(dig_rig_track_build_air(&machine, &how, &track, &error), DIG_EINVAL);
    assert_contains(error.text, "force sensor");
    assert_int_equal(track.rows, 42);
}
