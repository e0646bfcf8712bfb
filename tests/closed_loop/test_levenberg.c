#include "closed_loop/numeric/levenberg.h"

#include "tests/testlib.h"

// Rosenbrock's valley as a sum of squares; its bottom is at (1, 1).
static void valley(void *const context, const double x[], double r[])
{
    (void)context;
    r[0] = 10.0 * (x[1] - x[0] * x[0]);
    r[1] = 1.0 - x[0];
}

static struct dig_levenberg problem(double memory[], const double most)
{
    return (struct dig_levenberg){ .unknowns   = 2,
                                   .residuals  = 2,
                                   .low        = { -2.0, -2.0 },
                                   .high       = { most, 2.0 },
                                   .step       = 1e-6,
                                   .iterations = 200,
                                   .residual   = valley,
                                   .memory     = memory };
}

TEST(the_bottom_of_a_curved_valley_is_found)
{
    double                     memory[8], squares = 0.0;
    double                     x[2] = { -1.2, 1.0 };
    const struct dig_levenberg p    = problem(memory, 2.0);
    dig_levenberg_run(&p, x, &squares);
    assert_close(x[0], 1.0, 1e-2);
    assert_close(x[1], 1.0, 2e-2);
    assert_close(squares, 0.0, 1e-4);
}

// With x0 held below 0.5 the best is on the bound: r1 = 0.5, x1 = 0.25.
TEST(a_bound_is_kept_and_the_rest_is_fitted)
{
    double                     memory[8], squares = 0.0;
    double                     x[2] = { -1.2, 1.0 };
    const struct dig_levenberg p    = problem(memory, 0.5);
    dig_levenberg_run(&p, x, &squares);
    assert_close(x[0], 0.5, 1e-9);
    assert_close(x[1], 0.25, 1e-3);
    assert_close(squares, 0.25, 1e-3);
}

TEST(a_held_unknown_stays)
{
    double               memory[8], squares = 0.0;
    double               x[2] = { 0.7, -1.0 };
    struct dig_levenberg p    = problem(memory, 2.0);
    p.low[0] = p.high[0] = 0.7;
    dig_levenberg_run(&p, x, &squares);
    assert_close(x[0], 0.7, 0.0);
    assert_close(x[1], 0.49, 1e-4);
}
