// Curves with bands as an SVG picture. The gnuplot program (found in PATH) draws axes and curves
// and is given numbers only: its language runs commands that stand in a text. Titles, labels and
// the key are written around its picture here, escaped.

#ifndef DIG_CLOSED_LOOP_REPORT_PLOT_H
#define DIG_CLOSED_LOOP_REPORT_PLOT_H

#include "core/curve.h"
#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#define DIG_PLOT_SERIES_MAX 8

/// Told apart without colour: what is measured is a line or points, what is predicted is dashed.
enum dig_plot_style {
    DIG_PLOT_LINE,
    DIG_PLOT_DASHED,
    DIG_PLOT_DOTTED,
    DIG_PLOT_POINTS,
    DIG_PLOT_BAND
};

/// Colours of all pages.
enum {
    DIG_PLOT_PREDICTED = 0x1f5fa8,
    DIG_PLOT_MEASURED  = 0xc0392b,
    DIG_PLOT_BEFORE    = 0xc77f00,
    DIG_PLOT_FED       = 0x555555
};

struct dig_plot_series {
    const char         *title; // in the key; NULL: not in the key
    enum dig_plot_style style;
    unsigned            rgb; // 0x1f5fa8
    size_t              n;
    const double       *x;
    const double       *y;    // the lower edge of a band
    const double       *high; // the upper edge of a band; else unused
};

struct dig_plot {
    const char            *title;
    const char            *x_label;
    const char            *y_label;
    const char            *right_label;  // of a second scale at the right; NULL: none
    double                 right_factor; // what y is on it: y times this
    double                 x_to;         // the axis goes from 0 to here; 0: as the points lie
    bool                   from_zero;    // the y axis holds 0
    bool                   counts;       // y counts something: no marks between whole numbers
    unsigned               height;       // of 480 wide, where text is 14 high
    size_t                 series;       // drawn in this order, later ones on top
    struct dig_plot_series s[DIG_PLOT_SERIES_MAX];
};

#define DIG_PLOT_BAND_SIGMAS 1.645 // of the band that holds 90 % of digs

/// A channel of one dig over its path, %, as it was measured and as a model has it.
struct dig_plot_dig {
    double x[DIG_CURVE_POINTS], measured[DIG_CURVE_POINTS], model[DIG_CURVE_POINTS];
    double low[DIG_CURVE_POINTS], high[DIG_CURVE_POINTS]; // the band about the model
};

/// Fills it from curves and the model's sigma, so many units of theirs to one of the picture. What
/// was measured is a gap outside the progress first to last.
void dig_plot_of_dig(double unit, const double measured[DIG_CURVE_POINTS], double first,
                     double last, const double model[DIG_CURVE_POINTS],
                     const double sigma[DIG_CURVE_POINTS], struct dig_plot_dig *dig);

/// Writes a <figure> for an HTML page, of one <svg> element. Points that are not finite are gaps.
/// As one of a page's conditions: where one before it did not hold it is not drawn. DIG_EIO:
/// gnuplot is missing or failed; nothing useful was written then. Starts a process; takes some tens
/// of milliseconds.
void dig_plot_figure(const struct dig_plot *plot, FILE *to, struct dig_conditions *c);

#endif // DIG_CLOSED_LOOP_REPORT_PLOT_H
