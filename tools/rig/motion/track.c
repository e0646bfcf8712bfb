#include "tools/rig/motion/track.h"

#include "tools/rig/motion/air.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Half width of the second difference that gives the accelerations, in frames.
static const size_t reach = 5;

struct dig_rig_track_options dig_rig_track_options_default(void)
{
    return (struct dig_rig_track_options){
        .scene_tooth_m = 0.09,
        .rate_Hz       = 200.0,
        .air           = true,
        .air_pace      = 1.0,
        .blend         = true,
    };
}

static struct dig_rig_pose placed(const struct dig_rig_path *const path, const size_t i,
                                  const struct dig_rig_placement *const placement)
{
    const struct dig_rig_pose pose = path->frame[i].pose;
    return (struct dig_rig_pose){ pose.X_m + placement->X_m, pose.Z_m + placement->Z_m,
                                  pose.phi_rad };
}

// Whether inertia counts at frame i: the machine stands still at both ends.
static bool moves(const struct dig_rig_track_options *const options,
                  const struct dig_rig_path *const path, const size_t i)
{
    return !options->quasi_static && i >= reach && i + reach < path->frames;
}

// Accelerations of the links at frame i, or of a bucket that a force sensor carries: second
// differences of where they are.
static enum dig_status move(const struct dig_machine *const  machine,
                            const struct dig_rig_path *const path, const size_t i,
                            const struct dig_rig_placement *const placement,
                            struct dig_rig_motion *const          motion)
{
    static const double   share[3] = { 1.0, -2.0, 1.0 };
    struct dig_rig_motion result   = { .turn_radps2 = { 0.0 } };
    const double          span_s   = (double)reach * DIG_RIG_STEP_s;
    const double          per_s2   = 1.0 / (span_s * span_s);
    for (size_t k = 0; k < 3; k++) {
        const struct dig_rig_pose pose   = placed(path, i - reach + k * reach, placement);
        struct dig_rig_joints     joints = { .rad = { 0.0 } };
        if (!machine->sensor.fitted && dig_rig_inverse(machine, &pose, &joints) != DIG_OK) {
            return DIG_EUNREACHABLE;
        }
        const struct dig_rig_front front = machine->sensor.fitted
                                               ? dig_rig_front_carried(machine, &pose)
                                               : dig_rig_front_at(machine, &joints);
        for (int j = 0; j < DIG_JOINTS; j++) {
            result.com_mps2[j] =
                dig_vec2_add_scaled(result.com_mps2[j], share[k] * per_s2, front.com_m[j]);
            result.turn_radps2[j] += share[k] * per_s2 * front.attitude_rad[j];
        }
    }
    *motion = result;
    return DIG_OK;
}

static enum dig_status refuse(const struct dig_machine *const    machine,
                              const struct dig_rig_margin *const margin, const double at_s,
                              struct dig_error *const error)
{
    char       text[200];
    const bool mechanical = margin->limit <= DIG_RIG_LIMIT_LEVER;
    return dig_error_set(error, mechanical ? DIG_EUNREACHABLE : DIG_EINVAL,
                         "%s cannot do this dig: %s (at %.2f s)", machine->name,
                         dig_rig_margin_text(margin, sizeof text, text), at_s);
}

static enum dig_status fill(const struct dig_machine *const           machine,
                            const struct dig_rig_track_options *const options,
                            const struct dig_rig_path *const path, const size_t every,
                            struct dig_rig_track *const track, struct dig_error *const error)
{
    double worst_s = 0.0;
    for (size_t r = 0; r < track->rows; r++) {
        const size_t              i      = r * every;
        const double              t_s    = (double)i * DIG_RIG_STEP_s;
        const struct dig_rig_pose pose   = placed(path, i, &track->placement);
        struct dig_rig_motion     motion = { .turn_radps2 = { 0.0 } };
        struct dig_rig_state      state;
        enum dig_status           status = DIG_OK;
        if (moves(options, path, i)) {
            status = move(machine, path, i, &track->placement, &motion);
        }
        if (status == DIG_OK) {
            status = dig_rig_state_solve(machine, &pose, &motion, &path->frame[i].soil, &state);
        }
        if (status != DIG_OK) {
            return dig_error_set(
                error, status,
                "%s: pin at X %.3f m, Z %.3f m, bucket at %.1f deg is out of reach "
                "(at %.2f s)",
                machine->name, pose.X_m, pose.Z_m, pose.phi_rad * 180.0 / acos(-1.0), t_s);
        }
        if (!(state.nearest.share >= track->nearest.share)) {
            track->nearest = state.nearest;
            worst_s        = t_s;
        }
        track->row[r] = (struct dig_rig_row){
            .pose      = pose,
            .soil      = path->frame[i].soil,
            .joints    = state.joints,
            .pressures = state.pressures,
            .load      = state.load,
        };
    }
    return track->nearest.share > 0.0 ? DIG_OK : refuse(machine, &track->nearest, worst_s, error);
}

// The rows of a path as it is placed, or where the machine has most room.
static enum dig_status lay(const struct dig_machine *const           machine,
                           const struct dig_rig_track_options *const options,
                           const struct dig_rig_path *const path, const bool search,
                           struct dig_rig_track *const track, struct dig_error *const error)
{
    const size_t         every  = (size_t)lround(1.0 / (DIG_RIG_STEP_s * options->rate_Hz));
    enum dig_status      status = DIG_OK;
    struct dig_rig_track result = {
        .rows          = (path->frames - 1) / every + 1,
        .step_s        = (double)every * DIG_RIG_STEP_s,
        .nearest       = { .share = INFINITY },
        .placement     = { .X_m = options->pin_X_m, .Z_m = options->pin_Z_m },
        .blend_off_m   = path->blend_off_m,
        .blend_off_rad = path->blend_off_rad,
    };
    if (search) {
        status = dig_rig_placement_find(machine, path, &result.placement, error);
    }
    struct dig_rig_row *const row = malloc(result.rows * sizeof *row);
    result.row                    = row;
    if (status == DIG_OK) {
        status = row == NULL ? dig_error_set(error, DIG_ENOMEM, "%zu rows", result.rows)
                             : fill(machine, options, path, every, &result, error);
    }
    if (status != DIG_OK) {
        free(row);
        return status;
    }
    *track     = result;
    track->row = row; // which the analyzer does not see in the struct
    return DIG_OK;
}

enum dig_status dig_rig_track_build(const struct dig_machine *const           machine,
                                    const struct dig_rig_track_options *const options,
                                    const size_t recordings, const struct dig_recording recording[],
                                    struct dig_rig_track *const track,
                                    struct dig_error *const     error)
{
    assert(machine != NULL && options != NULL && track != NULL);

    const double                      tooth_m      = machine->link[DIG_JOINT_BUCKET].length_m;
    const struct dig_rig_path_options path_options = {
        .lambda   = tooth_m / options->scene_tooth_m,
        .tooth_m  = tooth_m,
        .air      = options->air,
        .air_pace = options->air_pace,
        .blend    = options->blend,
    };
    struct dig_rig_path path;
    enum dig_status status = dig_rig_path_build(&path_options, recordings, recording, &path, error);
    if (status != DIG_OK) {
        return status;
    }

    status =
        lay(machine, options, &path, !options->placed && !machine->sensor.fitted, track, error);
    dig_rig_path_finish(&path);
    return status;
}

enum dig_status dig_rig_track_build_air(const struct dig_machine *const           machine,
                                        const struct dig_rig_track_options *const options,
                                        struct dig_rig_track *const               track,
                                        struct dig_error *const                   error)
{
    assert(machine != NULL && options != NULL && track != NULL);
    struct dig_rig_path path;
    enum dig_status     status = dig_rig_air_build(machine, &path, error);
    if (status != DIG_OK) {
        return status;
    }
    status = lay(machine, options, &path, false, track, error);
    dig_rig_path_finish(&path);
    return status;
}

void dig_rig_track_finish(struct dig_rig_track *const track)
{
    if (track != NULL) {
        free(track->row);
        *track = (struct dig_rig_track){ .rows = 0 };
    }
}
