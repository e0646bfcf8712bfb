#include "firmware_host/publish/output.h"

#include <assert.h>
#include <math.h>

static const double first_us   = 16.0;
static const double per_octave = 4.0;

double dig_latency_to_us(const int bin)
{
    return bin < DIG_LATENCY_BINS - 1 ? first_us * exp2(bin / per_octave) : (double)INFINITY;
}

void dig_latency_add(struct dig_latency *const latency, const int64_t took_ns)
{
    assert(latency != NULL);
    const double octaves = log2(fmax((double)took_ns * 1e-3, 1.0) / first_us);
    const double bin     = fmin(fmax(ceil(octaves * per_octave), 0.0), DIG_LATENCY_BINS - 1);
    latency->count[(int)bin]++;
    latency->samples++;
}

double dig_latency_quantile_us(const struct dig_latency *const latency, const double share)
{
    assert(latency != NULL);
    int64_t below = 0;
    for (int i = 0; i < DIG_LATENCY_BINS && latency->samples > 0; i++) {
        below += latency->count[i];
        if ((double)below >= share * (double)latency->samples) {
            return dig_latency_to_us(i);
        }
    }
    return 0.0;
}
