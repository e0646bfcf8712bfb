#include "closed_loop/accuracy/effect_size.h"

#include "closed_loop/accuracy/judge.h"
#include "closed_loop/numeric/levenberg.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum {
    EVERY  = 4, // points of the grid: curves are smoothed over more
    POINTS = DIG_CURVE_POINTS / EVERY,
    MOST   = DIG_TRAJECTORY_MAX * POINTS
};

// 1 sigma of what is known of the floor and of what the effect adds, over the floor.
static const double unsure = 0.25;

// The moments that a gravel is to explain, group by group.
struct moments {
    const struct dig_batch *batch;
    double                  weight[DIG_TRAJECTORY_MAX][POINTS]; // root of digs times rig time
    double                  target_Nm[DIG_TRAJECTORY_MAX][POINTS];
};

static void weigh(const struct dig_curve_set *const set, const struct dig_group *const group,
                  const double first, const double last, double weight[POINTS])
{
    const struct dig_trajectory *const t = &set->trajectory[group->trajectory];
    for (size_t p = 0; p < POINTS; p++) {
        const double at     = (double)(p * EVERY) / (DIG_CURVE_POINTS - 1);
        const double half   = 0.5 * EVERY / (DIG_CURVE_POINTS - 1);
        const double time_s = dig_trajectory_time_s(t, set->tooth_m, fmin(at + half, 1.0)) -
                              dig_trajectory_time_s(t, set->tooth_m, fmax(at - half, 0.0));
        weight[p] = at >= first && at <= last ? sqrt((double)group->digs * fmax(time_s, 0.0)) : 0.0;
    }
}

static void left_of(void *const context, const double x[], double r[])
{
    const struct moments *const m = context;
    for (size_t g = 0; g < m->batch->groups; g++) {
        double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        dig_response_surface_curve(m->batch->soil->surface, m->batch->group[g].trajectory, x,
                                   curve);
        for (size_t p = 0; p < POINTS; p++) {
            r[g * POINTS + p] =
                m->weight[g][p] * (m->target_Nm[g][p] - curve[DIG_CHANNEL_MY_Nm][p * EVERY]);
        }
    }
}

// The least that any gravel of the table leaves of the moments.
static double least_left(struct moments *const m, const double place[DIG_AXES])
{
    static const struct dig_hypothesis none             = { .effects = 0 };
    static const double                from[][DIG_AXES] = {
                       { -0.6, -0.6, 0.0 }, { 0.6, -0.6, 0.0 }, { -0.6, 0.6, 0.0 }, { 0.6, 0.6, 0.0 }
    };
    double               memory[MOST * (DIG_AXES + 2)];
    struct dig_levenberg l     = { .unknowns   = DIG_AXES,
                                   .residuals  = m->batch->groups * POINTS,
                                   .step       = 1e-4,
                                   .iterations = 20,
                                   .residual   = left_of,
                                   .context    = m,
                                   .memory     = memory };
    double               least = INFINITY;
    dig_hypothesis_bounds(m->batch->soil, &none, l.low, l.high);
    for (size_t s = 0; s <= sizeof from / sizeof from[0]; s++) {
        double x[DIG_AXES];
        double squares = 0.0;
        memcpy(x, s == 0 ? place : from[s - 1], sizeof x);
        dig_levenberg_run(&l, x, &squares);
        least = fmin(least, squares);
    }
    return least;
}

// The means over a group's digs of what each one's moment has, where all of them were measured;
// returns what the means are uncertain by, in squares.
static double begin(const struct dig_batch *const batch, const struct dig_fitted *const fitted,
                    const double moment_Nm[][POINTS], struct moments *const m)
{
    double floor = 0.0;
    *m           = (struct moments){ .batch = batch };
    for (size_t g = 0; g < batch->groups; g++) {
        const struct dig_group *const group = &batch->group[g];
        double                        sd[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        double                        first = 0.0;
        double                        last  = 1.0;
        for (size_t i = 0; i < batch->digs; i++) {
            const struct dig_measured *const dig = &batch->measured[batch->dig[i].measured];
            if (batch->dig[i].group != g) {
                continue;
            }
            first = fmax(first, dig->first);
            last  = fmin(last, dig->last);
            for (size_t p = 0; p < POINTS; p++) {
                m->target_Nm[g][p] += moment_Nm[i][p] / (double)group->digs;
            }
        }
        weigh(batch->soil->surface->set, group, first, last, m->weight[g]);
        dig_judge_sd(batch->soil->surface, batch->scatter, group->trajectory, fitted->number, 0.0,
                     sd);
        for (size_t p = 0; p < POINTS; p++) {
            const double one = m->weight[g][p] * sd[DIG_CHANNEL_MY_Nm][p * EVERY];
            floor += one * one * (1.0 / (double)group->digs + fitted->noise[g]);
        }
    }
    return floor;
}

// The size of what is added to the moments of the batch's digs.
static double size_of(const struct dig_batch *const batch, const struct dig_fitted *const fitted,
                      const double added_Nm[][POINTS])
{
    struct moments m;
    const double   floor = begin(batch, fitted, added_Nm, &m);
    double         added = 0.0;
    for (size_t g = 0; g < batch->groups; g++) {
        double curve[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        dig_response_surface_curve(batch->soil->surface, batch->group[g].trajectory, fitted->number,
                                   curve);
        for (size_t p = 0; p < POINTS; p++) {
            added += pow(m.weight[g][p] * m.target_Nm[g][p], 2.0);
            m.target_Nm[g][p] += curve[DIG_CHANNEL_MY_Nm][p * EVERY];
        }
    }
    return added > 0.0 && floor > 0.0 ? sqrt(least_left(&m, fitted->number) / floor) : 0.0;
}

double dig_effect_size_of_machine(const struct dig_batch *const  batch,
                                  const struct dig_fitted *const fitted,
                                  const double machine[][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])
{
    assert(batch != NULL && fitted != NULL && machine != NULL);
    double added_Nm[DIG_MEASURED_MAX][POINTS];
    for (size_t i = 0; i < batch->digs; i++) {
        for (size_t p = 0; p < POINTS; p++) {
            added_Nm[i][p] = machine[batch->dig[i].measured][DIG_CHANNEL_MY_Nm][p * EVERY];
        }
    }
    return size_of(batch, fitted, (const double(*)[POINTS])added_Nm);
}

double dig_effect_size_left(const struct dig_batch *const  batch,
                            const struct dig_fitted *const fitted)
{
    assert(batch != NULL && fitted != NULL);
    struct moments m;
    double         dug_Nm[DIG_MEASURED_MAX][POINTS];
    for (size_t i = 0; i < batch->digs; i++) {
        const struct dig_measured *const dig = &batch->measured[batch->dig[i].measured];
        for (size_t p = 0; p < POINTS; p++) {
            dug_Nm[i][p] = dig->value[DIG_CHANNEL_MY_Nm][p * EVERY] -
                           dig->machine[DIG_CHANNEL_MY_Nm][p * EVERY];
        }
    }
    const double floor = begin(batch, fitted, (const double(*)[POINTS])dug_Nm, &m);
    return floor > 0.0 ? sqrt(fmax(least_left(&m, fitted->number) / floor - 1.0, 0.0)) : 0.0;
}

// The fit without one of its effects, the others as they are.
static struct dig_fitted leave_out(const struct dig_fitted *const chosen, const size_t e)
{
    struct dig_fitted less = *chosen;
    size_t            n    = 0;
    for (size_t i = 0; i < chosen->hypothesis.effects; i++) {
        if (i != e) {
            less.hypothesis.effect[n]       = chosen->hypothesis.effect[i];
            less.number[DIG_AT_U(n)]        = chosen->number[DIG_AT_U(i)];
            less.number[DIG_AT_CONTRAST(n)] = chosen->number[DIG_AT_CONTRAST(i)];
            n++;
        }
    }
    less.hypothesis.effects = n;
    return less;
}

double dig_effect_size_of_soil(const struct dig_batch *const  batch,
                               const struct dig_fitted *const chosen, const size_t e,
                               const double noise[])
{
    assert(batch != NULL && chosen != NULL && noise != NULL);
    double            added_Nm[DIG_MEASURED_MAX][POINTS];
    struct dig_fitted less = leave_out(chosen, e);
    memcpy(less.noise, noise, sizeof less.noise);
    for (size_t i = 0; i < batch->digs; i++) {
        const struct dig_measured *const dig = &batch->measured[batch->dig[i].measured];
        double                           with[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        double                           without[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        dig_fitted_curve(batch->soil, chosen, dig, with);
        dig_fitted_curve(batch->soil, &less, dig, without);
        for (size_t p = 0; p < POINTS; p++) {
            added_Nm[i][p] =
                with[DIG_CHANNEL_MY_Nm][p * EVERY] - without[DIG_CHANNEL_MY_Nm][p * EVERY];
        }
    }
    return size_of(batch, &less, (const double(*)[POINTS])added_Nm);
}

double dig_effect_size_chance(const double size)
{
    return 0.5 * erfc(-(size - 1.0) / (sqrt(2.0) * unsure));
}
