// What the paper's findings are tested on: the runs of a table one by one, and recordings of digs,
// all smoothed and on the grid of the path.

#ifndef DIG_TESTS_PAPER_DIGS_H
#define DIG_TESTS_PAPER_DIGS_H

#include "core/curve.h"
#include "core/error.h"

#include <stdbool.h>
#include <stdint.h>

/// One dig of the table.
struct paper_run {
    size_t entry, trajectory, packing;
    double moment_Nm[DIG_CURVE_POINTS];
    // As the engine gave it: windows moments, Fx, Fz, the i-th at first_s + i step_s.
    size_t windows;
    double first_s, step_s;
    float *raw; // [3 * windows]
};

/// One dig of a recording. Its gravel is read off the name ("mu0.5_mur0.9_rho2500…").
struct paper_recording {
    char   name[64]; // of the file, without folder and ending
    size_t entry;    // SIZE_MAX: no gravel of the table
    size_t trajectory;
    double moment_Nm[DIG_CURVE_POINTS];
};

struct paper_table {
    struct dig_curve_set   *set;
    size_t                  runs;
    struct paper_run       *run;
    size_t                  recordings;
    struct paper_recording *recording;
};

/// Reads a table and recordings of its scene. Free with paper_finish().
DIG_MUST_CHECK enum dig_status paper_load(const char *path, size_t files, char *const file[],
                                          struct paper_table *table, struct dig_error *error);
void                           paper_finish(struct paper_table *table);

/// Index of a trajectory of the table; exits when there is none.
size_t paper_trajectory(const struct paper_table *table, const char *name);

/// The mean over an entry's beds without run number `skip` (SIZE_MAX: with all); how many it has.
size_t paper_mean(const struct paper_table *table, size_t entry, size_t trajectory, size_t skip,
                  double mean_Nm[DIG_CURVE_POINTS]);

/// The dig of the same bed along another trajectory, or SIZE_MAX.
size_t paper_same_bed(const struct paper_table *table, size_t run, size_t trajectory);

/// The recording of the same bed along another trajectory, or NULL.
const struct paper_recording *paper_pair(const struct paper_table *table, size_t recording,
                                         size_t trajectory);

/// True for the paper's objects A, B and C (its Table V).
bool paper_is_object(const double gravel[DIG_AXES]);

/// OUT/NAME.dat: time and moment, for gnuplot.
void paper_write_curve(const char *out, const char *name, const struct paper_table *table,
                       size_t trajectory, const double moment_Nm[DIG_CURVE_POINTS]);

/// OUT/NAME.csv: a run of the table as a force recording.
void paper_write_run(const char *out, const char *name, const struct paper_table *table,
                     size_t run);

#endif // DIG_TESTS_PAPER_DIGS_H
