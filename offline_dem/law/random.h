// SplitMix64 (Steele, Lea & Flood, OOPSLA 2014): a counter and a mixing function. Small, and the
// same on every machine, which the C library's generator is not.

#ifndef DIG_OFFLINE_DEM_LAW_RANDOM_H
#define DIG_OFFLINE_DEM_LAW_RANDOM_H

#include <stdint.h>

struct dig_random {
    uint64_t state; // the seed, at the beginning
};

static inline uint64_t dig_random_next(struct dig_random *const random)
{
    random->state += 0x9E3779B97F4A7C15U;
    uint64_t z = random->state;
    z          = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z          = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
}

/// Uniform in [low, high), from the upper 53 bits.
static inline double dig_random_between(struct dig_random *const random, const double low,
                                        const double high)
{
    return low + (high - low) * ((double)(dig_random_next(random) >> 11) * 0x1p-53);
}

#endif // DIG_OFFLINE_DEM_LAW_RANDOM_H
