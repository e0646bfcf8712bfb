#include "closed_loop/numeric/dense.h"

#include "tests/model_front.h"
#include "tests/testlib.h"

enum { N = 7 };

// A matrix that is positive definite because it is B B' + 1, and what it makes of x.
static void make(uint64_t *const seed, double a[N * N], double x[N], double ax[N])
{
    double b[N * N];
    for (size_t i = 0; i < N * N; i++) {
        b[i] = model_normal(seed);
    }
    for (size_t i = 0; i < N; i++) {
        x[i] = model_normal(seed);
        for (size_t j = 0; j < N; j++) {
            a[i * N + j] = i == j ? 1.0 : 0.0;
            for (size_t k = 0; k < N; k++) {
                a[i * N + j] += b[i * N + k] * b[j * N + k];
            }
        }
    }
    for (size_t i = 0; i < N; i++) {
        ax[i] = 0.0;
        for (size_t j = 0; j < N; j++) {
            ax[i] += a[i * N + j] * x[j];
        }
    }
}

TEST(a_system_is_solved)
{
    uint64_t seed = 3;
    for (int round = 0; round < 20; round++) {
        double a[N * N], x[N], b[N];
        make(&seed, a, x, b);
        assert_int_equal(dig_cholesky(N, a), DIG_OK);
        dig_cholesky_solve(N, a, b);
        for (size_t i = 0; i < N; i++) {
            assert_close(b[i], x[i], 1e-10);
        }
    }
}

TEST(multiplying_undoes_solving)
{
    uint64_t seed = 4;
    double   a[N * N], x[N], b[N];
    make(&seed, a, x, b);
    assert_int_equal(dig_cholesky(N, a), DIG_OK);
    double y[N];
    for (size_t i = 0; i < N; i++) {
        y[i] = x[i];
    }
    dig_lower_multiply(N, a, y);
    dig_lower_solve(N, a, y);
    for (size_t i = 0; i < N; i++) {
        assert_close(y[i], x[i], 1e-12);
    }
}

TEST(a_product_with_the_inverse_solves)
{
    uint64_t seed = 5;
    double   a[N * N], x[N], b[N], inverse[N * N];
    make(&seed, a, x, b);
    assert_int_equal(dig_cholesky(N, a), DIG_OK);
    dig_lower_invert(N, a, inverse);
    for (size_t i = 0; i < N; i++) {
        x[i] = b[i];
    }
    dig_lower_multiply(N, inverse, x);
    dig_lower_solve(N, a, b);
    for (size_t i = 0; i < N; i++) {
        assert_close(x[i], b[i], 1e-10);
    }
}

TEST(the_determinant_is_that_of_a_known_matrix)
{
    double a[4] = { 4.0, 2.0, 2.0, 3.0 }; // 4 * 3 - 2 * 2
    assert_int_equal(dig_cholesky(2, a), DIG_OK);
    assert_close(dig_lower_log_det(2, a), log(8.0), 1e-12);
}

TEST(what_is_not_positive_definite_is_refused)
{
    double flat[4]     = { 1.0, 1.0, 1.0, 1.0 };
    double negative[1] = { -1.0 };
    double nan[1]      = { (double)NAN };
    assert_int_equal(dig_cholesky(2, flat), DIG_EINVAL);
    assert_int_equal(dig_cholesky(1, negative), DIG_EINVAL);
    assert_int_equal(dig_cholesky(1, nan), DIG_EINVAL);
}
