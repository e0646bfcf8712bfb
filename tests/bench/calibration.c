// How well a posterior knows what it says: each dig of a gravel that was dug more than once against
// the table without that dig, and recordings of LIGGGHTS, whose gravel their names tell. By the
// packings' covariance, where the table has one to be believed, and by the assumed one. Of each:
// the logarithm of how much denser the posterior is at the true gravel than where nothing is known,
// the share of digs whose gravel is in the 90 % interval of friction, rolling friction and density
// (where the truth is no end of the axis), and the root mean square of what the mean is off by, as
// a share of the axis.
//
//   calibration TABLE.sqlite TRAJECTORY [RECORDING.csv…]     RECORDING: mu0.3_mur0.3_rho2500….csv

#include "closed_loop/recordings/observe.h"
#include "core/outline.h"
#include "estimator/match/gaussian.h"
#include "estimator/match/pool.h"
#include "files/recording_csv.h"
#include "tests/table_runs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FINE = 25, FINE_DENSITY = 13, GRID = FINE * FINE * FINE_DENSITY };
static const int fine[DIG_AXES] = { FINE, FINE, FINE_DENSITY };

struct score {
    int    digs, asked[DIG_AXES], inside[DIG_AXES];
    double log, off2[DIG_AXES];
};

struct bench {
    struct table_runs all;
    struct score      score[2][2]; // forces, by the covariance
};

// Weights of the fine grid, the sum of which is 1.
static void weigh(const struct dig_curve_set *const set, const struct dig_observation *const dig,
                  double weight[GRID])
{
    static struct dig_pool_sums sums;
    static struct dig_gaussian  likelihood;
    dig_pool_sum(1, dig, &sums);
    dig_gaussian_make(set, &sums.group[0], &likelihood);
    double most = -INFINITY, sum = 0.0;
    for (int i = 0; i < GRID; i++) {
        const int         at[DIG_AXES] = { i / FINE_DENSITY / FINE, i / FINE_DENSITY % FINE,
                                           i % FINE_DENSITY };
        struct dig_gravel gravel;
        struct dig_cell   cell;
        for (int a = 0; a < DIG_AXES; a++) {
            gravel.value[a] = dig_axis_value(set, (enum dig_axis)a, (at[a] + 0.5) / fine[a]);
        }
        weight[i] = dig_cell_find(set, &gravel, (size_t)dig->trajectory, &cell) == DIG_OK
                        ? dig_gaussian_log(&likelihood, &cell)
                        : -(double)INFINITY;
        most      = fmax(most, weight[i]);
    }
    for (int i = 0; i < GRID; i++) {
        weight[i] = exp(weight[i] - most);
        sum += weight[i];
    }
    for (int i = 0; i < GRID; i++) {
        weight[i] /= sum;
    }
}

static double quantile(const int axis, const double marginal[], const double probability)
{
    double below = 0.0;
    for (int i = 0; i < fine[axis]; i++) {
        if (below + marginal[i] >= probability && marginal[i] > 0.0) {
            return (i + (probability - below) / marginal[i]) / fine[axis];
        }
        below += marginal[i];
    }
    return 1.0;
}

static void judge(const struct dig_curve_set *const set, const struct dig_observation *const dig,
                  const struct dig_gravel *const truth, struct score *const s)
{
    static double weight[GRID];
    double        marginal[DIG_AXES][FINE] = { { 0.0 } };
    int           at[DIG_AXES];
    weigh(set, dig, weight);
    for (int i = 0; i < GRID; i++) {
        marginal[0][i / FINE_DENSITY / FINE] += weight[i];
        marginal[1][i / FINE_DENSITY % FINE] += weight[i];
        marginal[2][i % FINE_DENSITY] += weight[i];
    }
    for (int a = 0; a < DIG_AXES; a++) {
        const double place = dig_axis_position(set, (enum dig_axis)a, truth->value[a]);
        double       mean  = 0.0;
        at[a]              = (int)fmin(place * fine[a], fine[a] - 1.0);
        for (int i = 0; i < fine[a]; i++) {
            mean += marginal[a][i] * (i + 0.5) / fine[a];
        }
        s->off2[a] += pow(mean - place, 2.0);
        if (place > 1e-6 && place < 1.0 - 1e-6) {
            s->asked[a]++;
            s->inside[a] +=
                place >= quantile(a, marginal[a], 0.05) && place <= quantile(a, marginal[a], 0.95)
                    ? 1
                    : 0;
        }
    }
    s->log += log(fmax(weight[(at[0] * FINE + at[1]) * FINE_DENSITY + at[2]] * GRID, 1e-300));
    s->digs++;
}

// By moment and forces and by the moment, each with the covariance and without.
static void judge_all(struct bench *const b, struct dig_observation *const dig,
                      const struct dig_gravel *const truth)
{
    struct dig_covariance *const covariance = b->all.set->covariance;
    for (int way = 0; way < 4; way++) {
        dig->forces            = way / 2 == 1;
        b->all.set->covariance = way % 2 == 1 ? covariance : NULL;
        judge(b->all.set, dig, truth, &b->score[way / 2][way % 2]);
    }
    b->all.set->covariance = covariance;
}

static double block_mean(const double curve[], const size_t block)
{
    enum { WIDE = DIG_CURVE_POINTS / DIG_COVARIANCE_BLOCKS };
    double sum = 0.0;
    for (size_t k = 0; k < WIDE; k++) {
        sum += curve[block * WIDE + k] / WIDE;
    }
    return sum;
}

// The covariance without what one of n digs adds to it.
static void leave_out_of(struct dig_covariance *const c, const double mean[][DIG_CURVE_POINTS],
                         const struct table_run *const run, const double n)
{
    enum { BLOCKS = DIG_COVARIANCE_BLOCKS };
    double off[DIG_COVARIANCE_NUMBERS];
    for (size_t ch = 0; ch < DIG_FORCE_CHANNELS; ch++) {
        double square = 0.0;
        for (size_t b = 0; b < BLOCKS; b++) {
            square += pow(block_mean(mean[ch], b), 2.0) / BLOCKS;
        }
        for (size_t b = 0; b < BLOCKS; b++) {
            off[ch * BLOCKS + b] =
                (block_mean(run->value[ch], b) - block_mean(mean[ch], b)) / sqrt(square);
        }
    }
    for (size_t i = 0; i < DIG_COVARIANCE_NUMBERS; i++) {
        for (size_t j = 0; j < DIG_COVARIANCE_NUMBERS; j++) {
            c->of[i][j] =
                (c->of[i][j] * c->freedom - n / (n - 1.0) * off[i] * off[j]) / (c->freedom - 1.0);
        }
    }
    c->freedom -= 1.0;
}

static void leave_out(struct bench *const b, const size_t left)
{
    const size_t                slot  = table_run_slot(&b->all, &b->all.run[left]);
    struct dig_curve *const     curve = &b->all.set->curve[slot];
    static struct dig_ensemble  rest, all;
    const struct dig_curve      whole = *curve;
    const struct dig_covariance known = b->all.set->covariance[b->all.trajectory];
    memset(&rest, 0, sizeof rest);
    memset(&all, 0, sizeof all);
    for (size_t i = 0; i < b->all.runs; i++) {
        if (b->all.run[i].entry == b->all.run[left].entry) {
            dig_ensemble_add(&all, (const double(*)[DIG_CURVE_POINTS])b->all.run[i].value);
            if (i != left) {
                dig_ensemble_add(&rest, (const double(*)[DIG_CURVE_POINTS])b->all.run[i].value);
            }
        }
    }
    if (rest.packings < 2) {
        return;
    }
    dig_ensemble_curve(&rest, curve);
    leave_out_of(&b->all.set->covariance[b->all.trajectory],
                 (const double(*)[DIG_CURVE_POINTS])all.mean, &b->all.run[left],
                 (double)all.packings);
    b->all.set->packings[slot]--;
    dig_outlines_draw(b->all.set);
    struct dig_observation dig = table_run_observed(&b->all.run[left]);
    judge_all(b, &dig, &b->all.set->gravel[b->all.run[left].entry]);
    b->all.set->packings[slot]++;
    *curve                                    = whole;
    b->all.set->covariance[b->all.trajectory] = known;
    dig_outlines_draw(b->all.set);
}

static void judge_recording(struct bench *const b, const char *const path)
{
    const char *const    name = strrchr(path, '/') != NULL ? strrchr(path, '/') + 1 : path;
    struct dig_gravel    truth;
    struct dig_recording recording;
    struct dig_measured  seen;
    struct dig_error     error = { "" };
    if (sscanf(name, "mu%lf_mur%lf_rho%lf", &truth.value[0], &truth.value[1], &truth.value[2]) !=
            3 ||
        dig_recording_read(path, &recording, &error) != DIG_OK ||
        dig_observe_dig(b->all.set, &recording, &seen, &error) != DIG_OK) {
        (void)fprintf(stderr, "calibration: %s: %s\n", path, error.text);
        return;
    }
    dig_recording_finish(&recording);
    for (int a = 0; a < DIG_AXES; a++) {
        struct dig_axis_interval place;
        if (dig_axis_locate(b->all.set, (enum dig_axis)a, truth.value[a], &place) != DIG_OK) {
            return; // no gravel of the table
        }
    }
    struct dig_observation dig = { .trajectory = seen.trajectory, .last = 1.0 };
    memcpy(dig.moment_Nm, seen.value[0], sizeof dig.moment_Nm);
    memcpy(dig.force_N, seen.value[1], sizeof dig.force_N);
    judge_all(b, &dig, &truth);
}

static void print(const struct bench *const b, const char *const what)
{
    for (int way = 0; way < 4; way++) {
        const struct score *const s = &b->score[way / 2][way % 2];
        (void)printf("%-10s %-17s %-10s %3d digs, score %5.2f, in the interval", what,
                     way / 2 == 1 ? "moment and forces" : "moment",
                     way % 2 == 1 ? "packings" : "assumed", s->digs, s->log / s->digs);
        for (int a = 0; a < DIG_AXES; a++) {
            (void)printf(" %3d of %3d", s->inside[a], s->asked[a]);
        }
        (void)printf(", off");
        for (int a = 0; a < DIG_AXES; a++) {
            (void)printf(" %.3f", sqrt(s->off2[a] / s->digs));
        }
        (void)printf("\n");
    }
}

int main(const int argc, char *argv[])
{
    struct dig_error    error = { "TABLE.sqlite TRAJECTORY [RECORDING.csv…]" };
    struct bench *const b     = calloc(1, sizeof *b);
    int                 rc    = 1;
    if (argc >= 3 && b != NULL && table_runs_read(argv[1], argv[2], &b->all, &error) == DIG_OK) {
        for (size_t i = 0; i < b->all.runs; i++) {
            leave_out(b, i);
        }
        print(b, "left out");
        memset(b->score, 0, sizeof b->score);
        for (int i = 3; i < argc; i++) {
            judge_recording(b, argv[i]);
        }
        if (b->score[0][0].digs > 0) {
            print(b, "LIGGGHTS");
        }
        rc = 0;
    }
    if (rc != 0) {
        (void)fprintf(stderr, "calibration: %s\n", error.text);
    }
    dig_curve_set_destroy(b != NULL ? b->all.set : NULL);
    free(b);
    return rc;
}
