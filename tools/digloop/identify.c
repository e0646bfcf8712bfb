#include "closed_loop/observe.h"
#include "estimator/match.h"
#include "files/identity_json.h"
#include "tools/digloop/commands.h"
#include "tools/digloop/recording.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EVALUATIONS    400
#define OUTSIDE_FLOORS 3.0

// Digs of all recordings.
struct pool {
    size_t                  digs;
    struct dig_observation *dig; // [digs]
};

static enum dig_status add(struct pool *const pool, const struct dig_observed_digs *const more,
                           struct dig_error *const error)
{
    struct dig_observation *const grown =
        realloc(pool->dig, (pool->digs + more->digs) * sizeof *grown);
    if (grown == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    memcpy(grown + pool->digs, more->dig, more->digs * sizeof *grown);
    pool->dig = grown;
    pool->digs += more->digs;
    return DIG_OK;
}

static enum dig_status collect(const struct digloop_options *const options,
                               const struct dig_curve_set *const   set,
                               const struct digloop_machine *const machine, const int trajectory,
                               struct pool *const pool, struct dig_error *const error)
{
    enum dig_status status = DIG_OK;
    for (int i = 0; i < options->recordings && status == DIG_OK; i++) {
        struct dig_observed_digs digs = { .digs = 0 };
        status = digloop_read_digs(options->recording[i], machine, set, trajectory, &digs, error);
        if (status == DIG_OK) {
            status = add(pool, &digs, error);
        }
        dig_observed_digs_finish(&digs);
    }
    return status;
}

// The mean of all digs, and how many there were.
static enum dig_status observe_all(const struct digloop_options *const options,
                                   const struct dig_curve_set *const   set,
                                   const struct digloop_machine *const machine,
                                   struct dig_observation *const mean, size_t *const digs,
                                   struct dig_error *const error)
{
    int             trajectory = -1;
    enum dig_status status     = DIG_OK;
    if (options->trajectory != NULL) {
        status = digloop_find_trajectory(options, set, &trajectory, error);
    }
    if (status != DIG_OK) {
        return status;
    }
    struct pool pool = { .digs = 0 };
    status           = collect(options, set, machine, trajectory, &pool, error);
    if (status == DIG_OK) {
        struct dig_error why = { "" };
        status               = dig_observe_mean(pool.digs, pool.dig, mean, &why);
        if (status != DIG_OK) {
            (void)dig_error_set(error, status, "%s; --trajectory NAME takes those along one",
                                why.text);
        }
    }
    *digs = pool.digs;
    free(pool.dig);
    return status;
}

static void show_identity(const struct dig_identity *const id, FILE *const to)
{
    for (int a = 0; a < DIG_AXES; a++) {
        (void)fprintf(to, "  %-14s %8.4g   90 %%: %.4g to %.4g   nearest entry %.4g\n",
                      dig_axis_name((enum dig_axis)a), id->gravel.value[a], id->low.value[a],
                      id->high.value[a], id->nearest.value[a]);
    }
    (void)fprintf(to, "  distance %.3f, nearest entry %.3f, noise floor %.3f%s\n", id->distance,
                  id->nearest_distance, id->noise_floor,
                  id->outside ? "; OUTSIDE: none of the table's gravels" : "");
}

enum dig_status digloop_identify(const struct digloop_options *const options,
                                 const struct dig_curve_set *const   set,
                                 const struct digloop_machine *const machine,
                                 struct dig_error *const             error)
{
    struct dig_observation observation = { .trajectory = 0 };
    struct dig_match       match;
    size_t                 digs   = 0;
    enum dig_status        status = observe_all(options, set, machine, &observation, &digs, error);
    if (status != DIG_OK) {
        return status;
    }
    status = dig_match_nearest(set, &observation, OUTSIDE_FLOORS, &match);
    if (status == DIG_ENOMATCH) {
        return dig_error_set(error, status, "%s: holds no curve along %s, expected one or more",
                             options->table, set->trajectory[observation.trajectory].name);
    }
    if (status == DIG_OK) {
        status = dig_fit_refine(set, &observation, EVALUATIONS, &match);
    }
    if (status != DIG_OK) {
        return dig_error_set(error, status, "%s: %s", options->table, dig_status_str(status));
    }

    struct dig_identity id = {
        .digs             = digs,
        .gravel           = match.gravel,
        .mean             = match.mean,
        .low              = match.low,
        .high             = match.high,
        .nearest          = set->gravel[match.nearest],
        .distance         = match.distance,
        .nearest_distance = match.nearest_distance,
        .noise_floor      = match.noise_floor,
        .outside          = match.outside,
        .samples          = match.samples,
    };
    _Static_assert(DIG_MATCH_SAMPLES <= DIG_IDENTITY_SAMPLES_MAX, "the posterior must fit");
    memcpy(id.sample, match.sample, match.samples * sizeof match.sample[0]);
    (void)snprintf(id.scene_hash, sizeof id.scene_hash, "%s", set->scene_hash);
    (void)snprintf(id.trajectory, sizeof id.trajectory, "%s",
                   set->trajectory[observation.trajectory].name);
    if (options->json) {
        dig_identity_write(stdout, &id);
    } else {
        show_identity(&id, stdout);
    }
    return DIG_OK;
}
