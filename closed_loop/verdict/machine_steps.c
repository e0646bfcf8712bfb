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
#include "estimator/effects/effect.h"

#include <assert.h>
#include <math.h>
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
    for (size_t f = 0; answer->numbers > 0 && f < DIG_FILE_ERRORS; f++, n++) {
        answer->file[f] = answer->value[n];
        for (size_t k = 0; k < answer->numbers; k++) {
            answer->file[f] += z[k] * answer->step[k][n];
        }
    }
}

enum dig_status dig_trace_apply(const struct dig_trace_work *const w, const size_t effects,
                                const struct dig_model_effect effect[],
                                const double                  file[DIG_FILE_ERRORS])
{
    double                machine[DIG_MEASURED_MAX][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    const enum dig_status status = dig_machine_side_apply(w->machine, effects, effect, file,
                                                          DIG_APPLY_TO_ALL, w->measured, machine);
    for (size_t i = 0; i < w->digs && status == DIG_OK; i++) {
        memcpy(w->measured[i].machine, machine[i], sizeof machine[i]);
    }
    return status;
}

// What effects of the machine and of its file add to the means, roughly: in differences it is
// enough.
static enum dig_status added_by(const struct dig_trace_work *const w, const size_t effects,
                                const struct dig_model_effect effect[],
                                const double file[DIG_FILE_ERRORS], double added[][DIG_FEATURES])
{
    double                machine[DIG_MEASURED_MAX][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    const enum dig_status status = dig_machine_side_apply(w->machine, effects, effect, file,
                                                          DIG_APPLY_ROUGHLY, w->measured, machine);
    if (status != DIG_OK) {
        return status;
    }
    memset(added, 0, DIG_TRAJECTORY_MAX * sizeof added[0]);
    for (size_t i = 0; i < w->batch->digs; i++) {
        const struct dig_group *const group = &w->batch->group[w->batch->dig[i].group];
        double                        feature[DIG_FEATURES];
        dig_features_of((const double(*)[DIG_CURVE_POINTS])machine[w->batch->dig[i].measured],
                        feature);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            added[group->trajectory][f] += feature[f] / (double)group->digs;
        }
    }
    return DIG_OK;
}

// The same of an answer at z.
static enum dig_status added_at(const struct dig_trace_work *const     w,
                                const struct dig_machine_answer *const answer, const double z[],
                                double added[][DIG_FEATURES])
{
    struct dig_machine_answer there = *answer;
    dig_machine_steps_values(z, NULL, &there);
    return added_by(w, there.effects, there.effect, there.file, added);
}

// The same of an answer with one number beside it.
static enum dig_status added_with(const struct dig_trace_work *const     w,
                                  const struct dig_machine_answer *const answer,
                                  const struct dig_machine_other *const  other,
                                  double                                 added[][DIG_FEATURES])
{
    const double                             z[DIG_MACHINE_NUMBERS] = { 0.0 };
    const struct dig_effect                 *of                     = dig_effect_of(other->effect);
    const struct dig_effect_parameter *const parameter = &of->parameter[other->parameter];
    struct dig_machine_answer                there     = *answer;
    struct dig_model_effect                  effect[DIG_MACHINE_AT_ONCE + 1];
    for (size_t i = 0; i < answer->numbers; i++) {
        there.value[i] += other->with[i];
    }
    dig_machine_steps_values(z, NULL, &there);
    memcpy(effect, there.effect, there.effects * sizeof effect[0]);
    struct dig_model_effect *const beside = &effect[there.effects];
    *beside = (struct dig_model_effect){ .effect = other->effect, .parameters = 1 };
    memcpy(beside->parameter[0].name, parameter->name, strlen(parameter->name) + 1);
    beside->parameter[0].value = parameter->absent + other->value;
    return added_by(w, there.effects + 1, effect, there.file, added);
}

// Whether a step changes anything: what the file has exactly is not open.
static bool is_open(const struct dig_machine_answer *const answer, const size_t k)
{
    bool open = false;
    for (size_t i = 0; i < DIG_MACHINE_NUMBERS; i++) {
        open = open || fabs(answer->step[k][i]) > 0.0;
    }
    return open;
}

// Leaves how much more one is than the other. A step at which a dig is not told is a way that stays
// shut.
static enum dig_status take_off(const enum dig_status status, double middle[][DIG_FEATURES],
                                double of[][DIG_FEATURES])
{
    for (size_t t = 0; t < DIG_TRAJECTORY_MAX; t++) {
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            of[t][f] = status == DIG_OK ? of[t][f] - middle[t][f] : 0.0;
        }
    }
    return status == DIG_ENOMATCH ? DIG_OK : status;
}

enum dig_status dig_machine_steps_make(const struct dig_trace_work *const     w,
                                       const struct dig_machine_answer *const answer,
                                       struct dig_steps *const                steps)
{
    assert(w != NULL && answer != NULL && steps != NULL);
    double                    z[DIG_MACHINE_NUMBERS] = { 0.0 };
    double                    middle[DIG_TRAJECTORY_MAX][DIG_FEATURES];
    struct dig_machine_answer there = *answer;
    memset(steps, 0, sizeof *steps);
    if (answer->numbers == 0) {
        return DIG_ENOMATCH;
    }
    steps->steps = answer->numbers;
    dig_machine_steps_values(z, NULL, &there);
    enum dig_status status = dig_trace_apply(w, there.effects, there.effect, there.file);
    if (status == DIG_OK) {
        status = added_at(w, answer, z, middle);
    }
    for (size_t k = 0; k < answer->numbers && status == DIG_OK; k++) {
        if (!is_open(answer, k)) {
            continue;
        }
        z[k]   = 1.0;
        status = take_off(added_at(w, answer, z, steps->of[k]), middle, steps->of[k]);
        z[k]   = 0.0;
    }
    return status;
}

enum dig_status dig_machine_others_make(const struct dig_trace_work *const     w,
                                        const struct dig_machine_answer *const answer,
                                        struct dig_steps *const                steps)
{
    assert(w != NULL && answer != NULL && steps != NULL && steps->steps == answer->numbers);
    const double    z[DIG_MACHINE_NUMBERS] = { 0.0 };
    double          middle[DIG_TRAJECTORY_MAX][DIG_FEATURES];
    enum dig_status status = added_at(w, answer, z, middle);
    for (size_t i = 0; i < answer->others && steps->steps < DIG_STEPS_MAX && status == DIG_OK;
         i++) {
        const size_t k   = steps->steps++;
        steps->middle[k] = 0.0;
        status =
            take_off(added_with(w, answer, &answer->other[i], steps->of[k]), middle, steps->of[k]);
    }
    return status;
}
