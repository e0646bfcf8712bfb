// Tests for files/lcm/predicted_curve.c

#include "files/lcm/predicted_curve.h"

#include "tests/testlib.h"

#include <string.h>

static double moment_Nm[DIG_PREDICTED_POINTS];
static double sigma_Nm[DIG_PREDICTED_POINTS];
static char   actual[] = "actual";

// From 0.37 to 1: moment 370, 380, … 1000, a thousand times the progress; sigma a tenth of it.
static digsight_prediction_t prediction(void)
{
    for (int i = 0; i < DIG_PREDICTED_POINTS; i++) {
        moment_Nm[i] = 370.0 + 10.0 * i;
        sigma_Nm[i]  = 37.0 + i;
    }
    return (digsight_prediction_t){ .valid         = 1,
                                    .trajectory    = actual,
                                    .from_progress = 0.37,
                                    .to_progress   = 1.0,
                                    .points        = DIG_PREDICTED_POINTS,
                                    .moment_Nm     = moment_Nm,
                                    .sigma_Nm      = sigma_Nm,
                                    .peak_Nm       = 1300.0,
                                    .energy_J      = 5.0 };
}

TEST(a_curve_is_read_between_its_points)
{
    const digsight_prediction_t m = prediction();
    struct dig_predicted_curve  curve;
    double                      moment = -1.0;
    double                      sigma  = -1.0;
    assert_true(dig_predicted_curve_take(&m, &curve));
    assert_string_equal(curve.trajectory, "actual");
    assert_close(curve.peak_Nm, 1300.0, 0.0);
    static const double inside[] = { 0.37, 0.375, 0.5, 0.8888, 1.0 };
    for (size_t i = 0; i < sizeof inside / sizeof inside[0]; i++) {
        assert_true(dig_predicted_curve_at(&curve, inside[i], &moment, &sigma));
        assert_close(moment, 1000.0 * inside[i], 1e-9);
        assert_close(sigma, 100.0 * inside[i], 1e-9);
    }
    moment = sigma                = -1.0;
    static const double outside[] = { 0.0, 0.3699, 1.0001, -1e300, (double)INFINITY, (double)NAN };
    for (size_t i = 0; i < sizeof outside / sizeof outside[0]; i++) {
        assert_false(dig_predicted_curve_at(&curve, outside[i], &moment, &sigma));
    }
    assert_true(moment < 0.0 && sigma < 0.0);
}

static void check_refused(const digsight_prediction_t *const m)
{
    struct dig_predicted_curve curve = { .peak_Nm = 42.0 };
    assert_false(dig_predicted_curve_take(m, &curve));
    assert_close(curve.peak_Nm, 42.0, 0.0);
}

TEST(what_is_no_curve_is_refused_and_writes_nothing)
{
    digsight_prediction_t m = prediction();
    m.valid                 = 0;
    check_refused(&m);
    m        = prediction();
    m.points = 63;
    check_refused(&m);
    static char names[][40] = { "", "..", "\033[2J", "a_name_of_more_than_thirty_one_chars" };
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        m            = prediction();
        m.trajectory = names[i];
        check_refused(&m);
    }
    static const double ranges[][2] = {
        { -0.1, 1.0 }, { 0.5, 0.5 }, { 0.0, 1.1 }, { (double)NAN, 1.0 }, { 0.0, (double)NAN }
    };
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        m               = prediction();
        m.from_progress = ranges[i][0];
        m.to_progress   = ranges[i][1];
        check_refused(&m);
    }
    static const double moments[] = { (double)NAN, (double)INFINITY, -1.1e9 };
    for (size_t i = 0; i < sizeof moments / sizeof moments[0]; i++) {
        m             = prediction();
        moment_Nm[63] = moments[i];
        check_refused(&m);
        m            = prediction();
        sigma_Nm[17] = moments[i];
        check_refused(&m);
    }
}
