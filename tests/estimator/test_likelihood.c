// Test for estimator/match/likelihood.c: the formula written out

#include "estimator/match/likelihood.h"

#include "estimator/match/entry_scatter.h"
#include "tests/estimator/random_dig.h"
#include "tests/testlib.h"

enum { POINTS = DIG_CURVE_POINTS, PACKINGS = 3 };

static const struct made_options options = { .relative_sd = 0.15, .packings = PACKINGS };

// The oracle, of an entry of the table itself: what likelihood.h says, D inverted by its cofactors.
static double log_by_hand(const struct dig_curve_set *const set, const size_t entry,
                          const struct dig_pooled *const group)
{
    const double sign[3][3]         = { { 1, DIG_ENTRY_SCATTER_MY_FX, DIG_ENTRY_SCATTER_MY_FZ },
                                        { DIG_ENTRY_SCATTER_MY_FX, 1, DIG_ENTRY_SCATTER_FX_FZ },
                                        { DIG_ENTRY_SCATTER_MY_FZ, DIG_ENTRY_SCATTER_FX_FZ, 1 } };
    const struct dig_curve *const c = &set->curve[entry * MADE_TRAJECTORIES + group->trajectory];
    const int                     n = group->forces ? 3 : 1;
    double                        mean2[3] = { 0.0 }, points = 0.0;
    for (int k = 0; k < POINTS; k++) {
        points += group->count[k] > 0.0 ? 1.0 : 0.0;
        for (int i = 0; i < n && group->count[k] > 0.0; i++) {
            mean2[i] += pow((double)c->mean[i][k], 2.0);
        }
    }
    double sum = 0.0;
    for (int k = 0; k < POINTS; k++) {
        if (!(group->count[k] > 0.0)) {
            continue;
        }
        const double m[3]      = { group->mean[0][k], group->mean[1][k], group->mean[2][k] };
        const double sigma2[3] = { group->sigma2[0][k], group->sigma2[1][k], group->sigma2[2][k] };
        double       miss[3], spread[3], d[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
        for (int i = 0; i < n; i++) {
            // Made with one relative spread everywhere: it is the pooled one, too.
            const double t2 = pow((double)c->mean[i][k], 2.0);
            const double w  = 4.0 / (4.0 + PACKINGS - 1.0);
            const double s2 = (1.0 - w) * pow((double)c->sd[i][k], 2.0) + w * 0.15 * 0.15 * t2 +
                              pow(0.15 / 4.0, 2.0) * mean2[i] / points;
            miss[i]   = m[i] - (double)c->mean[i][k];
            spread[i] = sqrt(s2 * (1.0 / group->count[k] + 1.0 / PACKINGS));
        }
        for (int i = 0; i < n; i++) {
            for (int j = 0; j < n; j++) {
                d[i][j] = sign[i][j] * spread[i] * spread[j];
            }
            d[i][i] += sigma2[i] / group->count[k];
        }
        double determinant = 0.0, squares = 0.0;
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                const int    a = (i + 1) % 3, b = (i + 2) % 3, e = (j + 1) % 3, f = (j + 2) % 3;
                const double cofactor = d[a][e] * d[b][f] - d[a][f] * d[b][e];
                determinant += i == 0 ? d[0][j] * cofactor : 0.0;
                squares += i < n && j < n ? miss[i] * miss[j] * cofactor : 0.0;
            }
        }
        sum += squares / determinant + log(determinant);
    }
    const struct dig_trajectory t = made_trajectory((enum made_trajectory)group->trajectory);
    const double whole_m          = dig_trajectory_path_m(&t, 0.09, dig_trajectory_duration_s(&t));
    const double effective        = (points - 1.0) / 255.0 * whole_m / (0.25 * 0.09);
    return -0.5 * effective * sum / points;
}

TEST(it_is_the_formula_written_out)
{
    struct dig_curve_set *const set  = made_table(&options);
    uint64_t                    seed = 31;
    for (int trial = 0; trial < 40; trial++) {
        const enum made_trajectory along  = (enum made_trajectory)(trial % 3);
        const struct dig_gravel    gravel = random_gravel(&seed);
        struct dig_observation     dig[3];
        for (int d = 0; d < 3; d++) {
            dig[d]       = make_dig(&gravel, along, trial % 2 == 0, &seed);
            dig[d].first = trial % 5 == 0 ? 0.2 * d : 0.0;
            dig[d].last  = trial % 7 == 0 ? 0.9 : 1.0;
        }
        struct dig_pool_sums sums;
        dig_pool_sum(1 + (size_t)trial % 3, dig, &sums);
        struct dig_likelihood likelihood;
        dig_likelihood_make(set, &sums.group[0], &likelihood);
        for (size_t e = 0; e < set->entries; e += 5) {
            struct dig_cell cell;
            assert_int_equal(dig_cell_find(set, &set->gravel[e], (size_t)along, &cell), DIG_OK);
            const double expected = log_by_hand(set, e, &sums.group[0]);
            assert_close(dig_likelihood_log(&likelihood, &cell), expected,
                         1e-6 * (1.0 + fabs(expected)));
        }
    }
    made_table_destroy(set);
}

// The oracle: every friction is tried, each as likely as a normal number is, and the digs are
// compared with that friction taken off.
TEST(what_friction_of_a_drive_adds_is_one_number_for_all_points)
{
    struct dig_curve_set *const set  = made_table(&options);
    uint64_t                    seed = 33;
    for (int trial = 0; trial < 6; trial++) {
        const struct dig_gravel gravel = random_gravel(&seed);
        struct dig_observation  dig    = make_dig(&gravel, MADE_SIMPLE_A, trial % 2 == 0, &seed);
        for (int k = 0; k < POINTS; k++) { // the rod turns about
            const double way                                 = k < 150 ? 1.0 : -1.0;
            dig.rubs[DIG_JOINT_BUCKET][DIG_CHANNEL_MY_Nm][k] = (float)(0.05 * way);
            dig.rubs[DIG_JOINT_BUCKET][DIG_CHANNEL_FX_N][k]  = (float)(-0.3 * way);
            dig.rubs[DIG_JOINT_BUCKET][DIG_CHANNEL_FZ_N][k]  = (float)(0.1 * k / POINTS);
            dig.moment_Nm[k] += 2.0 * 0.05 * way;
            dig.sigma_Nm[k]         = hypot(dig.sigma_Nm[k], 0.05);
            dig.force_sigma_N[0][k] = hypot(dig.force_sigma_N[0][k], 0.3);
            dig.force_sigma_N[1][k] = hypot(dig.force_sigma_N[1][k], 0.1 * k / POINTS);
        }
        struct dig_pool_sums  sums;
        struct dig_likelihood likelihood;
        struct dig_cell       cell;
        const size_t          e = (size_t)(7 * trial);
        dig_pool_sum(1, &dig, &sums);
        dig_likelihood_make(set, &sums.group[0], &likelihood);
        assert_int_equal(dig_cell_find(set, &set->gravel[e], MADE_SIMPLE_A, &cell), DIG_OK);

        enum { STEPS = 1600 };
        static struct dig_pooled off;
        const double             width = 16.0, step  = width / STEPS;
        double                   log_of[STEPS], most = -INFINITY, sum = 0.0;
        for (int i = 0; i < STEPS; i++) {
            const double rubs = step * (i + 0.5) - 0.5 * width;
            off               = sums.group[0];
            for (int k = 0; k < POINTS; k++) {
                for (int c = 0; c < (off.forces ? 3 : 1); c++) {
                    const double v = (double)dig.rubs[DIG_JOINT_BUCKET][c][k];
                    off.mean[c][k] -= rubs * v;
                }
            }
            log_of[i] = log_by_hand(set, e, &off) - 0.5 * rubs * rubs;
            most      = fmax(most, log_of[i]);
        }
        for (int i = 0; i < STEPS; i++) {
            sum += step * exp(log_of[i] - most) / sqrt(2.0 * 3.14159265358979);
        }
        const double expected = most + log(sum);
        assert_close(dig_likelihood_log(&likelihood, &cell), expected,
                     1e-5 * (1.0 + fabs(expected)));
    }
    made_table_destroy(set);
}
