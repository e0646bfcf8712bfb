// How far off a daemon was in the ground, for one run of it:
//   loop_judge LOG.lcm TRUTH.csv TRAJECTORY
// TRUTH.csv is `digrig record --truth`'s. Prints
//   estimate ERROR SAMPLES     what it published of digs going on, against what was there
//   prediction ERROR SAMPLES   the last whole dig along TRAJECTORY that it predicted before one,
//                              else the first in it, against what was there then
// Errors are relative: rms of the difference over rms of the truth. What was there is the moment at
// the truth's nearest pose of the bucket, so no clocks are compared.

#include "files/lcm/lcm_log.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROWS_MAX   100000
#define POINTS_MAX 1024
#define NEAR       0.02 // metres and radians: what is farther was never there

struct row {
    double X_m, Z_m, phi_rad, My_Nm;
};

struct sum {
    double wrong, whole;
    size_t n;
};

struct judge {
    const char *trajectory;
    size_t      rows;
    struct row  truth[ROWS_MAX]; // in the ground
    int         points;          // of the prediction; 0: none yet
    double      from, to, predicted_Nm[POINTS_MAX];
    struct sum  estimate, prediction;
};

static bool truth_at(const struct judge *const j, const digsight_estimate_t *const m,
                     double *const My_Nm)
{
    double least = NEAR;
    for (size_t i = 0; i < j->rows; i++) {
        const struct row *const t   = &j->truth[i];
        const double            off = fabs(t->X_m - m->pin_X_m) + fabs(t->Z_m - m->pin_Z_m) +
                           fabs(t->phi_rad - m->bucket_phi_rad);
        if (off < least) {
            least  = off;
            *My_Nm = t->My_Nm;
        }
    }
    return least < NEAR;
}

static void add(struct sum *const sum, const double told_Nm, const double truth_Nm)
{
    sum->wrong += (told_Nm - truth_Nm) * (told_Nm - truth_Nm);
    sum->whole += truth_Nm * truth_Nm;
    sum->n++;
}

static void estimate(void *const context, const int64_t time_us, const digsight_estimate_t *const m)
{
    struct judge *const j        = context;
    double              truth_Nm = 0.0;
    (void)time_us;
    if (m->phase != 2 || !m->moment_valid || !truth_at(j, m, &truth_Nm)) {
        return;
    }
    add(&j->estimate, m->moment_Nm, truth_Nm);
    if (j->points > 1 && strcmp(m->trajectory, j->trajectory) == 0 && m->progress >= j->from) {
        const double done = (fmin(m->progress, j->to) - j->from) / (j->to - j->from);
        const double at   = done * (double)(j->points - 1);
        const int    k    = (int)fmin(at, (double)(j->points - 2));
        const double w    = at - (double)k;
        add(&j->prediction, (1.0 - w) * j->predicted_Nm[k] + w * j->predicted_Nm[k + 1], truth_Nm);
    }
}

static void prediction(void *const context, const int64_t time_us,
                       const digsight_prediction_t *const m)
{
    struct judge *const j = context;
    (void)time_us;
    const bool whole = m->from_progress < 0.001 && m->to_progress > 0.999;
    if (m->valid && strcmp(m->trajectory, j->trajectory) == 0 && j->prediction.n == 0 &&
        (whole || j->points == 0) && m->to_progress > m->from_progress && m->points <= POINTS_MAX) {
        j->points = m->points;
        j->from   = m->from_progress;
        j->to     = m->to_progress;
        memcpy(j->predicted_Nm, m->moment_Nm, (size_t)m->points * sizeof m->moment_Nm[0]);
    }
}

static int read_truth(const char *const path, struct judge *const j)
{
    char        line[256];
    FILE *const file = fopen(path, "r");
    if (file == NULL || fgets(line, sizeof line, file) == NULL) {
        return -1;
    }
    while (j->rows < ROWS_MAX && fgets(line, sizeof line, file) != NULL) {
        struct row *const r = &j->truth[j->rows];
        double            t_s;
        double            force[2];
        if (sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf,%lf", &t_s, &r->X_m, &r->Z_m, &r->phi_rad,
                   &force[0], &force[1], &r->My_Nm) == 7 &&
            fabs(r->My_Nm) > 0.0) {
            j->rows++;
        }
    }
    (void)fclose(file);
    return j->rows > 1 ? 0 : -1;
}

static void tell(const char *const what, const struct sum *const sum)
{
    (void)printf("%s %.4f %zu\n", what, sum->whole > 0.0 ? sqrt(sum->wrong / sum->whole) : 1e9,
                 sum->n);
}

int main(const int argc, char *argv[])
{
    struct judge *const         j      = calloc(1, sizeof *j);
    const struct dig_lcm_reader reader = { .context    = j,
                                           .estimate   = estimate,
                                           .prediction = prediction };
    struct dig_error            error  = { "" };
    if (j == NULL || argc != 4 || read_truth(argv[2], j) != 0) {
        (void)fprintf(stderr, "usage: loop_judge LOG.lcm TRUTH.csv TRAJECTORY\n");
        return 2;
    }
    j->trajectory = argv[3];
    if (dig_lcm_log_each(argv[1], &reader, &error) != DIG_OK) {
        (void)fprintf(stderr, "loop_judge: %s\n", error.text);
        return 1;
    }
    tell("estimate", &j->estimate);
    tell("prediction", &j->prediction);
    free(j);
    return 0;
}
