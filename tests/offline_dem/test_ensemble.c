// The DEM against another code, by ensembles: phase means of moment and force over beds of ours and
// of LIGGGHTS. A single dig is chaotic, so means are compared with their standard errors.
//
//                 ours                                  LIGGGHTS'
//   on the grid   tables/reference_rig.sqlite                     tests/data/reference, but for
//   .5/.0, whose
//                                                       rolling friction lies outside the grid
//   off the grid  tests/data/liggghts_more/ours         tests/data/liggghts_more
//   with an       the same                              the same, and tests/data/liggghts_digs
//   effect
//
// Cohesion acts at LIGGGHTS' walls, too: of 2e5 J/m3, above what a wall's springs bear, it is
// another bed there and left out. Its rock has edges. Small beds of clumps, and many of them:
// test_small_digs.
//
// For every case, trajectory, phase and channel
//   |ours - LIGGGHTS| <= max(10 % of the case's largest phase mean, 2 standard errors of the
//   difference)
// and the signed differences, each over its case's largest phase mean, average to at most 5 %.
// Where a code has fewer than four beds, the spread of one of its digs is taken from the three
// gravels that have enough, in shares of the largest phase mean.

#include "tests/offline_dem/phase_means.h"
#include "tests/testlib.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define BEDS_ENOUGH  4 // for a spread of its own
#define BEDS_MAX     5 // files looked for
#define TRAJECTORIES 2

static const char *const trajectory_name[TRAJECTORIES] = { "simpleA", "actual" };

#define REFERENCE "tests/data/reference/"

/// A gravel, or one with an effect of a table of effects. Files: "[_seedN]__trajectory.csv" behind
/// the name; the first bed has no number.
struct pair {
    double      friction, rolling, density_kgpm3;
    const char *table, *file;
    int         ours_least, theirs_least; // beds
    const char *effect;                   // NULL: none
    double      magnitude;
};

#define RIG  "tables/reference_rig.sqlite"
#define MORE "tests/data/liggghts_more/"
#define OURS "tests/data/liggghts_more/ours/"
#define DIGS "tests/data/liggghts_digs/"

static const struct pair pair[] = {
    { 0.3, 0.3, 2500.0, RIG, REFERENCE "mu0.3_mur0.3_rho2500", 10, 4, NULL, 0.0 },
    { 0.5, 0.5, 2500.0, RIG, REFERENCE "mu0.5_mur0.5_rho2500", 10, 5, NULL, 0.0 },
    { 0.9, 0.9, 2500.0, RIG, REFERENCE "mu0.9_mur0.9_rho2500", 10, 4, NULL, 0.0 },
    { 0.3, 0.9, 2500.0, RIG, REFERENCE "mu0.3_mur0.9_rho2500", 2, 1, NULL, 0.0 },
    { 0.5, 0.9, 2500.0, RIG, REFERENCE "mu0.5_mur0.9_rho2500", 2, 1, NULL, 0.0 },
    { 0.9, 0.3, 2500.0, RIG, REFERENCE "mu0.9_mur0.3_rho2500", 2, 1, NULL, 0.0 },
    { 0.5, 0.5, 4000.0, RIG, REFERENCE "mu0.5_mur0.5_rho4000", 2, 1, NULL, 0.0 },
    { 0.35, 0.6, 3500.0, OURS "gravels.sqlite", MORE "mu0.35_mur0.6_rho3500", 6, 2, NULL, 0.0 },
    { 0.4, 0.4, 2000.0, OURS "gravels.sqlite", MORE "mu0.4_mur0.4_rho2000", 6, 2, NULL, 0.0 },
    { 0.4, 0.6, 2000.0, OURS "gravels.sqlite", MORE "mu0.4_mur0.6_rho2000", 6, 1, NULL, 0.0 },
    { 0.6, 0.6, 2200.0, OURS "gravels.sqlite", MORE "mu0.6_mur0.6_rho2200", 6, 1, NULL, 0.0 },
    { 0.6, 0.8, 3000.0, OURS "gravels.sqlite", MORE "mu0.6_mur0.8_rho3000", 6, 2, NULL, 0.0 },
    { 0.8, 0.4, 1700.0, OURS "gravels.sqlite", MORE "mu0.8_mur0.4_rho1700", 6, 2, NULL, 0.0 },
    { 0.5, 0.5, 2500.0, OURS "slope.sqlite", MORE "slope_up", 6, 1, NULL, 0.0 },
    { 0.5, 0.5, 2500.0, OURS "rock.sqlite", MORE "obstacle", 6, 1, NULL, 0.0 },
    { 0.5, 0.5, 2500.0, OURS "effects.sqlite", DIGS "poly", 6, 1, "polydispersity", 1.6666667 },
    { 0.5, 0.5, 2500.0, OURS "effects.sqlite", MORE "cohesion_all", 6, 2, "cohesion", 1e5 },
};
#define PAIRS (sizeof pair / sizeof pair[0])

struct both {
    struct phase_means ours, theirs;
};

static struct both           both[PAIRS][TRAJECTORIES];
static struct dig_trajectory trajectory[TRAJECTORIES];

static bool is_pair(const struct pair *const p, const struct dig_run_origin *const o)
{
    return fabs(o->gravel.value[DIG_AXIS_FRICTION] - p->friction) < 1e-9 &&
           fabs(o->gravel.value[DIG_AXIS_ROLLING] - p->rolling) < 1e-9 &&
           fabs(o->gravel.value[DIG_AXIS_DENSITY_kgpm3] - p->density_kgpm3) < 1e-6 &&
           strcmp(o->effect, p->effect == NULL ? "" : p->effect) == 0 &&
           fabs(o->magnitude - p->magnitude) <= 1e-9 * p->magnitude;
}

/// The table that is read, and its trajectories.
struct reading {
    const char           *table;
    struct dig_trajectory trajectory[DIG_TRAJECTORY_MAX];
};

static enum dig_status visit_run(void *const context, const struct dig_run *const run,
                                 struct dig_error *const error)
{
    (void)error;
    const struct reading *const reading = context;
    const char *const           name    = reading->trajectory[run->origin.trajectory].name;
    for (size_t g = 0; g < PAIRS; g++) {
        for (int k = 0; k < TRAJECTORIES; k++) {
            if (strcmp(pair[g].table, reading->table) == 0 && is_pair(&pair[g], &run->origin) &&
                strcmp(name, trajectory_name[k]) == 0) {
                phase_means_add_run(&both[g][k].ours, &trajectory[k], run);
            }
        }
    }
    return DIG_OK;
}

static void read_table(const char *const path)
{
    struct dig_store *store = NULL;
    struct dig_error  error = { "" };
    assert_ok(dig_store_open(path, &store, &error), error);
    size_t                             count   = 0;
    const struct dig_trajectory *const t       = dig_store_trajectories(store, &count);
    struct reading                     reading = { .table = path };
    memcpy(reading.trajectory, t, count * sizeof *t);
    for (size_t i = 0; i < count; i++) {
        for (int k = 0; k < TRAJECTORIES; k++) {
            if (strcmp(t[i].name, trajectory_name[k]) == 0) {
                trajectory[k] = t[i];
            }
        }
    }
    const struct dig_run_visitor visitor = { visit_run, &reading };
    assert_int_equal(dig_store_walk(store, &visitor, &error), DIG_OK);
    dig_store_close(store);
}

// beds/ holds further ones, along simpleA alone.
static void read_files(const struct pair *const p, const int k, struct phase_means *const theirs)
{
    char              path[256];
    const char *const name = strrchr(p->file, '/') + 1;
    (void)snprintf(path, sizeof path, "%s__%s.csv", p->file, trajectory_name[k]);
    (void)phase_means_add_file(theirs, &trajectory[k], path);
    for (int bed = 1; bed <= BEDS_MAX; bed++) {
        (void)snprintf(path, sizeof path, "%s_seed%d__%s.csv", p->file, bed, trajectory_name[k]);
        (void)phase_means_add_file(theirs, &trajectory[k], path);
        (void)snprintf(path, sizeof path, "%.*sbeds/%s_seed%d__%s.csv", (int)(name - p->file),
                       p->file, name, bed, trajectory_name[k]);
        (void)phase_means_add_file(theirs, &trajectory[k], path);
    }
}

static int read_all(void **state)
{
    (void)state;
    static const char *const table[] = { RIG, OURS "gravels.sqlite", OURS "slope.sqlite",
                                         OURS "effects.sqlite", OURS "rock.sqlite" };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        read_table(table[i]);
    }
    for (size_t g = 0; g < PAIRS; g++) {
        for (int k = 0; k < TRAJECTORIES; k++) {
            read_files(&pair[g], k, &both[g][k].theirs);
        }
    }
    return 0;
}

TEST(every_case_has_enough_beds)
{
    for (size_t g = 0; g < PAIRS; g++) {
        for (int k = 0; k < TRAJECTORIES; k++) {
            assert_true(both[g][k].ours.beds >= pair[g].ours_least);
            assert_true(both[g][k].theirs.beds >= pair[g].theirs_least);
        }
    }
}

// One dig's spread as a share of its case's largest phase mean: root mean square over the cases
// that have enough beds in both codes.
static double usual_share(const int k, const size_t p, const int c)
{
    double sum = 0.0;
    int    n   = 0;
    for (size_t g = 0; g < PAIRS; g++) {
        const struct both *const b = &both[g][k];
        if (b->ours.beds >= BEDS_ENOUGH && b->theirs.beds >= BEDS_ENOUGH) {
            const double scale = phase_means_largest(&b->theirs, &trajectory[k], c);
            sum += pow(phase_means_spread(&b->ours, p, c) / scale, 2.0) +
                   pow(phase_means_spread(&b->theirs, p, c) / scale, 2.0);
            n += 2;
        }
    }
    return sqrt(sum / n);
}

static double error_of_mean(const struct phase_means *const m, const int k, const size_t p,
                            const int c, const double scale)
{
    const double spread =
        m->beds >= BEDS_ENOUGH ? phase_means_spread(m, p, c) : usual_share(k, p, c) * scale;
    return spread / sqrt(m->beds);
}

/// Over all phase means compared; few: of cases with few beds.
struct tally {
    int    compared, bad, few, few_bad;
    double bias;
};

static void compare(const struct pair *const p, const struct both *const b, const int k,
                    const int c, struct tally *const tally)
{
    const struct dig_trajectory *const t     = &trajectory[k];
    const double                       scale = phase_means_largest(&b->theirs, t, c);
    for (size_t i = 0; i < t->phases; i++) {
        const double ours    = phase_means_mean(&b->ours, i, c);
        const double theirs  = phase_means_mean(&b->theirs, i, c);
        const double se      = error_of_mean(&b->ours, k, i, c, scale);
        const double ref_se  = error_of_mean(&b->theirs, k, i, c, scale);
        const bool   few     = b->ours.beds < BEDS_ENOUGH || b->theirs.beds < BEDS_ENOUGH;
        const double allowed = fmax(0.10 * scale, 2.0 * hypot(se, ref_se));
        const bool   ok      = fabs(ours - theirs) <= allowed;
        const bool   never   = fabs(ours - theirs) > fmax(0.10 * scale, 3.5 * hypot(se, ref_se));
        print_message("%-21s %-8s %-12s %-3s %9.4f +- %6.4f %9.4f +- %6.4f %8.4f %8.4f%s\n",
                      strrchr(p->file, '/') + 1, t->name, t->phase[i].name, phase_channel_name[c],
                      ours, se, theirs, ref_se, ours - theirs, allowed, ok ? "" : "  <-- too far");
        tally->bias += (ours - theirs) * (theirs < 0.0 ? -1.0 : 1.0) / scale;
        tally->compared++;
        tally->few += few;
        tally->few_bad += few && !ok;
        tally->bad += never || (!few && !ok);
    }
}

TEST(phase_means_agree_with_liggghts)
{
    struct tally tally = { 0 };
    print_message("%-21s %-8s %-12s %-3s %19s %19s %8s %8s\n", "gravel", "dig", "phase", "",
                  "ours +- s.e.", "LIGGGHTS +- s.e.", "diff", "allowed");
    for (size_t g = 0; g < PAIRS; g++) {
        for (int k = 0; k < TRAJECTORIES; k++) {
            for (int c = 0; c < PHASE_CHANNELS; c++) {
                compare(&pair[g], &both[g][k], k, c, &tally);
            }
        }
    }
    print_message("%d phase means, %d too far apart; of %d with few beds %d beyond two standard "
                  "errors; mean signed bias %.2f %%\n",
                  tally.compared, tally.bad, tally.few, tally.few_bad,
                  100.0 * tally.bias / tally.compared);
    assert_int_equal(tally.bad, 0);
    assert_true(tally.few_bad <= 0.05 * tally.few);
    assert_true(fabs(tally.bias / tally.compared) <= 0.05);
}

TESTS_WITH(read_all, NULL)
