// The findings of the paper, tested on a table of ours and on digs of LIGGGHTS:
//   paper TABLE.sqlite EFFECTS.sqlite|- OUT RECORDING.csv…
//
// Prints what it finds, one line a case, and writes the curves for the plots into OUT. What the
// letters are: docs/paper.md. scripts/paper.sh runs it and draws.

#include "tests/paper/digs.h"

#include "closed_loop/accuracy/score.h"
#include "tables/load.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Where the actual dig has its peaks: penetration and first rotation, pulling, second rotation.
struct shape {
    double first_Nm, valley_Nm, second_Nm; // largest; smallest between the two; largest
    double middle;                         // mean while pulling / mean of the two peaks
};

static double time_of(const struct dig_trajectory *const t, const double tooth_m, const size_t k)
{
    return dig_trajectory_time_s(t, tooth_m, (double)k / (DIG_CURVE_POINTS - 1));
}

// The end of phase i, s.
static double end_of(const struct dig_trajectory *const t, const size_t i)
{
    double end_s = 0.0;
    for (size_t p = 0; p <= i; p++) {
        end_s += t->phase[p].duration_s;
    }
    return end_s;
}

static size_t largest(const double y[], const size_t from, const size_t to)
{
    size_t best = from;
    for (size_t k = from; k < to; k++) {
        best = y[k] > y[best] ? k : best;
    }
    return best;
}

static size_t point_at(const struct dig_trajectory *const t, const double tooth_m,
                       const double at_s)
{
    size_t k = 0;
    while (k + 1 < DIG_CURVE_POINTS && time_of(t, tooth_m, k) < at_s) {
        k++;
    }
    return k;
}

static struct shape shape_of(const struct dig_trajectory *const t, const double tooth_m,
                             const double y[])
{
    const size_t turned = point_at(t, tooth_m, end_of(t, 1));
    const size_t pulled = point_at(t, tooth_m, end_of(t, 2));
    const size_t curled = point_at(t, tooth_m, end_of(t, 3));
    const size_t first  = largest(y, 0, turned);
    const size_t second = largest(y, pulled, curled);
    struct shape s      = { .first_Nm = y[first], .second_Nm = y[second], .valley_Nm = y[first] };
    for (size_t k = first; k < second; k++) {
        s.valley_Nm = fmin(s.valley_Nm, y[k]);
    }
    double sum = 0.0;
    for (size_t k = turned; k < pulled; k++) {
        sum += y[k];
    }
    s.middle = sum / (double)(pulled - turned) / (0.5 * (s.first_Nm + s.second_Nm));
    return s;
}

// valley / smaller peak: 1 is no valley at all.
static double depth_of(const struct shape *const s)
{
    return s->valley_Nm / fmin(s->first_Nm, s->second_Nm);
}

static void tell_shape(const char *const name, const struct paper_table *const table,
                       const size_t actual, const double y[])
{
    const struct shape s = shape_of(&table->set->trajectory[actual], table->set->tooth_m, y);
    (void)printf("shape %-34s first %6.3f valley %6.3f second %6.3f Nm  valley/peak %5.2f  "
                 "middle/peaks %5.2f\n",
                 name, s.first_Nm, s.valley_Nm, s.second_Nm, depth_of(&s), s.middle);
}

// (a), (b): the shapes of every recording and of every gravel of the table.
static void tell_shapes(const struct paper_table *const table, const char *const out)
{
    const size_t actual = paper_trajectory(table, "actual");
    for (size_t i = 0; i < table->recordings; i++) {
        const struct paper_recording *const r = &table->recording[i];
        if (r->trajectory == actual) {
            tell_shape(r->name, table, actual, r->moment_Nm);
            paper_write_curve(out, r->name, table, actual, r->moment_Nm);
        }
    }
    for (size_t i = 0; i < table->runs; i++) {
        const struct paper_run *const r = &table->run[i];
        const double *const           v = table->set->gravel[r->entry].value;
        char                          name[96];
        (void)snprintf(name, sizeof name, "ours_%g_%g_%g_bed%zu", v[0], v[1], v[2], r->packing);
        if (r->trajectory == actual) {
            tell_shape(name, table, actual, r->moment_Nm);
        }
    }
    for (size_t e = 0; e < table->set->entries; e++) {
        double              mean_Nm[DIG_CURVE_POINTS];
        char                name[64];
        const double *const v = table->set->gravel[e].value;
        (void)snprintf(name, sizeof name, "table_%g_%g_%g", v[0], v[1], v[2]);
        if (paper_mean(table, e, actual, SIZE_MAX, mean_Nm) > 0) {
            tell_shape(name, table, actual, mean_Nm);
            paper_write_curve(out, name, table, actual, mean_Nm);
        }
    }
}

// (b): the shapes of what was dug with an effect.
static enum dig_status tell_effects(const struct paper_table *const table, const char *const path,
                                    const char *const out, struct dig_error *const error)
{
    const size_t          actual = paper_trajectory(table, "actual");
    struct dig_entry_set *set    = NULL;
    const enum dig_status status = dig_effects_load(path, table->set, &set, error);
    if (status != DIG_OK || set == NULL) {
        return status;
    }
    for (size_t e = 0; e < set->entries; e++) {
        const struct dig_entry *const x  = &set->entry[e];
        const size_t                  at = e * set->trajectories + actual;
        double                        mean_Nm[DIG_CURVE_POINTS];
        char                          name[96];
        (void)snprintf(name, sizeof name, "%s_%g_%g_%g_%g", dig_effect_name(x->effect),
                       x->magnitude, x->gravel.value[0], x->gravel.value[1], x->gravel.value[2]);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            mean_Nm[k] = (double)set->curve[at].mean[DIG_CHANNEL_MY_Nm][k];
        }
        if (set->packings[at] > 0) {
            tell_shape(name, table, actual, mean_Nm);
            paper_write_curve(out, name, table, actual, mean_Nm);
        }
    }
    dig_entry_set_destroy(set);
    return DIG_OK;
}

// ||a - b|| / ||a|| over rig time.
static double distance(const struct paper_table *const table, const size_t trajectory,
                       const double a[DIG_CURVE_POINTS], const double b[DIG_CURVE_POINTS])
{
    static const double nothing[DIG_CURVE_POINTS];
    struct dig_score    score = { .wrong_N2m2s = 0.0 };
    dig_score_add(&score, &table->set->trajectory[trajectory], table->set->tooth_m, 0.0, 1.0, a, b,
                  nothing);
    return dig_score_error(&score);
}

// The paper's selection: the gravel whose curve is nearest, the dig itself left out of its mean.
static size_t nearest(const struct paper_table *const table, const size_t trajectory,
                      const double moment_Nm[DIG_CURVE_POINTS], const size_t skip_run,
                      double *const how_far)
{
    size_t best = SIZE_MAX;
    *how_far    = INFINITY;
    for (size_t e = 0; e < table->set->entries; e++) {
        double mean_Nm[DIG_CURVE_POINTS];
        if (paper_mean(table, e, trajectory, skip_run, mean_Nm) > 0) {
            const double far = distance(table, trajectory, moment_Nm, mean_Nm);
            if (far < *how_far) {
                *how_far = far;
                best     = e;
            }
        }
    }
    return best;
}

enum { VALUES_MAX = 8 }; // of an axis

struct tally {
    size_t digs, right, axis[DIG_AXES];
    double right_error, chosen_error; // summed over digs
    size_t wrong;
    double wrong_error, wrong_right_error; // of the digs for which another gravel was chosen
    size_t values[DIG_AXES];
    double value[DIG_AXES][VALUES_MAX];
    size_t chosen[DIG_AXES][VALUES_MAX][VALUES_MAX]; // truth, choice
};

// Which of an axis' values that is, in the order in which they were seen.
static size_t value_of(struct tally *const t, const int axis, const double value)
{
    size_t v = 0;
    while (v < t->values[axis] && fabs(t->value[axis][v] - value) > 1e-9) {
        v++;
    }
    if (v == VALUES_MAX) {
        (void)fprintf(stderr, "paper: an axis has more than %d values\n", VALUES_MAX);
        exit(1);
    }
    t->value[axis][v] = value;
    t->values[axis] += v == t->values[axis] ? 1 : 0;
    return v;
}

static void count(struct tally *const t, const struct dig_gravel *const truth,
                  const struct dig_gravel *const chosen, const double right_error,
                  const double chosen_error)
{
    bool same = true;
    for (int a = 0; a < DIG_AXES; a++) {
        const bool hit = fabs(truth->value[a] - chosen->value[a]) < 1e-9;
        t->axis[a] += hit ? 1 : 0;
        const size_t is = value_of(t, a, truth->value[a]);
        t->chosen[a][is][value_of(t, a, chosen->value[a])]++;
        same = same && hit;
    }
    t->digs++;
    t->right += same ? 1 : 0;
    t->right_error += right_error;
    t->chosen_error += chosen_error;
    if (!same) {
        t->wrong++;
        t->wrong_error += chosen_error;
        t->wrong_right_error += right_error;
    }
}

static void tell_tally(const char *const what, const struct tally *const t)
{
    const double n = (double)t->digs;
    (void)printf("select %s: %zu digs, right %.0f %%; friction %.0f %%, rolling %.0f %%, density "
                 "%.0f %%; error of the predicted actual dig: right gravel %.3f, chosen %.3f; "
                 "of %zu wrong choices: chosen %.3f, right %.3f\n",
                 what, t->digs, 100.0 * (double)t->right / n, 100.0 * (double)t->axis[0] / n,
                 100.0 * (double)t->axis[1] / n, 100.0 * (double)t->axis[2] / n, t->right_error / n,
                 t->chosen_error / n, t->wrong, t->wrong_error / fmax((double)t->wrong, 1.0),
                 t->wrong_right_error / fmax((double)t->wrong, 1.0));
}

// A line for every value of an axis: of the digs that have it, how many were given which.
static void tell_confusion(const char *const what, const struct tally *const t)
{
    static const char *const axis[DIG_AXES] = { "friction", "rolling", "density" };
    for (int a = 0; a < DIG_AXES; a++) {
        for (size_t is = 0; is < t->values[a]; is++) {
            (void)printf("confusion %s: %s %g taken for", what, axis[a], t->value[a][is]);
            for (size_t c = 0; c < t->values[a]; c++) {
                (void)printf("  %g: %zu", t->value[a][c], t->chosen[a][is][c]);
            }
            (void)printf("\n");
        }
    }
}

static void tell_choice(const char *const name, const struct paper_table *const table,
                        const size_t chosen, const double far, const double chosen_error,
                        const double right_error)
{
    const double *const v = table->set->gravel[chosen].value;
    (void)printf("choice %-34s -> %g/%g/%g  distance %.3f  error of the actual dig %.3f, of the "
                 "right gravel %.3f\n",
                 name, v[0], v[1], v[2], far, chosen_error, right_error);
}

// (c) with every bed of the table that has a simpleA and an actual dig, left out of its own mean.
static void select_own(const struct paper_table *const table)
{
    const size_t simple = paper_trajectory(table, "simpleA");
    const size_t actual = paper_trajectory(table, "actual");
    struct tally all    = { .digs = 0 };
    for (size_t i = 0; i < table->runs; i++) {
        const struct paper_run *const r    = &table->run[i];
        const size_t                  next = paper_same_bed(table, i, actual);
        double                        right_Nm[DIG_CURVE_POINTS];
        if (r->trajectory != simple || next == SIZE_MAX ||
            paper_mean(table, r->entry, actual, next, right_Nm) == 0) {
            continue;
        }
        double              far    = 0.0;
        const size_t        chosen = nearest(table, simple, r->moment_Nm, i, &far);
        double              mean_Nm[DIG_CURVE_POINTS];
        const double *const truth_Nm = table->run[next].moment_Nm;
        if (chosen == SIZE_MAX || paper_mean(table, chosen, actual, next, mean_Nm) == 0) {
            continue;
        }
        const double right_error  = distance(table, actual, truth_Nm, right_Nm);
        const double chosen_error = distance(table, actual, truth_Nm, mean_Nm);
        count(&all, &table->set->gravel[r->entry], &table->set->gravel[chosen], right_error,
              chosen_error);
        const double *const v = table->set->gravel[r->entry].value;
        char                name[64];
        (void)snprintf(name, sizeof name, "ours_%g_%g_%g_bed%zu", v[0], v[1], v[2], r->packing);
        if (paper_is_object(v)) {
            tell_choice(name, table, chosen, far, chosen_error, right_error);
        }
    }
    tell_tally("own beds", &all);
    tell_confusion("own beds", &all);
}

// (c) with digs of LIGGGHTS whose gravel is in the table.
static void select_recorded(const struct paper_table *const table)
{
    const size_t simple = paper_trajectory(table, "simpleA");
    const size_t actual = paper_trajectory(table, "actual");
    struct tally all    = { .digs = 0 };
    for (size_t i = 0; i < table->recordings; i++) {
        const struct paper_recording *const r    = &table->recording[i];
        const struct paper_recording *const next = paper_pair(table, i, actual);
        double                              right_Nm[DIG_CURVE_POINTS];
        double                              mean_Nm[DIG_CURVE_POINTS];
        if (r->trajectory != simple || next == NULL || r->entry == SIZE_MAX ||
            paper_mean(table, r->entry, actual, SIZE_MAX, right_Nm) == 0) {
            continue;
        }
        double       far    = 0.0;
        const size_t chosen = nearest(table, simple, r->moment_Nm, SIZE_MAX, &far);
        if (chosen == SIZE_MAX || paper_mean(table, chosen, actual, SIZE_MAX, mean_Nm) == 0) {
            continue;
        }
        const double right_error  = distance(table, actual, next->moment_Nm, right_Nm);
        const double chosen_error = distance(table, actual, next->moment_Nm, mean_Nm);
        count(&all, &table->set->gravel[r->entry], &table->set->gravel[chosen], right_error,
              chosen_error);
        tell_choice(r->name, table, chosen, far, chosen_error, right_error);
    }
    if (all.digs > 0) {
        tell_tally("LIGGGHTS", &all);
    }
}

// (d): the first bed of every gravel with a value of .7, which a table without that value has to
// find between its points.
static void write_objects(const struct paper_table *const table, const char *const out)
{
    for (size_t i = 0; i < table->runs; i++) {
        const struct paper_run *const r = &table->run[i];
        const double *const           v = table->set->gravel[r->entry].value;
        const bool                    off =
            fabs(v[DIG_AXIS_FRICTION] - .7) < 1e-9 || fabs(v[DIG_AXIS_ROLLING] - .7) < 1e-9;
        if (off && r->packing == 0) {
            char name[96];
            (void)snprintf(name, sizeof name, "X_%g_%g_%g__%s", v[0], v[1], v[2],
                           table->set->trajectory[r->trajectory].name);
            paper_write_run(out, name, table, i);
        }
    }
}

int main(const int argc, char **const argv)
{
    if (argc < 5) {
        (void)fputs("usage: paper TABLE.sqlite EFFECTS.sqlite|- OUT RECORDING.csv...\n", stderr);
        return 2;
    }
    struct paper_table table;
    struct dig_error   error = { "" };
    if (paper_load(argv[1], (size_t)argc - 4, argv + 4, &table, &error) != DIG_OK) {
        (void)fprintf(stderr, "paper: %s\n", error.text);
        return 1;
    }
    tell_shapes(&table, argv[3]);
    enum dig_status status = DIG_OK;
    if (strcmp(argv[2], "-") != 0) {
        status = tell_effects(&table, argv[2], argv[3], &error);
    }
    select_own(&table);
    select_recorded(&table);
    write_objects(&table, argv[3]);
    paper_finish(&table);
    if (status != DIG_OK) {
        (void)fprintf(stderr, "paper: %s\n", error.text);
    }
    return status == DIG_OK ? 0 : 1;
}
