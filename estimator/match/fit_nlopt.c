// Refinement by NLopt, which only this file of the estimator includes. NLopt allocates inside
// nlopt_optimize(), so this runs on a thread of its own, never in the tick; it is bounded by
// evaluations, not by the clock.

#include "estimator/approach/interpolate.h"
#include "estimator/match/match.h"
#include "estimator/match/pool.h"
#include "estimator/match/posterior.h"

#include <nlopt.h>

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

enum { STARTS = 3, EXCESS_EVALUATIONS = 100 };

// Distance of a gravel outside the table: greater than of any curve.
static const double no_curve = 1e6;

// The fit in positions 0 … 1 along the axes that have more than one point.
struct problem {
    const struct dig_curve_set *set;
    const struct dig_pool_sums *sums;
    unsigned                    dimensions;
    enum dig_axis               axis[DIG_AXES];
    struct dig_gravel           fixed; // the other axes
};

static struct problem make_problem(const struct dig_curve_set *const set,
                                   const struct dig_pool_sums *const sums,
                                   const struct dig_match *const     match)
{
    struct problem problem = {
        .set   = set,
        .sums  = sums,
        .fixed = set->gravel[match->nearest],
    };
    for (int a = 0; a < DIG_AXES; a++) {
        if (set->axis_count[a] > 1) {
            problem.axis[problem.dimensions++] = (enum dig_axis)a;
        }
    }
    return problem;
}

static struct dig_gravel gravel_of(const struct problem *const problem, const double x[])
{
    struct dig_gravel gravel = problem->fixed;
    for (unsigned d = 0; d < problem->dimensions; d++) {
        gravel.value[problem->axis[d]] = dig_axis_value(problem->set, problem->axis[d], x[d]);
    }
    return gravel;
}

static struct dig_distance distance_at(const struct problem *const    problem,
                                       const struct dig_gravel *const gravel)
{
    struct dig_misfit all = { .miss2_Nm2 = 0.0 };
    for (size_t g = 0; g < problem->sums->groups; g++) {
        const struct dig_pooled *const group = &problem->sums->group[g];
        struct dig_cell                cell;
        if (dig_cell_find(problem->set, gravel, group->trajectory, &cell) != DIG_OK) {
            return (struct dig_distance){ .distance = no_curve, .noise_floor = no_curve };
        }
        const struct dig_misfit misfit = dig_cell_misfit(&cell, group);
        dig_misfit_add(&all, &misfit);
    }
    return dig_misfit_distance(&all);
}

// NOLINTNEXTLINE(readability-non-const-parameter): the signature is NLopt's
static double distance_of(const unsigned n, const double *const x, double *const gradient,
                          void *const context)
{
    (void)n;
    (void)gradient;
    const struct problem *const problem = context;
    const struct dig_gravel     gravel  = gravel_of(problem, x);
    return distance_at(problem, &gravel).distance;
}

// NOLINTNEXTLINE(readability-non-const-parameter): the signature is NLopt's
static double excess_of(const unsigned n, const double *const x, double *const gradient,
                        void *const context)
{
    (void)n;
    (void)gradient;
    const struct problem *const problem = context;
    const struct dig_gravel     gravel  = gravel_of(problem, x);
    return fmin(dig_posterior_excess(problem->set, problem->sums, &gravel), no_curve);
}

// Starting points, the best first.
struct starts {
    size_t count;
    double distance[STARTS];
    double x[STARTS][DIG_AXES];
};

// Inserts a starting point if it is good enough; the nearest entry stays first.
static void add_start(struct starts *const starts, const double distance, const double x[DIG_AXES])
{
    size_t place = starts->count;
    while (place > 1 && distance < starts->distance[place - 1]) {
        place--;
    }
    if (place >= STARTS) {
        return;
    }
    starts->count = starts->count < STARTS ? starts->count + 1 : STARTS;
    for (size_t s = starts->count - 1; s > place; s--) {
        starts->distance[s] = starts->distance[s - 1];
        memcpy(starts->x[s], starts->x[s - 1], sizeof starts->x[s]);
    }
    starts->distance[place] = distance;
    memcpy(starts->x[place], x, sizeof starts->x[place]);
}

// Index of a gravel of the table on an axis.
static size_t index_on(const struct dig_curve_set *const set, const enum dig_axis axis,
                       const double value)
{
    size_t at = 0;
    while (at + 1 < set->axis_count[axis] && set->axis[axis][at] < value * (1.0 - 1e-9)) {
        at++;
    }
    return at;
}

static void position_of(const struct problem *const problem, const struct dig_gravel *const gravel,
                        double x[DIG_AXES])
{
    for (unsigned d = 0; d < problem->dimensions; d++) {
        const enum dig_axis axis = problem->axis[d];
        x[d]                     = dig_axis_position(problem->set, axis, gravel->value[axis]);
    }
}

// Starting points: the nearest entry; the posterior's mean, which lies in the right valley where
// there are several; and the best neighbours of the nearest along the axes, as a ridge may separate
// it from the minimum.
static struct starts choose_starts(const struct problem *const    problem,
                                   const struct dig_gravel *const middle)
{
    const struct dig_curve_set *const set = problem->set;

    double nearest[DIG_AXES] = { 0.0 };
    position_of(problem, &problem->fixed, nearest);
    struct starts starts = { .count = 0 };
    add_start(&starts, 0.0, nearest);

    const double at_middle = distance_at(problem, middle).distance;
    if (at_middle < no_curve) {
        double x[DIG_AXES] = { 0.0 };
        position_of(problem, middle, x);
        add_start(&starts, at_middle, x);
    }

    for (unsigned side = 0; side < 2 * problem->dimensions; side++) {
        const unsigned      d    = side / 2;
        const bool          down = side % 2 == 0;
        const enum dig_axis axis = problem->axis[d];
        const size_t        at   = index_on(set, axis, problem->fixed.value[axis]);
        if (down ? at == 0 : at + 1 >= set->axis_count[axis]) {
            continue;
        }
        struct dig_gravel gravel = problem->fixed;
        gravel.value[axis]       = set->axis[axis][down ? at - 1 : at + 1];
        const double distance    = distance_at(problem, &gravel).distance;
        if (distance < no_curve) {
            double x[DIG_AXES] = { nearest[0], nearest[1], nearest[2] };
            x[d]               = dig_axis_position(set, axis, gravel.value[axis]);
            add_start(&starts, distance, x);
        }
    }
    return starts;
}

// Minimises from one start; *x and *least improve or stay.
static enum dig_status improve(struct problem *const problem, const nlopt_func minimised,
                               const double start[const DIG_AXES], const double step[],
                               const int max_evaluations, double x[const DIG_AXES],
                               double *const least)
{
    struct nlopt_opt_s *const opt = nlopt_create(NLOPT_LN_SBPLX, problem->dimensions);
    if (opt == NULL) {
        return DIG_ENOMEM;
    }
    double at[DIG_AXES];
    memcpy(at, start, sizeof at);
    double       found = INFINITY;
    nlopt_result result =
        nlopt_set_min_objective(opt, minimised, problem) < 0 ||
                nlopt_set_lower_bounds1(opt, 0.0) < 0 || nlopt_set_upper_bounds1(opt, 1.0) < 0 ||
                nlopt_set_initial_step(opt, step) < 0 || nlopt_set_xtol_abs1(opt, 1e-5) < 0 ||
                nlopt_set_maxeval(opt, max_evaluations) < 0
            ? NLOPT_OUT_OF_MEMORY
            : nlopt_optimize(opt, at, &found);
    nlopt_destroy(opt);

    // Rounding limits what it can reach; what it has reached then still counts.
    if (result < 0 && result != NLOPT_ROUNDOFF_LIMITED) {
        return result == NLOPT_OUT_OF_MEMORY ? DIG_ENOMEM : DIG_EINVAL;
    }
    if (found < *least) {
        *least = found;
        memcpy(x, at, sizeof at);
    }
    return DIG_OK;
}

// Whether every dig has forces.
static bool has_forces(const struct dig_pool_sums *const sums)
{
    bool has = true;
    for (size_t g = 0; g < sums->groups; g++) {
        has = has && sums->group[g].forces;
    }
    return has;
}

// Whether the gravel is outside the table by the forces. The most probable gravel lies on a grid,
// which may be too coarse for digs of little scatter: then its surroundings are searched too.
static enum dig_status contradict(const struct dig_curve_set *const set,
                                  const struct dig_pool_sums *const sums,
                                  const struct dig_match *const     match,
                                  const struct dig_gravel *const mode, bool *const contradicted)
{
    double least = dig_posterior_excess(set, sums, mode);
    if (least > DIG_POSTERIOR_OUTSIDE) {
        static const double step[DIG_AXES] = { 0.04, 0.04, 0.04 };
        struct problem      problem        = make_problem(set, sums, match);
        double              x[DIG_AXES]    = { 0.0 };
        position_of(&problem, mode, x);
        const enum dig_status status =
            problem.dimensions > 0
                ? improve(&problem, excess_of, x, step, EXCESS_EVALUATIONS, x, &least)
                : DIG_OK;
        if (status != DIG_OK) {
            return status;
        }
    }
    *contradicted = least > DIG_POSTERIOR_OUTSIDE;
    return DIG_OK;
}

// The posterior. Where no gravel of the table fits both moment and forces, that of the moment alone
// predicts the next dig better than a compromise.
static enum dig_status fill_posterior(const struct dig_curve_set *const set,
                                      struct dig_pool_sums *const       sums,
                                      struct dig_match *const refined, bool *const contradicted)
{
    *contradicted          = false;
    enum dig_status status = dig_posterior_fill(set, sums, refined);
    if (status == DIG_OK && has_forces(sums)) {
        status = contradict(set, sums, refined, &refined->mode, contradicted);
    }
    if (*contradicted) {
        for (size_t g = 0; g < sums->groups; g++) {
            sums->group[g].forces = false;
        }
        status = dig_posterior_fill(set, sums, refined);
    }
    return status;
}

static enum dig_status refine(const struct dig_curve_set *const set,
                              struct dig_pool_sums *const sums, const int max_evaluations,
                              struct dig_match *const match)
{
    // A table of scattered points has no cell, so no posterior: the nearest entry stands.
    struct dig_match      refined = *match;
    bool                  contradicted;
    const enum dig_status judged = fill_posterior(set, sums, &refined, &contradicted);
    if (judged != DIG_OK && judged != DIG_ENOMATCH) {
        return judged;
    }

    struct problem problem = make_problem(set, sums, match);
    double         best    = match->nearest_distance;
    if (problem.dimensions > 0) {
        const struct starts starts         = choose_starts(&problem, &refined.mean);
        double              x[DIG_AXES]    = { 0.0 };
        double              step[DIG_AXES] = { 0.0 };
        for (unsigned d = 0; d < problem.dimensions; d++) {
            x[d]    = starts.x[0][d];
            step[d] = 0.4 / (double)(set->axis_count[problem.axis[d]] - 1);
        }
        int left = max_evaluations;
        for (size_t s = 0; s < starts.count && left > 0; s++) {
            const int             share = s + 1 < starts.count ? (left + 1) / 2 : left;
            const enum dig_status status =
                improve(&problem, distance_of, starts.x[s], step, share, x, &best);
            if (status != DIG_OK) {
                return status;
            }
            left -= share;
        }
        refined.gravel = gravel_of(&problem, x);
    }

    // Outside the table: by the smallest distance, or by the forces. The gravel: by all channels.
    struct dig_distance at_best = distance_at(&problem, &refined.gravel);
    if (at_best.distance < no_curve) {
        refined.outside =
            contradicted || at_best.distance > match->outside_floors * at_best.noise_floor;
    }
    if (judged == DIG_OK && has_forces(sums)) {
        refined.gravel = refined.mode;
        refined.forces = true;
        at_best        = distance_at(&problem, &refined.gravel);
    }
    if (at_best.distance < no_curve) {
        refined.distance    = at_best.distance;
        refined.noise_floor = at_best.noise_floor;
    }

    // Distance and posterior weight errors differently; the interval is widened to hold its gravel.
    for (int a = 0; a < DIG_AXES; a++) {
        refined.low.value[a]  = fmin(refined.low.value[a], refined.gravel.value[a]);
        refined.high.value[a] = fmax(refined.high.value[a], refined.gravel.value[a]);
    }
    dig_match_find_family(set, &refined);
    *match = refined;
    return DIG_OK;
}

enum dig_status dig_fit_refine(const struct dig_curve_set *const set, const size_t digs,
                               const struct dig_observation dig[], const int max_evaluations,
                               struct dig_match *const match)
{
    assert(set != NULL && dig != NULL && match != NULL);
    if (!match->valid || match->nearest < 0 || (size_t)match->nearest >= set->entries ||
        max_evaluations < 1 || digs < 1 || dig_observations_check(set, digs, dig) != DIG_OK) {
        return DIG_EINVAL;
    }
    struct dig_pool_sums sums;
    dig_pool_sum(digs, dig, &sums);
    return refine(set, &sums, max_evaluations, match);
}
