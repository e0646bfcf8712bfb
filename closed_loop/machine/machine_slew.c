#include "closed_loop/machine/machine_slew.h"

#include "core/linkage.h"
#include "estimator/wrench/correction.h"
#include "estimator/wrench/statics.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// So many blocks make a second; it sets in and dies away within so many more, which go with them.
enum { LEAST_BLOCKS = 5, BLOCKS_BESIDE = 3 };

// Log evidence that slewing must bring, and of what is left beyond noise the share it explains.
static const double least_evidence = 15.0;
static const double least_share    = 0.5;

// What pulls at the machine for a while: slewing, outward; or the ground that its bucket rests on,
// upward, and about the bucket's pin as well, wherever it is touched.
enum cause { SLEWS, RESTS, CAUSES };
enum { UP, ABOUT, PULLS };

// A rod this slow stands, as far as its friction is concerned.
static const double stands_mps = 5.0 * DIG_FRICTION_STILL_mps;

// Blocks of a segment that follow each other, all pulled the same way.
struct stretch {
    size_t end; // row
    double blocks, rows;
    double pull2[PULLS][PULLS], pull_left[PULLS], left2; // sums over rows, in their sigmas
};

// Moments about a joint, Nm: of what slewing with 1 rad/s pulls, and of 1 N and 1 Nm of the ground.
static void moments_of(const struct dig_machine *const machine, const struct dig_front *const front,
                       const enum cause cause, const size_t joint, double moment_Nm[PULLS])
{
    moment_Nm[UP]    = 0.0;
    moment_Nm[ABOUT] = cause == RESTS ? 1.0 : 0.0;
    if (cause == RESTS) {
        moment_Nm[UP] = front->pin_m[DIG_JOINT_BUCKET].x - front->pin_m[joint].x;
    }
    for (size_t k = joint; k < DIG_JOINTS && cause == SLEWS; k++) {
        moment_Nm[UP] -= machine->link[k].mass_kg * front->com_m[k].x *
                         (front->com_m[k].y - front->pin_m[joint].y);
    }
}

// What a row's drive holds of that, in its sigmas. False where it is not of the cause: a bucket
// that rests does not move.
static bool pulls_of(const struct dig_air *const air, const struct dig_air_row *const row,
                     const enum cause cause, double pull[PULLS])
{
    bool is     = true;
    pull[UP]    = 0.0;
    pull[ABOUT] = 0.0;
    for (size_t p = row->first; p < row->first + row->points; p++) {
        const double *const    joint_rad = &air->point[p].sample.value[DIG_SIGNAL_BOOM_rad];
        const struct dig_front front     = dig_front_place(&air->machine, joint_rad);
        struct dig_lever       lever     = { .length_m = 0.0 };
        double                 moment_Nm[PULLS];
        if (dig_lever_solve(&air->machine, row->joint, joint_rad[row->joint], &lever) != DIG_OK) {
            continue;
        }
        moments_of(&air->machine, &front, cause, row->joint, moment_Nm);
        const double rod_mps = lever.arm_m * air->point[p].rates.velocity_radps[row->joint];
        is                   = is && (cause != RESTS || fabs(rod_mps) < stands_mps);
        for (int k = 0; k < PULLS; k++) {
            pull[k] -= moment_Nm[k] / lever.arm_m / (double)row->points / row->sigma_N;
        }
    }
    return is;
}

// Adds the next block where it is pulled so, or goes past it where it is none of a stretch.
static bool add_block(const struct dig_air *const air, const enum cause cause, const double left[],
                      const size_t end, struct stretch *const stretch)
{
    struct stretch with = *stretch;
    const size_t   from = stretch->end;
    double         own  = 0.0;
    bool           is   = true;
    for (; with.end < end && air->row[with.end].first == air->row[from].first; with.end++) {
        double pull[PULLS];
        is = pulls_of(air, &air->row[with.end], cause, pull) && is;
        own += pull[UP] * left[with.end];
        with.rows += 1.0;
        with.left2 += left[with.end] * left[with.end];
        for (int k = 0; k < PULLS; k++) {
            with.pull_left[k] += pull[k] * left[with.end];
            for (int l = 0; l < PULLS; l++) {
                with.pull2[k][l] += pull[k] * pull[l];
            }
        }
    }
    with.blocks += 1.0;
    is = is && own > 0.0;
    if (is || stretch->blocks < 1.0) {
        *stretch = with;
    }
    return is;
}

static bool is_clear(const struct stretch *const s, const double least_blocks)
{
    const double by =
        s->pull2[ABOUT][ABOUT] > 0.0 ? s->pull2[UP][ABOUT] / s->pull2[ABOUT][ABOUT] : 0.0;
    const double about   = s->pull2[ABOUT][ABOUT] > 0.0
                               ? s->pull_left[ABOUT] * s->pull_left[ABOUT] / s->pull2[ABOUT][ABOUT]
                               : 0.0;
    const double up_left = s->pull_left[UP] - by * s->pull_left[ABOUT]; // of UP beside ABOUT
    const double up2     = s->pull2[UP][UP] - by * s->pull2[UP][ABOUT];
    if (!(up_left > 0.0 && up2 > 0.0)) {
        return false;
    }
    const double explained = about + up_left * up_left / up2;
    return s->blocks >= least_blocks && 0.5 * up_left * up_left / up2 > least_evidence &&
           explained > least_share * (s->left2 - s->rows);
}

// Marks rows [first, end) and those of the segment near them.
static void mark(const struct dig_air *const air, const struct dig_air_segment *const segment,
                 const size_t first, const size_t end, double out[])
{
    const size_t beside = BLOCKS_BESIDE * air->row[first].points;
    const size_t from   = air->row[first].first;
    const size_t to     = air->row[end - 1].first;
    for (size_t r = segment->first_row; r < segment->first_row + segment->rows; r++) {
        const size_t at = air->row[r].first;
        if (at + beside >= from && at <= to + beside) {
            out[r] = 1.0;
        }
    }
}

// Marks what is pulled so in a segment.
static void find(const struct dig_air *const air, const struct dig_air_segment *const segment,
                 const enum cause cause, const double least_blocks, const double left[],
                 double out[])
{
    const size_t end = segment->first_row + segment->rows;
    for (size_t r = segment->first_row; r < end;) {
        struct stretch stretch = { .end = r };
        while (stretch.end < end && add_block(air, cause, left, end, &stretch)) {
        }
        if (is_clear(&stretch, least_blocks)) {
            mark(air, segment, r, stretch.end, out);
        }
        r = stretch.end;
    }
}

static void take_out(struct dig_air *const air, const double out[])
{
    size_t kept = 0;
    for (size_t s = 0; s < air->segments; s++) {
        struct dig_air_segment *const segment = &air->segment[s];
        const size_t                  end     = segment->first_row + segment->rows;
        const size_t                  first   = kept;
        for (size_t r = segment->first_row; r < end; r++) {
            if (!(out[r] > 0.0)) {
                air->row[kept++] = air->row[r];
            }
        }
        segment->first_row = first;
        segment->rows      = kept - first;
    }
    air->rows = kept;
}

bool dig_slew_leave_out(struct dig_lines *const lines, const double at[], const enum dig_slew which)
{
    assert(lines != NULL && at != NULL);
    struct dig_air *const air  = lines->air;
    double *const         left = lines->work;
    double *const         out  = left + air->rows;
    double                rows = 0.0;
    memset(out, 0, air->rows * sizeof *out);
    dig_lines_rest(lines, at, left);
    for (size_t s = 0; s < air->segments; s++) {
        if (which == DIG_SLEW_TOUCHES) {
            find(air, &air->segment[s], RESTS, 1.0, left, out);
            continue;
        }
        for (int cause = 0; cause < CAUSES; cause++) {
            find(air, &air->segment[s], (enum cause)cause, LEAST_BLOCKS, left, out);
        }
    }
    for (size_t r = 0; r < air->rows; r++) {
        rows += out[r];
    }
    if (!(rows > 0.0) || 2.0 * rows > (double)air->rows) {
        return false;
    }
    take_out(air, out);
    return true;
}

void dig_slew_rows_save(const struct dig_air *const air, struct dig_slew_rows *const rows)
{
    assert(air != NULL && rows != NULL);
    memcpy(rows->row, air->row, air->rows * sizeof *rows->row);
    rows->rows = air->rows;
    for (size_t s = 0; s < air->segments; s++) {
        rows->of[s] = air->segment[s].rows;
    }
}

void dig_slew_rows_restore(const struct dig_slew_rows *const rows, struct dig_air *const air)
{
    assert(rows != NULL && air != NULL);
    size_t first = 0;
    memcpy(air->row, rows->row, rows->rows * sizeof *rows->row);
    for (size_t s = 0; s < air->segments; s++) {
        air->segment[s].first_row = first;
        air->segment[s].rows      = rows->of[s];
        first += rows->of[s];
    }
    air->rows = first;
}
