// Counts what this thread allocates, by standing in front of the C library's functions. It defines
// malloc(): one file of a program may include it, no shared one. A sanitizer stands there already,
// and glibc's own names are needed; elsewhere nothing is counted.

#ifndef DIG_TESTS_COUNT_ALLOCATIONS_H
#define DIG_TESTS_COUNT_ALLOCATIONS_H

#include "tests/testlib.h"

#include <stdlib.h>

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define COUNTS_ALLOCATIONS 1
extern void *__libc_malloc(size_t size);               // NOLINT(bugprone-reserved-identifier)
extern void *__libc_calloc(size_t count, size_t size); // NOLINT(bugprone-reserved-identifier)
extern void *__libc_realloc(void *old, size_t size);   // NOLINT(bugprone-reserved-identifier)
// volatile: the compiler takes malloc() for a function that leaves it as it is.
static _Thread_local volatile unsigned long allocations;

void *malloc(const size_t size)
{
    allocations++;
    return __libc_malloc(size);
}

void *calloc(const size_t count, const size_t size)
{
    allocations++;
    return __libc_calloc(count, size);
}

void *realloc(void *const old, const size_t size)
{
    allocations++;
    return __libc_realloc(old, size);
}
#else
#define COUNTS_ALLOCATIONS 0
static const unsigned long allocations = 0;
#endif

/// At the head of a test that counts: skips it where nothing is counted, and fails where the count
/// itself does not work.
static inline void skip_unless_allocations_count(void)
{
    if (!COUNTS_ALLOCATIONS) {
        print_message("SKIP: a sanitizer owns malloc, allocations are counted without it\n");
        skip();
    }
    const unsigned long before  = allocations;
    void *volatile const memory = malloc(1);
    free(memory);
    assert_true(allocations > before);
}

#endif // DIG_TESTS_COUNT_ALLOCATIONS_H
