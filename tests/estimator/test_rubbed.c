// Tests for estimator/match/rubbed.c: by elimination in the whole matrix.

#include "estimator/match/rubbed.h"

#include "tests/model_front.h"
#include "tests/testlib.h"

#include <math.h>

enum { NUMBERS = 7 };

struct case_of {
    double x[NUMBERS], v[NUMBERS][DIG_RUBS], weight;
};

static struct case_of draw(uint64_t *const seed)
{
    struct case_of c = { .weight = 0.2 + 3.0 * model_uniform(seed) };
    for (int i = 0; i < NUMBERS; i++) {
        c.x[i] = model_normal(seed);
        for (int j = 0; j < DIG_RUBS; j++) {
            c.v[i][j] = 2.0 * model_normal(seed);
        }
    }
    return c;
}

static struct dig_rubbed sum_of(const struct case_of *const c)
{
    struct dig_rubbed rubbed = { .b = { 0.0 } };
    for (int i = 0; i < NUMBERS; i++) {
        dig_rubbed_add(c->x[i], c->v[i], &rubbed);
    }
    return rubbed;
}

// x' (noise2 + V V')^-1 x, and the logarithm of that matrix's determinant.
static double square_by_hand(const struct case_of *const c, const double noise2,
                             double *const log_det)
{
    double d[NUMBERS][NUMBERS + 1];
    for (int i = 0; i < NUMBERS; i++) {
        for (int k = 0; k < NUMBERS; k++) {
            d[i][k] = i == k ? noise2 : 0.0;
            for (int j = 0; j < DIG_RUBS; j++) {
                d[i][k] += c->v[i][j] * c->v[k][j];
            }
        }
        d[i][NUMBERS] = c->x[i];
    }
    *log_det = 0.0;
    for (int i = 0; i < NUMBERS; i++) {
        *log_det += log(d[i][i]);
        for (int r = 0; r < NUMBERS; r++) {
            const double by = d[r][i] / d[i][i];
            for (int k = i; k <= NUMBERS && r != i; k++) {
                d[r][k] -= by * d[i][k];
            }
        }
    }
    double square = 0.0;
    for (int i = 0; i < NUMBERS; i++) {
        square += c->x[i] * d[i][NUMBERS] / d[i][i];
    }
    return square;
}

TEST(it_is_the_inverse_of_the_whole_covariance)
{
    uint64_t seed = 3;
    for (int trial = 0; trial < 100; trial++) {
        const struct case_of         c      = draw(&seed);
        const struct dig_rubbed      rubbed = sum_of(&c);
        const struct dig_rubbed_sums sums   = dig_rubbed_sum(&rubbed, c.weight);
        double                       x2 = 0.0, log_det = 0.0;
        for (int i = 0; i < NUMBERS; i++) {
            x2 += c.x[i] * c.x[i];
        }
        // Counted so often, a number has so much less noise.
        const double noise2 = 1.0 / c.weight;
        const double square = square_by_hand(&c, noise2, &log_det);
        assert_close(c.weight * x2 - sums.explained, square, 1e-9 * (1.0 + square));
        assert_close(sums.log_det + NUMBERS * log(noise2), log_det, 1e-9);
        assert_close(dig_rubbed_left2(&rubbed, x2, noise2), noise2 * square, 1e-8 * (1.0 + x2));
    }
}

TEST(two_digs_friction_is_one)
{
    uint64_t                seed   = 4;
    const struct case_of    one    = draw(&seed);
    const struct case_of    other  = draw(&seed);
    struct dig_rubbed       sum    = sum_of(&one);
    const struct dig_rubbed second = sum_of(&other);
    dig_rubbed_join(&sum, &second);
    struct dig_rubbed both = sum_of(&one);
    for (int i = 0; i < NUMBERS; i++) {
        dig_rubbed_add(other.x[i], other.v[i], &both);
    }
    assert_close(dig_rubbed_sum(&sum, 1.0).explained, dig_rubbed_sum(&both, 1.0).explained, 1e-9);
}

TEST(without_friction_nothing_is_explained)
{
    static const struct dig_rubbed none = { .b = { 0.0 } };
    assert_close(dig_rubbed_sum(&none, 5.0).explained, 0.0, 0.0);
    assert_close(dig_rubbed_sum(&none, 5.0).log_det, 0.0, 0.0);
    assert_close(dig_rubbed_left2(&none, 9.0, 4.0), 9.0, 0.0);
}
