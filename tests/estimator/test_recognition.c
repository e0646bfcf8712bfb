// Tests for what the estimator recognises of a dig: what the bucket does (estimator/track/motion.c,
// phase.c), which trajectory it digs, how far it gets and how it ends (track.c, window.c, ending.c,
// abort_detection.c). Digs of tables/reference_rig.sqlite, each in another bed, dug in eleven ways.
//
// A third of the digs is dug in one way each; DIG_TEST_ALL=1: all in all ways, some minutes.
// DIG_TEST_BED=1: in each gravel's second bed, with which nothing was chosen.

#include "tables/store.h"
#include "tests/estimator/dug.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

static const struct dug_way ways[] = {
    { .name = "as it stands", .loud = 1, .pace = 1, .until = 1 },
    { .name = "loud", .loud = 3, .pace = 1, .until = 1 },
    { .name = "slow", .loud = 1, .pace = 0.5, .until = 1 },
    { .name = "fast", .loud = 1, .pace = 2, .until = 1 },
    { .name = "paused", .loud = 1, .pace = 1, .pause_s = 6, .until = 1 },
    { .name = "hesitating", .loud = 1, .pace = 1, .hesitations = 6, .until = 1 },
    { .name = "unsteady", .loud = 1, .pace = 1, .wobble_m = 0.001, .until = 1 },
    { .name        = "all of it",
      .loud        = 2,
      .pace        = 0.7,
      .pause_s     = 3,
      .hesitations = 4,
      .wobble_m    = 0.0007,
      .until       = 1 },
    { .name = "partial", .loud = 1, .pace = 1, .from = 0.12, .until = 0.7 },
    { .name = "aborted", .loud = 1, .pace = 1, .until = 0.5 },
    { .name = "aborted, full", .loud = 1, .pace = 1, .until = 0.6, .carries = true },
};
enum { WAYS = sizeof ways / sizeof ways[0] };

enum { DIGS_MAX = 256 };

// What was told of the digs of one way.
struct result {
    struct dug_matrix matrix;
    size_t            digs;
    size_t            told[MADE_TRAJECTORIES][MADE_TRAJECTORIES + 1]; // truth by told; last: none
    size_t            whole[MADE_TRAJECTORIES];                       // told to the end
    size_t            ended[MADE_TRAJECTORIES][3];                    // by enum dig_ending
    double            beyond[MADE_TRAJECTORIES]; // progress by which too much was told, at most
};

struct digs {
    int             bed;
    size_t          count;
    struct dug_soil soil[DIGS_MAX];
    struct result   result[WAYS];
};

// One bed of each gravel, along each trajectory.
static enum dig_status keep(void *const context, const struct dig_run *const run,
                            struct dig_error *const error)
{
    (void)error;
    struct digs *const digs = context;
    if ((int)run->origin.packing != digs->bed || run->origin.effect[0] != '\0' ||
        !dig_approach_is_plain(&run->origin.approach)) {
        return DIG_OK;
    }
    assert_true(digs->count < DIGS_MAX);
    float *const moment_Nm = malloc(run->windows * sizeof *moment_Nm);
    assert_non_null(moment_Nm);
    memcpy(moment_Nm, run->value, run->windows * sizeof *moment_Nm);
    digs->soil[digs->count++] = (struct dug_soil){
        .which     = (enum made_trajectory)run->origin.trajectory,
        .windows   = run->windows,
        .first_s   = run->first_s,
        .step_s    = run->step_s,
        .moment_Nm = moment_Nm,
    };
    return DIG_OK;
}

static void dig_one(struct digs *const digs, const size_t index, const size_t way)
{
    const struct dug_soil *const soil   = &digs->soil[index];
    struct result *const         result = &digs->result[way];
    struct dug_end               end;
    dug_dig(soil, &ways[way], 1 + index * WAYS + way, &result->matrix, &end);
    assert_true(end.digs <= 1);
    result->digs++;
    result->ended[soil->which][end.ending]++;
    if (end.digs == 0) {
        result->told[soil->which][MADE_TRAJECTORIES]++;
        if (end.ending == DIG_ENDING_ABORTED) {
            assert_int_equal(end.trajectory, soil->which);
            assert_close(end.last, ways[way].until, 0.03);
        }
        return;
    }
    result->told[soil->which][end.trajectory]++;
    result->whole[soil->which] += end.last > 0.95 ? 1 : 0;
    result->beyond[soil->which] = fmax(result->beyond[soil->which], end.last - ways[way].until);
}

static int dig_all(void **state)
{
    static struct digs digs;
    struct dig_store  *store = NULL;
    if (dig_store_open("tables/reference_rig.sqlite", &store, NULL) != DIG_OK) {
        return -1;
    }
    digs.bed = getenv("DIG_TEST_BED") != NULL ? 1 : 0;
    const enum dig_status status =
        dig_store_walk(store, &(struct dig_run_visitor){ keep, &digs }, NULL);
    dig_store_close(store);
    if (status != DIG_OK) {
        return -1;
    }
    const bool   all  = getenv("DIG_TEST_ALL") != NULL;
    const size_t step = all ? 1 : test_is_quick() ? 7 : 2;
    for (size_t i = 0; i < digs.count; i += step) {
        for (size_t way = 0; way < WAYS; way++) {
            if (all || way == i / step % WAYS) {
                dig_one(&digs, i, way);
            }
        }
    }
    *state = &digs;
    return 0;
}

// Of the samples away from borders; contact is the beginning of penetration.
static double right(const struct dug_matrix *const m, const enum dug_truth truth)
{
    static const enum dug_told as[DUG_TRUTHS] = {
        [DUG_AIR] = DUG_TOLD_AIR,   [DUG_PENETRATION] = DUG_TOLD_PENETRATION,
        [DUG_DRAG] = DUG_TOLD_DRAG, [DUG_CURL] = DUG_TOLD_CURL,
        [DUG_LIFT] = DUG_TOLD_LIFT,
    };
    return dug_share(m, truth, as[truth]) +
           (truth == DUG_PENETRATION ? dug_share(m, truth, DUG_TOLD_CONTACT) : 0.0);
}

static const enum dug_truth judged[] = { DUG_AIR, DUG_PENETRATION, DUG_DRAG, DUG_CURL, DUG_LIFT };
enum { JUDGED = sizeof judged / sizeof judged[0] };

TEST(what_the_bucket_does_is_told_however_it_is_dug)
{
    const struct digs *const digs = *fixture;
    print_message("%% right         air  penetr.   drag    curl    lift\n");
    for (size_t w = 0; w < WAYS; w++) {
        const struct dug_matrix *const m = &digs->result[w].matrix;
        print_message("%-14s", ways[w].name);
        for (size_t k = 0; k < JUDGED; k++) {
            if (dug_samples(m, judged[k]) < 100) {
                print_message("       -");
                continue;
            }
            print_message(" %7.2f", 100.0 * right(m, judged[k]));
            assert_true(right(m, judged[k]) > (judged[k] == DUG_AIR ? 0.999 : 0.9));
        }
        print_message("\n");
    }
}

TEST(what_the_bucket_does_is_told_away_from_borders)
{
    const struct digs *const digs = *fixture;
    static struct dug_matrix all;
    for (size_t w = 0; w < WAYS; w++) {
        dug_add(&all, &digs->result[w].matrix);
    }
    dug_print(&all);
    for (size_t k = 0; k < JUDGED; k++) {
        assert_true(right(&all, judged[k]) > 0.95);
    }
}

// Never another than it was; "none" where it can be two (simpleB and actual begin alike) or none.
TEST(which_trajectory_is_dug_is_told_or_left_open)
{
    const struct digs *const digs                     = *fixture;
    static const char *const names[MADE_TRAJECTORIES] = { "simpleA", "simpleB", "actual" };
    print_message("%-14s %-9s  simpleA  simpleB  actual  none  to the end\n", "", "");
    for (size_t w = 0; w < WAYS; w++) {
        const struct result *const r = &digs->result[w];
        for (int t = 0; t < MADE_TRAJECTORIES; t++) {
            print_message("%-14s %-9s  %7zu  %7zu  %6zu  %4zu  %10zu\n", ways[w].name, names[t],
                          r->told[t][0], r->told[t][1], r->told[t][2], r->told[t][3], r->whole[t]);
            for (int told = 0; told < MADE_TRAJECTORIES; told++) {
                assert_true(told == t || r->told[t][told] == 0);
            }
            if (ways[w].until >= 1.0) {
                assert_true(20 * r->told[t][MADE_TRAJECTORIES] <= r->told[t][t]);
            }
        }
    }
}

TEST(what_is_given_up_is_never_told_as_dug_to_the_end)
{
    const struct digs *const digs = *fixture;
    for (size_t w = 0; w < WAYS; w++) {
        const struct result *const r = &digs->result[w];
        for (int t = 0; t < MADE_TRAJECTORIES; t++) {
            if (ways[w].until < 1.0) {
                assert_int_equal(r->whole[t], 0);
                assert_true(r->beyond[t] < 0.03);
            }
        }
    }
}

// Light gravel is not felt to the end of every dig, which is then told neither way, nor is what is
// given up while it can be two.
TEST(how_a_dig_ended_is_told_or_left_open)
{
    const struct digs *const digs                     = *fixture;
    static const char *const names[MADE_TRAJECTORIES] = { "simpleA", "simpleB", "actual" };
    print_message("%-14s %-9s  not told  whole  aborted\n", "", "");
    for (size_t w = 0; w < WAYS; w++) {
        const struct result *const r = &digs->result[w];
        for (int t = 0; t < MADE_TRAJECTORIES; t++) {
            const size_t *const n = r->ended[t];
            print_message("%-14s %-9s  %8zu  %5zu  %7zu\n", ways[w].name, names[t],
                          n[DIG_ENDING_OPEN], n[DIG_ENDING_WHOLE], n[DIG_ENDING_ABORTED]);
            if (ways[w].until < 1.0) {
                assert_int_equal(n[DIG_ENDING_WHOLE], 0);
                assert_true(t != MADE_ACTUAL || n[DIG_ENDING_OPEN] == 0);
                assert_true(t != MADE_SIMPLE_A || 20 * n[DIG_ENDING_OPEN] <= n[DIG_ENDING_ABORTED]);
            } else {
                assert_int_equal(n[DIG_ENDING_ABORTED], 0);
            }
        }
    }
}

TESTS_WITH(dig_all, NULL)
