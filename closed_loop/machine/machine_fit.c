#include "closed_loop/machine/machine_fit.h"

#include "closed_loop/numeric/dense.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// How wide the prior of an effect may be, in its parameters' scales. With one width for all, a weak
// effect of many parameters would be given to another that has fewer, and of a strong one the rest
// to what the file may have wrong.
static const double width[] = { 4.0, 1.0, 0.25, 0.0625, 0.015625 };
static const double scale   = 1.0;
enum { WIDTHS = sizeof width / sizeof width[0], WIDTHS_OF_SETS = 2 };

// A step is halved so often.
enum { HALVINGS = 6 };

enum dig_status dig_fit_make(struct dig_air *const air, const double file_scale[DIG_FILE_ERRORS],
                             struct dig_fit *const fit)
{
    assert(air != NULL && fit != NULL);
    *fit                         = (struct dig_fit){ .s2 = 1.0 };
    const enum dig_status status = dig_lines_make(air, file_scale, &fit->lines);
    const size_t          n      = fit->lines.columns;
    if (status != DIG_OK) {
        return status;
    }
    fit->slope2 = malloc((3 * n * n + n) * sizeof *fit->slope2);
    if (fit->slope2 == NULL) {
        dig_fit_finish(fit);
        return DIG_ENOMEM;
    }
    fit->work       = fit->slope2 + n * n;
    fit->covariance = fit->work + n * n;
    fit->at         = fit->covariance + n * n;
    for (size_t c = 0; c < n; c++) {
        const bool of_file = fit->lines.column[c].effect == DIG_EFFECT_UNLISTED;
        fit->of[c]         = of_file ? -1 : (int)fit->lines.column[c].effect;
        fit->base[c]       = of_file ? 1.0 : 0.0;
        fit->wide[c]       = 1.0;
    }
    return DIG_OK;
}

void dig_fit_finish(struct dig_fit *const fit)
{
    if (fit != NULL) {
        dig_lines_finish(&fit->lines);
        free(fit->slope2);
        *fit = (struct dig_fit){ .rows = 0.0 };
    }
}

struct dig_fit_answer dig_fit_solve_each(const struct dig_fit *const fit, const double widths[],
                                         const enum dig_fit_leave leave)
{
    assert(fit != NULL && widths != NULL);
    const size_t  all = fit->lines.columns;
    double *const h   = fit->work;
    double        x[DIG_LINES_COLUMNS_MAX];
    double        share[DIG_LINES_COLUMNS_MAX];
    size_t        column[DIG_LINES_COLUMNS_MAX];
    size_t        n = 0;
    for (size_t c = 0; c < all; c++) {
        if (widths[c] > 0.0 && !dig_lines_is_bent(&fit->lines, c)) {
            column[n]  = c;
            share[n++] = widths[c];
        }
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j <= i; j++) {
            h[i * n + j] = share[i] * share[j] * fit->slope2[column[i] * all + column[j]] / fit->s2;
        }
        h[i * n + i] += 1.0;
        x[i] = -share[i] * fit->slope_rest[column[i]] / fit->s2;
    }
    const bool solved = dig_cholesky(n, h) == DIG_OK; // H is never less than I
    dig_cholesky_solve(n, h, x);
    double gain  = 0.0;
    double size2 = 0.0;
    for (size_t i = 0; i < n; i++) {
        gain -= x[i] * share[i] * fit->slope_rest[column[i]] / fit->s2;
        size2 += x[i] * x[i];
    }
    if (leave >= DIG_FIT_VALUES) {
        memset(fit->at, 0, all * sizeof(double));
        for (size_t i = 0; i < n; i++) {
            fit->at[column[i]] = share[i] * x[i];
        }
    }
    if (leave == DIG_FIT_COVARIANCE) {
        memset(fit->covariance, 0, all * all * sizeof(double));
        for (size_t i = 0; i < n; i++) {
            double one[DIG_LINES_COLUMNS_MAX];
            memset(one, 0, n * sizeof one[0]);
            one[i] = 1.0;
            dig_cholesky_solve(n, h, one);
            for (size_t j = 0; j < n; j++) {
                fit->covariance[column[i] * all + column[j]] = share[i] * share[j] * one[j];
            }
        }
    }
    return (struct dig_fit_answer){
        .log_evidence = solved ? 0.5 * (gain - dig_lower_log_det(n, h)) : (double)-INFINITY,
        .rest2        = fit->rest2 - fit->s2 * (gain + size2),
        .width        = 1.0,
    };
}

void dig_fit_widths(const struct dig_fit *const fit, const unsigned set, const double wide,
                    double widths[])
{
    assert(fit != NULL && widths != NULL);
    for (size_t c = 0; c < fit->lines.columns; c++) {
        const bool in_set = fit->of[c] >= 0 && ((set >> fit->of[c]) & 1U) != 0;
        widths[c]         = in_set ? wide * fit->wide[c] : fit->base[c];
    }
}

// As dig_fit_solve(), with priors of one width, not counted.
static struct dig_fit_answer solve_at(const struct dig_fit *const fit, const unsigned set,
                                      const double wide, const enum dig_fit_leave leave)
{
    double widths[DIG_LINES_COLUMNS_MAX];
    dig_fit_widths(fit, set, wide, widths);
    struct dig_fit_answer answer = dig_fit_solve_each(fit, widths, leave);
    answer.log_evidence -= fit->log_none;
    answer.width = wide;
    return answer;
}

// Moves the equations from where the lines are to all absent; bent columns stay.
static void move_to_absent(struct dig_fit *const fit)
{
    const struct dig_lines *const lines = &fit->lines;
    const size_t                  n     = lines->columns;
    double                        back[DIG_LINES_COLUMNS_MAX]; // how far each goes
    double                        more[DIG_LINES_COLUMNS_MAX];
    for (size_t c = 0; c < n; c++) {
        back[c] = dig_lines_is_bent(lines, c) ? 0.0 : -lines->at[c];
    }
    for (size_t a = 0; a < n; a++) {
        more[a] = 0.0;
        for (size_t b = 0; b < n; b++) {
            more[a] += fit->slope2[a > b ? a * n + b : b * n + a] * back[b];
        }
        fit->rest2 += back[a] * (2.0 * fit->slope_rest[a] + more[a]);
    }
    for (size_t a = 0; a < n; a++) {
        fit->slope_rest[a] += more[a];
    }
}

void dig_fit_set_noise(struct dig_fit *const fit, const double s2)
{
    assert(fit != NULL && s2 > 0.0);
    fit->s2       = s2;
    fit->log_none = 0.0;
    fit->log_none = solve_at(fit, 0, 0.0, DIG_FIT_NOTHING).log_evidence;
}

void dig_fit_sum(struct dig_fit *const fit, const double weight[])
{
    assert(fit != NULL);
    const size_t n = fit->lines.columns;
    fit->rows      = 0.0;
    fit->rest2     = 0.0;
    memset(fit->slope_rest, 0, n * sizeof(double));
    memset(fit->slope2, 0, n * n * sizeof(double));
    for (size_t d = 0; d < fit->lines.digs; d++) {
        const struct dig_lines_normal *const normal = &fit->lines.normal[d];
        const double                         w      = weight != NULL ? weight[d] : 1.0;
        if (!(w > 0.0)) {
            continue;
        }
        fit->rows += w * (double)normal->rows;
        fit->rest2 += w * normal->rest2;
        for (size_t a = 0; a < n; a++) {
            fit->slope_rest[a] += w * normal->slope_rest[a];
        }
        for (size_t i = 0; i < n * n; i++) {
            fit->slope2[i] += w * normal->slope2[i];
        }
    }
    move_to_absent(fit);

    fit->s2                = 1.0;
    const double free_rows = fmax(fit->rows - (double)n, 0.25 * fit->rows);
    const double rest2     = solve_at(fit, ~0U, 1.0, DIG_FIT_NOTHING).rest2;
    dig_fit_set_noise(fit, fmax(1.0, rest2 / fmax(free_rows, 1.0)));
}

// The width that gives one effect the most evidence. Of several, none is narrow: a weak one beside
// another is what the other's formula lacks.
static double width_of(const struct dig_fit *const fit, const unsigned set)
{
    double       best = -INFINITY;
    double       wide = scale;
    const size_t most = (set & (set - 1U)) == 0 ? WIDTHS : WIDTHS_OF_SETS;
    for (size_t w = 0; w < most; w++) {
        const double tried = solve_at(fit, set, width[w], DIG_FIT_NOTHING).log_evidence;
        wide               = tried > best ? width[w] : wide;
        best               = fmax(tried, best);
    }
    return wide;
}

struct dig_fit_answer dig_fit_solve(const struct dig_fit *const fit, const unsigned set,
                                    const enum dig_fit_leave leave)
{
    assert(fit != NULL);
    struct dig_fit_answer answer = solve_at(fit, set, width_of(fit, set), leave);
    answer.log_evidence -= set != 0 ? log(WIDTHS) : 0.0;
    return answer;
}

struct dig_fit_answer dig_fit_solve_wide(const struct dig_fit *const fit, const unsigned set,
                                         const enum dig_fit_leave leave)
{
    assert(fit != NULL);
    struct dig_fit_answer answer = solve_at(fit, set, scale, leave);
    answer.log_evidence -= log(WIDTHS);
    return answer;
}

double dig_fit_evidence(const struct dig_fit *const fit, const unsigned set)
{
    return dig_fit_solve(fit, set, DIG_FIT_NOTHING).log_evidence;
}

// What is left at other values, and what priors of these widths lose there.
static double rest2_at(const struct dig_fit *const fit, const double at[], const double widths[])
{
    double sum = 0.0;
    for (size_t c = 0; c < fit->lines.columns; c++) {
        sum += widths[c] > 0.0 ? pow(at[c] / widths[c], 2.0) : 0.0;
    }
    return dig_lines_rest2(&fit->lines, at) + fit->s2 * sum;
}

double dig_fit_step(struct dig_fit *const fit, const double widths[])
{
    assert(fit != NULL && widths != NULL);
    const double now = rest2_at(fit, fit->lines.at, widths);
    for (int halved = 0; halved < HALVINGS; halved++) {
        double tried[DIG_LINES_COLUMNS_MAX];
        double moved = 0.0;
        for (size_t c = 0; c < fit->lines.columns; c++) {
            const double way = ldexp(fit->at[c] - fit->lines.at[c], -halved);
            tried[c]         = fit->lines.at[c] + way;
            moved            = widths[c] > 0.0 ? fmax(moved, fabs(way) / widths[c]) : moved;
        }
        if (rest2_at(fit, tried, widths) <= now) {
            memcpy(fit->lines.at, tried, fit->lines.columns * sizeof(double));
            return moved;
        }
    }
    return 0.0;
}

// The one whose change gains most, and the gain.
static double best_change(const struct dig_greedy *const from, const unsigned set, const bool adds,
                          unsigned *const changed)
{
    const double now  = from->evidence(from->context, set);
    double       best = -INFINITY;
    for (unsigned e = 0; e < from->n; e++) {
        const unsigned bit = 1U << e;
        if (((set & bit) == 0) == adds) {
            const double gain = from->evidence(from->context, set ^ bit) - now;
            if (gain > best) {
                best     = gain;
                *changed = set ^ bit;
            }
        }
    }
    return best;
}

unsigned dig_greedy_select(const struct dig_greedy *const from, unsigned set)
{
    assert(from != NULL && from->evidence != NULL);
    for (unsigned step = 0; step < from->n; step++) {
        unsigned more = set;
        if (!(best_change(from, set, true, &more) > from->least)) {
            break;
        }
        set = more;
        for (unsigned back = 0; back < from->n && set != 0; back++) {
            unsigned less = set;
            if (!(best_change(from, set, false, &less) > -from->least)) {
                break;
            }
            set = less;
        }
    }
    return set;
}

static double evidence(void *const context, const unsigned set)
{
    return dig_fit_evidence(context, set);
}

unsigned dig_fit_select(struct dig_fit *const fit, const double least, const unsigned set)
{
    assert(fit != NULL);
    return dig_greedy_select(&(struct dig_greedy){ DIG_MACHINE_EFFECTS, least, evidence, fit },
                             set);
}
