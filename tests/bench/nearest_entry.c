// Which distance finds the entry that a dig is of: each dig of a gravel that was dug more than
// once, against the table without that dig. The Euclidean norm of the moment (by which MATCH's
// nearest entry is), the posterior's likelihood of the moment, and of moment and forces, and the
// noise-weighted distance of both (by which MATCH's weighted entry is). Of each:
// how often the entry is the dig's own, and by how much its moment along the other trajectory is
// off that of the dig's own entry. Last what is predicted, which is of no entry: the posterior's
// mean.
//
//   nearest_entry TABLE.sqlite TRAJECTORY OTHER_TRAJECTORY

#include "estimator/match/likelihood.h"
#include "estimator/match/match.h"
#include "estimator/match/pool.h"
#include "tables/derive.h"
#include "tables/load.h"
#include "tables/store.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RUNS_MAX = 400, WAYS = 5 };
static const char *const way_names[WAYS] = { "Euclidean, moment", "likelihood, moment",
                                             "likelihood, moment and forces",
                                             "noise-weighted, moment",
                                             "noise-weighted, moment and forces" };

struct run {
    size_t entry;
    double value[DIG_CHANNELS][DIG_CURVE_POINTS];
};

struct bench {
    struct dig_curve_set *set;
    size_t                trajectory, other;
    size_t                runs;
    struct run            run[RUNS_MAX];
    size_t                digs, own[WAYS];
    double                off[WAYS], predicted_off;
};

static size_t slot_of(const struct bench *const b, const size_t entry, const size_t trajectory)
{
    return entry * b->set->trajectories + trajectory;
}

static enum dig_status take(void *const context, const struct dig_run *const run,
                            struct dig_error *const error)
{
    struct bench *const b = context;
    if (run->origin.trajectory != b->trajectory || run->origin.effect[0] != '\0' ||
        !dig_approach_is_plain(&run->origin.approach)) {
        return DIG_OK;
    }
    if (b->runs == RUNS_MAX) {
        return dig_error_set(error, DIG_EINVAL, "more than %d runs", RUNS_MAX);
    }
    struct run *const one = &b->run[b->runs++];
    for (size_t e = 0; e < b->set->entries; e++) {
        if (memcmp(&b->set->gravel[e], &run->origin.gravel, sizeof run->origin.gravel) == 0) {
            one->entry = e;
        }
    }
    return dig_derive_run(&b->set->trajectory[b->trajectory], b->set->tooth_m,
                          b->set->smooth_half_s, run->windows, run->first_s, run->step_s,
                          run->value, one->value);
}

static size_t likeliest(const struct bench *const b, const struct dig_observation *const dig)
{
    static struct dig_pool_sums  sums;
    static struct dig_likelihood likelihood;
    dig_pool_sum(1, dig, &sums);
    dig_likelihood_make(b->set, NULL, &sums.group[0], &likelihood);
    size_t best = 0;
    double most = -INFINITY;
    for (size_t e = 0; e < b->set->entries; e++) {
        struct dig_cell cell;
        if (dig_cell_find(b->set, &b->set->gravel[e], b->trajectory, &cell) != DIG_OK) {
            continue;
        }
        const double log = dig_likelihood_log(&likelihood, &cell);
        best             = log > most ? e : best;
        most             = fmax(log, most);
    }
    return best;
}

static size_t weighted(const struct bench *const b, const struct dig_observation *const dig)
{
    struct dig_match match;
    if (dig_match_nearest(b->set, 1, dig, 2.5, &match) != DIG_OK) {
        return 0;
    }
    dig_match_find_weighted(b->set, NULL, 1, dig, &match);
    return (size_t)match.weighted;
}

// Relative, of a moment along the other trajectory against that of an entry.
static double off_by(const struct bench *const b, const struct dig_curve *const is,
                     const size_t truth)
{
    const struct dig_curve *const should = &b->set->curve[slot_of(b, truth, b->other)];
    double                        miss2  = 0.0;
    double                        whole2 = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double t = (double)should->mean[DIG_CHANNEL_MY_Nm][k];
        miss2 += pow((double)is->mean[DIG_CHANNEL_MY_Nm][k] - t, 2.0);
        whole2 += t * t;
    }
    return sqrt(miss2 / whole2);
}

static void judge(struct bench *const b, const struct run *const run)
{
    struct dig_observation dig = { .dig_count = 1, .trajectory = (int)b->trajectory, .last = 1.0 };
    struct dig_match       match;
    memcpy(dig.moment_Nm, run->value[0], sizeof dig.moment_Nm);
    memcpy(dig.force_N, run->value[1], sizeof dig.force_N);
    if (dig_match_nearest(b->set, 1, &dig, 2.5, &match) != DIG_OK) {
        return;
    }
    size_t found[WAYS] = { (size_t)match.nearest, likeliest(b, &dig), 0, weighted(b, &dig) };
    dig.forces         = true;
    found[2]           = likeliest(b, &dig);
    found[4]           = weighted(b, &dig);
    b->digs++;
    for (int w = 0; w < WAYS; w++) {
        b->own[w] += found[w] == run->entry ? 1 : 0;
        b->off[w] += off_by(b, &b->set->curve[slot_of(b, found[w], b->other)], run->entry);
    }
    static struct dig_curve predicted;
    const bool              told = dig_match_nearest(b->set, 1, &dig, 2.5, &match) == DIG_OK &&
                      dig_fit_refine(b->set, 1, &dig, 300, &match) == DIG_OK &&
                      dig_predict_curve(b->set, &match, b->other, &predicted) == DIG_OK;
    b->predicted_off += told ? off_by(b, &predicted, run->entry) : (double)NAN;
}

// The table without the dig. A single one that is left has the entry's spread.
static void leave_out(struct bench *const b, const size_t left)
{
    const size_t            slot  = slot_of(b, b->run[left].entry, b->trajectory);
    struct dig_curve *const curve = &b->set->curve[slot];
    const struct dig_curve  whole = *curve;
    struct dig_ensemble     ensemble;
    memset(&ensemble, 0, sizeof ensemble);
    for (size_t i = 0; i < b->runs; i++) {
        if (i != left && b->run[i].entry == b->run[left].entry) {
            dig_ensemble_add(&ensemble, (const double(*)[DIG_CURVE_POINTS])b->run[i].value);
        }
    }
    if (ensemble.packings == 0) {
        return;
    }
    dig_ensemble_curve(&ensemble, curve);
    if (ensemble.packings == 1) {
        memcpy(curve->sd, whole.sd, sizeof curve->sd);
    }
    b->set->packings[slot]--;
    judge(b, &b->run[left]);
    b->set->packings[slot]++;
    *curve = whole;
}

static size_t trajectory_of(const struct dig_curve_set *const set, const char *const name)
{
    size_t t = 0;
    while (t < set->trajectories && strcmp(set->trajectory[t].name, name) != 0) {
        t++;
    }
    return t;
}

int main(const int argc, char *argv[])
{
    struct dig_error    error = { "TABLE.sqlite TRAJECTORY OTHER_TRAJECTORY" };
    struct dig_store   *store = NULL;
    struct bench *const b     = calloc(1, sizeof *b);
    int                 rc    = 1;
    if (argc == 4 && b != NULL && dig_table_load(argv[1], &b->set, &error) == DIG_OK &&
        dig_store_open(argv[1], &store, &error) == DIG_OK) {
        b->trajectory                        = trajectory_of(b->set, argv[2]);
        b->other                             = trajectory_of(b->set, argv[3]);
        const struct dig_run_visitor visitor = { take, b };
        if (b->trajectory < b->set->trajectories && b->other < b->set->trajectories &&
            dig_store_walk(store, &visitor, &error) == DIG_OK) {
            for (size_t i = 0; i < b->runs; i++) {
                leave_out(b, i);
            }
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
    dig_store_close(store);
    dig_curve_set_destroy(b != NULL ? b->set : NULL);
    free(b);
    return rc;
}
