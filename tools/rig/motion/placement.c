#include "tools/rig/motion/placement.h"

#include <math.h>
#include <stdbool.h>

// Every so many frames of the path: 10 ms, less than the force between grains takes to peak; and to
// see roughly where a good place is.
static const size_t fine_stride   = 10;
static const size_t coarse_stride = 160;

static const double per_metre = 0.05; // that the dug surface lies off the tracks' ground

// Out of a joint's or a cylinder's range is worse than any load: a smaller load would not help.
static const double out_of_range = 1e6;

struct found {
    double                score; // to be large
    struct dig_rig_margin margin;
};

// The least over every so many frames of the path, or something not above `enough` as soon as it is
// sure to be. *first: the frame to begin at, and then that of the least: what stops one place stops
// most of its neighbours.
static enum dig_status least_margin(const struct dig_machine *const  machine,
                                    const struct dig_rig_path *const path, const size_t stride,
                                    const double X_m, const double Z_m, const double enough,
                                    size_t *const first, struct found *const found)
{
    const struct dig_rig_motion still = { .turn_radps2 = { 0.0 } };
    const size_t                begin = *first;
    const size_t                tried = (path->frames + stride - 1) / stride;
    struct found                least = { .score = INFINITY };
    for (size_t n = 0; n < tried; n++) {
        const size_t        at   = (begin + n) % tried;
        const size_t        i    = at * stride;
        struct dig_rig_pose pose = path->frame[i].pose;
        pose.X_m += X_m;
        pose.Z_m += Z_m;
        struct dig_rig_state  state;
        const enum dig_status status =
            dig_rig_state_solve(machine, &pose, &still, &path->frame[i].soil, &state);
        if (status != DIG_OK) {
            *first = at;
            return status;
        }
        const bool         fits = state.mechanical.share > 0.0;
        const struct found here = {
            .score  = fits ? state.nearest.share : state.mechanical.share - out_of_range,
            .margin = fits ? state.nearest : state.mechanical,
        };
        if (!(here.score >= least.score)) {
            least  = here;
            *first = at;
        }
        if (!(least.score > enough)) {
            break;
        }
    }
    *found = least;
    return DIG_OK;
}

static double reach_of_m(const struct dig_machine *const machine)
{
    return machine->link[DIG_JOINT_BOOM].length_m + machine->link[DIG_JOINT_ARM].length_m;
}

// Pin height when the dug surface is at the tracks' ground: the tooth touches it at the start.
static double level_of_m(const struct dig_machine *const  machine,
                         const struct dig_rig_path *const path)
{
    return -machine->boom_foot_Z_m -
           machine->link[DIG_JOINT_BUCKET].length_m * sin(path->contact_phi_rad);
}

// The best of all places by every so many frames, of those whose score is above *score, which is
// then its. None: nothing is written.
static void best_place(const struct dig_machine *const  machine,
                       const struct dig_rig_path *const path, const size_t stride,
                       double *const score, struct dig_rig_placement *const place)
{
    static const double surface_m[] = { 0.0, -0.25, 0.25, -0.5, 0.5, -0.75, 0.75, -1.0, 1.0 };

    const double reach_m = reach_of_m(machine);
    const double level_m = level_of_m(machine, path);
    size_t       first   = 0;
    for (size_t s = 0; s < sizeof surface_m / sizeof surface_m[0]; s++) {
        const double penalty = per_metre * fabs(surface_m[s]);
        for (int percent = 25; percent < 100; percent++) {
            const double          X_m = 0.01 * percent * reach_m;
            const double          Z_m = level_m + surface_m[s];
            struct found          found;
            const enum dig_status status =
                least_margin(machine, path, stride, X_m, Z_m, *score + penalty, &first, &found);
            if (status == DIG_OK && found.score - penalty > *score) {
                *place =
                    (struct dig_rig_placement){ .X_m = X_m, .Z_m = Z_m, .margin = found.margin };
                *score = found.score - penalty;
            }
        }
    }
}

// A score that the best place surely is above: just below that of the one which is best by few
// frames. Most others are told to be worse by their first frame then.
static double surely_below(const struct dig_machine *const  machine,
                           const struct dig_rig_path *const path)
{
    struct dig_rig_placement place;
    struct found             found;
    double                   score = -INFINITY;
    size_t                   first = 0;
    best_place(machine, path, coarse_stride, &score, &place);
    if (!isfinite(score) || least_margin(machine, path, fine_stride, place.X_m, place.Z_m,
                                         -INFINITY, &first, &found) != DIG_OK) {
        return -INFINITY;
    }
    return found.score - per_metre * fabs(place.Z_m - level_of_m(machine, path)) - 1e-9;
}

enum dig_status dig_rig_placement_find(const struct dig_machine *const  machine,
                                       const struct dig_rig_path *const path,
                                       struct dig_rig_placement *const  placement,
                                       struct dig_error *const          error)
{
    struct dig_rig_placement best       = { .X_m = 0.0 };
    double                   best_score = surely_below(machine, path);
    best_place(machine, path, fine_stride, &best_score, &best);
    if (!isfinite(best_score)) {
        return dig_error_set(
            error, DIG_EUNREACHABLE,
            "%s: no place within reach of boom and arm (%.2f m) holds the whole dig", machine->name,
            reach_of_m(machine));
    }
    if (best_score < -0.5 * out_of_range) {
        char text[200];
        return dig_error_set(
            error, DIG_EUNREACHABLE,
            "%s cannot do this dig anywhere; nearest with the pin starting at X %.2f "
            "m, Z %.2f m: %s",
            machine->name, best.X_m, best.Z_m,
            dig_rig_margin_text(&best.margin, sizeof text, text));
    }
    *placement = best;
    return DIG_OK;
}
