// Which distance finds the entry that a dig is of: each dig of a gravel that was dug more than
// once, against the table without that dig. The Euclidean norm of the moment (by which MATCH's
// nearest entry is), the posterior's likelihood of the moment, and of moment and forces, and the
// noise-weighted distance of both (by which MATCH's weighted entry is). Of each:
// how often the entry is the dig's own, and by how much its moment along the other trajectory is
// off that of the dig's own entry. Last what is predicted, which is of no entry: the posterior's
// mean.
//
//   nearest_entry TABLE.sqlite TRAJECTORY OTHER_TRAJECTORY

#include "estimator/match/gaussian.h"
#include "estimator/match/match.h"
#include "estimator/match/pool.h"
#include "tests/table_runs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WAYS = 5 };
static const char *const way_names[WAYS] = { "Euclidean, moment", "likelihood, moment",
                                             "likelihood, moment and forces",
                                             "noise-weighted, moment",
                                             "noise-weighted, moment and forces" };

struct bench {
    struct table_runs all;
    size_t            other, digs, own[WAYS];
    double            off[WAYS], predicted_off;
};

static size_t slot_of(const struct bench *const b, const size_t entry, const size_t trajectory)
{
    return entry * b->all.set->trajectories + trajectory;
}

static size_t likeliest(const struct bench *const b, const struct dig_observation *const dig)
{
    static struct dig_pool_sums sums;
    static struct dig_gaussian  likelihood;
    dig_pool_sum(1, dig, &sums);
    dig_gaussian_make(b->all.set, &sums.group[0], &likelihood);
    size_t best = 0;
    double most = -INFINITY;
    for (size_t e = 0; e < b->all.set->entries; e++) {
        struct dig_cell cell;
        if (dig_cell_find(b->all.set, &b->all.set->gravel[e], b->all.trajectory, &cell) != DIG_OK) {
            continue;
        }
        const double log = dig_gaussian_log(&likelihood, &cell);
        best             = log > most ? e : best;
        most             = fmax(log, most);
    }
    return best;
}

static size_t weighted(const struct bench *const b, const struct dig_observation *const dig)
{
    struct dig_match match;
    if (dig_match_nearest(b->all.set, 1, dig, 2.5, &match) != DIG_OK) {
        return 0;
    }
    dig_match_find_weighted(b->all.set, 1, dig, &match);
    return (size_t)match.weighted;
}

// Of a moment along the other trajectory against that of an entry.
static double off_by(const struct bench *const b, const struct dig_curve *const is,
                     const size_t truth)
{
    return table_runs_off(is, &b->all.set->curve[slot_of(b, truth, b->other)]);
}

static void judge(void *const context, const struct table_run *const run)
{
    struct bench *const    b   = context;
    struct dig_observation dig = table_run_observed(run);
    struct dig_match       match;
    if (dig_match_nearest(b->all.set, 1, &dig, 2.5, &match) != DIG_OK) {
        return;
    }
    size_t found[WAYS] = { (size_t)match.nearest, likeliest(b, &dig), 0, weighted(b, &dig) };
    dig.forces         = true;
    found[2]           = likeliest(b, &dig);
    found[4]           = weighted(b, &dig);
    b->digs++;
    for (int w = 0; w < WAYS; w++) {
        b->own[w] += found[w] == run->entry ? 1 : 0;
        b->off[w] += off_by(b, &b->all.set->curve[slot_of(b, found[w], b->other)], run->entry);
    }
    static struct dig_curve predicted;
    const bool              told = dig_match_nearest(b->all.set, 1, &dig, 2.5, &match) == DIG_OK &&
                      dig_fit_refine(b->all.set, 1, &dig, 300, &match) == DIG_OK &&
                      dig_predict_curve(b->all.set, &match, b->other, &predicted) == DIG_OK;
    b->predicted_off += told ? off_by(b, &predicted, run->entry) : (double)NAN;
}

int main(const int argc, char *argv[])
{
    struct dig_error    error = { "TABLE.sqlite TRAJECTORY OTHER_TRAJECTORY" };
    struct bench *const b     = calloc(1, sizeof *b);
    int                 rc    = 1;
    if (argc == 4 && b != NULL && table_runs_read(argv[1], argv[2], &b->all, &error) == DIG_OK) {
        b->other = table_runs_trajectory(b->all.set, argv[3]);
        if (b->other < b->all.set->trajectories) {
            table_runs_leave_out_each(&b->all, judge, b);
            for (int w = 0; w < WAYS; w++) {
                printf("%-36s %4zu digs, their own entry %3zu (%2.0f %%), the other dig off by "
                       "%.3f in the mean\n",
                       way_names[w], b->digs, b->own[w],
                       100.0 * (double)b->own[w] / (double)b->digs, b->off[w] / (double)b->digs);
            }
            printf("%-36s %4zu digs, the other dig off by %.3f in the mean\n", "predicted", b->digs,
                   b->predicted_off / (double)b->digs);
            rc = 0;
        }
    }
    if (rc != 0) {
        (void)fprintf(stderr, "nearest_entry: %s\n", error.text);
    }
    dig_curve_set_destroy(b != NULL ? b->all.set : NULL);
    free(b);
    return rc;
}
