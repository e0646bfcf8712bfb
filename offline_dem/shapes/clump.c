#include "offline_dem/shapes/clump.h"

#include "core/units.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define COLUMNS 512 // along each side of the shape's base

// Volume and its first and second moments.
struct moments {
    double v;
    double x[3];
    double xx[3][3];
};

struct interval {
    double from, to;
};

static void sort_intervals(const size_t n, struct interval interval[])
{
    for (size_t i = 1; i < n; i++) {
        const struct interval one = interval[i];
        size_t                k   = i;
        for (; k > 0 && interval[k - 1].from > one.from; k--) {
            interval[k] = interval[k - 1];
        }
        interval[k] = one;
    }
}

// The column at (x, y) from a to b.
static void add_interval(const double x, const double y, const double a, const double b,
                         struct moments *const m)
{
    const double l  = b - a;
    const double z  = 0.5 * (b * b - a * a);
    const double zz = (b * b * b - a * a * a) / 3.0;
    m->v += l;
    m->x[0] += x * l;
    m->x[1] += y * l;
    m->x[2] += z;
    m->xx[0][0] += x * x * l;
    m->xx[1][1] += y * y * l;
    m->xx[2][2] += zz;
    m->xx[0][1] += x * y * l;
    m->xx[0][2] += x * z;
    m->xx[1][2] += y * z;
}

static void add_column(const struct dig_clump *const clump, const double x, const double y,
                       struct moments *const m)
{
    struct interval cut[DIG_CLUMP_MAX];
    size_t          cuts = 0;
    for (size_t k = 0; k < clump->spheres; k++) {
        const double dx = x - clump->x[k];
        const double dy = y - clump->y[k];
        const double h2 = clump->radius[k] * clump->radius[k] - dx * dx - dy * dy;
        if (h2 > 0.0) {
            const double h = sqrt(h2);
            cut[cuts++]    = (struct interval){ clump->z[k] - h, clump->z[k] + h };
        }
    }
    sort_intervals(cuts, cut);
    for (size_t k = 0; k < cuts;) {
        struct interval joined = cut[k++];
        while (k < cuts && cut[k].from <= joined.to) {
            joined.to = fmax(joined.to, cut[k++].to);
        }
        add_interval(x, y, joined.from, joined.to, m);
    }
}

static struct moments integrate(const struct dig_clump *const clump)
{
    double low[2]  = { INFINITY, INFINITY };
    double high[2] = { -INFINITY, -INFINITY };
    for (size_t k = 0; k < clump->spheres; k++) {
        const double c[2] = { clump->x[k], clump->y[k] };
        for (int a = 0; a < 2; a++) {
            low[a]  = fmin(low[a], c[a] - clump->radius[k]);
            high[a] = fmax(high[a], c[a] + clump->radius[k]);
        }
    }
    struct moments m  = { 0 };
    const double   hx = (high[0] - low[0]) / COLUMNS;
    const double   hy = (high[1] - low[1]) / COLUMNS;
    for (int j = 0; j < COLUMNS; j++) {
        for (int i = 0; i < COLUMNS; i++) {
            add_column(clump, low[0] + (i + 0.5) * hx, low[1] + (j + 0.5) * hy, &m);
        }
    }
    double *const number[] = { &m.v,        &m.x[0],     &m.x[1],     &m.x[2],     &m.xx[0][0],
                               &m.xx[1][1], &m.xx[2][2], &m.xx[0][1], &m.xx[0][2], &m.xx[1][2] };
    for (size_t k = 0; k < sizeof number / sizeof number[0]; k++) {
        *number[k] *= hx * hy;
    }
    return m;
}

static void invert(const double m[3][3], double inverse[3][3])
{
    double determinant = 0.0;
    for (int c = 0; c < 3; c++) {
        determinant += m[0][c] * (m[1][(c + 1) % 3] * m[2][(c + 2) % 3] -
                                  m[1][(c + 2) % 3] * m[2][(c + 1) % 3]);
    }
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            inverse[c][r] = (m[(r + 1) % 3][(c + 1) % 3] * m[(r + 2) % 3][(c + 2) % 3] -
                             m[(r + 1) % 3][(c + 2) % 3] * m[(r + 2) % 3][(c + 1) % 3]) /
                            determinant;
        }
    }
}

// Inertia about the centre of mass c, per mass: the trace of the second moments less the moments.
static void set_inertia(const struct moments *const m, const double c[3], const double scale,
                        struct dig_clump_shape *const shape)
{
    double second[3][3];
    for (int r = 0; r < 3; r++) {
        for (int s = 0; s < 3; s++) {
            const double raw = r <= s ? m->xx[r][s] : m->xx[s][r];
            second[r][s]     = (raw / m->v - c[r] * c[s]) * scale * scale;
        }
    }
    const double trace = second[0][0] + second[1][1] + second[2][2];
    for (int r = 0; r < 3; r++) {
        for (int s = 0; s < 3; s++) {
            shape->inertia[r][s] = (r == s ? trace : 0.0) - second[r][s];
        }
    }
    invert((const double(*)[3])shape->inertia, shape->inverse);
}

enum dig_status dig_clump_shape_make(const struct dig_clump *const clump,
                                     struct dig_clump_shape *const shape)
{
    struct dig_clump_shape made = { .spheres = clump->spheres };
    if (clump->spheres == 0) {
        *shape = made;
        return DIG_OK;
    }
    if (clump->spheres > DIG_CLUMP_MAX) {
        return DIG_EINVAL;
    }
    const struct moments m = integrate(clump);
    if (!(m.v > 0.0) || !isfinite(m.v)) {
        return DIG_EINVAL;
    }
    const double scale = cbrt(DIG_PI / 6.0 / m.v);
    const double c[3]  = { m.x[0] / m.v, m.x[1] / m.v, m.x[2] / m.v };
    for (size_t k = 0; k < clump->spheres; k++) {
        const double *const at = made.at[k];
        made.at[k][0]          = scale * (clump->x[k] - c[0]);
        made.at[k][1]          = scale * (clump->y[k] - c[1]);
        made.at[k][2]          = scale * (clump->z[k] - c[2]);
        made.radius[k]         = scale * clump->radius[k];
        made.bound =
            fmax(made.bound, made.radius[k] + sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]));
    }
    set_inertia(&m, c, scale, &made);
    *shape = made;
    return DIG_OK;
}

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int k = 0; k < 3; k++) {
        c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    }
}

// The two spheres that, with the first, fix a shape's orientation: the farthest from the first, and
// the farthest from the line through both.
static void choose_axes(const struct dig_clump_shape *const shape, size_t *const far,
                        size_t *const aside, double *const off)
{
    double most = 0.0;
    *far        = 0;
    for (size_t k = 1; k < shape->spheres; k++) {
        const double d[3] = { shape->at[k][0] - shape->at[0][0], shape->at[k][1] - shape->at[0][1],
                              shape->at[k][2] - shape->at[0][2] };
        if (length(d) > most) {
            most = length(d);
            *far = k;
        }
    }
    *aside = 0;
    *off   = 0.0;
    for (size_t k = 1; k < shape->spheres; k++) {
        double line[3];
        double d[3];
        double n[3];
        for (int a = 0; a < 3; a++) {
            line[a] = shape->at[*far][a] - shape->at[0][a];
            d[a]    = shape->at[k][a] - shape->at[0][a];
        }
        cross(line, d, n);
        if (length(n) > *off) {
            *off   = length(n);
            *aside = k;
        }
    }
}

// Three axes at right angles: the first along `line`, the second on the side of `d` (NULL: on any).
static void make_axes(const double line[3], const double *const d, double axis[3][3])
{
    const double l = length(line);
    for (int k = 0; k < 3; k++) {
        axis[0][k] = line[k] / l;
    }
    double     aside[3] = { 0.0, 0.0, 0.0 };
    const int  flat     = fabs(axis[0][0]) < fabs(axis[0][1]) ? 0 : 1;
    const int  least    = fabs(axis[0][2]) < fabs(axis[0][flat]) ? 2 : flat;
    const bool any      = d == NULL;
    aside[least]        = 1.0;
    double n[3];
    cross(axis[0], any ? aside : d, n);
    const double ln = length(n);
    for (int k = 0; k < 3; k++) {
        axis[2][k] = n[k] / ln;
    }
    cross(axis[2], axis[0], axis[1]);
}

void dig_clump_orientation(const struct dig_clump_shape *const shape, const double at_m[][3],
                           double rotation[3][3])
{
    size_t far   = 0;
    size_t aside = 0;
    double off   = 0.0;
    choose_axes(shape, &far, &aside, &off);
    if (far == 0) {
        const double same[3][3] = { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } };
        memcpy(rotation, same, sizeof same);
        return;
    }
    const bool flat = off < 1e-6;
    double     line[2][3];
    double     d[2][3];
    for (int a = 0; a < 3; a++) {
        line[0][a] = shape->at[far][a] - shape->at[0][a];
        d[0][a]    = shape->at[aside][a] - shape->at[0][a];
        line[1][a] = at_m[far][a] - at_m[0][a];
        d[1][a]    = at_m[aside][a] - at_m[0][a];
    }
    double axis[2][3][3];
    for (int f = 0; f < 2; f++) {
        make_axes(line[f], flat ? NULL : d[f], axis[f]);
    }
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            rotation[r][c] = axis[1][0][r] * axis[0][0][c] + axis[1][1][r] * axis[0][1][c] +
                             axis[1][2][r] * axis[0][2][c];
        }
    }
}
