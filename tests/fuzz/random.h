// The numbers of the fuzzers: the same state gives the same inputs again.

#ifndef DIG_TESTS_FUZZ_RANDOM_H
#define DIG_TESTS_FUZZ_RANDOM_H

#include <stddef.h>
#include <stdint.h>

static uint64_t state;

static inline uint64_t next(void) // splitmix64, Steele, Lea and Flood 2014
{
    uint64_t z = (state += 0x9E3779B97F4A7C15u);
    z          = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z          = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

/// 0 ... n - 1; 0 of none.
static inline size_t below(const size_t n)
{
    return n == 0 ? 0 : (size_t)(next() % n);
}

#endif // DIG_TESTS_FUZZ_RANDOM_H
