// Digs as people dig them, driven through an estimator: at any pace, with pauses, hesitations and
// unsteady hands, in part, given up. The soil resists as it did in digs of
// tables/reference_rig.sqlite, grain by grain; what the bucket did at each sample is known, and
// counted against what was told.

#ifndef DIG_TESTS_DUG_H
#define DIG_TESTS_DUG_H

#include "tests/driven.h"

/// What the bucket truly does.
enum dug_truth {
    DUG_AIR,  // before the dig, and after the load is gone
    DUG_WEAK, // in soil that resists by less than the sensors tell
    DUG_PENETRATION,
    DUG_DRAG,
    DUG_CURL,
    DUG_LIFT,
    DUG_OUT, // on its way out behind the path's end, or behind where it was given up, and the dump
    DUG_TRUTHS
};

/// What the estimator told: the phase, with what is done in the soil in the place of "dig".
enum dug_told {
    DUG_TOLD_AIR,
    DUG_TOLD_CONTACT,
    DUG_TOLD_NONE, // dig, and no motion
    DUG_TOLD_PENETRATION,
    DUG_TOLD_DRAG,
    DUG_TOLD_CURL,
    DUG_TOLD_LIFT,
    DUG_TOLD_EXIT,
    DUG_TOLDS
};

/// Samples, truth by told: near is within a tenth of a second of rig time, at the dig's pace, of
/// where the truth changes.
struct dug_matrix {
    size_t far[DUG_TRUTHS][DUG_TOLDS];
    size_t near[DUG_TRUTHS][DUG_TOLDS];
};

/// How one is dug.
struct dug_way {
    const char *name;
    double      loud;        // noise and steps of the sensors, times those of the ZX200
    double      pace;        // 2: twice as fast as Froude has it
    double      pause_s;     // machine time stood still in the middle; the soil relaxes
    int         hesitations; // short stops with a small step back, anywhere
    double      wobble_m;    // how far the hand strays from the path, rig scale
    double      from;        // progress up to which there is no soil (a hole)
    double      until;       // progress at which the bucket is lifted out; 1: dug to the end
    bool        carries;     // half of the moment when it is given up, as a load
};

/// One recorded dig: the moment of the soil at rig scale, window by window.
struct dug_soil {
    enum made_trajectory which;
    size_t               windows;
    double               first_s, step_s;
    const float         *moment_Nm;
};

/// What was told of a dig in the end.
struct dug_end {
    size_t digs;       // observed
    int    trajectory; // of the last one, or of the one followed until it was given up; -1: none
    double first, last;

    enum dig_ending ending;
};

/// Digs it with a fresh estimator and adds its samples to the matrix.
void dug_dig(const struct dug_soil *soil, const struct dug_way *way, uint64_t seed,
             struct dug_matrix *matrix, struct dug_end *end);

void dug_add(struct dug_matrix *sum, const struct dug_matrix *more);

/// Samples of a row, and the share told so, of those away from borders.
size_t dug_samples(const struct dug_matrix *matrix, enum dug_truth truth);
double dug_share(const struct dug_matrix *matrix, enum dug_truth truth, enum dug_told told);

void dug_print(const struct dug_matrix *matrix);

#endif // DIG_TESTS_DUG_H
