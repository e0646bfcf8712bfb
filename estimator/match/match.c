#include "estimator/match/match.h"

#include "core/text.h"
#include "estimator/approach/interpolate.h"
#include "estimator/match/nearest.h"
#include "estimator/match/pool.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

void dig_match_find_family(const struct dig_curve_set *const set, struct dig_match *const match)
{
    assert(set != NULL && match != NULL);
    for (int a = 0; a < DIG_AXES; a++) {
        const enum dig_axis axis  = (enum dig_axis)a;
        const double        width = dig_axis_position(set, axis, match->high.value[a]) -
                             dig_axis_position(set, axis, match->low.value[a]);
        match->untold[a] = match->samples > 0 && width > DIG_MATCH_TOLD;
    }
}

bool dig_match_is_family(const struct dig_match *const match)
{
    assert(match != NULL);
    return match->untold[0] || match->untold[1] || match->untold[2];
}

void dig_match_unresolved(const struct dig_match *const match, char text[const DIG_UNTOLD_SIZE])
{
    assert(match != NULL && text != NULL);
    text[0] = '\0';
    for (int a = 0; a < DIG_AXES; a++) {
        if (match->untold[a]) {
            dig_text_list(DIG_UNTOLD_SIZE, text, dig_axis_name((enum dig_axis)a));
        }
    }
}

static bool is_measured(const struct dig_observation *const o, const size_t point)
{
    const double at = (double)point / (DIG_CURVE_POINTS - 1);
    return at >= o->first && at <= o->last;
}

static bool is_sound(const struct dig_curve_set *const   set,
                     const struct dig_observation *const observation)
{
    if (observation->trajectory < 0 || (size_t)observation->trajectory >= set->trajectories ||
        !(observation->first >= 0.0 && observation->last <= 1.0)) {
        return false;
    }
    double sum = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        if (!isfinite(observation->moment_Nm[k]) ||
            !(observation->sigma_Nm[k] >= 0.0 && isfinite(observation->sigma_Nm[k]))) {
            return false;
        }
        for (size_t c = 0; observation->forces && c + 1 < DIG_FORCE_CHANNELS; c++) {
            if (!isfinite(observation->force_N[c][k]) ||
                !(observation->force_sigma_N[c][k] >= 0.0 &&
                  isfinite(observation->force_sigma_N[c][k]))) {
                return false;
            }
        }
        sum += is_measured(observation, k) ? pow(observation->moment_Nm[k], 2.0) : 0.0;
    }
    return sum > 0.0 && isfinite(sum);
}

enum dig_status dig_observations_check(const struct dig_curve_set *const set, const size_t digs,
                                       const struct dig_observation dig[])
{
    assert(set != NULL && dig != NULL);
    bool sound = true;
    for (size_t d = 0; d < digs && sound; d++) {
        sound = is_sound(set, &dig[d]);
    }
    return sound ? DIG_OK : DIG_EINVAL;
}

struct dig_misfit dig_cell_misfit(const struct dig_cell *const   cell,
                                  const struct dig_pooled *const group)
{
    double mean_Nm[DIG_CURVE_POINTS];
    double sd_Nm[DIG_CURVE_POINTS];
    dig_cell_blend(cell, DIG_CHANNEL_MY_Nm, mean_Nm, sd_Nm);

    const double      widened           = 1.0 + cell->inverse_packings;
    double            miss2             = 0.0;
    double            rubs_Nm[DIG_RUBS] = { 0.0 };
    struct dig_rubbed rubbed            = { .b = { 0.0 } };
    double            floor2            = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double n    = group->count[k]; // 0 where nothing was measured
        const double miss = group->mean[DIG_CHANNEL_MY_Nm][k] - mean_Nm[k];
        miss2 += n * miss * miss;
        floor2 += n * (sd_Nm[k] * sd_Nm[k] * widened + group->sigma2[DIG_CHANNEL_MY_Nm][k]);
        for (size_t j = 0; group->rubbed && j < DIG_RUBS; j++) {
            rubs_Nm[j] = sqrt(n) * (double)group->rubs[j][DIG_CHANNEL_MY_Nm][k];
        }
        if (group->rubbed) {
            dig_rubbed_add(sqrt(n) * miss, rubs_Nm, &rubbed);
        }
    }
    return (struct dig_misfit){ .miss2_Nm2  = group->scatter_Nm2 + miss2,
                                .floor2_Nm2 = floor2,
                                .norm2_Nm2  = group->norm2_Nm2,
                                .rubbed     = rubbed };
}

void dig_misfit_add(struct dig_misfit *const sum, const struct dig_misfit *const more)
{
    assert(sum != NULL && more != NULL);
    sum->miss2_Nm2 += more->miss2_Nm2;
    sum->floor2_Nm2 += more->floor2_Nm2;
    sum->norm2_Nm2 += more->norm2_Nm2;
    dig_rubbed_join(&sum->rubbed, &more->rubbed);
}

struct dig_distance dig_misfit_distance(const struct dig_misfit *const sum)
{
    assert(sum != NULL);
    const double left2 = dig_rubbed_left2(&sum->rubbed, sum->miss2_Nm2, sum->floor2_Nm2);
    return (struct dig_distance){ .distance    = sqrt(left2 / sum->norm2_Nm2),
                                  .noise_floor = sqrt(sum->floor2_Nm2 / sum->norm2_Nm2) };
}

enum dig_status dig_match_interpolate(const struct dig_curve_set *const set,
                                      const struct dig_gravel *const    gravel,
                                      const size_t trajectory, struct dig_curve *const curve)
{
    assert(set != NULL && gravel != NULL && curve != NULL);
    if (trajectory >= set->trajectories) {
        return DIG_EINVAL;
    }
    struct dig_cell       cell;
    const enum dig_status status = dig_cell_find(set, gravel, trajectory, &cell);
    if (status == DIG_OK) {
        dig_cell_curve(&cell, curve);
    }
    return status;
}

// Distance of an entry from all digs; infinite when it lacks one of their trajectories.
static struct dig_distance entry_distance(const struct dig_curve_set *const set, const size_t entry,
                                          const struct dig_pool_sums *const sums)
{
    struct dig_misfit all = { .miss2_Nm2 = 0.0 };
    for (size_t g = 0; g < sums->groups; g++) {
        const size_t slot = entry * set->trajectories + sums->group[g].trajectory;
        if (set->packings[slot] <= 0) {
            return (struct dig_distance){ .distance = INFINITY };
        }
        const struct dig_cell   cell   = dig_cell_of_entry(set, slot);
        const struct dig_misfit misfit = dig_cell_misfit(&cell, &sums->group[g]);
        dig_misfit_add(&all, &misfit);
    }
    return dig_misfit_distance(&all);
}

enum dig_status dig_match_nearest(const struct dig_curve_set *const set, const size_t digs,
                                  const struct dig_observation dig[], const double outside_floors,
                                  struct dig_match *const match)
{
    assert(set != NULL && dig != NULL && match != NULL);
    if (digs < 1 || !(outside_floors > 0.0) || dig_observations_check(set, digs, dig) != DIG_OK) {
        return DIG_EINVAL;
    }
    struct dig_pool_sums sums;
    dig_pool_sum(digs, dig, &sums);

    const int nearest = dig_nearest_find(set, &sums);
    if (nearest < 0) {
        return DIG_ENOMATCH;
    }
    const struct dig_distance best = entry_distance(set, (size_t)nearest, &sums);

    *match = (struct dig_match){
        .valid            = true,
        .dig_count        = sums.dig_count,
        .digs             = digs,
        .nearest          = nearest,
        .nearest_distance = best.distance,
        .weighted         = -1,

        .weighted_distance = (double)NAN,
        .gravel            = set->gravel[nearest],
        .distance          = best.distance,
        .mean              = set->gravel[nearest],
        .mode              = set->gravel[nearest],
        .low               = set->gravel[nearest],
        .high              = set->gravel[nearest],
        .noise_floor       = best.noise_floor,
        .outside           = best.distance > outside_floors * best.noise_floor,
        .outside_floors    = outside_floors,
    };
    return DIG_OK;
}
