#include "core/chance.h"

#include "tests/testlib.h"

// Tabulated quantiles of chi square (any book of tables).
TEST(tails_of_chi_square_are_those_of_the_tables)
{
    const struct {
        double freedom, x, tail;
    } known[] = { { 1, 3.8415, 0.05 },  { 1, 6.6349, 0.01 },   { 5, 15.0863, 0.01 },
                  { 10, 18.307, 0.05 }, { 30, 50.8922, 0.01 }, { 100, 149.449, 0.001 } };
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        assert_close(dig_chance_gamma_tail(known[i].freedom, 2.0 * known[i].freedom, known[i].x),
                     known[i].tail, 2e-5);
    }
    assert_close(dig_chance_gamma_tail(7.0, 14.0, 0.0), 1.0, 0.0);
    assert_close(dig_chance_gamma_tail(2.0, 4.0, 60.0), exp(-30.0), 1e-22); // closed form
}

TEST(draws_have_the_tail_that_is_claimed)
{
    enum { DRAWS = 20000, FREEDOM = 4 };
    uint64_t seed  = 11;
    double   above = 0.0;
    for (int i = 0; i < DRAWS; i++) {
        double sum = 0.0;
        for (int k = 0; k < FREEDOM; k++) {
            const double z = dig_chance_normal(&seed);
            sum += z * z;
        }
        above += sum > 9.4877 ? 1.0 / DRAWS : 0.0; // 5 % of chi square with 4 degrees
    }
    assert_close(above, 0.05, 5.0 * sqrt(0.05 * 0.95 / DRAWS));
}

TEST(every_index_comes_as_often)
{
    enum { DRAWS = 30000, PLACES = 6 };
    uint64_t seed          = 12;
    double   count[PLACES] = { 0.0 };
    for (int i = 0; i < DRAWS; i++) {
        count[dig_chance_index(&seed, PLACES)] += 1.0;
        const double u = dig_chance_uniform(&seed);
        assert_true(u >= 0.0 && u < 1.0);
    }
    for (size_t i = 0; i < PLACES; i++) {
        assert_close(count[i] / DRAWS, 1.0 / PLACES, 5.0 * sqrt(1.0 / PLACES / DRAWS));
    }
}
