// Random draws of the blind bench: the same seed gives the same campaign on every machine.

#ifndef DIG_TESTS_BLIND_DRAW_H
#define DIG_TESTS_BLIND_DRAW_H

#include <stddef.h>
#include <stdint.h>

struct blind_draw {
    uint64_t state;
};

/// A stream of its own for every pair of numbers.
struct blind_draw blind_draw_init(uint64_t seed, uint64_t stream);

/// In [0, 1); in [0, n); in [low, high); as likely in each decade; mean 0 and deviation 1.
double blind_uniform(struct blind_draw *draw);
size_t blind_below(struct blind_draw *draw, size_t n);
double blind_between(struct blind_draw *draw, double low, double high);
double blind_normal(struct blind_draw *draw);

/// +1 or -1.
double blind_sign(struct blind_draw *draw);

/// Fisher-Yates over n indices.
void blind_shuffle(struct blind_draw *draw, size_t n, size_t index[]);

#endif // DIG_TESTS_BLIND_DRAW_H
