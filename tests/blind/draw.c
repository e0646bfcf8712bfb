#include "tests/blind/draw.h"

#include <assert.h>
#include <math.h>

// xorshift64* (Vigna, 2016).
static uint64_t next(struct blind_draw *const draw)
{
    uint64_t x = draw->state;
    x ^= x >> 12U;
    x ^= x << 25U;
    x ^= x >> 27U;
    draw->state = x;
    return x * UINT64_C(0x2545F4914F6CDD1D);
}

struct blind_draw blind_draw_init(const uint64_t seed, const uint64_t stream)
{
    struct blind_draw draw = { (seed + 1) * UINT64_C(0xD1342543DE82EF95) ^
                               (stream + 1) * UINT64_C(0xAF251AF3B0F025B5) };
    draw.state             = draw.state == 0 ? 1 : draw.state;
    for (int i = 0; i < 16; i++) {
        (void)next(&draw);
    }
    return draw;
}

double blind_uniform(struct blind_draw *const draw)
{
    return (double)(next(draw) >> 11U) / 9007199254740992.0;
}

size_t blind_below(struct blind_draw *const draw, const size_t n)
{
    assert(n > 0);
    return (size_t)(blind_uniform(draw) * (double)n);
}

double blind_between(struct blind_draw *const draw, const double low, const double high)
{
    return low + (high - low) * blind_uniform(draw);
}

// The polar method (Marsaglia), one of the pair.
double blind_normal(struct blind_draw *const draw)
{
    for (;;) {
        const double u = 2.0 * blind_uniform(draw) - 1.0;
        const double v = 2.0 * blind_uniform(draw) - 1.0;
        const double s = u * u + v * v;
        if (s > 0.0 && s < 1.0) {
            return u * sqrt(-2.0 * log(s) / s);
        }
    }
}

double blind_sign(struct blind_draw *const draw)
{
    return blind_uniform(draw) < 0.5 ? -1.0 : 1.0;
}

void blind_shuffle(struct blind_draw *const draw, const size_t n, size_t index[])
{
    for (size_t i = n; i > 1; i--) {
        const size_t j = blind_below(draw, i);
        const size_t t = index[i - 1];
        index[i - 1]   = index[j];
        index[j]       = t;
    }
}
