#include "closed_loop/verdict/joint_fit.h"

#include "closed_loop/numeric/dense.h"
#include "closed_loop/recordings/features.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { STEPS = DIG_MACHINE_NUMBERS, UNKNOWNS = STEPS + DIG_AXES, ROUNDS = 3 };

// A step of the gravel's place for slopes, of -1 … 1.
static const double place_step = 0.02;

static const double ninety = 1.645;

// What a step adds to the means of the groups, and what free air's middle adds to them beyond what
// was taken off, in the batch's units.
struct slopes {
    double of[STEPS][DIG_TRAJECTORY_MAX][DIG_FEATURES];
    double middle[DIG_TRAJECTORY_MAX][DIG_FEATURES];
};

// The numbers of a fit, and the normal equations of its last round.
struct joint {
    const struct dig_whitened_digs *batch;
    const struct slopes            *slopes;
    struct dig_common_error         error[DIG_TRAJECTORY_MAX]; // of the groups' means
    size_t                          steps;
    double                          z[STEPS];
    double                          place[DIG_AXES];
    double                          a[UNKNOWNS][UNKNOWNS], b[UNKNOWNS];
    double                          covariance[STEPS][STEPS]; // of z
};

static void put_values(struct dig_machine_answer *const answer, const double z[])
{
    size_t n = 0;
    for (size_t e = 0; e < answer->effects; e++) {
        for (size_t p = 0; p < answer->effect[e].parameters; p++, n++) {
            double *const value = &answer->effect[e].parameter[p].value;
            *value              = answer->value[n];
            for (size_t k = 0; k < answer->numbers; k++) {
                *value += z[k] * answer->step[k][n];
            }
        }
    }
}

// The means over the groups' digs of what the machine adds, whitened.
static void mean_added(const struct dig_whitened_digs *const batch,
                       const struct dig_measured measured[], double y[][DIG_FEATURES])
{
    memset(y, 0, batch->groups * sizeof y[0]);
    for (size_t i = 0; i < batch->digs; i++) {
        const struct dig_whitened_digs_group *const group = &batch->group[batch->dig[i].group];
        double                                      feature[DIG_FEATURES];
        double                                      one[DIG_FEATURES];
        dig_features_of(measured[batch->dig[i].measured].machine, feature);
        dig_whitened_digs_whiten(group, feature, one);
        for (size_t f = 0; f < group->features; f++) {
            y[batch->dig[i].group][f] += one[f] / (double)group->digs;
        }
    }
}

// What the machine adds to the means at z.
static enum dig_status added_at(struct dig_machine_side *const         machine,
                                const struct dig_whitened_digs *const  batch,
                                const struct dig_machine_answer *const answer, const double z[],
                                struct dig_measured other[], double y[][DIG_FEATURES])
{
    struct dig_machine_answer there = *answer;
    put_values(&there, z);
    const enum dig_status status =
        dig_machine_side_apply(machine, there.effects, there.effect, other);
    if (status == DIG_OK) {
        mean_added(batch, other, y);
    }
    return status == DIG_EINVAL ? DIG_ENOMATCH : status;
}

// A step at which a dig is not told is a way that stays shut.
static enum dig_status find_slopes(struct dig_machine_side *const         machine,
                                   const struct dig_whitened_digs *const  batch,
                                   const struct dig_machine_answer *const answer, const size_t digs,
                                   const struct dig_measured measured[],
                                   struct slopes *const      slopes)
{
    double                     here[DIG_TRAJECTORY_MAX][DIG_FEATURES];
    const double               middle[STEPS] = { 0.0 };
    struct dig_measured *const other         = malloc(digs * sizeof *other);
    if (other == NULL) {
        return DIG_ENOMEM;
    }
    memset(slopes, 0, sizeof *slopes);
    memcpy(other, measured, digs * sizeof *other);
    mean_added(batch, measured, here);
    enum dig_status status = added_at(machine, batch, answer, middle, other, slopes->middle);
    for (size_t k = 0; k < answer->numbers && status == DIG_OK; k++) {
        double z[STEPS]            = { 0.0 };
        z[k]                       = 1.0;
        const enum dig_status told = added_at(machine, batch, answer, z, other, slopes->of[k]);
        status                     = told == DIG_ENOMATCH ? DIG_OK : told;
        for (size_t g = 0; g < batch->groups && told == DIG_OK; g++) {
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                slopes->of[k][g][f] -= slopes->middle[g][f];
            }
        }
    }
    for (size_t g = 0; g < batch->groups; g++) {
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            slopes->middle[g][f] -= here[g][f];
        }
    }
    free(other);
    return status;
}

static void plain_model(const struct dig_whitened_digs *const batch, const size_t g,
                        const double place[], double y[DIG_FEATURES])
{
    double feature[DIG_FEATURES];
    double amplitude[DIG_FORCE_CHANNELS];
    dig_response_surface_features(batch->surface, batch->group[g].trajectory, place, feature,
                                  amplitude);
    dig_whitened_digs_whiten(&batch->group[g], feature, y);
}

// Adds one group's means to the normal equations of the changes of z and the place.
static void add_group(struct joint *const j, const size_t g)
{
    const struct dig_whitened_digs_group *const group = &j->batch->group[g];
    double                                      rest[DIG_FEATURES];
    double                                      slope[UNKNOWNS][DIG_FEATURES];
    plain_model(j->batch, g, j->place, rest);
    for (size_t p = 0; p < DIG_AXES; p++) {
        double there[DIG_AXES];
        memcpy(there, j->place, sizeof there);
        there[p] += place_step;
        plain_model(j->batch, g, there, slope[j->steps + p]);
        for (size_t f = 0; f < group->features; f++) {
            slope[j->steps + p][f] = (slope[j->steps + p][f] - rest[f]) / place_step;
        }
    }
    for (size_t f = 0; f < group->features; f++) {
        rest[f] = group->mean[f] - j->slopes->middle[g][f] - rest[f];
        for (size_t k = 0; k < j->steps; k++) {
            rest[f] -= j->z[k] * j->slopes->of[k][g][f];
            slope[k][f] = j->slopes->of[k][g][f];
        }
    }
    (void)dig_common_error_squares(group, &j->error[g], rest);
    for (size_t i = 0; i < j->steps + DIG_AXES; i++) {
        (void)dig_common_error_squares(group, &j->error[g], slope[i]);
        for (size_t f = 0; f < group->features; f++) {
            j->b[i] += slope[i][f] * rest[f];
            for (size_t k = 0; k <= i; k++) {
                j->a[i][k] += slope[i][f] * slope[k][f];
            }
        }
    }
}

// Fits, and leaves the covariance of z; half the log of its determinant in *log_spread.
static bool fit(struct joint *const j, double *const log_spread)
{
    const size_t n = j->steps + DIG_AXES;
    double       lower[UNKNOWNS * UNKNOWNS];
    for (int round = 0; round < ROUNDS; round++) {
        memset(j->a, 0, sizeof j->a);
        memset(j->b, 0, sizeof j->b);
        for (size_t g = 0; g < j->batch->groups; g++) {
            add_group(j, g);
        }
        for (size_t i = 0; i < n; i++) {
            // Of the gravel's place no more is known than that the table holds it.
            j->a[i][i] += 1.0;
            j->b[i] -= i < j->steps ? j->z[i] : j->place[i - j->steps];
            for (size_t k = 0; k <= i; k++) {
                lower[i * n + k] = j->a[i][k];
            }
        }
        if (dig_cholesky(n, lower) != DIG_OK) {
            return false;
        }
        dig_lower_solve(n, lower, j->b);
        dig_lower_transposed_solve(n, lower, j->b);
        for (size_t i = 0; i < n; i++) {
            *(i < j->steps ? &j->z[i] : &j->place[i - j->steps]) += j->b[i];
        }
    }
    double root[STEPS * STEPS];
    for (size_t i = 0; i < j->steps; i++) {
        double one[UNKNOWNS] = { 0.0 };
        one[i]               = 1.0;
        dig_lower_solve(n, lower, one);
        dig_lower_transposed_solve(n, lower, one);
        memcpy(j->covariance[i], one, j->steps * sizeof one[0]);
        memcpy(&root[i * j->steps], one, j->steps * sizeof one[0]);
    }
    if (dig_cholesky(j->steps, root) != DIG_OK) {
        return false;
    }
    *log_spread = 0.0;
    for (size_t i = 0; i < j->steps; i++) {
        *log_spread += log(root[i * j->steps + i]);
    }
    return true;
}

static void write_intervals(const struct joint *const j, struct dig_machine_answer *const answer)
{
    size_t n = 0;
    for (size_t e = 0; e < answer->effects; e++) {
        for (size_t p = 0; p < answer->effect[e].parameters; p++, n++) {
            struct dig_model_parameter *const to = &answer->effect[e].parameter[p];

            double variance = 0.0;
            for (size_t i = 0; i < j->steps; i++) {
                for (size_t k = 0; k < j->steps; k++) {
                    variance += answer->step[i][n] * j->covariance[i][k] * answer->step[k][n];
                }
            }
            to->low  = to->value - ninety * sqrt(fmax(variance, 0.0));
            to->high = to->value + ninety * sqrt(fmax(variance, 0.0));
        }
    }
}

enum dig_status dig_joint_fit(struct dig_machine_side *const         machine,
                              const struct dig_machine_answer *const answer, const size_t digs,
                              const struct dig_measured             measured[],
                              const struct dig_whitened_digs *const batch,
                              const struct dig_soil *const          soil,
                              const struct dig_fitted *const        plain,
                              struct dig_machine_answer *const fitted, double *const log_cost)
{
    assert(machine != NULL && answer != NULL && measured != NULL && batch != NULL);
    assert(soil != NULL && plain != NULL && fitted != NULL && log_cost != NULL);
    struct slopes *const slopes = malloc(sizeof *slopes);
    struct joint *const  j      = calloc(1, sizeof *j);
    enum dig_status      status = DIG_ENOMEM;
    if (slopes != NULL && j != NULL) {
        *j = (struct joint){ .batch = batch, .slopes = slopes, .steps = answer->numbers };
        memcpy(j->place, plain->number, sizeof j->place);
        dig_hypothesis_errors(batch, soil, plain, j->error);
        status = find_slopes(machine, batch, answer, digs, measured, slopes);
    }
    double log_spread = 0.0;
    if (status == DIG_OK) {
        status = answer->numbers > 0 && fit(j, &log_spread) ? DIG_OK : DIG_ENOMATCH;
    }
    if (status == DIG_OK) {
        double squares = 0.0;
        for (size_t k = 0; k < j->steps; k++) {
            squares += j->z[k] * j->z[k];
        }
        *fitted = *answer;
        put_values(fitted, j->z);
        write_intervals(j, fitted);
        *log_cost = log_spread - 0.5 * squares;
    }
    free(slopes);
    free(j);
    return status;
}
