#include "core/regular.h"
#include "core/units.h"
#include "estimator/match/match.h"
#include "files/identity_json.h"
#include "tools/digloop/as_dug.h"
#include "tools/digloop/commands.h"
#include "tools/digloop/recording.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EVALUATIONS    400
#define OUTSIDE_FLOORS 3.0

static enum dig_status add(struct dig_observed_digs *const       pool,
                           const struct dig_observed_digs *const more,
                           struct dig_error *const               error)
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

static enum dig_status collect(const struct digloop_job *const job, const int trajectory,
                               struct dig_observed_digs *const pool, struct dig_error *const error)
{
    enum dig_status    status    = DIG_OK;
    char *const *const recording = job->options->recording;
    for (int i = 0; i < job->options->recordings && status == DIG_OK; i++) {
        struct dig_observed_digs digs = { .digs = 0 };
        for (int k = 0; k < i; k++) { // a bed that counts twice would be known too well
            if (dig_regular_same(recording[i], recording[k])) {
                (void)dig_error_set(error, DIG_EINVAL, "%s: named twice, expected a dig once",
                                    recording[i]);
                return DIG_EINVAL;
            }
        }
        status = digloop_read_digs(job, job->options->recording[i], trajectory, &digs, error);
        if (status == DIG_OK) {
            status = add(pool, &digs, error);
        }
        dig_observed_digs_finish(&digs);
    }
    if (status == DIG_OK && pool->dig == NULL) {
        (void)dig_error_set(error, DIG_EINVAL, "no recording, expected one or more");
        return DIG_EINVAL;
    }
    return status;
}

// Which trajectories identify in a daemon by default.
static bool is_simple(const struct dig_trajectory *const t)
{
    return strncmp(t->name, "simple", 6) == 0;
}

// Digs along several trajectories are of one ground when each is one that identifies: an actual dig
// among them would predict itself.
static enum dig_status check_along(const struct dig_curve_set *const     set,
                                   const struct dig_observed_digs *const pool,
                                   struct dig_error *const               error)
{
    const int first = pool->dig[0].trajectory;
    bool      same = true, simple = true;
    for (size_t d = 0; d < pool->digs; d++) {
        same   = same && pool->dig[d].trajectory == first;
        simple = simple && is_simple(&set->trajectory[pool->dig[d].trajectory]);
    }
    return same || simple
               ? DIG_OK
               : dig_error_set(error, DIG_EINVAL,
                               "recordings of different trajectories, expected digs along one, or "
                               "along those that begin with \"simple\"; --trajectory NAME takes "
                               "those along one");
}

static enum dig_status observe_all(const struct digloop_job *const job,
                                   struct dig_observed_digs *const pool,
                                   struct dig_error *const         error)
{
    int             trajectory = -1;
    enum dig_status status     = DIG_OK;
    if (job->options->trajectory != NULL) {
        status = digloop_find_trajectory(job, &trajectory, error);
    }
    if (status == DIG_OK) {
        status = collect(job, trajectory, pool, error);
    }
    if (status == DIG_OK) {
        status = check_along(job->set, pool, error);
    }
    for (size_t d = 0; status == DIG_OK && d < pool->digs; d++) {
        pool->dig[d].forces = pool->dig[d].forces && !job->options->moment_alone;
    }
    return status;
}

static enum dig_status match_all(const char *const table, const struct dig_curve_set *const set,
                                 const struct dig_observed_digs *const pool,
                                 struct dig_match *const match, struct dig_error *const error)
{
    enum dig_status status = dig_match_nearest(set, pool->digs, pool->dig, OUTSIDE_FLOORS, match);
    if (status == DIG_ENOMATCH) {
        return dig_error_set(error, status, "%s: holds no gravel with a curve along %s%s", table,
                             set->trajectory[pool->dig[pool->digs - 1].trajectory].name,
                             pool->digs > 1 ? " and all else that was dug" : "");
    }
    if (status == DIG_OK) {
        dig_match_find_weighted(set, pool->digs, pool->dig, match);
        status = dig_fit_refine(set, pool->digs, pool->dig, EVALUATIONS, match);
    }
    return status == DIG_OK ? DIG_OK
                            : dig_error_set(error, status, "%s: %s", table, dig_status_str(status));
}

// "3 digs (simpleA): moment and forces"; and why not the forces, where some have them.
static void show_measured(const struct dig_curve_set *const     set,
                          const struct dig_observed_digs *const pool, const bool forces,
                          FILE *const to)
{
    (void)fprintf(to, "  %zu dig%s (", pool->digs, pool->digs == 1 ? "" : "s");
    for (size_t t = 0, named = 0; t < set->trajectories; t++) {
        bool dug = false;
        for (size_t d = 0; d < pool->digs; d++) {
            dug = dug || (size_t)pool->dig[d].trajectory == t;
        }
        if (dug) {
            (void)fprintf(to, "%s%s", named++ > 0 ? ", " : "", set->trajectory[t].name);
        }
    }
    size_t with = 0;
    for (size_t d = 0; d < pool->digs; d++) {
        with += pool->dig[d].forces ? 1 : 0;
    }
    (void)fputs(forces ? "): moment and forces" : "): moment alone", to);
    if (!forces && with > 0) {
        (void)fprintf(to, "; forces in %zu of them", with);
    }
    (void)fputs("\n", to);
}

static bool is_shown_alike(const struct dig_approach *const a, const struct dig_approach *const b)
{
    return fabs(a->depth - b->depth) < 5e-4 && fabs(a->attack_rad - b->attack_rad) < 1e-4;
}

// "dig 1 at depth 1.080, attack 2.00 deg, …", each dig of a table that knows such; and what it was
// matched at, where the table does not go so far.
static void show_approaches(const struct dig_observed_digs *const pool, FILE *const to)
{
    for (size_t d = 0; d < pool->digs; d++) {
        const struct dig_observation *const dig     = &pool->dig[d];
        const struct dig_approach           matched = dig_approach_normalized(&dig->approach);
        if (!(dig->made.depth > 0.0)) {
            continue;
        }
        (void)fprintf(to, "  dig %zu at depth %.3f, attack %.2f deg, ", d + 1, dig->made.depth,
                      dig->made.attack_rad / DIG_RAD_PER_DEG);
        if (!is_shown_alike(&dig->made, &matched)) {
            (void)fprintf(to, "matched at %.3f, %.2f deg, ", matched.depth,
                          matched.attack_rad / DIG_RAD_PER_DEG);
        }
        (void)fprintf(to, "%.1f mm off that path\n", 1e3 * dig->off_path_m);
    }
}

static void show_identity(const struct dig_identity *const id, FILE *const to)
{
    const struct dig_match *const m = &id->match;
    for (int a = 0; a < DIG_AXES; a++) {
        (void)fprintf(to, "  %-14s %8.4g   90 %%: %.4g to %.4g   nearest entry %.4g\n",
                      dig_axis_name((enum dig_axis)a), m->gravel.value[a], m->low.value[a],
                      m->high.value[a], id->nearest.value[a]);
    }
    (void)fprintf(to, "  distance %.3f, nearest entry %.3f, noise floor %.3f%s\n", m->distance,
                  m->nearest_distance, m->noise_floor,
                  m->outside ? "; OUTSIDE: none of the table's gravels" : "");
    if (m->weighted >= 0) {
        const double *const g = id->weighted_nearest.value;
        (void)fprintf(to, "  noise-weighted: entry %.4g / %.4g / %.4g, %.2f of what is expected\n",
                      g[DIG_AXIS_FRICTION], g[DIG_AXIS_ROLLING], g[DIG_AXIS_DENSITY_kgpm3],
                      m->weighted_distance);
    }
}

// Friction of a cylinder that its file lacks pushes like no gravel either.
static void show_doubt(const struct digloop_job *const job, const struct dig_match *const match,
                       FILE *const to)
{
    if (match->outside && job->options->machine != NULL && job->options->model == NULL) {
        (void)fputs(
            "  perhaps it is the machine: digloop trace finds friction, weights and offsets "
            "that its file lacks\n",
            to);
    }
}

static void show_family(const struct dig_match *const match, FILE *const to)
{
    char untold[DIG_UNTOLD_SIZE];
    dig_match_unresolved(match, untold);
    dig_axes_without_units(untold);
    if (untold[0] != '\0') {
        (void)fprintf(
            to, "  a FAMILY of gravels that resist alike, of which this is one: %s not told\n",
            untold);
    }
}

static struct dig_identity identity_of(const struct dig_curve_set *const   set,
                                       const struct dig_observation *const youngest,
                                       const struct dig_match *const       match)
{
    struct dig_identity id = {
        .made    = youngest->made,
        .matched = youngest->approach,
        .match   = *match,
        .nearest = set->gravel[match->nearest],
        .family  = dig_match_is_family(match),
    };
    if (match->weighted >= 0) {
        id.weighted_nearest = set->gravel[match->weighted];
    }
    (void)snprintf(id.scene_hash, sizeof id.scene_hash, "%s", set->scene_hash);
    (void)snprintf(id.trajectory, sizeof id.trajectory, "%s",
                   set->trajectory[youngest->trajectory].name);
    return id;
}

enum dig_status digloop_identify(const struct digloop_job *const job, struct dig_error *const error)
{
    struct dig_observed_digs pool  = { .digs = 0 };
    struct digloop_as_dug    table = { .set = NULL };
    struct dig_match         match;
    enum dig_status          status = observe_all(job, &pool, error);
    if (status == DIG_OK) {
        status = digloop_as_dug_make(job->set, pool.digs, pool.dig, &table, error);
    }
    if (status == DIG_OK) {
        status = match_all(job->options->table, table.set, &pool, &match, error);
        digloop_as_dug_restore(&table, pool.digs, pool.dig);
    }
    digloop_as_dug_finish(&table);
    if (status == DIG_OK) {
        const struct dig_identity id = identity_of(job->set, &pool.dig[pool.digs - 1], &match);
        if (job->options->json) {
            dig_identity_write(stdout, &id);
        } else {
            show_measured(job->set, &pool, match.forces, stdout);
            show_approaches(&pool, stdout);
            show_identity(&id, stdout);
            show_doubt(job, &match, stdout);
            show_family(&match, stdout);
        }
    }
    dig_observed_digs_finish(&pool);
    return status;
}
