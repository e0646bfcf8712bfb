#include "closed_loop/recordings/alignment.h"

#include "closed_loop/recordings/observe.h"
#include "core/entry_set.h"
#include "estimator/approach/approach_fit.h"
#include "estimator/approach/approach_route.h"
#include "estimator/approach/approach_slots.h"
#include "estimator/approach/approaches.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

// Of two trajectories that a path fits alike it follows the one against which the bucket is turned
// less.
static const double turn_share = 0.1;

// The way at equal steps of progress.
static void lay_out(const struct dig_recording *const recording, const double progress[],
                    const double tooth_m, struct dig_path_point way[const DIG_APPROACH_FIT_POINTS])
{
    struct dig_alignment_place at = { .row = 0 };
    for (int k = 0; k < DIG_APPROACH_FIT_POINTS; k++) {
        const double along = (double)k / (DIG_APPROACH_FIT_POINTS - 1);
        at                 = dig_alignment_place(recording->rows, progress, along, at.row);

        const struct dig_pose pose = dig_alignment_pose(recording, &at);
        way[k] = (struct dig_path_point){ pose.x_m, pose.z_m, tooth_m * pose.theta_rad };
    }
}

// The rms distance from the trajectory dug as the way was, with what of that the table does not
// reach in quadrature.
static double fit_distance(const struct dig_recording *const recording, const double progress[],
                           const struct dig_curve_set *const set, const size_t trajectory,
                           struct dig_approach *const made, struct dig_approach *const reached)
{
    struct dig_path_point way[DIG_APPROACH_FIT_POINTS];
    lay_out(recording, progress, set->tooth_m, way);
    const double off_m = dig_approach_fit(&set->trajectory[trajectory], set->tooth_m,
                                          set->approaches->depth_m[trajectory], way, made);
    return hypot(off_m, dig_approach_clamp(set, trajectory, made, reached)) / set->tooth_m;
}

// A path of which one trajectory may be the nearest, and another have too short a part alike it.
static enum dig_status refuse_path(const struct dig_curve_set *const set, const int nearest,
                                   const double off, const int cut, struct dig_error *const error)
{
    char lacks[DIG_NAME_SIZE + 64] = "";
    char away[DIG_NAME_SIZE + 64]  = "";
    if (cut >= 0) {
        (void)snprintf(lacks, sizeof lacks, "; it lacks more than three tenths of \"%s\" at an end",
                       set->trajectory[cut].name);
    }
    if (nearest >= 0) {
        (void)snprintf(away, sizeof away,
                       ": nearest is \"%s\", %.3f bucket lengths away, expected at most %.2f",
                       set->trajectory[nearest].name, off, DIG_OBSERVE_PATH_LIMIT);
    }
    return dig_error_set(error, DIG_ENOMATCH, "the recording's path is none of the table's%s%s",
                         away, lacks);
}

enum dig_status dig_path_match(const struct dig_curve_set *const set,
                               const struct dig_recording *const recording, const double progress[],
                               const bool as_dug, struct dig_measured *const observed,
                               struct dig_alignment_part *const best_part,
                               struct dig_error *const          error)
{
    assert(set != NULL && recording != NULL && progress != NULL && observed != NULL);
    int    best  = -1;
    int    cut   = -1;
    double least = INFINITY;
    *best_part   = (struct dig_alignment_part){ .to = 1.0, .off = (double)INFINITY };
    for (size_t t = 0; t < set->trajectories; t++) {
        struct dig_approach       made     = dig_approach_plain();
        struct dig_approach       approach = dig_approach_plain();
        struct dig_alignment_part part     = { .to = 1.0 };
        if (as_dug && dig_approach_varies(set, t)) {
            part.off = fit_distance(recording, progress, set, t, &made, &approach);
        } else {
            const struct dig_route            route  = dig_approach_route(set, t);
            const struct dig_alignment_target target = { &set->trajectory[t], set->tooth_m,
                                                         route.turn_least_m / set->tooth_m,
                                                         route.turn_most_m / set->tooth_m };
            part            = dig_alignment_align(recording, progress, &target);
            made.attack_rad = part.turned_rad;
        }
        const double score = hypot(part.off, turn_share * made.attack_rad);
        if (dig_alignment_lacks_too_much(&part)) {
            cut = part.off <= DIG_OBSERVE_PATH_LIMIT ? (int)t : cut;
        } else if (score < least) {
            least              = score;
            best               = (int)t;
            *best_part         = part;
            observed->made     = made;
            observed->approach = approach;
        }
    }
    if (best < 0 || !(best_part->off <= DIG_OBSERVE_PATH_LIMIT)) {
        return refuse_path(set, best, best_part->off, cut, error);
    }
    observed->trajectory = best;
    observed->off_path_m = best_part->off * set->tooth_m;
    return DIG_OK;
}
