// Tests for core/sort.c.

#include "core/sort.h"

#include "tests/testlib.h"

#include <math.h>

TEST(numbers_come_out_in_order_each_as_often_as_it_was)
{
    double value[] = { 3.0, -INFINITY, 0.5, 3.0, INFINITY, -2.0 };
    dig_sort(6, value);
    const double expected[] = { -INFINITY, -2.0, 0.5, 3.0, 3.0, INFINITY };
    assert_memory_equal(value, expected, sizeof expected);
    dig_sort(0, NULL);
}

TEST(the_median_has_as_many_below_as_above)
{
    double odd[]  = { 9.0, 1.0, 5.0 };
    double even[] = { 4.0, 1.0, 3.0, 2.0 };
    assert_close(dig_sort_median(3, odd), 5.0, 0.0);
    assert_close(dig_sort_median(4, even), 3.0, 0.0);
}
