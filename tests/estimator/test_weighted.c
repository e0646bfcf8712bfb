// Tests for estimator/match/weighted.c: the formula written out, and what it finds that the
// Euclidean norm of the moment does not

#include "estimator/match/weighted.h"

#include "estimator/match/entry_scatter.h"
#include "estimator/match/match.h"
#include "estimator/match/posterior.h"
#include "tests/estimator/random_dig.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

enum {
    POINTS   = DIG_CURVE_POINTS,
    BLOCKS   = DIG_COVARIANCE_BLOCKS,
    WIDE     = 32,
    PACKINGS = 3,
    MOST     = 3 * 3 * BLOCKS
};

static const struct made_options options = { .relative_sd = 0.15, .packings = PACKINGS };

static const double channels[3][3] = { { 1, DIG_POSTERIOR_MY_FX, DIG_POSTERIOR_MY_FZ },
                                       { DIG_POSTERIOR_MY_FX, 1, DIG_POSTERIOR_FX_FZ },
                                       { DIG_POSTERIOR_MY_FZ, DIG_POSTERIOR_FX_FZ, 1 } };

// What is compared of one trajectory: a number a block and channel, and D between all of them.
struct numbers {
    int    count;
    double miss[MOST], d[MOST][MOST];
};

// Of the points of one block that lie in halves measured whole; NaN where neither was.
static double mean_in(const struct dig_pooled *const group, const int block, const double of[],
                      const float also[])
{
    double sum = 0.0, points = 0.0;
    for (int half = 0; half < 2; half++) {
        const int from  = block * WIDE + half * WIDE / 2;
        bool      whole = true;
        for (int k = from; k < from + WIDE / 2; k++) {
            whole = whole && group->count[k] > 0.0;
        }
        for (int k = from; k < from + WIDE / 2 && whole; k++) {
            sum += of != NULL ? of[k] : (double)also[k];
            points += 1.0;
        }
    }
    return sum / points;
}

// Mean of the correlation of all pairs of points of two blocks, as entry_scatter.h has it.
static double assumed(const struct dig_trajectory *const t, const int one, const int other)
{
    const double whole_m = dig_trajectory_path_m(t, 0.09, dig_trajectory_duration_s(t));
    double       sum     = 0.0;
    for (int i = 0; i < WIDE; i++) {
        for (int j = 0; j < WIDE; j++) {
            const double away_m = whole_m * ((one - other) * WIDE + i - j) / 255.0;
            const double own =
                exp(-3.14159265358979 * pow(away_m / (DIG_ENTRY_SCATTER_WIDTH * 0.09), 2.0));
            sum +=
                (DIG_ENTRY_SCATTER_SHARED + (1.0 - DIG_ENTRY_SCATTER_SHARED) * own) / (WIDE * WIDE);
        }
    }
    return sum;
}

// Between two numbers of one dig, relative to the sizes of the curves: what packings show, drawn a
// quarter towards 0.95 of the mean along its diagonal, or what is assumed; 5 % is each one's own.
static double covariance_of(const struct dig_curve_set *const set, const size_t trajectory,
                            const int one, const int other, const double relative_sd)
{
    const struct dig_trajectory t = made_trajectory((enum made_trajectory)trajectory);
    if (set->covariance == NULL) {
        return relative_sd * relative_sd * channels[one / BLOCKS][other / BLOCKS] *
               assumed(&t, one % BLOCKS, other % BLOCKS) * (one == other ? 1.0 : 0.95);
    }
    const struct dig_covariance *const c = &set->covariance[trajectory];
    if (one == other) {
        return c->of[one][one];
    }
    const int lag = other % BLOCKS - one % BLOCKS;
    double    sum = 0.0, n = 0.0;
    for (int i = one / BLOCKS * BLOCKS; i < (one / BLOCKS + 1) * BLOCKS; i++) {
        const int j = other / BLOCKS * BLOCKS + i % BLOCKS + lag;
        if (i % BLOCKS + lag >= 0 && i % BLOCKS + lag < BLOCKS) {
            sum += c->of[i][j] / sqrt(c->of[i][i] * c->of[j][j]);
            n += 1.0;
        }
    }
    const double scale = sqrt(c->of[one][one] * c->of[other][other]);
    return 0.95 * (0.75 * c->of[one][other] + 0.25 * 0.95 * sum / n * scale);
}

// Appends those of one trajectory; what belongs to others is not correlated with them.
static void append(const struct dig_curve_set *const set, const size_t entry,
                   const struct dig_pooled *const group, const double relative_sd,
                   const size_t nearest, struct numbers *const all)
{
    const struct dig_curve *const near =
        &set->curve[nearest * MADE_TRAJECTORIES + group->trajectory];
    const struct dig_curve *const c = &set->curve[entry * MADE_TRAJECTORIES + group->trajectory];
    const double *const measured[]  = { group->mean_Nm, group->force_N[0], group->force_N[1] };
    const double *const noise2[]    = { group->sigma2_Nm2, group->force_sigma2_N2[0],
                                        group->force_sigma2_N2[1] };
    const int           from        = all->count;
    int                 which[MOST];
    double dig2[MOST], noise2_of[MOST], together[MOST], square[3] = { 0 }, squares[3] = { 0 };
    double scale[MOST];
    for (int w = 0; w < (group->forces ? 3 : 1) * BLOCKS; w++) {
        const int    i = w / BLOCKS, b = w % BLOCKS;
        const double x    = mean_in(group, b, measured[i], NULL);
        double       size = 0.0, one[POINTS], noise[POINTS];
        if (isnan(x)) {
            continue;
        }
        for (int o = 0; o < BLOCKS; o++) {
            double sum = 0.0;
            for (int k = o * WIDE; k < (o + 1) * WIDE; k++) {
                sum += (double)near->mean[i][k] / WIDE;
            }
            size += sum * sum / BLOCKS;
        }
        for (int k = 0; k < POINTS; k++) {
            one[k] = 1.0 / group->count[k];
        }
        // Of one dig, so that each half counts its own number of digs.
        for (int k = 0; k < POINTS; k++) {
            const int half = k / (WIDE / 2) * (WIDE / 2);
            double    mean = 0.0;
            for (int m = half; m < half + WIDE / 2; m++) {
                mean += one[m] / (WIDE / 2);
            }
            noise[k] = mean * noise2[i][k];
        }
        const int    n    = all->count++;
        const double own2 = covariance_of(set, group->trajectory, w, w, relative_sd);
        which[n]          = w;
        scale[n]          = sqrt(size * own2 * (mean_in(group, b, one, NULL) + 1.0 / PACKINGS) +
                                 mean_in(group, b, noise, NULL)) /
                   sqrt(own2);
        all->miss[n] = x - mean_in(group, b, NULL, c->mean[i]);
        dig2[n]      = own2 * mean_in(group, b, one, NULL);
        noise2_of[n] = mean_in(group, b, noise, NULL);
        square[i] += x * x;
        squares[i] += 1.0;
    }
    // What was measured wrong goes together with nothing; of digs as large as those measured.
    for (int n = from; n < all->count; n++) {
        const int    i   = which[n] / BLOCKS;
        const double own = dig2[n] * square[i] / squares[i];
        together[n]      = sqrt(own / (own + noise2_of[n]));
    }
    for (int n = from; n < all->count; n++) {
        for (int o = from; o < all->count; o++) {
            all->d[n][o] = scale[n] * scale[o] * (n == o ? 1.0 : together[n] * together[o]) *
                           covariance_of(set, group->trajectory, which[n], which[o], relative_sd);
        }
    }
}

// q, by Gauss' elimination.
static double eliminate(struct numbers *const a)
{
    double right[MOST], q = 0.0;
    memcpy(right, a->miss, sizeof right);
    for (int i = 0; i < a->count; i++) {
        for (int r = i + 1; r < a->count; r++) {
            const double by = a->d[r][i] / a->d[i][i];
            for (int c = i; c < a->count; c++) {
                a->d[r][c] -= by * a->d[i][c];
            }
            right[r] -= by * right[i];
        }
    }
    for (int i = a->count - 1; i >= 0; i--) {
        for (int c = i + 1; c < a->count; c++) {
            right[i] -= a->d[i][c] * right[c];
        }
        right[i] /= a->d[i][i];
        q += a->miss[i] * right[i];
    }
    return q;
}

static struct dig_weighted by_hand(const struct dig_curve_set *const set,
                                   const struct dig_pool_sums *const sums, const double relative_sd,
                                   const size_t nearest)
{
    struct numbers *const all   = calloc(1, sizeof *all);
    struct dig_weighted   best  = { .entry = -1 };
    double                least = INFINITY;
    for (size_t e = 0; e < set->entries; e++) {
        bool dug = true;
        memset(all, 0, sizeof *all);
        for (size_t g = 0; g < sums->groups; g++) {
            dug = dug && set->packings[e * MADE_TRAJECTORIES + sums->group[g].trajectory] > 0;
            append(set, e, &sums->group[g], relative_sd, nearest, all);
        }
        const double q = eliminate(all);
        if (dug && q < least) {
            least = q;
            best  = (struct dig_weighted){ (int)e, sqrt(q / all->count) };
        }
    }
    free(all);
    return best;
}

// With a summary and without, the same to the last bit.
static struct dig_weighted find(const struct dig_curve_set *const set,
                                const struct dig_pool_sums *const sums, const size_t nearest)
{
    struct dig_outline *const outline = calloc(dig_prefilter_outlines(set), sizeof *outline);
    struct dig_prefilter      summary;
    dig_prefilter_make(set, outline, &summary);
    const struct dig_weighted by    = dig_weighted_find(set, &summary, sums, nearest);
    const struct dig_weighted plain = dig_weighted_find(set, NULL, sums, nearest);
    free(outline);
    assert_int_equal(by.entry, plain.entry);
    assert_memory_equal(&by.distance, &plain.distance, sizeof by.distance);
    return by;
}

// Of packings: of errors that are sums of a common one and of neighbours', at 200 degrees of
// freedom.
static struct dig_covariance *learnt(uint64_t *const seed)
{
    enum { DIGS = 200, N = DIG_COVARIANCE_NUMBERS };
    struct dig_covariance *const c = calloc(MADE_TRAJECTORIES, sizeof *c);
    for (int t = 0; t < MADE_TRAJECTORIES; t++) {
        c[t].freedom = DIGS;
        for (int dig = 0; dig < DIGS; dig++) {
            const double shared = 0.1 * model_normal(seed);
            double       error[N], last = 0.0;
            for (int i = 0; i < N; i++) {
                last     = 0.5 * last + (0.05 + 0.01 * (i % 5)) * model_normal(seed);
                error[i] = last + (i / BLOCKS == 1 ? -shared : shared);
            }
            for (int i = 0; i < N; i++) {
                for (int j = 0; j < N; j++) {
                    c[t].of[i][j] += error[i] * error[j] / DIGS;
                }
            }
        }
    }
    return c;
}

static void it_is_the_formula_written_out(void **state)
{
    (void)state;
    struct dig_curve_set *const set                       = made_table(&options);
    uint64_t                    seed                      = 17;
    int                         found                     = 0;
    set->packings[11 * MADE_TRAJECTORIES + MADE_SIMPLE_A] = 0; // a hole
    for (int trial = 0; trial < 24; trial++) {
        if (trial == 12) {
            set->covariance = learnt(&seed);
        }
        const struct dig_gravel gravel = trial % 3 == 0 ? set->gravel[11] : random_gravel(&seed);
        struct dig_observation  dig[3];
        const size_t            digs = 1 + (size_t)trial % 3;
        for (size_t d = 0; d < digs; d++) {
            dig[d]       = make_dig(&gravel, (enum made_trajectory)((d + (size_t)trial) % 2),
                                    trial % 4 < 2, &seed);
            dig[d].first = trial % 5 == 0 ? 0.1 + 0.1 * (double)d : 0.0;
            dig[d].last  = trial % 7 == 0 ? 0.6 : 1.0;
        }
        struct dig_pool_sums sums;
        dig_pool_sum(digs, dig, &sums);
        const size_t              nearest  = 12 + (size_t)trial;
        const struct dig_weighted expected = by_hand(set, &sums, 0.15, nearest);
        const struct dig_weighted is       = find(set, &sums, nearest);
        assert_int_equal(is.entry, expected.entry);
        assert_close(is.distance, expected.distance, 1e-6 * expected.distance);

        struct dig_match match = { .valid = true, .nearest = (int)nearest };
        dig_match_find_weighted(set, NULL, digs, dig, &match);
        assert_int_equal(match.weighted, is.entry);
        assert_close(match.weighted_distance, is.distance, 0.0);
        assert_int_equal(match.nearest, nearest);
        found += is.entry >= 0 ? 1 : 0;
    }
    assert_int_equal(found, 24);
    free(set->covariance);
    set->covariance = NULL;
    made_table_destroy(set);
}

// Moments that are alike, pushes that are not: the moment alone cannot tell two entries apart.
static void what_the_forces_tell_counts(void **state)
{
    (void)state;
    struct dig_curve_set *const set  = made_table(&options);
    uint64_t                    seed = 3;
    const size_t                one = 5, other = 34; // looked at before the others
    for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
        struct dig_curve *const like = &set->curve[other * MADE_TRAJECTORIES + t];
        *like                        = set->curve[one * MADE_TRAJECTORIES + t];
        for (int k = 0; k < POINTS; k++) {
            like->mean[1][k] *= 1.6F;
        }
    }
    for (size_t slot = 0; slot < set->entries * MADE_TRAJECTORIES; slot++) {
        const size_t entry  = slot / MADE_TRAJECTORIES;
        set->packings[slot] = entry == one || entry == other ? PACKINGS : 0;
    }
    for (int trial = 0; trial < 20; trial++) {
        struct dig_observation dig = make_dig(&set->gravel[one], MADE_SIMPLE_A, true, &seed);
        for (int k = 0; k < POINTS; k++) {
            dig.force_N[0][k] *= trial % 2 == 0 ? 1.6 : 1.0;
        }
        struct dig_match match = { .valid = true, .nearest = (int)one };
        dig_match_find_weighted(set, NULL, 1, &dig, &match);
        assert_int_equal(match.weighted, trial % 2 == 0 ? other : one);
        dig.forces    = false;
        match.nearest = (int)other;
        dig_match_find_weighted(set, NULL, 1, &dig, &match);
        assert_int_equal(match.weighted, one); // the first of two that are equal
    }
    made_table_destroy(set);
}

// An entry that is known from one packing alone, and nearly as near: were its own D taken, it would
// be nearer, in what digs may be off it.
static void who_is_known_worst_is_not_the_nearest_to_all(void **state)
{
    (void)state;
    struct dig_curve_set *const set = made_table(&options);
    enum { WORST = 20, OWN = 31 };
    for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
        struct dig_curve *const like = &set->curve[WORST * MADE_TRAJECTORIES + t];
        *like                        = set->curve[OWN * MADE_TRAJECTORIES + t];
        for (int k = 0; k < POINTS; k++) {
            for (int c = 0; c < 3; c++) {
                like->mean[c][k] *= 1.05F; // the digs are 1.02 of its own
            }
        }
        set->packings[WORST * MADE_TRAJECTORIES + t] = 1;
        set->packings[OWN * MADE_TRAJECTORIES + t]   = 40;
    }
    for (int forces = 0; forces < 2; forces++) {
        struct dig_observation dig   = made_observation(&set->gravel[OWN], MADE_SIMPLE_A, 0.0);
        struct dig_match       match = { .valid = true, .nearest = WORST };
        dig.forces                   = forces == 1;
        for (int k = 0; k < POINTS; k++) {
            dig.moment_Nm[k] *= 1.02;
            dig.force_N[0][k] = -8.0 * dig.moment_Nm[k];
            dig.force_N[1][k] = 5.0 * dig.moment_Nm[k];
        }
        dig_match_find_weighted(set, NULL, 1, &dig, &match);
        assert_int_equal(match.weighted, OWN);
    }
    made_table_destroy(set);
}

static void where_nothing_can_be_compared_no_entry_is_told(void **state)
{
    (void)state;
    struct dig_curve_set *const set   = made_table(&options);
    uint64_t                    seed  = 4;
    struct dig_match            match = { .valid = true };
    struct dig_observation      dig   = make_dig(&set->gravel[3], MADE_SIMPLE_A, true, &seed);
    dig.first                         = 0.5;
    dig.last                          = 0.55; // less than a block, or parts of two
    dig_match_find_weighted(set, NULL, 1, &dig, &match);
    assert_int_equal(match.weighted, -1);
    assert_true(isnan(match.weighted_distance));

    made_table_destroy(set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(it_is_the_formula_written_out),
        cmocka_unit_test(what_the_forces_tell_counts),
        cmocka_unit_test(who_is_known_worst_is_not_the_nearest_to_all),
        cmocka_unit_test(where_nothing_can_be_compared_no_entry_is_told),
    };
    return cmocka_run_group_tests_name("weighted", tests, NULL, NULL);
}
