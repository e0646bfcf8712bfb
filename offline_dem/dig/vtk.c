#include "offline_dem/dig/vtk.h"

#include "core/part.h"
#include "offline_dem/law/law_general.h"
#include "offline_dem/law/period.h"
#include "offline_dem/world/bodies.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PATH_SIZE 4096
#define FACETS    6

// Force of its neighbours on a grain, with the springs at present.
struct grain_force {
    double f_N[3];
    double load_N;
};

static void add_contact_forces(const struct dig_world *const world, const struct dig_law law,
                               const struct dig_contacts *const list,
                               struct grain_force               grain_force[])
{
    const struct dig_motion *const motion         = world->grains.motion;
    const double                   inverse_period = dig_period_inverse(world->period_y_m);
    for (size_t c = 0; c < list->n; c++) {
        struct dig_kinematics kinematics =
            dig_motion_between(&motion[list->i[c]], &motion[list->j[c]]);
        kinematics.dy_m = dig_period_fold(kinematics.dy_m, world->period_y_m, inverse_period);
        struct dig_contact_history     history = dig_contacts_history(list, c);
        const struct dig_contact_force force   = dig_law_apply(&law, 0.0, &kinematics, &history);
        const double                   f_N[3]  = { force.fx_N, force.fy_N, force.fz_N };
        const double half_N = 0.5 * sqrt(f_N[0] * f_N[0] + f_N[1] * f_N[1] + f_N[2] * f_N[2]);
        for (int k = 0; k < 3; k++) {
            grain_force[list->i[c]].f_N[k] += f_N[k];
            grain_force[list->j[c]].f_N[k] -= f_N[k];
        }
        grain_force[list->i[c]].load_N += half_N;
        grain_force[list->j[c]].load_N += half_N;
    }
}

// NULL when memory is short.
static struct grain_force *sum_contact_forces(const struct dig_world *const world)
{
    struct grain_force *const grain_force = calloc(world->grains.n + 1, sizeof *grain_force);
    for (size_t l = 0; grain_force != NULL && l < DIG_PAIR_LISTS; l++) {
        add_contact_forces(world, world->pair_law[l], &world->pair[l], grain_force);
    }
    return grain_force;
}

// What the files of one instant show.
struct picture {
    const struct dig_world   *world;
    const struct dig_tool    *tool;
    const struct grain_force *grain_force; // [grains]
};

static void begin_scalar(FILE *const file, const char *const name, const char *const type)
{
    (void)fprintf(file, "SCALARS %s %s 1\nLOOKUP_TABLE default\n", name, type);
}

static void write_grains(FILE *const file, const struct picture *const picture)
{
    const struct dig_grains *const  grains      = &picture->world->grains;
    const struct grain_force *const grain_force = picture->grain_force;
    const size_t                    n           = grains->n;
    (void)fprintf(file, "POINTS %zu double\n", n);
    for (size_t i = 0; i < n; i++) {
        const double *const x = grains->motion[i].x_m;
        (void)fprintf(file, "%.7g %.7g %.7g\n", x[0], x[1], x[2]);
    }
    (void)fprintf(file, "VERTICES %zu %zu\n", n, 2 * n);
    for (size_t i = 0; i < n; i++) {
        (void)fprintf(file, "1 %zu\n", i);
    }
    (void)fprintf(file, "POINT_DATA %zu\n", n);
    begin_scalar(file, "radius_m", "double");
    for (size_t i = 0; i < n; i++) {
        (void)fprintf(file, "%.7g\n", grains->type[grains->type_of[i]].radius_m);
    }
    begin_scalar(file, "name", "int");
    for (size_t i = 0; i < n; i++) {
        (void)fprintf(file, "%u\n", (unsigned)grains->id[i]);
    }
    begin_scalar(file, "clump", "int");
    for (size_t i = 0; i < n; i++) {
        (void)fprintf(file, "%u\n", grains->clump == NULL ? 0 : (unsigned)grains->clump[i]);
    }
    begin_scalar(file, "load_N", "double");
    for (size_t i = 0; i < n; i++) {
        (void)fprintf(file, "%.5g\n", grain_force[i].load_N);
    }
    (void)fprintf(file, "VECTORS velocity_mps double\n");
    for (size_t i = 0; i < n; i++) {
        const double *const v = grains->motion[i].v_mps;
        (void)fprintf(file, "%.5g %.5g %.5g\n", v[0], v[1], v[2]);
    }
    (void)fprintf(file, "VECTORS force_N double\n");
    for (size_t i = 0; i < n; i++) {
        const double *const f = grain_force[i].f_N;
        (void)fprintf(file, "%.5g %.5g %.5g\n", f[0], f[1], f[2]);
    }
}

// Vertex k of the profile stands at 2 k on the right side and at 2 k + 1 on the left.
static void write_bucket(FILE *const file, const struct picture *const picture)
{
    const struct dig_tool *const   tool   = picture->tool;
    const struct dig_bucket *const bucket = &tool->bucket;
    const size_t                   n      = bucket->points;
    (void)fprintf(file, "POINTS %zu double\n", 2 * n);
    for (size_t k = 0; k < 2 * n; k++) {
        const double half_m  = 0.5 * bucket->width_m;
        const double body[3] = { bucket->x_m[k / 2], k % 2 == 0 ? -half_m : half_m,
                                 bucket->z_m[k / 2] };
        double       world[3];
        dig_tool_rotate(tool, body, world);
        (void)fprintf(file, "%.7g %.7g %.7g\n", world[0] + tool->pose.x_m, world[1],
                      world[2] + tool->pose.z_m);
    }
    (void)fprintf(file, "POLYGONS %zu %zu\n", n - 1 + 2, 5 * (n - 1) + 2 * (n + 1));
    for (size_t k = 0; k + 1 < n; k++) {
        (void)fprintf(file, "4 %zu %zu %zu %zu\n", 2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1);
    }
    for (size_t side = 0; side < 2; side++) {
        (void)fprintf(file, "%zu", n);
        for (size_t k = 0; k < n; k++) {
            (void)fprintf(file, " %zu", 2 * k + side);
        }
        (void)fprintf(file, "\n");
    }
}

// A rock as the faces of a cube, projected onto the sphere if it is one, in FACETS x FACETS tiles.
static void write_rock_points(FILE *const file, const struct dig_rock_surface *const rock)
{
    for (int face = 0; face < 6; face++) {
        for (int k = 0; k < (FACETS + 1) * (FACETS + 1); k++) {
            double p[3];
            double x_m[3];
            p[face / 2]           = face % 2 == 0 ? -1.0 : 1.0;
            const int column      = k % (FACETS + 1);
            const int row         = k / (FACETS + 1);
            p[(face / 2 + 1) % 3] = 2.0 * column / FACETS - 1.0;
            p[(face / 2 + 2) % 3] = 2.0 * row / FACETS - 1.0;
            const double length   = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
            for (int a = 0; a < 3; a++) {
                p[a] *=
                    rock->shape == DIG_OBSTACLE_BOX ? rock->half_m[a] : rock->half_m[0] / length;
            }
            dig_rigid_rotate(rock->q, p, x_m);
            (void)fprintf(file, "%.7g %.7g %.7g\n", x_m[0] + rock->x_m[0], x_m[1] + rock->x_m[1],
                          x_m[2] + rock->x_m[2]);
        }
    }
}

static void write_rocks(FILE *const file, const struct picture *const picture)
{
    const struct dig_obstacles *const obstacles = &picture->world->bodies->obstacles;
    const size_t                      side      = FACETS + 1;
    const size_t                      faces     = 6 * obstacles->rocks;
    (void)fprintf(file, "POINTS %zu double\n", faces * side * side);
    for (size_t r = 0; r < obstacles->rocks; r++) {
        write_rock_points(file, &obstacles->rock[r].surface);
    }
    const size_t tiles = (size_t)FACETS * FACETS; // of one face
    const size_t quads = faces * tiles;
    (void)fprintf(file, "POLYGONS %zu %zu\n", quads, 5 * quads);
    for (size_t q = 0; q < quads; q++) {
        const size_t within = q % tiles;
        const size_t first  = q / tiles * side * side + within / FACETS * side + within % FACETS;
        (void)fprintf(file, "4 %zu %zu %zu %zu\n", first, first + 1, first + side + 1,
                      first + side);
    }
}

static enum dig_status end(FILE *const file)
{
    const int failed = ferror(file);
    return fclose(file) != 0 || failed ? DIG_EIO : DIG_OK;
}

static enum dig_status write_file(const char *const dir, const char *const what, const size_t frame,
                                  void (*const write)(FILE *, const struct picture *),
                                  const struct picture *const picture)
{
    char        path[PATH_SIZE];
    const int   length = snprintf(path, sizeof path, "%s/%s_%04zu.vtk", dir, what, frame);
    FILE *const file   = length < 0 || length >= PATH_SIZE ? NULL : dig_part_open(path);
    if (file == NULL) {
        return DIG_EIO;
    }
    (void)fprintf(file, "# vtk DataFile Version 3.0\n%s, SI units\nASCII\nDATASET POLYDATA\n",
                  what);
    write(file, picture);
    return end(file);
}

enum dig_status dig_vtk_write(const char *const dir, const size_t frame,
                              const struct dig_world *const world,
                              const struct dig_tool *const  tool)
{
    struct grain_force *const grain_force = sum_contact_forces(world);
    if (grain_force == NULL) {
        return DIG_ENOMEM;
    }
    const struct picture picture = { world, tool, grain_force };
    enum dig_status      status  = write_file(dir, "grains", frame, write_grains, &picture);
    status = status == DIG_OK ? write_file(dir, "bucket", frame, write_bucket, &picture) : status;
    if (status == DIG_OK && dig_bodies_rocks(world->bodies) > 0) {
        status = write_file(dir, "rocks", frame, write_rocks, &picture);
    }
    free(grain_force);
    return status;
}

static enum dig_status write_index(const char *const dir, const char *const what,
                                   const size_t frames, const double step_s)
{
    char        path[PATH_SIZE];
    const int   length = snprintf(path, sizeof path, "%s/%s.vtk.series", dir, what);
    FILE *const file   = length < 0 || length >= PATH_SIZE ? NULL : dig_part_open(path);
    if (file == NULL) {
        return DIG_EIO;
    }
    (void)fprintf(file, "{\"file-series-version\": \"1.0\", \"files\": [");
    for (size_t k = 0; k < frames; k++) {
        (void)fprintf(file, "%s\n  {\"name\": \"%s_%04zu.vtk\", \"time\": %.9g}", k == 0 ? "" : ",",
                      what, k, (double)k * step_s);
    }
    (void)fprintf(file, "\n]}\n");
    return end(file);
}

enum dig_status dig_vtk_index(const char *const dir, const size_t frames, const double step_s,
                              const bool rocks)
{
    static const char *const what[] = { "grains", "bucket", "rocks" };
    enum dig_status          status = DIG_OK;
    for (size_t i = 0; i < (rocks ? 3U : 2U) && status == DIG_OK; i++) {
        status = write_index(dir, what[i], frames, step_s);
    }
    return status;
}
