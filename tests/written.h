// What is written into a stream, as a text; and what every page has to be.

#ifndef DIG_TESTS_WRITTEN_H
#define DIG_TESTS_WRITTEN_H

#include "tests/testlib.h"

#include <stdio.h>
#include <string.h>

/// A stream whose text stands in *text after written_end(), malloc'ed. One at a time.
static inline FILE *written_begin(char **const text)
{
    static size_t size;
    FILE *const   to = open_memstream(text, &size);
    assert_non_null(to);
    return to;
}

static inline void written_end(FILE *const to)
{
    assert_int_equal(fclose(to), 0);
}

static inline size_t count_of(const char *const text, const char *const word)
{
    size_t n = 0;
    for (const char *at = text; (at = strstr(at, word)) != NULL; at++) {
        n++;
    }
    return n;
}

/// Namespaces are names; anything else with a scheme would be fetched.
static inline void check_page_stands_alone(const char *const page)
{
    assert_int_equal(count_of(page, "://"), count_of(page, "://www.w3.org/"));
}

#endif // DIG_TESTS_WRITTEN_H
