#include "closed_loop/machine/machine_noise.h"

#include "core/sort.h"

#include <assert.h>
#include <math.h>

// So many differences of blocks tell their size to a sixth.
enum { LEAST = 16 };

// Blocks two apart share little noise; neighbours share so much of it that those two apart differ
// by so much more. What differs by more than that is no noise but goes on: a ripple of seconds.
static const double more_two_apart = 1.2;

// The median of the size of a normal number, in its sigmas.
static const double median_size = 0.6745;

// Less than this is within what the rows of white noise differ by.
static const double least_more = 1.25;

// What the rows of a joint differ by so many blocks apart, in the sigmas of one; 1 where too few
// tell. room: [rows].
static double difference(const struct dig_air *const air, const double rest[],
                         const enum dig_joint joint, const size_t apart, double room[])
{
    size_t n = 0;
    for (size_t a = 0; a < air->rows; a++) {
        const struct dig_air_row *const row = &air->row[a];
        for (size_t b = a + 1;
             row->joint == joint && b < air->rows && air->row[b].segment == row->segment &&
             air->row[b].first <= row->first + apart * row->points;
             b++) {
            if (air->row[b].joint == joint &&
                air->row[b].first == row->first + apart * row->points) {
                room[n++] = fabs(rest[b] - rest[a]);
            }
        }
    }
    if (n < LEAST) {
        return 1.0;
    }
    return dig_sort_median(n, room) / (median_size * sqrt(2.0));
}

static double scatter_of(const struct dig_air *const air, const double rest[],
                         const enum dig_joint joint, double room[])
{
    return fmin(difference(air, rest, joint, 2, room),
                more_two_apart * difference(air, rest, joint, 1, room));
}

bool dig_machine_noise_widen(struct dig_lines *const lines, const double at[])
{
    assert(lines != NULL && at != NULL);
    struct dig_air *const air     = lines->air;
    double *const         room    = lines->work;
    double *const         plain   = room + air->rows;
    double *const         left    = room + 2 * air->rows;
    bool                  widened = false;
    dig_lines_rest(lines, lines->absent, plain);
    dig_lines_rest(lines, at, left);
    for (int j = 0; j < DIG_JOINTS; j++) {
        const enum dig_joint joint = (enum dig_joint)j;
        const double         more =
            fmin(scatter_of(air, plain, joint, room), scatter_of(air, left, joint, room));
        for (size_t r = 0; r < air->rows && more > least_more; r++) {
            air->row[r].sigma_N *= air->row[r].joint == joint ? more : 1.0;
        }
        widened = widened || more > least_more;
    }
    return widened;
}
