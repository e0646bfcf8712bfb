// Tests for files/recording_csv.c and files/text/csv.c

#include "files/recording_csv.h"

#include "tests/scratch.h"

#define FORCE "t_s,pin_x_m,pin_z_m,theta_deg,Fx_N,Fy_N,Fz_N,Mx_Nm,My_Nm,Mz_Nm\n"
#define MACHINE                                                                                    \
    "t_s,boom_rad,arm_rad,bucket_rad,boom_head_Pa,boom_rod_Pa,arm_head_Pa,arm_rod_Pa,"             \
    "bucket_head_Pa,bucket_rod_Pa\n"

TEST(the_force_recording_of_the_formats_loads_as_it_is_written)
{
    struct dig_recording r = { 0 };
    assert_int_equal(dig_recording_read("tests/data/formats/force_recording.csv", &r, NULL),
                     DIG_OK);
    assert_int_equal(r.rows, 3);
    assert_close(r.row[1].t_s, 0.0075, 0.0);
    assert_close(r.row[1].pin_x_m, 0.0835, 0.0);
    assert_close(r.row[1].pin_z_m, 0.1716, 0.0);
    assert_close(r.row[1].theta_deg, -15.0, 0.0);
    assert_close(r.row[1].Fx_N, 0.1, 0.0);
    assert_close(r.row[2].Fy_N, 0.01, 0.0);
    assert_close(r.row[1].Fz_N, -0.25, 0.0);
    assert_close(r.row[2].Mx_Nm, 1e-4, 0.0);
    assert_close(r.row[2].My_Nm, 0.025, 0.0);
    assert_close(r.row[2].Mz_Nm, -1e-4, 0.0);
    dig_recording_finish(&r);
}

TEST(the_machine_recording_of_the_formats_keeps_what_is_missing_missing)
{
    struct dig_machine_recording r = { 0 };
    assert_int_equal(
        dig_machine_recording_read("tests/data/formats/machine_recording.csv", &r, NULL), DIG_OK);
    assert_int_equal(r.rows, 3);
    assert_int_equal(r.row[1].time_ns, 10000000);
    assert_close(r.row[2].value[DIG_SIGNAL_ARM_rad], -1.899, 0.0);
    assert_close(r.row[1].value[DIG_SIGNAL_BUCKET_ROD_Pa], 8e5, 0.0);
    assert_true(r.row[0].valid[DIG_SIGNAL_BOOM_ROD_Pa]);
    assert_false(r.row[1].valid[DIG_SIGNAL_BOOM_ROD_Pa]);
    assert_close(r.row[1].value[DIG_SIGNAL_BOOM_ROD_Pa], 0.0, 0.0);
    assert_true(r.row[2].valid[DIG_SIGNAL_PITCH_rad]);
    assert_false(r.row[1].valid[DIG_SIGNAL_PITCH_rad]);
    assert_false(r.row[2].valid[DIG_SIGNAL_TEMPERATURE_degC]);
    assert_true(dig_sample_is_complete(&r.row[0]));
    assert_false(dig_sample_is_complete(&r.row[1]));
    dig_machine_recording_finish(&r);
}

TEST(the_booms_and_the_arms_pressures_may_lack_a_column)
{
    struct dig_machine_recording r = { 0 };
    const char *const            few =
        scratch_write("few.csv", "t_s,boom_rad,arm_rad,bucket_rad,bucket_head_Pa,bucket_rod_Pa\n"
                                 "0,1,2,3,4,5\n.01,1,2,3,4,5\n");
    assert_int_equal(dig_machine_recording_read(few, &r, NULL), DIG_OK);
    assert_true(dig_sample_has_moment(&r.row[1]));
    assert_false(dig_sample_is_complete(&r.row[1]));
    assert_false(r.row[0].valid[DIG_SIGNAL_ARM_ROD_Pa]);
    assert_close(r.row[0].value[DIG_SIGNAL_BUCKET_ROD_Pa], 5.0, 0.0);
    dig_machine_recording_finish(&r);

    const char *const fewer = scratch_write(
        "fewer.csv", "t_s,boom_rad,arm_rad,bucket_rad,bucket_head_Pa\n0,1,2,3,4\n.01,1,2,3,4\n");
    struct dig_error error = { "" };
    assert_int_equal(dig_machine_recording_read(fewer, &r, &error), DIG_EINVAL);
    assert_contains(error.text, "bucket_rod_Pa: missing");
}

TEST(a_rig_s_recording_holds_its_force_sensor)
{
    struct dig_machine_recording r    = { 0 };
    const char *const            path = "tests/data/formats/machine_recording_sensor.csv";
    assert_true(dig_machine_recording_is(path));
    assert_int_equal(dig_machine_recording_read(path, &r, NULL), DIG_OK);
    assert_int_equal(r.rows, 3);
    assert_true(dig_sample_is_complete(&r.row[0]) && dig_sample_has_moment(&r.row[0]));
    assert_close(r.row[0].value[DIG_SIGNAL_PIN_X_m], -0.0833, 0.0);
    assert_close(r.row[0].value[DIG_SIGNAL_PIN_Z_m], 0.1719, 0.0);
    assert_close(r.row[0].value[DIG_SIGNAL_BUCKET_rad], -1.309, 0.0);
    assert_close(r.row[1].value[DIG_SIGNAL_SENSOR_FX_N], 1.25, 0.0);
    assert_close(r.row[1].value[DIG_SIGNAL_SENSOR_FZ_N], -0.375, 0.0);
    assert_close(r.row[1].value[DIG_SIGNAL_SENSOR_MY_Nm], 0.0266, 0.0);
    assert_false(r.row[2].valid[DIG_SIGNAL_SENSOR_FZ_N]);
    assert_false(dig_sample_has_moment(&r.row[2]));
    assert_false(r.row[0].valid[DIG_SIGNAL_BOOM_rad] || r.row[0].valid[DIG_SIGNAL_BOOM_HEAD_Pa]);

    // Written and read back it is the same, and no column of a machine with cylinders comes in.
    struct dig_machine_recording again = { 0 };
    const char *const            copy  = scratch_path("sensor.csv");
    assert_int_equal(dig_machine_recording_write(copy, &r, NULL), DIG_OK);
    size_t      size = 0;
    char *const text = scratch_read(copy, &size);
    assert_null(strstr(text, "boom"));
    free(text);
    assert_int_equal(dig_machine_recording_read(copy, &again, NULL), DIG_OK);
    assert_int_equal(again.rows, r.rows);
    assert_memory_equal(again.row, r.row, r.rows * sizeof r.row[0]);
    dig_machine_recording_finish(&again);
    dig_machine_recording_finish(&r);

    struct dig_error  error = { "" };
    const char *const both  = scratch_write(
         "both.csv", "# a comment\n\nt_s,boom_rad,bucket_rad,pin_X_m,pin_Z_m,sensor_Fx_N,"
                      "sensor_Fz_N,sensor_My_Nm\n0,1,2,3,4,5,6,7\n.01,1,2,3,4,5,6,7\n");
    assert_int_equal(dig_machine_recording_read(both, &r, &error), DIG_EINVAL);
    assert_contains(error.text, "\"boom_rad\": unknown");
    const char *const lacks = scratch_write(
        "lacks.csv", "t_s,bucket_rad,pin_X_m,sensor_Fx_N,sensor_Fz_N,sensor_My_Nm\n0,1,2,3,4,5\n");
    assert_int_equal(dig_machine_recording_read(lacks, &r, &error), DIG_EINVAL);
    assert_contains(error.text, "pin_Z_m: missing");
    assert_false(dig_machine_recording_is("tests/data/formats/force_recording.csv"));
    assert_false(dig_machine_recording_is(scratch_path("none.csv")));
}

TEST(columns_may_come_in_any_order_with_crlf_blanks_and_comments)
{
    struct dig_recording r    = { 0 };
    const char *const    path = scratch_write(
           "any.csv", "\xef\xbb\xbf# first\r\n My_Nm , "
                         "t_s,pin_x_m,pin_z_m,theta_deg,Fx_N,Fy_N,Fz_N,Mx_Nm,Mz_Nm\r\n"
                         "\r\n7,0,1,2,3,4,5,6,8,9\r\n  # between\r\n 70 ,\t+.01,1,2,3,4,5,6,8,9");
    assert_int_equal(dig_recording_read(path, &r, NULL), DIG_OK);
    assert_int_equal(r.rows, 2);
    assert_close(r.row[0].My_Nm, 7.0, 0.0);
    assert_close(r.row[1].My_Nm, 70.0, 0.0);
    assert_close(r.row[1].t_s, 0.01, 0.0);
    assert_close(r.row[1].Mz_Nm, 9.0, 0.0);
    dig_recording_finish(&r);
}

TEST(a_machine_recording_may_have_a_hole_and_its_times_are_rounded)
{
    struct dig_machine_recording r = { 0 };
    assert_int_equal(
        dig_machine_recording_read(
            scratch_write("hole.csv",
                          MACHINE "2.01,,,,,,,,,\n2.02,,,,,,,,,\n2.03,,,,,,,,,\n2.065,,,,,,,,,\n"),
            &r, NULL),
        DIG_OK);
    assert_int_equal(r.rows, 4);
    assert_int_equal(r.row[0].time_ns, 2010000000);
    assert_int_equal(r.row[3].time_ns, 2065000000);
    dig_machine_recording_finish(&r);
}

TEST(every_defect_of_a_force_recording_is_told_by_line_and_column)
{
    static const char *const bad[][2] = {
        { "", ":1: no header, expected a header of t_s, pin_x_m" },
        { "# nothing\n", ":1: no header" },
        { FORCE, ":1: no row of numbers" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n", ":2: column t_s: 1 row, expected at least 2" },
        { "t_s,pin_x_m\n0,0\n", ":1: column pin_z_m: missing, expected a header of" },
        { "t_s,pin_x_m,pin_z_m,theta_deg,Fx_N,Fy_N,Fz_N,Mx_Nm,My_Nm,Mz_Nm,colour\n",
          ":1: column \"colour\": unknown" },
        { "t_s,t_s,pin_z_m,theta_deg,Fx_N,Fy_N,Fz_N,Mx_Nm,My_Nm,Mz_Nm\n",
          ":1: column t_s: given twice" },
        { "t,x\n1,2\n", ":1: column \"t\": unknown" },
        { "t_s;pin_x_m;pin_z_m\n1;2;3\n", ":1: semicolons between columns, expected commas" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n.01,0,0,0,0,0,0,0,zero,0\n",
          ":3: column My_Nm: \"zero\", expected a finite number" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n.01,0,0,0,0,0,0,0,nan,0\n", ":3: column My_Nm: \"nan\"" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n.01,0,0,0,inf,0,0,0,0,0\n", ":3: column Fx_N: \"inf\"" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n.01,0,0,0,1e999,0,0,0,0,0\n", ":3: column Fx_N: \"1e999\"" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n.01,0,0,0,0x1,0,0,0,0,0\n", ":3: column Fx_N: \"0x1\"" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n.01,0,0,0,1 2,0,0,0,0,0\n", ":3: column Fx_N: \"1 2\"" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n.01,0,,0,0,0,0,0,0,0\n", ":3: column pin_z_m: \"\"" },
        { "t_s,pin_x_m,pin_z_m,theta_deg,Fx_N,Fz_N\n0,0,0,0,0,0\n",
          ":1: column My_Nm: missing, expected a header of" },
        { "t_s,pin_x_m,pin_z_m,theta_deg,My_Nm,Fx_n\n0,0,0,0,0,0\n",
          ":1: column \"Fx_n\": unknown" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n.01,0,0,0,0,0,0,0,0\n",
          ":3: column Mz_Nm: the line has 9 fields, expected 10" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n.01,0,0,0,0,0,0,0,0,0,0\n",
          ":3: column after the last: the line has 11 fields, expected 10" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n\n0,0,0,0,0,0,0,0,0,0\n",
          ":4: column t_s: 0 after 0, expected ascending time" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n.1,0,0,0,0,0,0,0,0,0\n",
          ":3: column t_s: 0.1 s between samples, expected 0.02 s or less" },
        { FORCE "0,0,0,0,0,0,0,0,0,0\n1e300,0,0,0,0,0,0,0,0,0\n", ":3: column t_s: 1e+300" },
        { FORCE "0,0,0,0,1e30,0,0,0,,0\n.01,0,0,0,-1e308,0,0,0,0,0\n",
          ":3: column Fx_N: -1e+308, expected within +-1e+30" },
        { FORCE "0,0,0,2e30,0,0,0,0,0,0\n.01,0,0,0,0,0,0,0,0,0\n", ":2: column theta_deg: 2e+30" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct dig_error     error = { "" };
        struct dig_recording r     = { .rows = 42 };
        assert_int_equal(dig_recording_read(scratch_write("bad.csv", bad[i][0]), &r, &error),
                         DIG_EINVAL);
        assert_int_equal(r.rows, 42);
        assert_null(r.row);
        assert_contains(error.text, "bad.csv:");
        assert_contains(error.text, bad[i][1]);
    }
}

TEST(defects_of_machine_recordings_are_told_too)
{
    struct dig_error             error = { "" };
    struct dig_machine_recording r     = { .rows = 42 };
    assert_refused(dig_machine_recording_read(scratch_write("bad.csv", FORCE), &r, &error), error,
                   DIG_EINVAL, "bad.csv:1: column \"pin_x_m\": unknown");
    assert_refused(
        dig_machine_recording_read(
            scratch_write("bad.csv", MACHINE "0,,,,,,,,,\n.01,1,1,1,1,1,1,1,oops,1\n"), &r, &error),
        error, DIG_EINVAL, "bad.csv:3: column bucket_head_Pa: \"oops\"");
    assert_refused(dig_machine_recording_read(
                       scratch_write("bad.csv", MACHINE "0,,,,,,,,,\n.1,,,,,,,,,\n"), &r, &error),
                   error, DIG_EINVAL, "50 Hz");
    assert_refused(dig_machine_recording_read(
                       scratch_write("bad.csv", MACHINE "0,,,,,,,,,\n,,,,,,,,,\n"), &r, &error),
                   error, DIG_EINVAL, "bad.csv:3: column t_s: \"\"");
    assert_refused(dig_machine_recording_read(
                       scratch_write("bad.csv", MACHINE "0,,,,,,,,,\n.01,1,1,1,1,1,1,1,1e160,1\n"),
                       &r, &error),
                   error, DIG_EINVAL, "bad.csv:3: column bucket_head_Pa: 1e+160, expected within");
    assert_int_equal(r.rows, 42);
}

// A bus of 50 Hz that loses rows, a logger of 49.9 Hz, an hour between two digs.
TEST(a_machine_recording_may_lack_rows_now_and_then)
{
    struct dig_machine_recording r     = { .rows = 0 };
    struct dig_error             error = { "" };
    char                         text[8192];
    size_t                       at  = (size_t)snprintf(text, sizeof text, "%s", MACHINE);
    double                       t_s = 0.0;
    for (int i = 0; i < 100; i++) {
        t_s += i == 50 ? 3600.0 : i % 10 == 0 ? 0.04008 : 0.02004;
        at += (size_t)snprintf(text + at, sizeof text - at, "%.5f,1,1,1,1,1,1,1,1,1\n", t_s);
    }
    assert_ok(dig_machine_recording_read(scratch_write("lost.csv", text), &r, &error), error);
    assert_int_equal(r.rows, 100);
    dig_machine_recording_finish(&r);
}

// Loggers count seconds since 1970.
TEST(times_may_be_of_a_calendar)
{
    struct dig_recording         force   = { 0 };
    struct dig_machine_recording machine = { 0 };
    assert_int_equal(
        dig_recording_read(scratch_write("f.csv", FORCE
                                         "1795437600.25,0,0,0,0,0,0,0,0,0\n1795437600.255,0,0,0,0,"
                                         "0,0,0,0,0\n"),
                           &force, NULL),
        DIG_OK);
    assert_close(force.row[1].t_s - force.row[0].t_s, 0.005, 1e-6);
    assert_int_equal(
        dig_machine_recording_read(
            scratch_write("m.csv", MACHINE "1795437600.25,,,,,,,,,\n1795437600.255,,,,,,,,,\n"),
            &machine, NULL),
        DIG_OK);
    assert_close((double)(machine.row[1].time_ns - machine.row[0].time_ns), 5e6, 1e3);
    dig_recording_finish(&force);
    dig_machine_recording_finish(&machine);
}

// A rig may measure the moment alone, or lose samples: missing is never zero.
TEST(forces_may_be_missing_here_and_there_or_altogether)
{
    struct dig_recording r = { 0 };
    const char *path = scratch_write("some.csv", FORCE "0,1,2,3,,5,6,,8,9\n.01,1,2,3,4,,,7,,\n");
    assert_int_equal(dig_recording_read(path, &r, NULL), DIG_OK);
    assert_true(isnan(r.row[0].Fx_N) && isnan(r.row[0].Mx_Nm) && isnan(r.row[1].Fy_N) &&
                isnan(r.row[1].Fz_N) && isnan(r.row[1].My_Nm) && isnan(r.row[1].Mz_Nm));
    assert_close(r.row[0].Fz_N, 6.0, 0.0);
    assert_close(r.row[1].Fx_N, 4.0, 0.0);

    // Written, they are empty again.
    struct dig_recording again = { 0 };
    path                       = scratch_path("again.csv");
    assert_int_equal(dig_recording_write(path, &r, NULL), DIG_OK);
    char *const text = scratch_read(path, &(size_t){ 0 });
    assert_contains(text, "\n0,1,2,3,,5,6,,8,9\n0.01,1,2,3,4,,,7,,\n");
    free(text);
    assert_int_equal(dig_recording_read(path, &again, NULL), DIG_OK);
    assert_true(isnan(again.row[1].My_Nm));
    assert_close(again.row[1].Mx_Nm, 7.0, 0.0);
    dig_recording_finish(&again);
    dig_recording_finish(&r);

    path = scratch_write("alone.csv", "t_s,My_Nm,pin_x_m,pin_z_m,theta_deg\n"
                                      "0,8,1,2,3\n.01,9,1,2,3\n");
    assert_int_equal(dig_recording_read(path, &r, NULL), DIG_OK);
    assert_close(r.row[1].My_Nm, 9.0, 0.0);
    assert_true(isnan(r.row[1].Fx_N) && isnan(r.row[1].Fz_N) && isnan(r.row[1].carried_kg));
    dig_recording_finish(&r);
}

TEST(what_is_written_is_read_back)
{
    struct dig_force_row       rows[50];
    const struct dig_recording written = { .rows = 50, .row = rows };
    for (size_t i = 0; i < 50; i++) {
        const double k = (double)i;
        rows[i]        = (struct dig_force_row){
                   0.005 * k + 0.0025, k / 7, -k / 3,  1e-7 * k, 1e5 / (k + 1), k * k,
                   -1e-9 * k,          3,     1.0 / 3, -0.0,     k / 11
        };
    }
    struct dig_recording read = { 0 };
    const char *const    path = scratch_path("out.csv");
    assert_int_equal(dig_recording_write(path, &written, NULL), DIG_OK);
    assert_int_equal(dig_recording_read(path, &read, NULL), DIG_OK);
    assert_int_equal(read.rows, 50);
    for (size_t i = 0; i < 50; i++) {
        assert_close(read.row[i].t_s, rows[i].t_s, 1e-9);
        assert_close(read.row[i].pin_x_m, rows[i].pin_x_m, 1e-8 * fabs(rows[i].pin_x_m));
        assert_close(read.row[i].Fx_N, rows[i].Fx_N, 1e-8 * rows[i].Fx_N);
        assert_close(read.row[i].My_Nm, rows[i].My_Nm, 1e-9);
        assert_close(read.row[i].carried_kg, rows[i].carried_kg, 1e-8);
    }
    dig_recording_finish(&read);

    // A mass that is not known is no column, and no column is a mass that is not known.
    rows[7].carried_kg = (double)NAN;
    assert_int_equal(dig_recording_write(path, &written, NULL), DIG_OK);
    assert_int_equal(dig_recording_read(path, &read, NULL), DIG_OK);
    assert_true(isnan(read.row[0].carried_kg) && isnan(read.row[49].carried_kg));
    dig_recording_finish(&read);
    assert_false(scratch_exists("out.csv.part"));
}

TEST(a_machine_recording_is_read_back_with_its_gaps)
{
    struct dig_sample rows[20];
    memset(rows, 0, sizeof rows);
    for (int i = 0; i < 20; i++) {
        rows[i].time_ns = INT64_C(3600000000000) + i * INT64_C(10000001);
        for (int s = 0; s < DIG_SIGNALS; s++) {
            rows[i].valid[s] =
                (i + s) % 3 != 0 && s <= DIG_SIGNAL_TEMPERATURE_degC && s != DIG_SIGNAL_PITCH_rad;
            rows[i].value[s] = rows[i].valid[s] ? 12345678.9 * s - i / 3.0 : 0.0;
        }
    }
    const struct dig_machine_recording written = { .rows = 20, .row = rows };
    struct dig_machine_recording       read    = { 0 };
    const char *const                  path    = scratch_path("machine.csv");
    assert_int_equal(dig_machine_recording_write(path, &written, NULL), DIG_OK);
    assert_int_equal(dig_machine_recording_read(path, &read, NULL), DIG_OK);
    assert_int_equal(read.rows, 20);
    for (int i = 0; i < 20; i++) {
        assert_int_equal(read.row[i].time_ns, rows[i].time_ns);
        for (int s = 0; s < DIG_SIGNALS; s++) {
            assert_int_equal(read.row[i].valid[s], rows[i].valid[s]);
            assert_close(read.row[i].value[s], rows[i].value[s], 1e-11 * fabs(rows[i].value[s]));
        }
    }
    dig_machine_recording_finish(&read);

    size_t      size = 0;
    char *const text = scratch_read(path, &size);
    assert_null(strstr(text, "pitch_rad"));
    assert_non_null(strstr(text, "temperature_degC"));
    free(text);
}

TESTS_WITH(scratch_setup, scratch_teardown)
