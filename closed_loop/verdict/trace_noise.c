// Estimates noise of sensors that is correlated over a bin of a dig, as of a filtered load cell or
// an arm that trembles. Rows do not show it, as grains move as slowly. But it is as large where a
// dig hardly resists, it is rough along the dig, and no two digs have the same: neither scatter of
// beds nor any effect is like that. So the likelihood of the digs shows it.

#include "closed_loop/search/search_work.h"
#include "closed_loop/verdict/trace_work.h"

#include <math.h>
#include <string.h>

// Sizes of noise that are asked about, over the mean dig's, each .6 of the one before, and how long
// it may last.
static const double shares[]   = { 0.25, 0.15, 0.09, 0.054, 0.0324, 0.0194, 0.0117 };
static const double memory_s[] = { 0.03, 0.1, 0.3 };

static const struct dig_hypothesis none = { .effects = 0 };

static enum dig_status set_noise(const struct dig_trace_work *const w, const double place[DIG_AXES],
                                 const struct dig_lasting *const noise)
{
    for (size_t i = 0; i < w->digs; i++) {
        w->measured[i].lasting = *noise;
    }
    return dig_trace_whiten(w, place);
}

// Misfit by which an effect must lead the plain gravel to have a say.
static const double told_apart = 2.0 * DIG_SEARCH_TOLD_APART;

// The misfit, with that noise, of what explains the digs best: a plain gravel, or one effect, or
// what has no name, where that is told apart from it. Noise must not take from an effect what is
// its own. start: where to fit from, then the plain fit.
static enum dig_status least_misfit(const struct dig_trace_work *const w,
                                    const double                       place[DIG_AXES],
                                    const struct dig_lasting *const    noise,
                                    double start[DIG_HYPOTHESIS_NUMBERS], double *const misfit)
{
    struct dig_hypothesis single[DIG_RIVALS_MAX];
    struct dig_fitted     fitted[DIG_RIVALS_MAX + 1];
    struct dig_fitted     nameless;
    struct dig_statistic  statistic;
    const enum dig_status status = set_noise(w, place, noise);
    if (status != DIG_OK) {
        return status;
    }
    const size_t rivals = dig_search_rivals(w->batch, single);
    dig_null_simulation_fit(w->batch, &none, rivals, single, start, DIG_FIT_BARE, fitted,
                            &statistic);
    dig_hypothesis_fit_unlisted(w->batch, &fitted[0], &nameless);
    memcpy(start, fitted[0].number, sizeof fitted[0].number);
    const double gain = fmax(statistic.gain, fitted[0].misfit - nameless.misfit);
    *misfit           = dig_trace_misfit(w, &fitted[0]) - fmax(gain - told_apart, 0.0);
    return status;
}

// Noise of a share of the mean dig's size, over the trajectories.
static struct dig_lasting noise_of(const struct dig_whitened_digs *const batch, const double share,
                                   const double lasts_s)
{
    struct dig_lasting noise = { .memory_s = lasts_s };
    for (size_t g = 0; g < batch->groups; g++) {
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            noise.sigma[c] += share * batch->group[g].amplitude[c] / (double)batch->groups;
        }
    }
    return noise;
}

enum dig_status dig_trace_tell_noise(const struct dig_trace_work *const w,
                                     struct dig_fitted *const           plain)
{
    const struct dig_whitened_digs without                       = *w->batch;
    double                         start[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    struct dig_lasting             told                          = { .memory_s = 0.0 };
    double                         best                          = 0.0;
    double                         place[DIG_HYPOTHESIS_NUMBERS];
    memcpy(start, plain->number, DIG_AXES * sizeof start[0]);
    memcpy(place, start, sizeof place);
    enum dig_status status = least_misfit(w, plain->number, &told, start, &best);
    best -=
        2.0 * dig_search_penalty(&without, 1); // noise's size; its memory hardly tells by itself
    for (size_t m = 0; m < sizeof memory_s / sizeof memory_s[0]; m++) {
        for (size_t i = 0; i < sizeof shares / sizeof shares[0] && status == DIG_OK; i++) {
            const struct dig_lasting noise = noise_of(&without, shares[i], memory_s[m]);
            double                   misfit;
            status = least_misfit(w, plain->number, &noise, start, &misfit);
            if (status == DIG_OK && misfit < best) {
                best = misfit;
                told = noise;
                memcpy(place, start, sizeof place);
            }
        }
    }
    if (status == DIG_OK) {
        status = set_noise(w, place, &told);
    }
    if (status == DIG_OK && told.memory_s > 0.0) {
        dig_trace_fit_plain(w, plain);
    } else if (status == DIG_OK) {
        *w->batch = without;
    }
    return status;
}
