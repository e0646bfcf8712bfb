// Tests for closed_loop/machine/machine_doubt.c

#include "closed_loop/machine/machine_doubt.h"
#include "core/units.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <string.h>

enum { ERRORS = 3, ROWS = 12 };

static const double level = 0.05;

// Free air of a machine whose file is wrong by z tolerances each. Of the last error it shows so
// much.
static struct dig_machine_unlike ask(const double z[ERRORS], const double shown, uint64_t *state)
{
    static struct dig_fit fit;
    static double         slope2[ERRORS * ERRORS], work[ERRORS * ERRORS], cov[ERRORS * ERRORS];
    static double         at[ERRORS];
    memset(slope2, 0, sizeof slope2);
    fit =
        (struct dig_fit){ .slope2 = slope2, .work = work, .at = at, .covariance = cov, .s2 = 1.0 };
    fit.lines.columns = ERRORS;
    for (int c = 0; c < ERRORS; c++) {
        fit.lines.column[c].effect = DIG_EFFECT_UNLISTED;
        fit.of[c]                  = -1;
        fit.base[c]                = 1.0;
    }
    for (int r = 0; r < ROWS; r++) {
        const double slope[ERRORS] = { 1.0, 2.0 * sin(r), shown * cos(2.0 * r) };
        double       rest          = model_normal(state);
        for (int c = 0; c < ERRORS; c++) {
            rest -= slope[c] * z[c];
        }
        fit.rest2 += rest * rest;
        for (int a = 0; a < ERRORS; a++) {
            fit.slope_rest[a] += slope[a] * rest;
            for (int b = 0; b <= a; b++) {
                slope2[a * ERRORS + b] += slope[a] * slope[b];
            }
        }
    }
    return dig_machine_unlike_ask(&fit, level);
}

TEST(a_machine_like_its_file_is_found_unlike_as_often_as_asked_for)
{
    enum { DRAWS = 20000 };
    for (int k = 0; k < 3; k++) {
        const double shown = 0.01 * pow(10.0, k);
        uint64_t     state = 7;
        double       share = 0.0;
        for (int i = 0; i < DRAWS; i++) {
            const double z[ERRORS] = { model_normal(&state), model_normal(&state),
                                       model_normal(&state) };
            share += ask(z, shown, &state).is ? 1.0 / DRAWS : 0.0;
        }
        print_message("the last error shown by %.2f: %.4f at %.2f\n", shown, share, level);
        assert_close(share, level, 0.006);
    }
}

TEST(an_error_beyond_its_tolerance_is_the_one_that_is_named)
{
    uint64_t state = 11;
    for (int c = 0; c < ERRORS; c++) {
        for (int way = -1; way <= 1; way += 2) {
            double z[ERRORS] = { 0.3, -0.5, 0.4 };
            z[c]             = 7.0 * way;

            const struct dig_machine_unlike unlike = ask(z, 1.0, &state);
            assert_true(unlike.is && unlike.p < 1e-4);
            assert_int_equal(unlike.column, c);
        }
    }
}

TEST(an_error_that_free_air_does_not_show_is_never_named)
{
    const double z[ERRORS] = { 0.3, -0.5, 40.0 };
    uint64_t     state     = 13;
    assert_false(ask(z, 0.0, &state).is);
    assert_true(ask(z, 1.0, &state).is);
}

// Of what the rows say against a file without errors: averaged over the prior, in steps.
TEST(the_evidence_is_of_the_file_with_that_error_of_any_size)
{
    const double z[ERRORS] = { 9.0, 0.5, 0.0 };
    uint64_t     state     = 17;
    uint64_t     again     = state;
    double       rest[ROWS];
    double       sum  = 0.0;
    double       most = -INFINITY;

    const struct dig_machine_unlike unlike = ask(z, 0.0, &state);
    for (int r = 0; r < ROWS; r++) {
        rest[r] = model_normal(&again) - z[0] - 2.0 * sin(r) * z[1];
    }
    for (int pass = 0; pass < 2; pass++) {
        for (double a = 0.0; a < 15.0; a += 0.02) {
            for (double b = -4.0; b < 4.0; b += 0.02) {
                double log_density = -0.5 * (a * a / 16.0 + b * b) - log(2.0 * DIG_PI * 4.0);
                for (int r = 0; r < ROWS; r++) {
                    const double left = rest[r] + a + 2.0 * sin(r) * b;
                    log_density += 0.5 * (rest[r] * rest[r] - left * left);
                }
                most = pass == 0 ? fmax(most, log_density) : most;
                sum += pass == 0 ? 0.0 : exp(log_density - most) * 0.02 * 0.02;
            }
        }
    }
    // The last error is not shown, so that two were to choose from.
    assert_close(unlike.log_evidence, most + log(sum) - log(2.0), 0.01);
}
