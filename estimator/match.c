#include "estimator/match.h"

#include "estimator/interpolate.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>

static bool is_measured(const struct dig_observation *const o, const size_t point)
{
    const double at = (double)point / (DIG_CURVE_POINTS - 1);
    return at >= o->first && at <= o->last;
}

enum dig_status dig_observation_check(const struct dig_curve_set *const   set,
                                      const struct dig_observation *const observation)
{
    assert(set != NULL && observation != NULL);
    if (observation->trajectory < 0 || (size_t)observation->trajectory >= set->trajectories ||
        !(observation->first >= 0.0 && observation->last <= 1.0)) {
        return DIG_EINVAL;
    }
    double sum = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        if (!isfinite(observation->moment_Nm[k]) ||
            !(observation->sigma_Nm[k] >= 0.0 && isfinite(observation->sigma_Nm[k]))) {
            return DIG_EINVAL;
        }
        sum += is_measured(observation, k) ? pow(observation->moment_Nm[k], 2.0) : 0.0;
    }
    return sum > 0.0 && isfinite(sum) ? DIG_OK : DIG_EINVAL;
}

struct dig_distance dig_cell_distance(const struct dig_cell *const        cell,
                                      const struct dig_observation *const observation)
{
    double miss2  = 0.0;
    double floor2 = 0.0;
    double whole2 = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        if (!is_measured(observation, k)) {
            continue;
        }
        const double miss = observation->moment_Nm[k] - dig_cell_mean(cell, DIG_CHANNEL_MY_Nm, k);
        const double sd   = dig_cell_sd(cell, DIG_CHANNEL_MY_Nm, k);
        miss2 += miss * miss;
        floor2 += sd * sd * (1.0 + cell->inverse_packings) + pow(observation->sigma_Nm[k], 2.0);
        whole2 += observation->moment_Nm[k] * observation->moment_Nm[k];
    }
    return (struct dig_distance){ .distance    = sqrt(miss2 / whole2),
                                  .noise_floor = sqrt(floor2 / whole2) };
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
    if (status != DIG_OK) {
        return status;
    }
    for (int c = 0; c < DIG_CHANNELS; c++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            curve->mean[c][k] = (float)dig_cell_mean(&cell, (enum dig_channel)c, k);
            curve->sd[c][k]   = (float)dig_cell_sd(&cell, (enum dig_channel)c, k);
        }
    }
    return DIG_OK;
}

enum dig_status dig_match_nearest(const struct dig_curve_set *const   set,
                                  const struct dig_observation *const observation,
                                  const double outside_floors, struct dig_match *const match)
{
    assert(set != NULL && observation != NULL && match != NULL);
    const enum dig_status status = dig_observation_check(set, observation);
    if (status != DIG_OK || !(outside_floors > 0.0)) {
        return DIG_EINVAL;
    }

    int                 nearest = -1;
    struct dig_distance best    = { .distance = INFINITY };
    for (size_t e = 0; e < set->entries; e++) {
        const size_t slot = e * set->trajectories + (size_t)observation->trajectory;
        if (set->packings[slot] <= 0) {
            continue;
        }
        const struct dig_cell cell = {
            .corners          = 1,
            .curve            = { &set->curve[slot] },
            .weight           = { 1.0 },
            .inverse_packings = 1.0 / (double)set->packings[slot],
        };
        const struct dig_distance distance = dig_cell_distance(&cell, observation);
        if (distance.distance < best.distance) {
            best    = distance;
            nearest = (int)e;
        }
    }
    if (nearest < 0) {
        return DIG_ENOMATCH;
    }

    *match = (struct dig_match){
        .valid            = true,
        .dig_count        = observation->dig_count,
        .nearest          = nearest,
        .nearest_distance = best.distance,
        .gravel           = set->gravel[nearest],
        .distance         = best.distance,
        .mean             = set->gravel[nearest],
        .low              = set->gravel[nearest],
        .high             = set->gravel[nearest],
        .noise_floor      = best.noise_floor,
        .outside          = best.distance > outside_floors * best.noise_floor,
        .outside_floors   = outside_floors,
    };
    return DIG_OK;
}
