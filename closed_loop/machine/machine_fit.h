// Selects effects of the machine by their evidence in free air, and solves for their values.
//
// Linear in theta with independent normal priors (here of unit width), noise of variance s2 (never
// below the sensors'), the evidence of a set of effects is closed form: with H = I + A / s2 over
// its columns and b = -g / s2,
//
//   log evidence = ( b^T H^-1 b - log det H ) / 2                       against no effect at all
//
// so a parameter that the air does not show costs nothing and earns nothing. The width of one
// effect's prior is not known: of a few widths the best is taken, less the log of their number.
// Under no effect the evidence ratio has mean 1,
// hence exceeds K with a chance of at most 1 / K (Ville): an effect joins when the ratio exceeds
// candidates / false_alarm.

#ifndef DIG_CLOSED_LOOP_MACHINE_MACHINE_FIT_H
#define DIG_CLOSED_LOOP_MACHINE_MACHINE_FIT_H

#include "closed_loop/machine/machine_lines.h"
#include "core/status.h"

#include <stddef.h>

/// Free air made linear, its normal equations summed over digs, at all parameters absent. Free with
/// dig_fit_finish().
///
/// A set is a bit for each thing that columns belong to: for each effect of enum dig_effect_id, as
/// made; whoever asks of something else than effects writes of, base and wide anew.
struct dig_fit {
    struct dig_lines lines;
    int              of[DIG_LINES_COLUMNS_MAX];   // the bit of a column; -1: of none
    double           base[DIG_LINES_COLUMNS_MAX]; // width of its prior beside a set, in scales; 0:
                                                  // it stays absent
    double  wide[DIG_LINES_COLUMNS_MAX];          // and in it, of a set of width 1
    double  rows, rest2;
    double  slope_rest[DIG_LINES_COLUMNS_MAX]; // as struct dig_lines_normal
    double *slope2;
    double  s2;       // variance of the noise in the rows' sigmas
    double  log_none; // log evidence of the empty set
    double *work;     // [columns * columns]
    // Values and covariance as last solved for, 0 where not of the set.
    double *at;         // [columns]
    double *covariance; // [columns * columns]
};

/// What of an answer is left in the fit: nothing, its values, or both.
enum dig_fit_leave { DIG_FIT_NOTHING, DIG_FIT_VALUES, DIG_FIT_COVARIANCE };

/// One set, solved.
struct dig_fit_answer {
    double log_evidence;
    double rest2; // that remains
    double width; // of the prior
};

/// Makes the columns as dig_lines_make() does. Errors of the file have their prior in every answer.
/// DIG_ENOMEM: *fit is empty then.
DIG_MUST_CHECK enum dig_status
dig_fit_make(struct dig_air *air, const double file_scale[DIG_FILE_ERRORS], struct dig_fit *fit);
void dig_fit_finish(struct dig_fit *fit);

/// Sums the digs with these weights (how often each counts; NULL: once) and takes s2 from what all
/// columns together leave.
void dig_fit_sum(struct dig_fit *fit, const double weight[]);

/// Another variance of the noise in the rows' sigmas than that.
void dig_fit_set_noise(struct dig_fit *fit, double s2);

/// Solves for the set; the evidence is against the empty one. A bent column stays where the lines
/// have it.
struct dig_fit_answer dig_fit_solve(const struct dig_fit *fit, unsigned set,
                                    enum dig_fit_leave leave);

/// The same with priors as wide as the parameters' scales. A prior counts the more, the less the
/// air shows of a parameter.
struct dig_fit_answer dig_fit_solve_wide(const struct dig_fit *fit, unsigned set,
                                         enum dig_fit_leave leave);

/// The widths of all columns' priors, of a set of this width.
void dig_fit_widths(const struct dig_fit *fit, unsigned set, double wide, double widths[]);

/// Every column with a prior of its own width, in scales; 0: it stays absent. The evidence is that
/// of these priors, without a choice of widths; the answer's width is 1.
struct dig_fit_answer dig_fit_solve_each(const struct dig_fit *fit, const double widths[],
                                         enum dig_fit_leave leave);

/// The log evidence of a set alone.
double dig_fit_evidence(const struct dig_fit *fit, unsigned set);

/// Moves the lines to fit->at, or half of the way, or half of that: until what is left, not linear,
/// grows no more than priors of these widths gain. How far the farthest column moved, in widths;
/// one of width 0 goes along and does not count.
double dig_fit_step(struct dig_fit *fit, const double widths[]);

/// What a set is chosen from, a bit each.
struct dig_greedy {
    unsigned n;
    double   least;                                  // log evidence that one must bring
    double (*evidence)(void *context, unsigned set); // -INFINITY: no such set
    void *context;
};

/// Adds to the set while the log evidence grows by more than least, the best one each time; after
/// each takes out what it no longer needs.
unsigned dig_greedy_select(const struct dig_greedy *from, unsigned set);

/// The same of effects.
unsigned dig_fit_select(struct dig_fit *fit, double least, unsigned set);

#endif // DIG_CLOSED_LOOP_MACHINE_MACHINE_FIT_H
