#include "closed_loop/recordings/alignment.h"

#include "core/units.h"
#include "estimator/track/steady.h"

#include <assert.h>
#include <math.h>

// Of the tooth's length: what the path's sensors may scatter by.
static const double vertex_share = 0.01;

void dig_steady_path(struct dig_recording *const recording, const double tooth_m, double number[])
{
    assert(recording != NULL && recording->rows > 0 && number != NULL);
    const size_t                 rows   = recording->rows;
    const size_t                 stride = sizeof recording->row[0] / sizeof(double);
    struct dig_force_row *const  row    = recording->row;
    const struct dig_steady_axis axis[] = { { &row->pin_x_m, stride, 1.0 },
                                            { &row->pin_z_m, stride, 1.0 },
                                            { &row->theta_deg, stride,
                                              tooth_m * DIG_RAD_PER_DEG } };
    double *const                room[] = { number, number + rows, number + 2 * rows };
    for (int a = 0; a < DIG_STEADY_AXES; a++) {
        for (size_t i = 0; i < rows; i++) {
            number[i] = axis[a].value[i * stride];
        }
        dig_steady_readings(rows, 0.0, number);
        for (size_t i = 0; i < rows; i++) {
            axis[a].value[i * stride] = number[i];
        }
    }
    (void)dig_steady_smooth(rows, axis, vertex_share * tooth_m, room, number + 3 * rows);
}

// A recording that lies no farther off is whole, bucket lengths.
static const double whole_off = 0.002;

// Most that either end may lack, or have beyond the trajectory's.
static const double most_missing = 0.3;

// Most that either end is looked for to lack: a part that is no longer searched for would be taken
// for the largest that is. Both ends leave a path between them: a point is like any.
static const double most_searched = 0.45;

bool dig_alignment_lacks_too_much(const struct dig_alignment_part *const part)
{
    assert(part != NULL);
    return part->from > most_missing || part->to < 1.0 - most_missing;
}

static double step_m(const struct dig_force_row *const a, const struct dig_force_row *const b,
                     const double tooth_m)
{
    return hypot(b->pin_x_m - a->pin_x_m, b->pin_z_m - a->pin_z_m) +
           tooth_m * fabs(b->theta_deg - a->theta_deg) * DIG_RAD_PER_DEG;
}

// Lays the rows after one vertex and up to the next along the way between them, by what the steps
// of each add up to.
static double lay_between(const struct dig_recording *const recording, const double tooth_m,
                          const size_t vertex, const size_t next, const double from_m,
                          double way_m[])
{
    const double chord_m = step_m(&recording->row[vertex], &recording->row[next], tooth_m);
    double       steps_m = 0.0;
    for (size_t i = vertex + 1; i <= next; i++) {
        steps_m += step_m(&recording->row[i - 1], &recording->row[i], tooth_m);
        way_m[i] = steps_m;
    }
    for (size_t i = vertex + 1; i <= next; i++) {
        way_m[i] = from_m + (steps_m > 0.0 ? chord_m * way_m[i] / steps_m : 0.0);
    }
    return from_m + chord_m;
}

double dig_alignment_progress(const struct dig_recording *const recording, const double tooth_m,
                              double progress[])
{
    assert(recording != NULL && recording->rows > 0 && progress != NULL);
    const size_t last   = recording->rows - 1;
    size_t       vertex = 0;
    double       way_m  = 0.0;
    progress[0]         = 0.0;
    for (size_t i = 1; i <= last; i++) {
        if (i == last || step_m(&recording->row[vertex], &recording->row[i], tooth_m) >=
                             vertex_share * tooth_m) {
            way_m  = lay_between(recording, tooth_m, vertex, i, way_m, progress);
            vertex = i;
        }
    }
    for (size_t i = 0; i <= last && way_m > 0.0; i++) {
        progress[i] /= way_m;
    }
    return way_m;
}

struct dig_alignment_place dig_alignment_place(const size_t rows, const double progress[],
                                               const double at, const size_t from)
{
    assert(rows >= 2);
    struct dig_alignment_place place = { .row = from };
    while (place.row + 2 < rows && progress[place.row + 1] <= at) {
        place.row++;
    }
    const double span = progress[place.row + 1] - progress[place.row];
    place.fraction    = span > 0.0 ? fmin(fmax((at - progress[place.row]) / span, 0.0), 1.0) : 0.0;
    return place;
}

struct dig_pose dig_alignment_pose(const struct dig_recording *const       recording,
                                   const struct dig_alignment_place *const place)
{
    const struct dig_force_row *const a = &recording->row[place->row];
    const struct dig_force_row *const b = a + 1;
    const double                      f = place->fraction;
    return (struct dig_pose){ a->pin_x_m + f * (b->pin_x_m - a->pin_x_m),
                              a->pin_z_m + f * (b->pin_z_m - a->pin_z_m),
                              (a->theta_deg + f * (b->theta_deg - a->theta_deg)) *
                                  DIG_RAD_PER_DEG };
}

void dig_alignment_compare(const struct dig_recording *const recording, const double progress[],
                           const struct dig_alignment_target *const target,
                           struct dig_alignment_part *const         part)
{
    enum { POINTS = 64 };
    const double               first = fmax(part->from, 0.0);
    const double               last  = fmin(part->to, 1.0);
    struct dig_pose            off[POINTS];
    struct dig_pose            mean = { 0.0, 0.0, 0.0 };
    struct dig_alignment_place at   = { .row = 0 };
    for (int k = 0; k < POINTS; k++) {
        const double along = first + (last - first) * (double)k / (POINTS - 1);
        at                 = dig_alignment_place(recording->rows, progress,
                                                 (along - part->from) / (part->to - part->from), at.row);

        const struct dig_pose here = dig_alignment_pose(recording, &at);
        const struct dig_pose pose = dig_trajectory_pose(
            target->trajectory, dig_trajectory_time_s(target->trajectory, target->tooth_m, along));
        off[k].x_m       = here.x_m - pose.x_m;
        off[k].z_m       = here.z_m - pose.z_m;
        off[k].theta_rad = here.theta_rad - pose.theta_rad;
        mean.x_m += off[k].x_m / POINTS;
        mean.z_m += off[k].z_m / POINTS;
        mean.theta_rad += off[k].theta_rad / POINTS;
    }
    mean.theta_rad = fmin(fmax(mean.theta_rad, target->least_rad), target->most_rad);
    double sum_m2  = 0.0;
    for (int k = 0; k < POINTS; k++) {
        sum_m2 += pow(target->tooth_m * (off[k].theta_rad - mean.theta_rad), 2.0) +
                  pow(off[k].x_m - mean.x_m, 2.0) + pow(off[k].z_m - mean.z_m, 2.0);
    }
    part->off        = sqrt(sum_m2 / POINTS) / target->tooth_m;
    part->turned_rad = mean.theta_rad;
}

// The end of the part, from or to, where it lies nearest, the other as it is: first coarsely all
// over, then ever finer about the best.
static void move_end(const struct dig_recording *const recording, const double progress[],
                     const struct dig_alignment_target *const target, const bool is_from,
                     struct dig_alignment_part *const best)
{
    enum { STEPS = 60, ROUNDS = 4 };
    const double least = is_from ? -most_missing : 1.0 - most_searched;
    const double most  = is_from ? most_searched : 1.0 + most_missing;
    double       low   = least;
    double       high  = most;
    for (int round = 0; round < ROUNDS; round++) {
        const double step = (high - low) / STEPS;
        for (int k = 0; k <= STEPS; k++) {
            struct dig_alignment_part tried      = *best;
            *(is_from ? &tried.from : &tried.to) = low + step * k;
            dig_alignment_compare(recording, progress, target, &tried);
            *best = tried.off < best->off ? tried : *best;
        }
        const double at = is_from ? best->from : best->to;
        low             = fmax(at - step, least);
        high            = fmin(at + step, most);
    }
}

struct dig_alignment_part dig_alignment_align(const struct dig_recording *const        recording,
                                              const double                             progress[],
                                              const struct dig_alignment_target *const target)
{
    assert(recording != NULL && progress != NULL && target != NULL);
    struct dig_alignment_part whole = { .to = 1.0 };
    dig_alignment_compare(recording, progress, target, &whole);
    if (whole.off <= whole_off) {
        return whole;
    }
    struct dig_alignment_part part = whole;
    for (int round = 0; round < 3; round++) {
        move_end(recording, progress, target, false, &part);
        move_end(recording, progress, target, true, &part);
    }
    return part.off < 0.5 * whole.off ? part : whole;
}
