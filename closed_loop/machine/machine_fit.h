// Free air linearised: the slopes of its equations by every parameter of every effect of the
// machine, about the parameters' present values.
//
//   rest(theta) = rest + sum over columns of slope * (theta - at)      every row in its own sigmas
//
// A column is one parameter in units of its scale, 1 sigma of its prior. Payload is common to all
// segments but the one before the first dig. Each segment may have a payload of its own besides,
// one column more.
//
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

#include "closed_loop/air/machine_air.h"
#include "closed_loop/recordings/measured.h"
#include "core/effect.h"
#include "core/model.h"
#include "core/status.h"

#include <stddef.h>

#define DIG_MACHINE_ALL_EFFECTS ((1U << DIG_MACHINE_EFFECTS) - 1U)

/// The bit of the errors of the machine's file (enum dig_file_error). Their columns are of no
/// effect of the catalogue: DIG_EFFECT_UNLISTED.
#define DIG_LINES_OF_FILE (1U << DIG_EFFECT_UNLISTED)

/// Everything that has columns.
#define DIG_LINES_ALL (DIG_MACHINE_ALL_EFFECTS | DIG_LINES_OF_FILE)

#define DIG_LINES_COLUMNS_MAX                                                                      \
    ((size_t)DIG_MACHINE_EFFECTS * DIG_MODEL_PARAMETERS_MAX + DIG_LINES_SEGMENTS_MAX +             \
     DIG_FILE_ERRORS)
#define DIG_LINES_SEGMENTS_MAX ((size_t)2 * DIG_MEASURED_MAX)

struct dig_lines_column {
    enum dig_effect_id effect;
    size_t             parameter; // of the effect, or of enum dig_file_error
    int                segment;   // of its own, or -1: all
    double             scale;
};

/// Normal equations of one dig: slope^T slope, slope^T rest, rest^T rest over its rows.
struct dig_lines_normal {
    size_t  rows;
    double  rest2;
    double *slope_rest; // [columns]
    double *slope2;     // [columns * columns], the lower triangle
};

/// Free with dig_lines_finish().
struct dig_lines {
    struct dig_air         *air;
    size_t                  columns;
    struct dig_lines_column column[DIG_LINES_COLUMNS_MAX];
    double                  at[DIG_LINES_COLUMNS_MAX];     // in scales from absent
    double                  absent[DIG_LINES_COLUMNS_MAX]; // 0
    size_t                  digs;                          // those of the air, in its order
    size_t                  dig[DIG_LINES_SEGMENTS_MAX];   // which of them a segment is of
    struct dig_lines_normal normal[DIG_MEASURED_MAX];      // of each dig
    double                 *normals;                       // theirs
    double                 *trust;      // [rows] what each row's rest and slopes are multiplied by
    double                 *work;       // [3 + columns][rows]; see dig_lines_update()
    struct dig_correction  *correction; // [segments]; the same
    double                 *joint;      // room for the rows of a joint: machine_noise.c
    size_t                 *joint_row;
};

/// Writes a bucket's payload: the common one of these values, if it carries that, and one of its
/// own of own_kg. That lies where the common one does or, where that is hardly any, in the bucket's
/// centre of mass.
void dig_lines_carry(const double common[], bool carries, double own_kg,
                     struct dig_added_mass *payload);

/// Makes the columns, all parameters at their absent values. The air must outlive it. file_scale: 1
/// sigma of each error of the file, a column each; 0: no such error and no column. DIG_ENOMEM:
/// *lines is empty then.
DIG_MUST_CHECK enum dig_status dig_lines_make(struct dig_air   *air,
                                              const double      file_scale[DIG_FILE_ERRORS],
                                              struct dig_lines *lines);

void dig_lines_finish(struct dig_lines *lines);

/// Makes the equations linear around at, for the effects of the set (a bit each); columns of others
/// count as without effect. Two evaluations of the air a column: some tenths of a second for all.
/// Leaves in work every row's residual times its trust, which any function that needs room
/// overwrites, and the slopes.
void dig_lines_update(struct dig_lines *lines, unsigned set);

/// Slope of every row by a column, times the row's trust, as last updated: [rows].
const double *dig_lines_slope(const struct dig_lines *lines, size_t column);

/// Sets the trust of every row from what effects explain of it at the present values: an effect
/// says by what share its form may be wrong, and the rows' residuals how much of that share is.
/// Returns chi-squared of the segments' means, one degree of freedom for every segment and joint.
double dig_lines_judge(struct dig_lines *lines);

/// Residual of every row in its sigmas at other values, neither linearised nor times its trust:
/// rest[rows].
void dig_lines_rest(const struct dig_lines *lines, const double at[], double rest[]);

/// Errors of the file at these values.
void dig_lines_file(const struct dig_lines *lines, const double at[], double file[DIG_FILE_ERRORS]);

/// The corrections of all segments at these values, correction[segments].
void dig_lines_correct(const struct dig_lines *lines, const double at[],
                       struct dig_correction correction[]);

/// The sum of (trust * rest)^2 at other values.
double dig_lines_rest2(const struct dig_lines *lines, const double at[]);

/// The column of an effect's first parameter; its others follow.
size_t dig_lines_first(const struct dig_lines *lines, enum dig_effect_id effect);

/// True for a column that only counts once its effect is in: the speed of a Stribeck friction.
bool dig_lines_is_bent(const struct dig_lines *lines, size_t column);

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
