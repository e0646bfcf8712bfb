// Trust of each row of free air: where effects explain much of it, their form may be wrong, and a
// rod that stands may be held by friction.

#include "closed_loop/machine/machine_fit.h"
#include "estimator/effects/effect.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// Forms may be wrong by all of their share, by half of it, and so on.
enum { FORM_SHARES = 4 };

// Adds what may be wrong with the form of what an effect explains of every row, in its sigmas: rows
// of a joint follow each other every DIG_JOINTS rows at most.
static void add_form(const struct dig_air *const air, const enum dig_effect_id effect,
                     const double explained[], double wrong[])
{
    const struct dig_effect *const known = dig_effect_of(effect);
    for (size_t r = 0; r < air->rows; r++) {
        const double here = fabs(explained[r]);
        double       most = here;
        size_t       by   = r > DIG_JOINTS ? r - DIG_JOINTS : 0;
        for (; by <= r + DIG_JOINTS && by < air->rows; by++) {
            if (air->row[by].joint == air->row[r].joint &&
                air->row[by].segment == air->row[r].segment) {
                most = fmax(most, fabs(explained[by]));
            }
        }
        wrong[r] += known->wrong_share * here + known->wrong_step * (most - here);
    }
}

// Chi-squared of sums over one segment and joint each: what is slow shows here best.
static double slow_rest2(const struct dig_lines *const lines, const double rest[],
                         const double wrong[])
{
    double sum = 0.0;
    for (size_t s = 0; s < lines->air->segments; s++) {
        const struct dig_air_segment *const segment = &lines->air->segment[s];

        double of[DIG_JOINTS]    = { 0.0 };
        double off[DIG_JOINTS]   = { 0.0 };
        double count[DIG_JOINTS] = { 0.0 };
        for (size_t r = segment->first_row; r < segment->first_row + segment->rows; r++) {
            const enum dig_joint j = lines->air->row[r].joint;
            of[j] += rest[r];
            off[j] += wrong[r];
            count[j] += 1.0;
        }
        for (int j = 0; j < DIG_JOINTS; j++) {
            sum += count[j] > 0.0 ? of[j] * of[j] / (count[j] + off[j] * off[j]) : 0.0;
        }
    }
    return sum;
}

// What an effect explains of every row whose rest with all of them is given; false when it has no
// values.
static bool explain(const struct dig_lines *const lines, const enum dig_effect_id effect,
                    const double rest[], double explained[])
{
    double at[DIG_LINES_COLUMNS_MAX];
    bool   any = false;
    for (size_t c = 0; c < lines->columns; c++) {
        const bool mine = lines->column[c].effect == effect;
        any             = any || (mine && fabs(lines->at[c]) > 0.0);
        at[c]           = mine ? 0.0 : lines->at[c];
    }
    if (any) {
        dig_lines_rest(lines, at, explained);
    }
    for (size_t r = 0; r < lines->air->rows && any; r++) {
        explained[r] -= rest[r];
    }
    return any;
}

// How much of what a form may be wrong by is wrong here: the share by which the rest is likeliest.
// wrong is of all forms, held of what cannot be told from it and stays as it is.
static double form_share(const size_t rows, const double rest[], const double wrong[],
                         const double held[])
{
    double best      = 1.0;
    double likeliest = -INFINITY;
    for (int halved = 0; halved < FORM_SHARES; halved++) {
        const double share          = ldexp(1.0, -halved);
        double       log_likelihood = 0.0;
        for (size_t r = 0; r < rows; r++) {
            const double sigma = hypot(1.0, share * wrong[r] + held[r]);
            log_likelihood -= log(sigma) + 0.5 * pow(rest[r] / sigma, 2.0);
        }
        if (log_likelihood > likeliest) {
            likeliest = log_likelihood;
            best      = share;
        }
    }
    return best;
}

double dig_lines_judge(struct dig_lines *const lines)
{
    assert(lines != NULL);
    const size_t  rows      = lines->air->rows;
    double *const rest      = lines->work;
    double *const explained = rest + rows;
    double *const wrong     = rest + 2 * rows;
    memset(wrong, 0, rows * sizeof *wrong);
    dig_lines_rest(lines, lines->at, rest);
    for (int e = 0; e < DIG_MACHINE_EFFECTS; e++) {
        if (explain(lines, (enum dig_effect_id)e, rest, explained)) {
            add_form(lines->air, (enum dig_effect_id)e, explained, wrong);
        }
    }
    dig_lines_correct(lines, lines->at, lines->correction);
    dig_air_held(lines->air, lines->correction, explained);
    const double share = form_share(rows, rest, wrong, explained);
    for (size_t r = 0; r < rows; r++) {
        wrong[r]        = share * wrong[r] + explained[r];
        lines->trust[r] = 1.0 / hypot(1.0, wrong[r]);
    }
    return slow_rest2(lines, rest, wrong);
}
