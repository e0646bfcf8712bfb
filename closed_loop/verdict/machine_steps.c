// A machine as free air leaves it open, as steps of a fit to the digs: the gain of a pressure
// sensor, say, reads little in free air and much in a dig.
//
//   y(dig) = soil(dig) + middle(dig) + sum over k of z[k] D[k](dig),    z ~ N(0, 1)
//
// middle is what an answer's values add to a dig, D what a step from there adds
// (closed_loop/machine/machine_side.h). Gravel, effects of the soil and z are then one fit:
// closed_loop/fit/likelihood.h.

#include "closed_loop/recordings/features.h"
#include "closed_loop/verdict/trace_work.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(DIG_MACHINE_NUMBERS <= DIG_STEPS_MAX, "every number of an answer is a step");

static const double ninety = 1.645;

void dig_machine_steps_values(const double z[], const double covariance[],
                              struct dig_machine_answer *const answer)
{
    size_t n = 0;
    for (size_t e = 0; e < answer->effects; e++) {
        for (size_t p = 0; p < answer->effect[e].parameters; p++, n++) {
            struct dig_model_parameter *const to = &answer->effect[e].parameter[p];

            double variance = 0.0;
            to->value       = answer->value[n];
            for (size_t k = 0; k < answer->numbers; k++) {
                to->value += z[k] * answer->step[k][n];
                for (size_t i = 0; covariance != NULL && i < answer->numbers; i++) {
                    variance += answer->step[i][n] * covariance[i * answer->numbers + k] *
                                answer->step[k][n];
                }
            }
            to->low  = to->value - ninety * sqrt(fmax(variance, 0.0));
            to->high = to->value + ninety * sqrt(fmax(variance, 0.0));
        }
    }
}

static void means_added(const struct dig_whitened_digs *const batch,
                        const struct dig_measured measured[], double added[][DIG_FEATURES])
{
    memset(added, 0, DIG_TRAJECTORY_MAX * sizeof added[0]);
    for (size_t i = 0; i < batch->digs; i++) {
        const struct dig_whitened_digs_group *const group = &batch->group[batch->dig[i].group];
        double                                      feature[DIG_FEATURES];
        dig_features_of(measured[batch->dig[i].measured].machine, feature);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            added[group->trajectory][f] += feature[f] / (double)group->digs;
        }
    }
}

// What the machine adds to the means at z.
static enum dig_status added_at(const struct dig_trace_work *const     w,
                                const struct dig_machine_answer *const answer, const double z[],
                                const enum dig_apply apply, struct dig_measured measured[],
                                double added[][DIG_FEATURES])
{
    struct dig_machine_answer there = *answer;
    dig_machine_steps_values(z, NULL, &there);
    const enum dig_status status =
        dig_machine_side_apply(w->machine, there.effects, there.effect, apply, measured);
    if (status == DIG_OK) {
        means_added(w->batch, measured, added);
    }
    return status == DIG_EINVAL ? DIG_ENOMATCH : status;
}

// A step at which a dig is not told is a way that stays shut.
static enum dig_status find_steps(const struct dig_trace_work *const     w,
                                  const struct dig_machine_answer *const answer,
                                  struct dig_measured other[], struct dig_steps *const steps)
{
    static const double none[DIG_MACHINE_NUMBERS] = { 0.0 };
    double              middle[DIG_TRAJECTORY_MAX][DIG_FEATURES];
    enum dig_status     status = added_at(w, answer, none, DIG_APPLY_ROUGHLY, other, middle);
    for (size_t k = 0; k < answer->numbers && status == DIG_OK; k++) {
        double z[DIG_MACHINE_NUMBERS] = { 0.0 };
        z[k]                          = 1.0;
        status = added_at(w, answer, z, DIG_APPLY_ROUGHLY, other, steps->of[k]);
        for (size_t t = 0; t < DIG_TRAJECTORY_MAX && status == DIG_OK; t++) {
            for (size_t f = 0; f < DIG_FEATURES; f++) {
                steps->of[k][t][f] -= middle[t][f];
            }
        }
        status = status == DIG_ENOMATCH ? DIG_OK : status;
    }
    return status;
}

enum dig_status dig_machine_steps_make(const struct dig_trace_work *const     w,
                                       const struct dig_machine_answer *const answer,
                                       struct dig_steps *const                steps)
{
    assert(w != NULL && answer != NULL && steps != NULL);
    static const double none[DIG_MACHINE_NUMBERS] = { 0.0 };
    double              middle[DIG_TRAJECTORY_MAX][DIG_FEATURES];
    memset(steps, 0, sizeof *steps);
    if (answer->numbers == 0) {
        return DIG_ENOMATCH;
    }
    steps->steps           = answer->numbers;
    enum dig_status status = added_at(w, answer, none, DIG_APPLY_TO_ALL, w->measured, middle);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_measured *const other = malloc(w->digs * sizeof *other);
    if (other == NULL) {
        return DIG_ENOMEM;
    }
    memcpy(other, w->measured, w->digs * sizeof *other);
    status = find_steps(w, answer, other, steps);
    free(other);
    return status;
}
