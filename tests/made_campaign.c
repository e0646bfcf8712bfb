#include "tests/made_campaign.h"

#include "core/units.h"
#include "tests/model_front.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PACKINGS = 5, BASES = 3, MAGNITUDES = 3, BED_PACKINGS = 3, SPREADS = 60 };

static const double channel_size[DIG_FORCE_CHANNELS] = { 1.0, -8.0, 5.0 };

static const enum dig_effect_id known[] = { DIG_EFFECT_COHESION, DIG_EFFECT_ADHESION,
                                            DIG_EFFECT_GROUND_SLOPE, DIG_EFFECT_LAYERING };

double made_effect(const enum dig_effect_id effect, const enum made_trajectory which,
                   const enum dig_channel channel, const double progress)
{
    const double sign = channel == DIG_CHANNEL_FX_N ? -1.0 : 1.0;
    const double half = which == MADE_ACTUAL ? 0.6 : 1.0;
    switch ((int)effect) {
    case DIG_EFFECT_COHESION: return sign * 0.9 * sin(2.0 * DIG_PI * progress);
    case DIG_EFFECT_ADHESION:
        return channel == DIG_CHANNEL_FZ_N ? -fmax(progress - 0.7, 0.0) * 4.0 : 0.0;
    case DIG_EFFECT_GROUND_SLOPE:
        return channel == DIG_CHANNEL_FZ_N ? half * cos(DIG_PI * progress) : 0.2 * sign * half;
    case DIG_EFFECT_LAYERING: return half * sign * exp(-pow((progress - 0.35) / 0.1, 2.0));
    case DIG_EFFECT_UNLISTED: return -sign * exp(-pow((progress - 0.55) / 0.08, 2.0));
    default: return 0.0;
    }
}

// Smooth random numbers of sd 1 along the progress.
static void scatter(uint64_t *const seed, double out[DIG_CURVE_POINTS])
{
    enum { KNOTS = 12, WIDTH = DIG_CURVE_POINTS / (KNOTS - 3) };
    double knot[KNOTS];
    for (size_t i = 0; i < KNOTS; i++) {
        knot[i] = model_normal(seed);
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const size_t i = k / WIDTH;
        const double f = (double)(k % WIDTH) / WIDTH;
        const double a = cos(0.5 * DIG_PI * f);
        const double b = sin(0.5 * DIG_PI * f);
        out[k]         = a * knot[i] + b * knot[i + 1];
    }
}

static double size_of(const struct dig_gravel *const gravel, const enum made_trajectory which)
{
    double sum = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        sum += pow(made_moment_Nm(gravel, which, (double)k / (DIG_CURVE_POINTS - 1), 0.0), 2.0);
    }
    return sqrt(sum / DIG_CURVE_POINTS);
}

struct dig_measured made_dig(const struct dig_gravel *const gravel,
                             const enum made_trajectory which, const size_t effects,
                             const enum dig_effect_id effect[], const double magnitude[],
                             uint64_t *const seed)
{
    struct dig_measured m = {
        .trajectory = (int)which, .use = DIG_USE_FIT, .pass = 1, .pace = 1.0, .last = 1.0
    };
    const double size = size_of(gravel, which);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        double off[DIG_CURVE_POINTS];
        scatter(seed, off);
        m.measured[c] = true;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double progress = (double)k / (DIG_CURVE_POINTS - 1);
            double       relative = MADE_SCATTER * off[k];
            for (size_t e = 0; e < effects; e++) {
                relative +=
                    magnitude[e] * made_effect(effect[e], which, (enum dig_channel)c, progress);
            }
            m.value[c][k] = channel_size[c] * made_moment_Nm(gravel, which, progress, 0.0) +
                            fabs(channel_size[c]) * size * relative;
        }
    }
    return m;
}

static void mean_curve(const struct dig_gravel *const gravel, const enum made_trajectory which,
                       const size_t effects, const enum dig_effect_id effect,
                       const double magnitude, const int packings, uint64_t *const seed,
                       struct dig_curve *const curve)
{
    const double size = size_of(gravel, which);
    memset(curve, 0, sizeof *curve);
    for (int p = 0; p < packings; p++) {
        const struct dig_measured m = made_dig(gravel, which, effects, &effect, &magnitude, seed);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                curve->mean[c][k] += (float)(m.value[c][k] / packings);
                curve->sd[c][k] = (float)(MADE_SCATTER * fabs(channel_size[c]) * size);
            }
        }
    }
}

static struct dig_entry_set *make_effects(const struct dig_curve_set *const set,
                                          uint64_t *const                   seed)
{
    static const struct dig_gravel bases[BASES] = { { { 0.3, 0.1, 2500 } },
                                                    { { 0.5, 0.4, 2500 } },
                                                    { { 0.9, 1.0, 2500 } } };
    struct dig_entry_set *const    effects      = calloc(1, sizeof *effects);
    memcpy(effects->scene_hash, set->scene_hash, sizeof effects->scene_hash);
    effects->trajectories = set->trajectories;
    effects->entries      = sizeof known / sizeof known[0] * BASES * MAGNITUDES;
    effects->entry        = calloc(effects->entries, sizeof *effects->entry);
    effects->packings     = calloc(effects->entries * set->trajectories, sizeof(int));
    effects->curve        = calloc(effects->entries * set->trajectories, sizeof *effects->curve);
    size_t e              = 0;
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        for (size_t b = 0; b < BASES; b++) {
            for (size_t m = 1; m <= MAGNITUDES; m++, e++) {
                const double u = (double)m / MAGNITUDES;
                effects->entry[e] =
                    (struct dig_entry){ .effect = known[i], .magnitude = u, .gravel = bases[b] };
                for (size_t t = 0; t < set->trajectories; t++) {
                    const size_t slot       = e * set->trajectories + t;
                    effects->packings[slot] = BED_PACKINGS;
                    mean_curve(&bases[b], (enum made_trajectory)t, 1, known[i], u, BED_PACKINGS,
                               seed, &effects->curve[slot]);
                }
            }
        }
    }
    return effects;
}

// As many packings of a few gravels as a table of some size has, about their own means.
static struct dig_scatter *make_scatter(const struct dig_response_surface *const surface,
                                        uint64_t *const                          seed)
{
    const size_t                 n = (size_t)SPREADS * PACKINGS * MADE_TRAJECTORIES;
    struct dig_scatter_residual *r = calloc(n, sizeof *r);
    size_t                       i = 0;
    for (size_t e = 0; e < SPREADS; e++) {
        const struct dig_gravel *const gravel = &surface->set->gravel[e % surface->set->entries];
        for (int t = 0; t < MADE_TRAJECTORIES; t++) {
            double mean[DIG_FEATURES] = { 0.0 };
            double size[DIG_FORCE_CHANNELS];
            for (size_t p = 0; p < PACKINGS; p++) {
                const struct dig_measured m =
                    made_dig(gravel, (enum made_trajectory)t, 0, NULL, NULL, seed);
                dig_features_of((const double(*)[DIG_CURVE_POINTS])m.value, r[i + p].value);
                for (size_t f = 0; f < DIG_FEATURES; f++) {
                    mean[f] += r[i + p].value[f] / PACKINGS;
                }
            }
            dig_features_amplitude(mean, NULL, size);
            for (size_t p = 0; p < PACKINGS; p++, i++) {
                r[i].trajectory = (size_t)t;
                r[i].entry      = e;
                r[i].packings   = PACKINGS;
                r[i].strength   = log(size[0] / gravel->value[DIG_AXIS_DENSITY_kgpm3]);
                dig_response_surface_place(surface, gravel, r[i].place);
                for (size_t f = 0; f < DIG_FEATURES; f++) {
                    r[i].value[f] = (r[i].value[f] - mean[f]) / size[f / DIG_FEATURE_BINS];
                }
            }
        }
    }
    struct dig_scatter *made = NULL;
    if (dig_scatter_pool(surface, n, r, &made) != DIG_OK) {
        abort();
    }
    free(r);
    return made;
}

struct made_world made_world(const uint64_t seed)
{
    uint64_t                  state   = seed;
    const struct made_options options = { .relative_sd = MADE_SCATTER, .packings = PACKINGS };
    struct made_world         world   = { .set = made_table(&options) };
    for (size_t e = 0; e < world.set->entries; e++) {
        for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
            mean_curve(&world.set->gravel[e], (enum made_trajectory)t, 0, DIG_EFFECT_UNLISTED, 0.0,
                       PACKINGS, &state, &world.set->curve[e * MADE_TRAJECTORIES + t]);
        }
    }
    world.effects = make_effects(world.set, &state);
    world.surface = calloc(1, sizeof *world.surface);
    if (dig_response_surface_fit(world.set, world.surface) != DIG_OK) {
        abort();
    }
    world.scatter = make_scatter(world.surface, &state);
    return world;
}

void made_world_finish(struct made_world *const world)
{
    dig_scatter_destroy(world->scatter);
    free(world->surface);
    free(world->effects->entry);
    free(world->effects->packings);
    free(world->effects->curve);
    free(world->effects);
    made_table_destroy(world->set);
}
