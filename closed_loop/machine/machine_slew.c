#include "closed_loop/machine/machine_slew.h"

#include "core/linkage.h"
#include "estimator/wrench/statics.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// So many blocks make a second; it sets in and dies away within so many more, which go with them.
enum { LEAST_BLOCKS = 5, BLOCKS_BESIDE = 3 };

// Log evidence that slewing must bring, and of what is left beyond noise the share it explains.
static const double least_evidence = 15.0;
static const double least_share    = 0.5;

// Blocks of a segment that follow each other, all pulled outward.
struct slew {
    size_t end; // row
    double blocks, rows;
    double pull2, pull_left, left2; // sums over rows, in their sigmas
};

// What a joint's drive holds while the machine slews with 1 rad/s, N at the rod.
static double pull_at_N(const struct dig_machine *const machine, const double joint_rad[DIG_JOINTS],
                        const enum dig_joint joint)
{
    const struct dig_front front  = dig_front_place(machine, joint_rad);
    struct dig_lever       lever  = { .length_m = 0.0 };
    double                 sum_Nm = 0.0;
    for (size_t k = joint; k < DIG_JOINTS; k++) {
        sum_Nm +=
            machine->link[k].mass_kg * front.com_m[k].x * (front.com_m[k].y - front.pin_m[joint].y);
    }
    return dig_lever_solve(machine, joint, joint_rad[joint], &lever) == DIG_OK
               ? sum_Nm / lever.arm_m
               : 0.0;
}

// The same of a row, in its sigmas.
static double pull_of(const struct dig_air *const air, const struct dig_air_row *const row)
{
    double sum_N = 0.0;
    for (size_t p = row->first; p < row->first + row->points; p++) {
        const double *const joint_rad = &air->point[p].sample.value[DIG_SIGNAL_BOOM_rad];
        sum_N += pull_at_N(&air->machine, joint_rad, row->joint);
    }
    return sum_N / (double)row->points / row->sigma_N;
}

// Adds the next block where it is pulled outward, or goes past it where it is none of a slew.
static bool add_block(const struct dig_air *const air, const double left[], const size_t end,
                      struct slew *const slew)
{
    struct slew  with = *slew;
    const size_t from = slew->end;
    double       own  = 0.0;
    for (; with.end < end && air->row[with.end].first == air->row[from].first; with.end++) {
        const double pull = pull_of(air, &air->row[with.end]);
        own += pull * left[with.end];
        with.rows += 1.0;
        with.pull2 += pull * pull;
        with.left2 += left[with.end] * left[with.end];
    }
    with.pull_left += own;
    with.blocks += 1.0;
    if (own > 0.0 || slew->blocks < 1.0) {
        *slew = with;
    }
    return own > 0.0;
}

static bool is_clear(const struct slew *const slew)
{
    const double explained = slew->pull_left * slew->pull_left / slew->pull2;
    return slew->blocks >= LEAST_BLOCKS && 0.5 * explained > least_evidence &&
           explained > least_share * (slew->left2 - slew->rows);
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

// Marks what is slewing in a segment.
static void find(const struct dig_air *const air, const struct dig_air_segment *const segment,
                 const double left[], double out[])
{
    const size_t end = segment->first_row + segment->rows;
    for (size_t r = segment->first_row; r < end;) {
        struct slew slew = { .end = r };
        while (slew.end < end && add_block(air, left, end, &slew)) {
        }
        if (is_clear(&slew)) {
            mark(air, segment, r, slew.end, out);
        }
        r = slew.end;
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

bool dig_slew_leave_out(struct dig_lines *const lines, const double at[])
{
    assert(lines != NULL && at != NULL);
    struct dig_air *const air  = lines->air;
    double *const         left = lines->work;
    double *const         out  = left + air->rows;
    double                rows = 0.0;
    memset(out, 0, air->rows * sizeof *out);
    dig_lines_rest(lines, at, left);
    for (size_t s = 0; s < air->segments; s++) {
        find(air, &air->segment[s], left, out);
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

enum dig_status dig_slew_rows_save(const struct dig_air *const air,
                                   struct dig_slew_rows *const rows)
{
    assert(air != NULL && rows != NULL);
    struct dig_air_row *const row = malloc((air->rows + 1) * sizeof *row);
    if (row == NULL) {
        return DIG_ENOMEM;
    }
    memcpy(row, air->row, air->rows * sizeof *row);
    rows->row  = row;
    rows->rows = air->rows;
    for (size_t s = 0; s < air->segments; s++) {
        rows->of[s] = air->segment[s].rows;
    }
    return DIG_OK;
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
