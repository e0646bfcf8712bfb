#include "tests/estimator/dug.h"

#include "core/units.h"
#include "estimator/estimator_state.h"
#include "tests/model_front.h"
#include "tests/testlib.h"

#include <stdlib.h>

enum { HESITATIONS_MAX = 8, TICKS_MAX = 20000 };

static const double lambda       = 10.0;
static const double tick_s       = 0.005; // machine time
static const double tooth_m      = 0.09;
static const double standing     = 0.6;  // of the moment, once the soil has relaxed
static const double relax_s      = 0.5;  // machine time
static const double near_s       = 0.1;  // rig time
static const double stride_m     = 0.03; // of the wobble, along the path
static const double out_m        = 0.05; // how high a bucket is lifted out
static const double soil_holds_m = 0.02; // over which the soil lets go meanwhile
static const double felt_Nm = 0.12; // rig scale: 1.2 kNm, of which a ZX200 tells 0.25 by 1 sigma

// What is done in each leg of the made trajectories.
static const enum dug_truth legs[MADE_TRAJECTORIES][DIG_PHASES_MAX] = {
    { DUG_PENETRATION, DUG_DRAG, DUG_LIFT },
    { DUG_PENETRATION, DUG_CURL },
    { DUG_PENETRATION, DUG_CURL, DUG_DRAG, DUG_CURL, DUG_LIFT },
};

struct digging {
    struct driven         *driven;
    const struct dug_soil *soil;
    const struct dug_way  *way;
    uint64_t               seed;
    double                 wobble_at[3]; // phases of the wobble
    size_t                 ticks;
    enum dug_truth         truth[TICKS_MAX];
    enum dug_told          told[TICKS_MAX];
    double                 moment_Nm[TICKS_MAX];
};

static enum dug_told told(const struct dig_estimate *const e)
{
    switch (e->phase) {
    case DIG_PHASE_AIR: assert_int_equal(e->motion, DIG_MOTION_NONE); return DUG_TOLD_AIR;
    case DIG_PHASE_CONTACT: return DUG_TOLD_CONTACT;
    case DIG_PHASE_EXIT: assert_int_equal(e->motion, DIG_MOTION_NONE); return DUG_TOLD_EXIT;
    case DIG_PHASE_DIG:
    default: break;
    }
    switch (e->motion) {
    case DIG_MOTION_PENETRATION: return DUG_TOLD_PENETRATION;
    case DIG_MOTION_DRAG: return DUG_TOLD_DRAG;
    case DIG_MOTION_CURL: return DUG_TOLD_CURL;
    case DIG_MOTION_LIFT: return DUG_TOLD_LIFT;
    case DIG_MOTION_NONE:
    default: return DUG_TOLD_NONE;
    }
}

static void tick(struct digging *const d, const struct dig_pose *const pose, const double up_m,
                 const double moment_Nm, const enum dug_truth truth)
{
    driven_tick(d->driven, *pose, up_m, pow(lambda, 4.0) * moment_Nm, 0.0, &d->seed);
    assert_true(d->ticks < TICKS_MAX);
    d->truth[d->ticks] = truth;
    d->told[d->ticks]  = told(&d->driven->estimate);

    d->moment_Nm[d->ticks] = moment_Nm;
    d->ticks++;
}

// The pose at a rig time, as an unsteady hand has it.
static struct dig_pose pose_at(const struct digging *const d, const struct dig_trajectory *const t,
                               const double rig_s)
{
    struct dig_pose pose  = dig_trajectory_pose(t, rig_s);
    const double    along = 2.0 * DIG_PI * dig_trajectory_path_m(t, tooth_m, rig_s) / stride_m;
    pose.x_m += d->way->wobble_m * sin(0.7 * along + d->wobble_at[0]);
    pose.z_m += d->way->wobble_m * sin(0.5 * along + d->wobble_at[1]);
    pose.theta_rad += d->way->wobble_m / tooth_m * sin(0.6 * along + d->wobble_at[2]);
    return pose;
}

static double soil_Nm(const struct dug_soil *const soil, const double rig_s)
{
    const double at = (rig_s - soil->first_s) / soil->step_s;
    const double i  = fmin(fmax(floor(at), 0.0), (double)soil->windows - 2.0);
    const double s  = fmin(fmax(at - i, 0.0), 1.0);
    return (1.0 - s) * (double)soil->moment_Nm[(size_t)i] +
           s * (double)soil->moment_Nm[(size_t)i + 1];
}

// Down through the air, turning a little.
static void approach(struct digging *const d, const struct dig_trajectory *const t)
{
    for (double left = 1.0; left > 0.0; left -= tick_s / 2.5) {
        struct dig_pose pose = pose_at(d, t, 0.0);
        pose.theta_rad -= 0.1 * left;
        pose.x_m -= 0.01 * left;
        tick(d, &pose, 0.03 * left, 0.0, DUG_AIR);
    }
}

// Stops for a while and steps a little back, which the soil hardly resists.
static void hesitate(struct digging *const d, const struct dig_trajectory *const t,
                     const double rig_s, const double for_s, const double back_s,
                     const enum dug_truth truth)
{
    const double full_Nm = soil_Nm(d->soil, rig_s);
    for (double s = 0.0; s < for_s; s += tick_s) {
        const double          back = back_s * sin(DIG_PI * s / for_s);
        const double          left = 1.0 - (1.0 - standing) * (1.0 - exp(-s / relax_s));
        const struct dig_pose pose = pose_at(d, t, fmax(rig_s - back, 0.0));
        tick(d, &pose, 0.0, left * full_Nm, truth);
    }
}

// Out of the soil, which lets go of all but the load; the load is dumped.
static void leave(struct digging *const d, const struct dig_trajectory *const t, const double rig_s)
{
    const struct dug_way *const way      = d->way;
    const bool                  given_up = way->until < 1.0;
    const struct dig_pose       pose     = pose_at(d, t, rig_s);
    const double                full_Nm  = soil_Nm(d->soil, rig_s);
    const double load_Nm = !given_up ? fmax(full_Nm, 0.0) : way->carries ? 0.5 * full_Nm : 0.0;
    const double up_m    = 0.0915 * way->pace * tick_s / sqrt(lambda);
    for (double up = 0.0; up < out_m; up += up_m) {
        const double held  = fmax(1.0 - up / soil_holds_m, 0.0);
        const bool   lifts = given_up && (way->carries || held > 0.0);
        tick(d, &pose, up, load_Nm + held * (full_Nm - load_Nm), lifts ? DUG_LIFT : DUG_OUT);
    }
    for (double s = 0.0; s < 3.0; s += tick_s) {
        tick(d, &pose, out_m, load_Nm * fmax(1.0 - s, 0.0), DUG_OUT);
    }
    for (double s = 0.0; s < 2.0; s += tick_s) {
        tick(d, &pose, out_m, 0.0, DUG_AIR);
    }
}

static void dig(struct digging *const d, const struct dig_trajectory *const t)
{
    const struct dug_way *const way     = d->way;
    const double                whole_m = dig_trajectory_path_m(t, tooth_m, 1e3);
    const double                whole_s = dig_trajectory_duration_s(t);
    double                      stop_at[HESITATIONS_MAX];
    assert_true(way->hesitations <= HESITATIONS_MAX);
    for (int h = 0; h < way->hesitations; h++) {
        stop_at[h] = (h + model_uniform(&d->seed)) / way->hesitations;
    }
    int    stops    = 0;
    bool   paused   = false;
    double rig_s    = 0.0;
    double progress = 0.0;
    while (rig_s < whole_s && progress < way->until) {
        progress                    = dig_trajectory_path_m(t, tooth_m, rig_s) / whole_m;
        const bool            soil  = progress >= way->from;
        const enum dug_truth  leg   = legs[d->soil->which][dig_trajectory_phase(t, rig_s)];
        const enum dug_truth  truth = soil ? leg : DUG_AIR;
        const struct dig_pose pose  = pose_at(d, t, rig_s);
        tick(d, &pose, 0.0, soil ? soil_Nm(d->soil, rig_s) : 0.0, truth);
        if (soil && !paused && progress > 0.45 && way->pause_s > 0.0) {
            paused = true;
            hesitate(d, t, rig_s, way->pause_s, 0.0, truth);
        }
        if (soil && stops < way->hesitations && progress > stop_at[stops]) {
            stops++;
            hesitate(d, t, rig_s, 0.2 + 0.8 * model_uniform(&d->seed),
                     0.05 * model_uniform(&d->seed), truth);
        }
        rig_s += way->pace * tick_s / sqrt(lambda);
    }
    leave(d, t, rig_s);
}

// Samples in a tenth of a second of rig time, at the dig's pace.
static size_t near_ticks(const struct digging *const d)
{
    return (size_t)(near_s * sqrt(lambda) / d->way->pace / tick_s);
}

static bool in_soil(const enum dug_truth truth)
{
    return truth != DUG_AIR && truth != DUG_OUT;
}

// What resists by less, on average over near_s on both sides, than its sensors tell is weak.
static void mark_weak(struct digging *const d)
{
    const size_t near = near_ticks(d);
    for (size_t i = 0; i < d->ticks; i++) {
        const size_t from = i > near ? i - near : 0;
        const size_t to   = i + near < d->ticks ? i + near : d->ticks - 1;
        double       sum  = 0.0;
        for (size_t k = from; k <= to; k++) {
            sum += d->moment_Nm[k];
        }
        if (in_soil(d->truth[i]) && sum < felt_Nm * d->way->loud * (double)(to - from + 1)) {
            d->truth[i] = DUG_WEAK;
        }
    }
}

// A sample is near when the truth is another one within near_s of it.
static void count(const struct digging *const d, struct dug_matrix *const matrix)
{
    const size_t near = near_ticks(d);
    for (size_t i = 0; i < d->ticks; i++) {
        const size_t  before = i > near ? i - near : 0;
        const size_t  after  = i + near < d->ticks ? i + near : d->ticks - 1;
        const bool    far    = d->truth[before] == d->truth[i] && d->truth[after] == d->truth[i];
        size_t *const row    = far ? matrix->far[d->truth[i]] : matrix->near[d->truth[i]];
        row[d->told[i]]++;
    }
}

void dug_dig(const struct dug_soil *const soil, const struct dug_way *const way,
             const uint64_t seed, struct dug_matrix *const matrix, struct dug_end *const end)
{
    static struct digging d;
    d = (struct digging){ .driven = driven_create(true), .soil = soil, .way = way, .seed = seed };
    struct dig_machine *const machine = &d.driven->machine;
    machine->pressure_step_Pa *= way->loud;
    machine->angle_step_rad *= way->loud;
    machine->angle_sigma_rad *= way->loud;
    for (int j = 0; j < DIG_JOINTS; j++) {
        machine->cylinder[j].pressure_sigma_Pa *= way->loud;
    }
    for (int i = 0; i < 3; i++) {
        d.wobble_at[i] = 2.0 * DIG_PI * model_uniform(&d.seed);
    }
    const struct dig_trajectory t = made_trajectory(soil->which);
    approach(&d, &t);
    dig(&d, &t);
    mark_weak(&d);
    count(&d, matrix);
    const struct dig_observation *const o = &d.driven->observation;

    *end = (struct dug_end){ .digs       = d.driven->observations,
                             .trajectory = d.driven->observations > 0 ? o->trajectory : -1,
                             .first      = o->first,
                             .last       = o->last,
                             .ending     = o->ending };
    if (d.driven->gave_up) {
        end->trajectory = d.driven->gave_up_of;
        end->last       = d.driven->gave_up_at;
        end->ending     = DIG_ENDING_ABORTED;
    }
    driven_destroy(d.driven);
}

static size_t row_sum(const size_t row[DUG_TOLDS])
{
    size_t all = 0;
    for (int i = 0; i < DUG_TOLDS; i++) {
        all += row[i];
    }
    return all;
}

void dug_add(struct dug_matrix *const sum, const struct dug_matrix *const more)
{
    for (int truth = 0; truth < DUG_TRUTHS; truth++) {
        for (int i = 0; i < DUG_TOLDS; i++) {
            sum->far[truth][i] += more->far[truth][i];
            sum->near[truth][i] += more->near[truth][i];
        }
    }
}

size_t dug_samples(const struct dug_matrix *const matrix, const enum dug_truth truth)
{
    return row_sum(matrix->far[truth]);
}

double dug_share(const struct dug_matrix *const matrix, const enum dug_truth truth,
                 const enum dug_told told)
{
    return (double)matrix->far[truth][told] / (double)row_sum(matrix->far[truth]);
}

void dug_print(const struct dug_matrix *const matrix)
{
    static const char *const truths[DUG_TRUTHS] = { "air",  "weak", "penetration", "drag",
                                                    "curl", "lift", "out" };
    print_message("%-12s %8s  %% air  contact   none  penetr.   drag    curl    lift    exit\n", "",
                  "samples");
    for (int far = 1; far >= 0; far--) {
        print_message("%s\n", far ? "away from borders" : "near a border");
        for (int truth = 0; truth < DUG_TRUTHS; truth++) {
            const size_t *const row = far ? matrix->far[truth] : matrix->near[truth];
            print_message("%-12s %8zu ", truths[truth], row_sum(row));
            for (int i = 0; i < DUG_TOLDS; i++) {
                print_message(" %7.2f", 100.0 * (double)row[i] / (double)row_sum(row));
            }
            print_message("\n");
        }
    }
}
