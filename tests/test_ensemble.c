// The DEM against another code, by ensembles: phase means of moment and force over packings of ours
// (tables/coarse.sqlite, made by `make tables`) and of LIGGGHTS (tests/data/reference). A single
// dig is chaotic, so means are compared with their standard errors.
//
// For every gravel, trajectory, phase and channel
//   |ours - reference| <= max(10 % of the case's largest phase mean, 2 standard errors of the
//   difference)
// and the signed differences, each over its case's largest phase mean, average to at most 5 %.

#include "core/curve.h"
#include "core/recording.h"
#include "files/recording_csv.h"
#include "tables/store.h"
#include "tests/testlib.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define PACKINGS_LEAST 10 // of ours, per gravel
#define TRAJECTORIES   2
#define GRAVELS        3

static const char *const trajectory_name[TRAJECTORIES] = { "simpleA", "actual" };

static const struct {
    double      friction, rolling;
    const char *file;     // of the reference, before "[_seedN]__trajectory.csv"
    int         packings; // of the reference
} gravel[GRAVELS] = {
    { 0.3, 0.3, "tests/data/reference/mu0.3_mur0.3_rho2500", 4 },
    { 0.5, 0.5, "tests/data/reference/mu0.5_mur0.5_rho2500", 5 },
    { 0.9, 0.9, "tests/data/reference/mu0.9_mur0.9_rho2500", 4 },
};

static const char *const channel_name[DIG_FORCE_CHANNELS] = { "My", "Fx", "Fz" };

/// Mean and spread of phase means over packings.
struct moments {
    int    n[DIG_PHASES_MAX][DIG_FORCE_CHANNELS];
    double sum[DIG_PHASES_MAX][DIG_FORCE_CHANNELS];
    double sum2[DIG_PHASES_MAX][DIG_FORCE_CHANNELS];
};

struct ensembles {
    size_t                trajectories;
    struct dig_trajectory trajectory[DIG_TRAJECTORY_MAX];
    struct moments        ours[GRAVELS][TRAJECTORIES];
    struct moments        reference[GRAVELS][TRAJECTORIES];
};

static void add_packing(struct moments *const m, const struct dig_trajectory *const t,
                        const size_t windows, const double t_s[],
                        const double value[][DIG_FORCE_CHANNELS])
{
    int    n[DIG_PHASES_MAX]                 = { 0 };
    double sum[DIG_PHASES_MAX][DIG_FORCE_CHANNELS] = { { 0.0 } };
    for (size_t i = 0; i < windows; i++) {
        const size_t p = dig_trajectory_phase(t, t_s[i]);
        n[p]++;
        for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
            sum[p][c] += value[i][c];
        }
    }
    for (size_t p = 0; p < t->phases; p++) {
        for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
            const double mean = sum[p][c] / n[p];
            m->n[p][c]++;
            m->sum[p][c] += mean;
            m->sum2[p][c] += mean * mean;
        }
    }
}

static double mean_of(const struct moments *const m, const size_t p, const int c)
{
    return m->sum[p][c] / m->n[p][c];
}

static double error_of_mean(const struct moments *const m, const size_t p, const int c)
{
    const double n        = m->n[p][c];
    const double mean     = m->sum[p][c] / n;
    const double variance = fmax(m->sum2[p][c] / n - mean * mean, 0.0) * n / (n - 1.0);
    return sqrt(variance / n);
}

#define WINDOWS_MAX 4096
static double at_s[WINDOWS_MAX];
static double value[WINDOWS_MAX][DIG_FORCE_CHANNELS];

static int gravel_of(const struct dig_gravel *const g)
{
    for (int i = 0; i < GRAVELS; i++) {
        if (fabs(g->value[DIG_AXIS_FRICTION] - gravel[i].friction) < 1e-9 &&
            fabs(g->value[DIG_AXIS_ROLLING] - gravel[i].rolling) < 1e-9 &&
            fabs(g->value[DIG_AXIS_DENSITY_kgpm3] - 2500.0) < 1e-6) {
            return i;
        }
    }
    return -1;
}

static int trajectory_of(const char *const name)
{
    for (int i = 0; i < TRAJECTORIES; i++) {
        if (strcmp(trajectory_name[i], name) == 0) {
            return i;
        }
    }
    return -1;
}

static enum dig_status visit_run(void *const context, const struct dig_run *const run,
                                 struct dig_error *const error)
{
    (void)error;
    struct ensembles *const            all = context;
    const struct dig_trajectory *const t   = &all->trajectory[run->origin.trajectory];
    const int                          g   = gravel_of(&run->origin.gravel);
    const int                          k   = trajectory_of(t->name);
    if (g < 0 || k < 0) {
        return DIG_OK;
    }
    assert_true(run->windows <= WINDOWS_MAX);
    for (size_t i = 0; i < run->windows; i++) {
        at_s[i] = run->first_s + (double)i * run->step_s;
        for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
            value[i][c] = (double)run->value[(size_t)c * run->windows + i];
        }
    }
    add_packing(&all->ours[g][k], t, run->windows, at_s, (const double(*)[DIG_FORCE_CHANNELS])value);
    return DIG_OK;
}

static void read_ours(struct ensembles *const all)
{
    struct dig_store *store = NULL;
    struct dig_error  error = { "" };
    if (dig_store_open("tables/coarse.sqlite", &store, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    const struct dig_trajectory *const t = dig_store_trajectories(store, &all->trajectories);
    memcpy(all->trajectory, t, all->trajectories * sizeof *t);
    const struct dig_run_visitor visitor = { visit_run, all };
    assert_int_equal(dig_store_walk(store, &visitor, &error), DIG_OK);
    dig_store_close(store);
}

static void read_reference(struct ensembles *const all)
{
    for (int g = 0; g < GRAVELS; g++) {
        for (int k = 0; k < TRAJECTORIES; k++) {
            size_t which = 0;
            while (strcmp(all->trajectory[which].name, trajectory_name[k]) != 0) {
                which++;
            }
            for (int seed = 1; seed <= gravel[g].packings; seed++) {
                char path[256], suffix[16] = "";
                if (seed > 1) {
                    (void)snprintf(suffix, sizeof suffix, "_seed%d", seed);
                }
                (void)snprintf(path, sizeof path, "%s%s__%s.csv", gravel[g].file, suffix,
                               trajectory_name[k]);
                struct dig_recording r     = { 0 };
                struct dig_error     error = { "" };
                if (dig_recording_read(path, &r, &error) != DIG_OK) {
                    fail_msg("%s", error.text);
                }
                for (size_t i = 0; i < r.rows; i++) {
                    at_s[i]                     = r.row[i].t_s;
                    value[i][DIG_CHANNEL_MY_Nm] = r.row[i].My_Nm;
                    value[i][DIG_CHANNEL_FX_N]  = r.row[i].Fx_N;
                    value[i][DIG_CHANNEL_FZ_N]  = r.row[i].Fz_N;
                }
                add_packing(&all->reference[g][k], &all->trajectory[which], r.rows, at_s,
                            (const double(*)[DIG_FORCE_CHANNELS])value);
                dig_recording_finish(&r);
            }
        }
    }
}

static struct ensembles all;

static int read_all(void **state)
{
    (void)state;
    read_ours(&all);
    read_reference(&all);
    return 0;
}

static const struct dig_trajectory *find(const char *const name)
{
    for (size_t i = 0; i < all.trajectories; i++) {
        if (strcmp(all.trajectory[i].name, name) == 0) {
            return &all.trajectory[i];
        }
    }
    return NULL;
}

static void every_gravel_has_enough_packings(void **state)
{
    (void)state;
    for (int g = 0; g < GRAVELS; g++) {
        for (int k = 0; k < TRAJECTORIES; k++) {
            assert_true(all.ours[g][k].n[0][0] >= PACKINGS_LEAST);
            assert_int_equal(all.reference[g][k].n[0][0], gravel[g].packings);
        }
    }
}

static double largest_phase_mean(const int g, const int k, const int c, const size_t phases)
{
    double most = 0.0;
    for (size_t p = 0; p < phases; p++) {
        most = fmax(most, fabs(mean_of(&all.reference[g][k], p, c)));
    }
    return most;
}

static void phase_means_agree_with_liggghts(void **state)
{
    (void)state;
    double bias = 0.0;
    int    n = 0, bad = 0;
    print_message("%-8s %-8s %-12s %-3s %18s %18s %8s %8s\n", "gravel", "dig", "phase", "",
                  "ours +- s.e.", "LIGGGHTS +- s.e.", "diff", "allowed");
    for (int g = 0; g < GRAVELS; g++) {
        for (int k = 0; k < TRAJECTORIES; k++) {
            const struct dig_trajectory *const t = find(trajectory_name[k]);
            for (int c = 0; c < DIG_FORCE_CHANNELS; c++) {
                const double scale = largest_phase_mean(g, k, c, t->phases);
                for (size_t p = 0; p < t->phases; p++) {
                    const double ours    = mean_of(&all.ours[g][k], p, c);
                    const double ref     = mean_of(&all.reference[g][k], p, c);
                    const double se      = error_of_mean(&all.ours[g][k], p, c);
                    const double ref_se  = error_of_mean(&all.reference[g][k], p, c);
                    const double allowed = fmax(0.10 * scale, 2.0 * hypot(se, ref_se));
                    const bool   ok      = fabs(ours - ref) <= allowed;
                    print_message("%.1f/%.1f  %-8s %-12s %-3s %9.4f +- %6.4f %9.4f +- %6.4f "
                                  "%8.4f %8.4f%s\n",
                                  gravel[g].friction, gravel[g].rolling, t->name, t->phase[p].name,
                                  channel_name[c], ours, se, ref, ref_se, ours - ref, allowed,
                                  ok ? "" : "  <-- too far");
                    bias += (ours - ref) * (ref < 0.0 ? -1.0 : 1.0) / scale;
                    n++;
                    bad += ok ? 0 : 1;
                }
            }
        }
    }
    print_message("mean signed bias %.2f %% over %d phase means\n", 100.0 * bias / n, n);
    assert_int_equal(bad, 0);
    assert_true(fabs(bias / n) <= 0.05);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_gravel_has_enough_packings),
        cmocka_unit_test(phase_means_agree_with_liggghts),
    };
    return cmocka_run_group_tests_name("ensemble", tests, read_all, NULL);
}
