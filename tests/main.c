// The main program of every test: runs the TEST()s of its file, in the order of the file.

#include "tests/testlib.h"

#include <assert.h>

enum { TESTS_MOST = 64 };

static struct CMUnitTest all[TESTS_MOST];
static int               line_of[TESTS_MOST];
static size_t            tests;
static CMFixtureFunction group_setup, group_teardown;

// Those that are earlier in the file go first: constructors come in any order.
void test_add(const struct CMUnitTest *const test, const int line)
{
    assert(tests < TESTS_MOST);
    size_t at = tests++;
    for (; at > 0 && line_of[at - 1] > line; at--) {
        all[at]     = all[at - 1];
        line_of[at] = line_of[at - 1];
    }
    all[at]     = *test;
    line_of[at] = line;
}

void test_add_group(const CMFixtureFunction setup, const CMFixtureFunction teardown)
{
    assert(group_setup == NULL && group_teardown == NULL);
    group_setup    = setup;
    group_teardown = teardown;
}

int main(void)
{
    assert(tests > 0);
    return _cmocka_run_group_tests("tests", all, tests, group_setup, group_teardown);
}
