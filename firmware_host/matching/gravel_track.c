#include "firmware_host/matching/gravel_track.h"

#include "core/units.h"
#include "estimator/approach/approach_slots.h"
#include "estimator/match/match.h"
#include "estimator/match/rubbed.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// A dig that fills the bucket by less than this share of the best one is not recommended.
static const double least_filling = 0.5;

struct dig_gravel_track
dig_gravel_track_make(const struct dig_curve_set *const set, const struct dig_match *const match,
                      const struct dig_observation *const dig, const int64_t now_ns,
                      const struct dig_gravel_track_settings *const settings)
{
    assert(set != NULL && match != NULL && dig != NULL && settings != NULL && match->nearest >= 0);
    struct dig_gravel_track track = {
        .any        = true,
        .valid      = match->valid,
        .match      = *match,
        .nearest    = set->gravel[match->nearest],
        .time_ns    = now_ns,
        .expires_ns = now_ns + dig_ns(settings->expires_s),
        .drift      = (double)NAN,

        .path_measured = dig->last - dig->first,
        .ending        = dig->ending,
        .made          = dig->made,
        .matched       = dig->approach,
    };
    if (match->weighted >= 0) {
        track.weighted = set->gravel[match->weighted];
    }
    (void)snprintf(track.trajectory, sizeof track.trajectory, "%s",
                   set->trajectory[dig->trajectory].name);
    (void)snprintf(track.table, sizeof track.table, "%s", set->scene_hash);
    return track;
}

void dig_gravel_track_invalidate(struct dig_gravel_track *const track, const char *const why)
{
    assert(track != NULL && why != NULL);
    track->valid       = false;
    track->going_on    = false;
    track->match.valid = false;
    (void)snprintf(track->wanted, sizeof track->wanted, "%s: dig a simple dig", why);
}

// Distance of a dig from a curve over the points measured, in noise floors.
static double floors_between(const struct dig_observation *const dig,
                             const struct dig_curve *const       curve)
{
    struct dig_rubbed rubbed = { .b = { 0.0 } };
    double            rubs_Nm[DIG_RUBS];
    double            miss2  = 0.0;
    double            floor2 = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = (double)k / (DIG_CURVE_POINTS - 1);
        if (at < dig->first || at > dig->last) {
            continue;
        }
        const double mean = (double)curve->mean[DIG_CHANNEL_MY_Nm][k];
        const double sd   = (double)curve->sd[DIG_CHANNEL_MY_Nm][k];
        miss2 += (dig->moment_Nm[k] - mean) * (dig->moment_Nm[k] - mean);
        floor2 += sd * sd + dig->sigma_Nm[k] * dig->sigma_Nm[k];
        for (size_t j = 0; j < DIG_RUBS; j++) {
            rubs_Nm[j] = (double)dig->rubs[j][DIG_CHANNEL_MY_Nm][k];
            floor2 -= rubs_Nm[j] * rubs_Nm[j]; // no noise, but one number for all points
        }
        dig_rubbed_add(dig->moment_Nm[k] - mean, rubs_Nm, &rubbed);
    }
    return sqrt(dig_rubbed_left2(&rubbed, miss2, floor2) / floor2);
}

// Compares a dig with its forecast. False where either is missing.
static bool update_drift(struct dig_gravel_track *const                track,
                         const struct dig_observation *const           dig,
                         const struct dig_expected *const              expected,
                         const struct dig_gravel_track_settings *const settings)
{
    if (!track->valid || !expected->valid) {
        return false;
    }
    const double floors = floors_between(dig, &expected->curve);
    if (!isfinite(floors)) {
        return false;
    }
    track->drift    = floors;
    track->differed = floors > settings->drift_floors ? track->differed + 1 : 0;
    if (track->differed == 0) {
        track->wanted[0] = '\0';
    }
    return true;
}

enum dig_gating dig_gravel_track_gate(struct dig_gravel_track *const                track,
                                      const struct dig_observation *const           dig,
                                      const struct dig_expected *const              expected,
                                      const struct dig_gravel_track_settings *const settings)
{
    assert(track != NULL && dig != NULL && expected != NULL && settings != NULL);
    if (!update_drift(track, dig, expected, settings)) {
        return DIG_REJECTED;
    }
    if (track->differed == 0) {
        return DIG_ACCEPTED;
    }
    if (track->differed >= DIG_TRACK_DRIFT_DIGS || track->match.digs < 2 ||
        track->drift > DIG_TRACK_DRIFT_FAR * settings->drift_floors) {
        return DIG_REJECTED;
    }
    (void)snprintf(track->wanted, sizeof track->wanted,
                   "a simple dig differed from those before: dig another");
    return DIG_HELD;
}

bool dig_gravel_track_compare(struct dig_gravel_track *const                track,
                              const struct dig_observation *const           dig,
                              const struct dig_expected *const              expected,
                              const struct dig_gravel_track_settings *const settings)
{
    assert(track != NULL && dig != NULL && expected != NULL && settings != NULL);
    if (!update_drift(track, dig, expected, settings)) {
        return false;
    }
    if (track->differed >= DIG_TRACK_DRIFT_DIGS) {
        dig_gravel_track_invalidate(track, "the ground has changed");
    }
    return true;
}

bool dig_gravel_track_expire(struct dig_gravel_track *const track, const int64_t now_ns)
{
    assert(track != NULL);
    if (!track->valid || now_ns < track->expires_ns) {
        return false;
    }
    dig_gravel_track_invalidate(track, "the gravel known is too old");
    return true;
}

// The entry nearest to a gravel, each axis over its span in the table.
static int nearest_entry(const struct dig_curve_set *const set, const struct dig_gravel *const g)
{
    int    nearest = -1;
    double least   = INFINITY;
    for (size_t e = 0; e < set->entries; e++) {
        double distance2 = 0.0;
        for (int a = 0; a < DIG_AXES; a++) {
            const double from = set->axis[a][0];
            const double span = set->axis[a][set->axis_count[a] - 1] - from;
            const double off  = set->gravel[e].value[a] - g->value[a];
            distance2 += span > 0.0 ? off * off / (span * span) : 0.0;
        }
        if (distance2 < least) {
            least   = distance2;
            nearest = (int)e;
        }
    }
    return nearest;
}

// Whether a gravel lies within the table's axes. Text files round it: 1e-6 of it is margin.
static bool holds(const struct dig_curve_set *const set, const struct dig_gravel *const g)
{
    for (int a = 0; a < DIG_AXES; a++) {
        const double margin = 1e-6 * g->value[a];
        if (!(g->value[a] >= set->axis[a][0] - margin &&
              g->value[a] <= set->axis[a][set->axis_count[a] - 1] + margin)) {
            return false;
        }
    }
    return set->entries > 0;
}

bool dig_gravel_track_set_table(struct dig_gravel_track *const    track,
                                const struct dig_curve_set *const set)
{
    assert(track != NULL && set != NULL);
    if (!track->any || strcmp(track->table, set->scene_hash) != 0 ||
        !holds(set, &track->match.gravel)) {
        return false;
    }
    track->match.nearest = nearest_entry(set, &track->match.gravel);
    track->nearest       = set->gravel[track->match.nearest];
    if (track->match.weighted >= 0) {
        track->match.weighted = nearest_entry(set, &track->weighted);
        track->weighted       = set->gravel[track->match.weighted];
    }
    dig_match_find_family(set, &track->match);
    return true;
}

int dig_gravel_track_hint(const struct dig_curve_set *const set,
                          const struct dig_forecast *const forecast, const double lambda,
                          double *const J_per_kg)
{
    assert(set != NULL && forecast != NULL && J_per_kg != NULL);
    double carried_kg[DIG_TRAJECTORY_MAX] = { 0 };
    double most_kg                        = 0.0;
    for (size_t t = 0; t < set->trajectories; t++) {
        const struct dig_expected *const expected = &forecast->expected[t];
        const double                     kg =
            pow(lambda, 3.0) *
            (double)expected->curve.mean[DIG_CHANNEL_CARRIED_kg][DIG_CURVE_POINTS - 1];
        carried_kg[t] = expected->valid && kg > 0.0 ? kg : 0.0; // NaN: not known
        most_kg       = fmax(most_kg, carried_kg[t]);
    }
    int    best  = -1;
    double least = INFINITY;
    for (size_t t = 0; t < set->trajectories; t++) {
        const double each = forecast->expected[t].energy_J / carried_kg[t];
        if (carried_kg[t] > 0.0 && carried_kg[t] >= least_filling * most_kg && each < least) {
            best  = (int)t;
            least = each;
        }
    }
    if (best >= 0) {
        *J_per_kg = least;
    }
    return best;
}
