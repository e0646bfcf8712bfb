#include "tools/rig/motion/path.h"

#include "core/room.h"
#include "core/units.h"
#include "tools/rig/motion/blend.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

// The tooth's reach sets the size of the air motions, so that a small machine makes small ones.
static const double hover_teeth   = 0.7;
static const double dip_teeth     = 0.4;
static const double clear_teeth   = 1.25; // of the pin above the ground when the bucket dumps
static const double swing_rad     = 0.35;
static const double dump_phi_rad  = -70.0 * DIG_RAD_PER_DEG;
static const double dump_more_rad = 0.17; // at least, however open the bucket is already
static const double hold_s        = 0.5;
// No faster than this at the pace of 1, so that the links' inertia stays small beside their weight.
static const double least_move_s   = 1.2;
static const double most_mps2      = 0.7;
static const double most_radps2    = 1.0;
static const double quintic_factor = 5.7735; // peak acceleration of a rest-to-rest move, T^2 / way

static const struct dig_rig_wrench none = { 0.0, 0.0, 0.0 };

// Position and rate of the three coordinates of a pose, to start or end a move with.
struct state {
    double at[3];
    double rate[3];
};

static bool push(struct dig_rig_path *const path, const struct dig_rig_frame *const frame)
{
    struct dig_rig_frame *const grown = dig_room(path->frame, path->frames, sizeof *grown);
    if (grown != NULL) {
        path->frame                 = grown;
        path->frame[path->frames++] = *frame;
    }
    return grown != NULL;
}

static struct dig_rig_pose pose_of(const double at[3])
{
    return (struct dig_rig_pose){ .X_m = at[0], .Z_m = at[1], .phi_rad = at[2] };
}

static struct dig_rig_wrench scaled(const struct dig_rig_wrench soil, const double factor)
{
    return (struct dig_rig_wrench){ factor * soil.FX_N, factor * soil.FZ_N, factor * soil.M_Nm };
}

// The share of a load still in the bucket at a fraction s of the dump: 1 to 0, smooth at both ends.
static double left(const double s)
{
    return 1.0 - s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
}

enum load { LOAD_HELD, LOAD_FADING };

static double duration_s(const double pace, const struct state *const from,
                         const struct state *const to)
{
    const double way_m    = hypot(to->at[0] - from->at[0], to->at[1] - from->at[1]);
    const double turn_rad = fabs(to->at[2] - from->at[2]);
    return fmax(least_move_s, fmax(sqrt(quintic_factor * way_m / most_mps2),
                                   sqrt(quintic_factor * turn_rad / most_radps2))) /
           pace;
}

// Moves from `from` to `to` in about seconds: the polynomial of degree five that has both rates and
// no acceleration at its ends. `from` itself is not emitted, `to` is.
static bool move_in(struct dig_rig_path *const path, const struct state *const from,
                    const struct state *const to, const double seconds,
                    const struct dig_rig_wrench soil, const enum load load)
{
    const size_t n = (size_t)lround(seconds / DIG_RIG_STEP_s);
    const double T = (double)n * DIG_RIG_STEP_s;
    for (size_t i = 1; i <= n; i++) {
        const double s = (double)i / (double)n;
        double       at[3];
        for (int c = 0; c < 3; c++) {
            const double v0 = from->rate[c] * T;
            const double v1 = to->rate[c] * T;
            const double d  = to->at[c] - from->at[c];
            at[c]           = from->at[c] + s * (v0 + s * s *
                                                (10.0 * d - 6.0 * v0 - 4.0 * v1 +
                                                 s * (-15.0 * d + 8.0 * v0 + 7.0 * v1 +
                                                      s * (6.0 * d - 3.0 * v0 - 3.0 * v1))));
        }
        const struct dig_rig_frame frame = {
            .pose = pose_of(at),
            .soil = scaled(soil, load == LOAD_FADING ? left(s) : 1.0),
        };
        if (!push(path, &frame)) {
            return false;
        }
    }
    return true;
}

static bool move(struct dig_rig_path *const path, const struct state *const from,
                 const struct state *const to, const struct dig_rig_wrench soil,
                 const enum load load)
{
    return move_in(path, from, to, duration_s(path->air_pace, from, to), soil, load);
}

// The same with an empty bucket.
static bool go(struct dig_rig_path *const path, const struct state *const from,
               const struct state *const to)
{
    return move(path, from, to, none, LOAD_HELD);
}

static bool hold(struct dig_rig_path *const path, const struct state *const at)
{
    return move_in(path, at, at, hold_s, none, LOAD_HELD);
}

// One row of a recording at machine scale, pin relative to the origin (rig coordinates).
struct scaled_row {
    double                t_s;
    double                at[3];
    struct dig_rig_wrench soil;
};

static struct scaled_row scale_row(const struct dig_force_row *const row, const double lambda,
                                   const struct dig_force_row *const origin)
{
    const double lambda3 = lambda * lambda * lambda;
    return (struct scaled_row){
        .t_s  = sqrt(lambda) * row->t_s,
        .at   = { -lambda * (row->pin_x_m - origin->pin_x_m),
                  lambda * (row->pin_z_m - origin->pin_z_m),
                  -0.5 * DIG_PI - row->theta_deg * DIG_RAD_PER_DEG },
        .soil = { -lambda3 * row->Fx_N, lambda3 * row->Fz_N, lambda3 * lambda * row->My_Nm },
    };
}

static double between(const double a, const double b, const double s)
{
    return a + s * (b - a);
}

// The recording on the path's grid: its own poses and forces, straight between the rows.
static bool replay(struct dig_rig_path *const path, const struct dig_recording *const recording,
                   const double lambda, const struct dig_force_row *const origin)
{
    const double begin_s = sqrt(lambda) * recording->row[0].t_s;
    const double end_s   = sqrt(lambda) * recording->row[recording->rows - 1].t_s;
    const size_t n       = (size_t)floor((end_s - begin_s) / DIG_RIG_STEP_s + 1e-9);
    size_t       r       = 0;
    for (size_t i = 0; i <= n; i++) {
        const double t_s = begin_s + (double)i * DIG_RIG_STEP_s;
        while (r + 2 < recording->rows && sqrt(lambda) * recording->row[r + 1].t_s < t_s) {
            r++;
        }
        const struct scaled_row a = scale_row(&recording->row[r], lambda, origin);
        const struct scaled_row b = scale_row(&recording->row[r + 1], lambda, origin);
        const double            s = fmin(1.0, fmax(0.0, (t_s - a.t_s) / (b.t_s - a.t_s)));

        struct dig_rig_frame frame = {
            .soil = { between(a.soil.FX_N, b.soil.FX_N, s), between(a.soil.FZ_N, b.soil.FZ_N, s),
                      between(a.soil.M_Nm, b.soil.M_Nm, s) },
        };
        double at[3];
        for (int c = 0; c < 3; c++) {
            at[c] = between(a.at[c], b.at[c], s);
        }
        frame.pose = pose_of(at);
        if (!push(path, &frame)) {
            return false;
        }
    }
    return true;
}

// State at the first (or last) row, with the mean rate over the 20 rows beside it, so that digits
// cut off in the file do not become speed.
static struct state end_state(const struct dig_recording *const recording, const double lambda,
                              const struct dig_force_row *const origin, const bool last)
{
    const size_t            rows  = recording->rows;
    const size_t            apart = rows > 20 ? 20 : rows - 1;
    const size_t            at    = last ? rows - 1 : 0;
    const size_t            other = last ? at - apart : apart;
    const struct scaled_row here  = scale_row(&recording->row[at], lambda, origin);
    const struct scaled_row there = scale_row(&recording->row[other], lambda, origin);

    struct state result;
    for (int c = 0; c < 3; c++) {
        result.at[c]   = here.at[c];
        result.rate[c] = (there.at[c] - here.at[c]) / (there.t_s - here.t_s);
    }
    return result;
}

static struct state rest(const double X_m, const double Z_m, const double phi_rad)
{
    return (struct state){ .at = { X_m, Z_m, phi_rad } };
}

// From wherever it hovers: dip and open, rise and curl, so that weights and frictions show in both
// directions, then down to the contact with the dig's own speed.
static bool approach(struct dig_rig_path *const path, const struct state *const contact,
                     const double tooth_m, struct state *const now)
{
    const double       X_m   = contact->at[0];
    const double       Z_m   = contact->at[1];
    const double       phi   = contact->at[2];
    const struct state hover = rest(X_m, Z_m + hover_teeth * tooth_m, phi - swing_rad);
    const struct state dip   = rest(X_m + 0.15 * tooth_m, Z_m + dip_teeth * tooth_m, phi);

    const bool ok = (path->frames == 0 || go(path, now, &hover)) && hold(path, &hover) &&
                    go(path, &hover, &dip) && go(path, &dip, &hover) && go(path, &hover, contact);
    if (ok) {
        path->frames--; // the recording's first row is the contact itself
    }
    return ok;
}

// Lift the load clear with the bucket as it stands, dump it, and move on empty.
static bool leave(struct dig_rig_path *const path, const struct state *const end,
                  const double ground_Z_m, const double tooth_m, struct state *const now)
{
    const struct dig_rig_wrench load = path->frame[path->frames - 1].soil;
    const double       Z_m  = fmax(end->at[1] + 0.3 * tooth_m, ground_Z_m + clear_teeth * tooth_m);
    const double       phi  = end->at[2];
    const double       dump = fmax(dump_phi_rad, phi + dump_more_rad);
    const struct state lifted  = rest(end->at[0], Z_m, phi);
    const struct state dumped  = rest(end->at[0], Z_m, dump);
    const struct state curled  = rest(end->at[0], Z_m, dump - swing_rad);
    const struct state lowered = rest(end->at[0], Z_m - 0.2 * tooth_m, dump - 0.5 * swing_rad);

    *now = lowered;
    return move(path, end, &lifted, load, LOAD_HELD) &&
           move(path, &lifted, &dumped, load, LOAD_FADING) && go(path, &dumped, &curled) &&
           go(path, &curled, &lowered);
}

// Back to where the whole path began, so that it can be played in a loop.
static bool go_home(struct dig_rig_path *const path, const struct state *const now)
{
    const struct dig_rig_pose home = path->frame[0].pose;
    const struct state        to   = rest(home.X_m, home.Z_m, home.phi_rad);
    return go(path, now, &to) && hold(path, &to);
}

static bool add_dig(struct dig_rig_path *const               path,
                    const struct dig_rig_path_options *const options,
                    const struct dig_recording *const        recording,
                    const struct dig_force_row *const origin, struct state *const now)
{
    if (!options->air) {
        return replay(path, recording, options->lambda, origin);
    }
    const struct state contact = end_state(recording, options->lambda, origin, false);
    const struct state end     = end_state(recording, options->lambda, origin, true);
    // A dig begins with the tooth on the ground: that is where the ground is.
    const double ground_Z_m = contact.at[1] + options->tooth_m * sin(contact.at[2]);
    return approach(path, &contact, options->tooth_m, now) &&
           replay(path, recording, options->lambda, origin) &&
           leave(path, &end, ground_Z_m, options->tooth_m, now);
}

enum dig_status dig_rig_path_build(const struct dig_rig_path_options *const options,
                                   const size_t recordings, const struct dig_recording recording[],
                                   struct dig_rig_path *const path, struct dig_error *const error)
{
    assert(options != NULL && path != NULL);

    if (!(options->lambda > 0.0 && isfinite(options->lambda) && options->tooth_m > 0.0)) {
        return dig_error_set(error, DIG_EINVAL, "lambda: %g, expected > 0", options->lambda);
    }
    if (recordings == 0) {
        return dig_error_set(error, DIG_EINVAL, "no recording given");
    }
    if (recordings > 1 && !options->air) {
        return dig_error_set(
            error, DIG_EINVAL,
            "%zu recordings without air motion: the bucket cannot jump between them", recordings);
    }
    for (size_t i = 0; i < recordings; i++) {
        if (recording[i].rows < 2) {
            return dig_error_set(error, DIG_EINVAL, "recording %zu: %zu rows, expected at least 2",
                                 i + 1, recording[i].rows);
        }
    }

    struct dig_rig_path made = {
        .air_pace        = options->air_pace,
        .contact_phi_rad = -0.5 * DIG_PI - recording[0].row[0].theta_deg * DIG_RAD_PER_DEG,
    };
    struct state now = rest(0.0, 0.0, 0.0);
    bool         ok  = true;
    for (size_t i = 0; i < recordings && ok; i++) {
        ok = add_dig(&made, options, &recording[i], &recording[0].row[0], &now);
    }
    if (ok && options->air) {
        ok = go_home(&made, &now);
    }

    if (ok && options->blend) {
        ok = dig_rig_blend(&made);
    }
    if (!ok) {
        free(made.frame);
        return dig_error_set(error, DIG_ENOMEM, "the path of %zu recordings does not fit in memory",
                             recordings);
    }
    *path = made;
    return DIG_OK;
}

void dig_rig_path_finish(struct dig_rig_path *const path)
{
    if (path != NULL) {
        free(path->frame);
        *path = (struct dig_rig_path){ .frames = 0 };
    }
}
