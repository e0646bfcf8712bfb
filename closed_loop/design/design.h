// Ranks simple digs by their information on the gravel, from the table's means and the scatter of
// its packings, before anything is dug.
//
//   information = 1/2 log2 det(1 + J' C^-1 J / 3)   bits
//
// J: derivative of one dig's features by the gravel's place (-1 … 1 on each axis, closed_loop/
// response_surface.h); C: covariance of one dig and of the table's mean; 1/3 is the variance of a
// place of which nothing is known. Averages over gravels of the table. Linear theory; the
// simulation beside it is not. What tells effects apart a trace says of the digs at hand.

#ifndef DIG_CLOSED_LOOP_DESIGN_DESIGN_H
#define DIG_CLOSED_LOOP_DESIGN_DESIGN_H

#include "closed_loop/model/response_surface.h"
#include "closed_loop/model/scatter.h"

#include <stdbool.h>
#include <stdint.h>

/// A dig of at most so many phases is simple: in, along or about, out.
#define DIG_DESIGN_SIMPLE_PHASES 3

struct dig_design_dig {
    bool   known, simple;
    double duration_s, path_m;
    double bits;         // on the gravel, of one dig of which the moment is measured
    double bits_wrench;  // of which both forces are measured too
    double sd[DIG_AXES]; // 1 sigma left of an axis, as a share of knowing nothing (moment)
    size_t partner;      // the second dig that adds most, itself perhaps …
    double bits_partner; // … and what both tell (moment)
    // Simulated, moment alone: rms error of the gravel's place after one dig over that of knowing
    // nothing, by axis and over all; rms relative error of the target's moment predicted with it.
    double error_axis[DIG_AXES];
    double error;
    double target_error;
};

struct dig_design {
    size_t                digs; // trajectories of the table
    struct dig_design_dig dig[DIG_TRAJECTORY_MAX];
    size_t                ranked; // simple ones, best first
    size_t                rank[DIG_TRAJECTORY_MAX];
    size_t                target;    // the dig to be predicted: the one of most phases
    size_t                reference; // "simpleA", or the first simple one of the table
    size_t                draws;
    // Squared error of the gravel's place by the reference less that by the best, mean over draws
    // with its 90 % interval: above 0 throughout, the recommendation is confirmed.
    double gain, gain_low, gain_high;
    bool   confirmed;
};

/// Computes it in a second or two with 400 draws, on 1 MB of stack. DIG_EINVAL: no simple
/// trajectory; DIG_ENOMEM. Writes *design on success only.
DIG_MUST_CHECK enum dig_status dig_design_run(const struct dig_response_surface *surface,
                                              const struct dig_scatter *scatter, size_t draws,
                                              uint64_t seed, struct dig_design *design);

#endif // DIG_CLOSED_LOOP_DESIGN_DESIGN_H
