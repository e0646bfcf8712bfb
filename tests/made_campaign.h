// Campaigns of the tests' own: digs of the made table's gravels, with effects of known shape in
// them and scatter of known covariance, so that every answer of the closed loop can be checked.

#ifndef DIG_TESTS_MADE_CAMPAIGN_H
#define DIG_TESTS_MADE_CAMPAIGN_H

#include "closed_loop/model/scatter.h"
#include "closed_loop/recordings/measured.h"
#include "core/entry_set.h"
#include "tests/made_table.h"

#define MADE_SCATTER 0.12 // of one dig, relative to the rms of its channel, at every point

/// The made table, its curves means of five scattering digs, and beds with cohesion, layering,
/// ground slope and adhesion at three gravels, three magnitudes, of three digs each.
struct made_world {
    struct dig_curve_set        *set;
    struct dig_entry_set        *effects;
    struct dig_response_surface *surface;
    struct dig_scatter          *scatter;
};

/// Owned by the caller; free with made_world_finish().
struct made_world made_world(uint64_t seed);
void              made_world_finish(struct made_world *world);

/// What an effect of the list above, or DIG_EFFECT_UNLISTED (a dip that none of them has), adds at
/// magnitude 1, relative to the rms of the channel, at one progress.
double made_effect(enum dig_effect_id effect, enum made_trajectory which, enum dig_channel channel,
                   double progress);

/// One dig of a gravel with effects at magnitudes, scattering.
struct dig_measured made_dig(const struct dig_gravel *gravel, enum made_trajectory which,
                             size_t effects, const enum dig_effect_id effect[],
                             const double magnitude[], uint64_t *seed);

#endif // DIG_TESTS_MADE_CAMPAIGN_H
