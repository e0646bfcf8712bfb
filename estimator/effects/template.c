#include "estimator/effects/template.h"

#include "estimator/approach/interpolate.h"
#include "estimator/effects/effect.h"

#include <assert.h>
#include <math.h>

enum { BASES_MAX = 16, KNOTS_MAX = 16 };

// The curves of one effect at one base gravel along one trajectory.
struct base {
    struct dig_gravel       gravel;
    struct dig_cell         plain;
    double                  strength;
    size_t                  knots;
    double                  magnitude[KNOTS_MAX]; // ascending, absent among them
    const struct dig_curve *curve[KNOTS_MAX];     // NULL where absent
    int                     packings[KNOTS_MAX];
};

// The two knots around a magnitude and their weights.
struct between {
    size_t knot[2];
    double weight[2];
};

double dig_template_absent(const enum dig_effect_id effect)
{
    return effect == DIG_EFFECT_UNLISTED ? 0.0 : dig_effect_of(effect)->parameter[0].absent;
}

// Widens the magnitudes from least to most, absent among them, by what may be extrapolated.
static void widen(const enum dig_effect_id effect, double *const least, double *const most)
{
    const double absent = dig_template_absent(effect);
    const double above  = *most - absent;
    const double below  = absent - *least;
    *most += DIG_TEMPLATE_BEYOND * above;
    *least -= DIG_TEMPLATE_BEYOND * below;
    if (dig_effect_of(effect)->mirrored) {
        *most += above > 0.0 ? 0.0 : DIG_TEMPLATE_BEYOND * below;
        *least -= below > 0.0 ? 0.0 : DIG_TEMPLATE_BEYOND * above;
    }
}

static bool is_computed(const struct dig_entry_set *const effects, const size_t entry,
                        const enum dig_effect_id effect, const size_t trajectory)
{
    return effects->entry[entry].effect == effect &&
           effects->packings[entry * effects->trajectories + trajectory] > 0;
}

bool dig_template_range(const struct dig_entry_set *const effects, const enum dig_effect_id effect,
                        const size_t trajectory, double *const low, double *const high)
{
    assert(low != NULL && high != NULL);
    double least = dig_template_absent(effect);
    double most  = least;
    bool   any   = false;
    for (size_t e = 0; effects != NULL && e < effects->entries; e++) {
        if (trajectory < effects->trajectories && is_computed(effects, e, effect, trajectory)) {
            least = fmin(least, effects->entry[e].magnitude);
            most  = fmax(most, effects->entry[e].magnitude);
            any   = true;
        }
    }
    if (any) {
        widen(effect, &least, &most);
        *low  = least;
        *high = most;
    }
    return any;
}

static double rms(const struct dig_cell *const cell, const enum dig_channel channel)
{
    double sum = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double mean = dig_cell_mean(cell, channel, k);
        sum += mean * mean;
    }
    return sqrt(sum / DIG_CURVE_POINTS);
}

static double strength(const struct dig_cell *const cell, const struct dig_gravel *const gravel)
{
    return log(rms(cell, DIG_CHANNEL_MY_Nm) / gravel->value[DIG_AXIS_DENSITY_kgpm3]);
}

// Inserts a knot in order of magnitude.
static void insert_knot(struct base *const base, const double magnitude,
                        const struct dig_curve *const curve, const int packings)
{
    if (base->knots == KNOTS_MAX) {
        return;
    }
    size_t k = base->knots++;
    for (; k > 0 && base->magnitude[k - 1] > magnitude; k--) {
        base->magnitude[k] = base->magnitude[k - 1];
        base->curve[k]     = base->curve[k - 1];
        base->packings[k]  = base->packings[k - 1];
    }
    base->magnitude[k] = magnitude;
    base->curve[k]     = curve;
    base->packings[k]  = packings;
}

static struct base *base_of(struct base base[], size_t *const bases,
                            const struct dig_gravel *const gravel, const enum dig_effect_id effect)
{
    for (size_t b = 0; b < *bases; b++) {
        if (dig_gravel_is_same(&base[b].gravel, gravel)) {
            return &base[b];
        }
    }
    if (*bases == BASES_MAX) {
        return NULL;
    }
    struct base *const made = &base[(*bases)++];
    *made                   = (struct base){ .gravel = *gravel };
    insert_knot(made, dig_template_absent(effect), NULL, 0);
    return made;
}

static enum dig_status gather(const struct dig_curve_set *const plain,
                              const struct dig_entry_set *const effects,
                              const enum dig_effect_id effect, const size_t trajectory,
                              struct base base[], size_t *const bases)
{
    *bases = 0;
    for (size_t e = 0; e < effects->entries; e++) {
        if (!is_computed(effects, e, effect, trajectory)) {
            continue;
        }
        struct base *const at = base_of(base, bases, &effects->entry[e].gravel, effect);
        const size_t       s  = e * effects->trajectories + trajectory;
        if (at != NULL) {
            insert_knot(at, effects->entry[e].magnitude, &effects->curve[s], effects->packings[s]);
        }
    }
    for (size_t b = 0; b < *bases; b++) {
        const enum dig_status status =
            dig_cell_find(plain, &base[b].gravel, trajectory, &base[b].plain);
        if (status != DIG_OK) {
            return status;
        }
        base[b].strength = strength(&base[b].plain, &base[b].gravel);
    }
    return *bases > 0 ? DIG_OK : DIG_ENOMATCH;
}

// The bases next to a strength, weaker and stronger, and their weights.
static void choose(const struct base base[], const size_t bases, const double at,
                   struct between *const chosen)
{
    size_t weaker   = 0;
    size_t stronger = 0;
    bool   below    = false;
    bool   above    = false;
    for (size_t b = 0; b < bases; b++) {
        if (base[b].strength <= at && (!below || base[b].strength > base[weaker].strength)) {
            weaker = b;
            below  = true;
        }
        if (base[b].strength > at && (!above || base[b].strength < base[stronger].strength)) {
            stronger = b;
            above    = true;
        }
    }
    weaker            = below ? weaker : stronger;
    stronger          = above ? stronger : weaker;
    const double span = base[stronger].strength - base[weaker].strength;
    const double f    = span > 0.0 ? (at - base[weaker].strength) / span : 0.0;
    *chosen           = (struct between){ { weaker, stronger }, { 1.0 - f, f } };
}

// The knots around a magnitude; beyond the last, the last two extrapolate.
static struct between locate(const struct base *const base, const double magnitude)
{
    size_t i = 0;
    while (i + 2 < base->knots && base->magnitude[i + 1] <= magnitude) {
        i++;
    }
    const double span = base->magnitude[i + 1] - base->magnitude[i];
    const double f    = (magnitude - base->magnitude[i]) / span;
    return (struct between){ { i, i + 1 }, { 1.0 - f, f } };
}

// Adds factor times the base's share at a magnitude to the mean, and its variance.
static void add_share(const struct base *const base, const struct between *const at,
                      const enum dig_channel channel, const double factor,
                      double delta[DIG_CURVE_POINTS], double variance[DIG_CURVE_POINTS])
{
    const double scale = factor / rms(&base->plain, channel);
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double mean     = dig_cell_mean(&base->plain, channel, k);
        const double sd       = dig_cell_sd(&base->plain, channel, k);
        double       sum      = 0.0;
        double       spread   = 0.0;
        double       of_plain = 0.0;
        for (int i = 0; i < 2; i++) {
            const size_t                  knot  = at->knot[i];
            const struct dig_curve *const curve = base->curve[knot];
            if (curve == NULL) {
                continue;
            }
            const double w       = at->weight[i];
            const double with_sd = (double)curve->sd[channel][k];
            sum += w * ((double)curve->mean[channel][k] - mean);
            spread += w * w * with_sd * with_sd / (double)base->packings[knot];
            of_plain += w;
        }
        spread += of_plain * of_plain * sd * sd * base->plain.inverse_packings;
        delta[k] += scale * sum;
        variance[k] += scale * scale * spread;
    }
}

double dig_template_scale(const struct dig_curve_set *const plain, const enum dig_effect_id effect,
                          const double base_kgpm3, const double density_kgpm3)
{
    assert(plain != NULL);
    const struct dig_effect *const known = dig_effect_of(effect);
    return known != NULL && known->over_stiffness
               ? pow(base_kgpm3 / density_kgpm3, plain->stiffness_power)
               : 1.0;
}

// The magnitude that acts on a base as `magnitude` acts on the gravel, within the base's range.
static double magnitude_at(const struct dig_curve_set *const plain, const struct base *const base,
                           const enum dig_effect_id effect, const double magnitude,
                           const struct dig_gravel *const gravel)
{
    const double scaled =
        magnitude * dig_template_scale(plain, effect, base->gravel.value[DIG_AXIS_DENSITY_kgpm3],
                                       gravel->value[DIG_AXIS_DENSITY_kgpm3]);
    double least = base->magnitude[0];
    double most  = base->magnitude[base->knots - 1];
    widen(effect, &least, &most);
    return fmin(fmax(scaled, least), most);
}

enum dig_status dig_template_find(const struct dig_curve_set *const plain,
                                  const struct dig_entry_set *const effects,
                                  const enum dig_effect_id effect, const double magnitude,
                                  const struct dig_gravel *const gravel, const size_t trajectory,
                                  struct dig_template *const found)
{
    assert(plain != NULL && gravel != NULL && found != NULL);
    double          low;
    double          high;
    struct dig_cell cell;
    if (trajectory >= plain->trajectories ||
        !dig_template_range(effects, effect, trajectory, &low, &high) ||
        !(magnitude >= low && magnitude <= high) ||
        dig_cell_find(plain, gravel, trajectory, &cell) != DIG_OK) {
        return DIG_ENOMATCH;
    }
    struct base base[BASES_MAX];
    size_t      bases;
    if (gather(plain, effects, effect, trajectory, base, &bases) != DIG_OK) {
        return DIG_ENOMATCH;
    }

    struct between chosen;
    choose(base, bases, strength(&cell, gravel), &chosen);
    struct dig_template sum = { .delta = { { 0.0 } } };
    for (int i = 0; i < 2; i++) {
        if (!(chosen.weight[i] > 0.0)) {
            continue;
        }
        const struct base *const at = &base[chosen.knot[i]];
        const struct between knots = locate(at, magnitude_at(plain, at, effect, magnitude, gravel));
        for (int c = 0; c < DIG_CHANNELS; c++) {
            add_share(at, &knots, (enum dig_channel)c,
                      chosen.weight[i] * rms(&cell, (enum dig_channel)c), sum.delta[c],
                      sum.sigma[c]);
        }
    }
    for (int c = 0; c < DIG_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            sum.sigma[c][k] = sqrt(sum.sigma[c][k]);
        }
    }
    *found = sum;
    return DIG_OK;
}
