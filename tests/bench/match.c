// The matcher on a large table: the nearest entry beside a look at all entries, and the refinement,
// on this thread's CPU clock.
//
//   match TABLE.sqlite POINTS DIGS
//
// The table is grown from TABLE's first trajectory: POINTS values of each axis (47: 103823
// gravels), interpolated, plus the error that a mean of three packings has: the spread that TABLE
// holds, correlated along the path and between moment and forces, so that neighbours differ as they
// do in a computed table. Digs are of gravels between the points, with the error of one dig; every
// second one measured the forces too. Prints
//   KIND ENTRIES DIGS MEDIAN_ms WORST_ms
// for "nearest", "all" (the same by a look at all entries), "weighed_moment" and "weighed_forces"
// (the entry of the least noise-weighted distance), "moment" and "forces" (refined).
// Fails when the nearest entry or its distance is not that of a look at all, to the last bit.

#include "estimator/match/match.h"
#include "core/outline.h"
#include "core/sort.h"
#include "estimator/approach/interpolate.h"
#include "estimator/match/entry_scatter.h"
#include "estimator/match/pool.h"
#include "tables/load.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { PACKINGS = 3, WIDTH = 12, EVALUATIONS = 400, DIGS_MAX = 1000 };

static const double outside_floors = 2.5;

struct times {
    size_t digs;
    double ms[DIGS_MAX];
};

static double cpu_ms(void)
{
    struct timespec t;
    (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

static _Noreturn void die(const char *const why)
{
    (void)fprintf(stderr, "match: %s\n", why);
    exit(1);
}

static void *take(const size_t count, const size_t size)
{
    void *const memory = calloc(count, size);
    if (memory == NULL) {
        die("no memory");
    }
    return memory;
}

static double uniform(uint64_t *const seed)
{
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    return (double)(*seed >> 11) * 0x1p-53;
}

// Of variance 1, a running mean over WIDTH points.
static void draw(uint64_t *const seed, double out[DIG_CURVE_POINTS])
{
    double white[DIG_CURVE_POINTS + WIDTH];
    for (size_t i = 0; i < DIG_CURVE_POINTS + WIDTH; i++) {
        white[i] = (uniform(seed) + uniform(seed) - 1.0) * sqrt(6.0 / WIDTH);
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        out[k] = 0.0;
        for (size_t i = 0; i < WIDTH; i++) {
            out[k] += white[k + i];
        }
    }
}

// Errors of moment and forces in standard deviations, correlated as packings are.
static void draw_errors(uint64_t *const seed, double error[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    const double l10 = DIG_ENTRY_SCATTER_MY_FX, l20 = DIG_ENTRY_SCATTER_MY_FZ;
    const double l11 = sqrt(1.0 - l10 * l10);
    const double l21 = (DIG_ENTRY_SCATTER_FX_FZ - l10 * l20) / l11;
    const double l22 = sqrt(1.0 - l20 * l20 - l21 * l21);
    for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
        draw(seed, error[c]);
    }
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double a = error[0][k], b = error[1][k], c = error[2][k];
        error[1][k] = l10 * a + l11 * b;
        error[2][k] = l20 * a + l21 * b + l22 * c;
    }
}

static void make_axes(const struct dig_curve_set *const from, const size_t points,
                      struct dig_curve_set *const set)
{
    for (int a = 0; a < DIG_AXES; a++) {
        set->axis_count[a] = points;
        set->axis[a]       = take(points, sizeof *set->axis[a]);
        for (size_t i = 0; i < points; i++) {
            set->axis[a][i] =
                dig_axis_value(from, (enum dig_axis)a, (double)i / (double)(points - 1));
        }
    }
}

static struct dig_curve_set *grow(const struct dig_curve_set *const from, const size_t points)
{
    struct dig_curve_set *const set = take(1, sizeof *set);
    *set                            = *from;
    set->trajectories               = 1;
    set->entries                    = points * points * points;
    set->gravel                     = take(set->entries, sizeof *set->gravel);
    set->packings                   = take(set->entries, sizeof *set->packings);
    set->curve                      = take(set->entries, sizeof *set->curve);
    set->outline                    = take(DIG_FORCE_CHANNELS * set->entries, sizeof *set->outline);
    set->cell                       = take(set->entries, sizeof *set->cell);
    make_axes(from, points, set);

    uint64_t seed = 20261122;
    for (size_t e = 0; e < set->entries; e++) {
        set->cell[e]     = (int)e;
        set->packings[e] = PACKINGS;
        set->gravel[e] =
            (struct dig_gravel){ { set->axis[0][e / points / points],
                                   set->axis[1][e / points % points], set->axis[2][e % points] } };
        double                  error[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        struct dig_curve *const curve = &set->curve[e];
        if (dig_match_interpolate(from, &set->gravel[e], 0, curve) != DIG_OK) {
            die("the table has a hole");
        }
        draw_errors(&seed, error);
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                curve->mean[c][k] += (float)(error[c][k] / sqrt(PACKINGS)) * curve->sd[c][k];
            }
        }
    }
    dig_outlines_draw(set);
    return set;
}

static struct dig_observation dig_somewhere(const struct dig_curve_set *const from,
                                            const bool forces, uint64_t *const seed)
{
    struct dig_gravel gravel;
    for (int a = 0; a < DIG_AXES; a++) {
        gravel.value[a] = dig_axis_value(from, (enum dig_axis)a, uniform(seed));
    }
    struct dig_curve curve;
    double           error[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    if (dig_match_interpolate(from, &gravel, 0, &curve) != DIG_OK) {
        die("the table has a hole");
    }
    draw_errors(seed, error);
    struct dig_observation o = { .trajectory = 0, .last = 1.0, .forces = forces };
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        double value[DIG_FORCE_CHANNELS];
        for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
            value[c] = (double)curve.mean[c][k] + error[c][k] * (double)curve.sd[c][k];
        }
        o.moment_Nm[k] = value[0];
        o.sigma_Nm[k]  = 0.01 * fabs(value[0]);
        for (size_t c = 1; forces && c < DIG_FORCE_CHANNELS; c++) {
            o.force_N[c - 1][k]       = value[c];
            o.force_sigma_N[c - 1][k] = 0.01 * fabs(value[c]);
        }
    }
    return o;
}

static void note(struct times *const times, const double ms)
{
    times->ms[times->digs] = ms;
    times->digs++;
}

static void look_at_all(const struct dig_curve_set *const   set,
                        const struct dig_observation *const o, int *const nearest,
                        double *const distance)
{
    static struct dig_pool_sums sums;
    dig_pool_sum(1, o, &sums);
    *distance = INFINITY;
    for (size_t e = 0; e < set->entries; e++) {
        const struct dig_cell   cell   = dig_cell_of_entry(set, e);
        const struct dig_misfit misfit = dig_cell_misfit(&cell, &sums.group[0]);
        const double            there  = dig_misfit_distance(&misfit).distance;
        *nearest                       = there < *distance ? (int)e : *nearest;
        *distance                      = fmin(there, *distance);
    }
}

static void match_once(const struct dig_curve_set *const set, const struct dig_observation *const o,
                       struct times *const nearest, struct times *const all,
                       struct times *const weighed, struct times *const refined)
{
    struct dig_match match;
    int              truly = -1;
    double           distance;
    const double     from = cpu_ms();
    if (dig_match_nearest(set, 1, o, outside_floors, &match) != DIG_OK) {
        die("no match");
    }
    const double found = cpu_ms();
    look_at_all(set, o, &truly, &distance);
    const double looked = cpu_ms();
    if (match.nearest != truly || memcmp(&match.distance, &distance, sizeof distance) != 0) {
        die("another entry is nearer than the one found by outlines");
    }
    dig_match_find_weighted(set, 1, o, &match);
    const double told = cpu_ms();
    if (dig_fit_refine(set, 1, o, EVALUATIONS, &match) != DIG_OK) {
        die("not refined");
    }
    note(nearest, found - from);
    note(all, looked - found);
    note(weighed, told - looked);
    note(refined, cpu_ms() - told);
}

static void print(const char *const kind, const size_t entries, struct times *const t)
{
    dig_sort(t->digs, t->ms);
    (void)printf("%s %zu %zu %.2f %.2f\n", kind, entries, t->digs, t->ms[t->digs / 2],
                 t->ms[t->digs - 1]);
}

int main(const int argc, char **const argv)
{
    const int points = argc == 4 ? atoi(argv[2]) : 0;
    const int digs   = argc == 4 ? atoi(argv[3]) : 0;
    if (points < 2 || digs < 2 || digs > DIGS_MAX) {
        die("expected TABLE.sqlite POINTS DIGS, 2 to 1000 digs");
    }
    struct dig_error      error = { "" };
    struct dig_curve_set *from  = NULL;
    if (dig_table_load(argv[1], &from, &error) != DIG_OK) {
        die(error.text);
    }
    const struct dig_curve_set *const set = grow(from, (size_t)points);

    static struct times nearest, all, weighed[2], refined[2];
    uint64_t            seed = 7;
    for (int d = 0; d < digs; d++) {
        const struct dig_observation o = dig_somewhere(from, d % 2 == 1, &seed);
        match_once(set, &o, &nearest, &all, &weighed[d % 2], &refined[d % 2]);
    }
    print("nearest", set->entries, &nearest);
    print("all", set->entries, &all);
    print("weighed_moment", set->entries, &weighed[0]);
    print("weighed_forces", set->entries, &weighed[1]);
    print("moment", set->entries, &refined[0]);
    print("forces", set->entries, &refined[1]);
    return 0;
}
