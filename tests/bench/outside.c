// How well "outside" is told by moment and forces, on a table's own packings:
//
//   inside   each dig of a gravel that was dug more than once, against the table without that dig:
//   the
//            share told as outside is a share of false alarms
//   beyond   each dig of a gravel on a face of the grid, against the table without the whole face,
//   and of
//            those told as outside, how wrong the next dig along the other trajectory would be
//            predicted by the gravel told (of the moment alone) and by the one that the forces
//            would pull it to
//
//   outside TABLE.sqlite TRAJECTORY OTHER_TRAJECTORY [SHARE_OF_THE_PATH]

#include "core/outline.h"
#include "estimator/match/match.h"
#include "estimator/match/pool.h"
#include "estimator/match/posterior.h"
#include "tests/table_runs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { EVALUATIONS = 300 };
static const double floors = 2.5;

struct bench {
    struct table_runs all;
    size_t            other;
    double            last; // of the path that is measured
};

struct tally {
    size_t digs, outside, by_moment, compared, better; // by_moment: outside by it alone
    double by_told, by_forces;                         // sums of relative errors, of those outside
};

static size_t slot_of(const struct bench *const b, const size_t entry, const size_t trajectory)
{
    return entry * b->all.set->trajectories + trajectory;
}

static struct dig_observation observed(const struct bench *const     b,
                                       const struct table_run *const run)
{
    struct dig_observation o = table_run_observed(run);
    o.last                   = b->last;
    o.forces                 = true;
    return o;
}

// Relative error of the moment that a match predicts along the other trajectory; NaN: none was dug.
static double error_of(const struct bench *const b, const struct dig_curve_set *const set,
                       const struct dig_match *const match, const size_t entry)
{
    static struct dig_curve predicted;
    const size_t            slot = slot_of(b, entry, b->other);
    if (b->all.set->packings[slot] < 1 ||
        dig_predict_curve(set, match, b->other, &predicted) != DIG_OK) {
        return (double)NAN;
    }
    return table_runs_off(&predicted, &b->all.set->curve[slot]);
}

static void judge(const struct bench *const b, const struct dig_curve_set *const set,
                  const struct table_run *const run, struct tally *const tally)
{
    static struct dig_pool_sums  sums;
    const struct dig_observation o = observed(b, run);
    struct dig_match             told;
    if (dig_match_nearest(set, 1, &o, floors, &told) != DIG_OK ||
        dig_fit_refine(set, 1, &o, EVALUATIONS, &told) != DIG_OK) {
        return;
    }
    struct dig_match       bare;
    struct dig_observation alone = o;
    alone.forces                 = false;
    if (dig_match_nearest(set, 1, &alone, floors, &bare) != DIG_OK ||
        dig_fit_refine(set, 1, &alone, EVALUATIONS, &bare) != DIG_OK) {
        return;
    }
    tally->by_moment += bare.outside ? 1 : 0;
    tally->digs++;
    if (told.forces) {
        return;
    }
    tally->outside++;
    struct dig_match pulled = told;
    dig_pool_sum(1, &o, &sums);
    if (dig_posterior_fill(set, &sums, &pulled) != DIG_OK) {
        return;
    }
    const double by_told   = error_of(b, set, &told, run->entry);
    const double by_forces = error_of(b, set, &pulled, run->entry);
    if (isfinite(by_told) && isfinite(by_forces)) {
        tally->compared++;
        tally->better += by_told < by_forces ? 1 : 0;
        tally->by_told += by_told;
        tally->by_forces += by_forces;
    }
}

static void tell(const char *const name, const struct tally *const t)
{
    printf("%-28s %4zu digs, %3zu told outside (%4.1f %%), %zu by the moment alone", name, t->digs,
           t->outside, 100.0 * (double)t->outside / (double)t->digs, t->by_moment);
    if (t->compared > 0) {
        printf("; next dig off by %.3f as told, %.3f by the forces; %zu of %zu better as told",
               t->by_told / (double)t->compared, t->by_forces / (double)t->compared, t->better,
               t->compared);
    }
    printf("\n");
}

static void add(struct tally *const sum, const struct tally *const more)
{
    sum->digs += more->digs;
    sum->outside += more->outside;
    sum->by_moment += more->by_moment;
    sum->compared += more->compared;
    sum->better += more->better;
    sum->by_told += more->by_told;
    sum->by_forces += more->by_forces;
}

struct inside {
    struct bench *bench;
    struct tally  tally;
};

static void judge_left(void *const context, const struct table_run *const left)
{
    struct inside *const in = context;
    judge(in->bench, in->bench->all.set, left, &in->tally);
}

// Each dig against its entry without it. A single dig that is left has the entry's spread.
static void look_inside(struct bench *const b)
{
    struct inside in = { .bench = b };
    table_runs_leave_out_each(&b->all, judge_left, &in);
    tell("inside", &in.tally);
}

static bool is_on_face(const struct bench *const b, const size_t entry, const int axis,
                       const double face)
{
    return fabs(b->all.set->gravel[entry].value[axis] / face - 1.0) < 1e-9;
}

// The grid without its first (end 0) or last points of an axis; entries of that face have no digs.
static struct dig_curve_set without(const struct bench *const b, const int axis, const int end,
                                    const double face, int packings[], int cell[])
{
    const struct dig_curve_set *const set   = b->all.set;
    struct dig_curve_set              less  = *set;
    const size_t                      slots = set->entries * set->trajectories;
    for (size_t s = 0; s < slots; s++) {
        packings[s] = is_on_face(b, s / set->trajectories, axis, face) ? 0 : set->packings[s];
    }
    less.packings = packings;
    less.cell     = cell;
    dig_outlines_draw(&less);
    less.axis_count[axis]--;
    less.axis[axis] = set->axis[axis] + (end == 0 ? 1 : 0);

    const size_t *const n     = less.axis_count;
    const size_t        cells = n[0] * n[1] * n[2];
    for (size_t i = 0; i < cells; i++) {
        size_t at[DIG_AXES] = { i / (n[1] * n[2]), i / n[2] % n[1], i % n[2] };
        at[axis] += end == 0 ? 1 : 0;
        cell[i] = set->cell[(at[0] * set->axis_count[1] + at[1]) * set->axis_count[2] + at[2]];
    }
    return less;
}

static void look_beyond(struct bench *const b)
{
    const size_t slots    = b->all.set->entries * b->all.set->trajectories;
    int *const   packings = malloc(slots * sizeof *packings);
    int *const   cell     = malloc(b->all.set->axis_count[0] * b->all.set->axis_count[1] *
                                   b->all.set->axis_count[2] * sizeof *cell);
    struct tally all      = { .digs = 0 };
    for (int axis = 0; packings != NULL && cell != NULL && axis < DIG_AXES; axis++) {
        for (int end = 0; end < 2 && b->all.set->axis_count[axis] > 2; end++) {
            const double face =
                b->all.set->axis[axis][end == 0 ? 0 : b->all.set->axis_count[axis] - 1];
            const struct dig_curve_set less  = without(b, axis, end, face, packings, cell);
            struct tally               tally = { .digs = 0 };
            for (size_t i = 0; i < b->all.runs; i++) {
                if (is_on_face(b, b->all.run[i].entry, axis, face)) {
                    judge(b, &less, &b->all.run[i], &tally);
                }
            }
            char name[64];
            (void)snprintf(name, sizeof name, "beyond, no %s %g",
                           dig_axis_name((enum dig_axis)axis), face);
            tell(name, &tally);
            add(&all, &tally);
        }
    }
    tell("beyond, all", &all);
    free(packings);
    free(cell);
}

int main(const int argc, char *argv[])
{
    struct dig_error    error = { "TABLE.sqlite TRAJECTORY OTHER_TRAJECTORY [SHARE]" };
    struct bench *const b     = calloc(1, sizeof *b);
    int                 rc    = 1;
    if (argc >= 4 && b != NULL && table_runs_read(argv[1], argv[2], &b->all, &error) == DIG_OK) {
        b->last  = argc > 4 ? atof(argv[4]) : 1.0;
        b->other = table_runs_trajectory(b->all.set, argv[3]);
        if (b->other < b->all.set->trajectories) {
            look_inside(b);
            look_beyond(b);
            rc = 0;
        }
    }
    if (rc != 0) {
        (void)fprintf(stderr, "outside: %s\n", error.text);
    }
    dig_curve_set_destroy(b != NULL ? b->all.set : NULL);
    free(b);
    return rc;
}
