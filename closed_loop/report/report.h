// What a run of the daemon showed, as one self-contained HTML page: which gravel was identified,
// what was predicted, what was measured, how far apart they are.

#ifndef DIG_CLOSED_LOOP_REPORT_REPORT_H
#define DIG_CLOSED_LOOP_REPORT_REPORT_H

#include "core/curve.h"
#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#define DIG_REPORT_RUNS_MAX 4

/// What each page says below of the error it shows.
#define DIG_REPORT_ERROR_NOTE                                                                       \
    "Error: relative Euclidean norm of the moment, measured minus predicted, over rig time from "   \
    "contact to exit, moving average ±0.16 s. Noise floor: 1 σ of what it would be if the model " \
    "were complete."

/// One dig of a run on the table's grid of path progress, rig scale, smoothed.
struct dig_report_dig {
    char   trajectory[DIG_NAME_SIZE];
    double first, last;                    // progress range that was measured
    double measured_Nm[DIG_CURVE_POINTS];  // by the estimator, from pressures and angles
    double model_Nm[DIG_CURVE_POINTS];     // identified on it, or predicted for it
    double sigma_Nm[DIG_CURVE_POINTS];     // 1 sigma of one dig about the model
    double recording_Nm[DIG_CURVE_POINTS]; // what was fed to the rig; NaN where not known
};

/// One run: one bus, one simple dig that identifies, one actual dig that was predicted.
struct dig_report_run {
    char                  name[64]; // "Modbus TCP"
    char                  dig[96];  // which recording, for people
    bool                  truth_known;
    struct dig_gravel     truth;
    struct dig_gravel     gravel, low, high; // identified: value, 5 %, 95 %
    struct dig_gravel     nearest;
    double                distance; // of the simple dig's curve to the fitted one, relative
    struct dig_report_dig simple;
    struct dig_report_dig real;
    double                error; // of the predicted dig against the measured one (docs/numerics.md)
    double                noise_floor; // 1 sigma of what it would be if the model were complete
};

struct dig_report {
    const char           *title;
    const char           *table;  // file; its folders are left out
    double                lambda; // machine's tooth length / rig's
    size_t                runs;
    struct dig_report_run run[DIG_REPORT_RUNS_MAX];
};

/// An axis of the gravel for people, with its unit; and the digits that are enough to see.
const char *dig_report_axis(int axis);
int         dig_report_axis_digits(int axis);

/// A chance for people: none is 0, though numbers may be too small to be told from it.
const char *dig_report_chance(double chance, size_t size, char text[]);

/// The lines a terminal gets: true and identified gravel with its 90 % interval, error and floor.
void dig_report_text(const struct dig_report *report, FILE *to);

/// The same as one JSON object.
void dig_report_json(const struct dig_report *report, FILE *to);

/// The page: needs gnuplot; DIG_EIO with *error without it.
DIG_MUST_CHECK enum dig_status dig_report_html(const struct dig_report *report, FILE *to,
                                               struct dig_error *error);

#endif // DIG_CLOSED_LOOP_REPORT_REPORT_H
