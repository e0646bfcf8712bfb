// Tests for tools/rig/record.c

#include "tools/rig/commands.h"

#include "files/recording_csv.h"
#include "tests/scratch.h"

static struct dig_rig_row rows[] = {
    {
        .pose      = { 7.25, -1.0, -1.5 },
        .soil      = { 0.0, 0.0, 0.0 },
        .joints    = { .rad = { 0.25, -1.0, -0.75 } },
        .pressures = { .head_Pa = { 8e6, 1e6, 1e6 }, .rod_Pa = { 1e6, 4e6, 2e6 } },
    },
    {
        .pose      = { 7.249, -1.0625, -1.5 },
        .soil      = { 38000.0, 33000.0, 4125.5 },
        .joints    = { .rad = { 0.25, -1.0, -0.75 } },
        .pressures = { .head_Pa = { 3.4e6, 2e6, 1.4e6 }, .rod_Pa = { 1e6, 1e6, 1e6 } },
    },
};

static const struct dig_rig_track track = { .rows = 2, .step_s = 0.005, .row = rows };

// Force in the rig's axes: a push towards machine +X is one towards the rig's -x.
TEST(truth_is_written_as_the_example_of_the_formats_stands)
{
    const struct dig_machine     machine = { .pressure_step_Pa = 0.0 };
    const struct dig_rig_options options = { .out   = scratch_path("run.csv"),
                                             .truth = scratch_path("truth.csv") };
    assert_int_equal(dig_rig_record(&machine, &options, &track, NULL), DIG_OK);
    size_t      size[2];
    char *const written = scratch_read(options.truth, &size[0]);
    char *const example = scratch_read("tests/data/formats/rig_truth.csv", &size[1]);
    assert_string_equal(written, example);
    free(written);
    free(example);
}

TEST(recording_reads_back_as_the_track_it_came_from)
{
    const struct dig_machine machine = { .pressure_step_Pa = 2e5, .angle_step_rad = 4e-4 };
    struct dig_rig_options   options = { .out = scratch_path("machine.csv") };
    assert_int_equal(dig_rig_record(&machine, &options, &track, NULL), DIG_OK);

    struct dig_machine_recording found;
    struct dig_error             error = { "" };
    assert_int_equal(dig_machine_recording_read(options.out, &found, &error), DIG_OK);
    assert_int_equal(found.rows, 2);
    assert_int_equal(found.row[1].time_ns, 5000000);
    assert_close(found.row[1].value[DIG_SIGNAL_ARM_HEAD_Pa], 2e6, 1e-3);
    assert_close(found.row[0].value[DIG_SIGNAL_BUCKET_rad], -0.75, 1e-12);
    dig_machine_recording_finish(&found);

    options.quantise = true;
    assert_int_equal(dig_rig_record(&machine, &options, &track, NULL), DIG_OK);
    assert_int_equal(dig_machine_recording_read(options.out, &found, &error), DIG_OK);
    assert_close(found.row[1].value[DIG_SIGNAL_BUCKET_HEAD_Pa], 1.4e6, 1e-3);
    assert_close(found.row[1].value[DIG_SIGNAL_BOOM_HEAD_Pa], 3.4e6, 1e-3);
    assert_close(found.row[0].value[DIG_SIGNAL_BOOM_rad], 0.25, 1e-12);
    dig_machine_recording_finish(&found);
}

TEST(file_that_cannot_be_written_is_reported_and_left_out)
{
    const struct dig_machine     machine = { .pressure_step_Pa = 0.0 };
    const struct dig_rig_options options = { .out   = scratch_path("none.csv"),
                                             .truth = "/nowhere/at/all.csv" };
    struct dig_error             error   = { "" };
    assert_int_equal(dig_rig_record(&machine, &options, &track, &error), DIG_EIO);
    assert_contains(error.text, "/nowhere/at/all.csv");
    assert_false(scratch_exists("none.csv"));
}

TESTS_WITH(scratch_setup, scratch_teardown)
