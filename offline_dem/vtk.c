#include "offline_dem/vtk.h"

#include <math.h>
#include <stdio.h>

#define PATH_SIZE 4096

static FILE *begin(const char *const dir, const char *const what, const size_t frame)
{
    char      path[PATH_SIZE];
    const int length = snprintf(path, sizeof path, "%s/%s_%04zu.vtk", dir, what, frame);
    if (length < 0 || length >= PATH_SIZE) {
        return NULL;
    }
    FILE *const file = fopen(path, "w");
    if (file != NULL) {
        (void)fprintf(file, "# vtk DataFile Version 3.0\n%s, SI units\nASCII\nDATASET POLYDATA\n",
                      what);
    }
    return file;
}

static enum dig_status end(FILE *const file)
{
    const int failed = ferror(file);
    return fclose(file) != 0 || failed ? DIG_EIO : DIG_OK;
}

static void write_grains(FILE *const file, const struct dig_grains *const grains)
{
    const size_t n = grains->n;
    (void)fprintf(file, "POINTS %zu double\n", n);
    for (size_t i = 0; i < n; i++) {
        const double *const x = grains->motion[i].x_m;
        (void)fprintf(file, "%.7g %.7g %.7g\n", x[0], x[1], x[2]);
    }
    (void)fprintf(file, "VERTICES %zu %zu\n", n, 2 * n);
    for (size_t i = 0; i < n; i++) {
        (void)fprintf(file, "1 %zu\n", i);
    }
    (void)fprintf(file, "POINT_DATA %zu\nSCALARS radius_m double 1\nLOOKUP_TABLE default\n", n);
    for (size_t i = 0; i < n; i++) {
        (void)fprintf(file, "%.7g\n", grains->kind[grains->of[i]].radius_m);
    }
    (void)fprintf(file, "SCALARS name int 1\nLOOKUP_TABLE default\n");
    for (size_t i = 0; i < n; i++) {
        (void)fprintf(file, "%u\n", (unsigned)grains->name[i]);
    }
    (void)fprintf(file, "SCALARS speed_mps double 1\nLOOKUP_TABLE default\n");
    for (size_t i = 0; i < n; i++) {
        const double *const v = grains->motion[i].v_mps;
        (void)fprintf(file, "%.5g\n", sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    }
}

// Vertex k of the profile stands at 2 k on the right side and at 2 k + 1 on the left.
static void write_bucket(FILE *const file, const struct dig_tool *const tool)
{
    const struct dig_bucket *const bucket = &tool->bucket;
    const size_t                   n      = bucket->points;
    (void)fprintf(file, "POINTS %zu double\n", 2 * n);
    for (size_t k = 0; k < 2 * n; k++) {
        const double half_m  = 0.5 * bucket->width_m;
        const double body[3] = { bucket->x_m[k / 2], k % 2 == 0 ? -half_m : half_m,
                                 bucket->z_m[k / 2] };
        double       world[3];
        dig_tool_turn(tool, body, world);
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

enum dig_status dig_vtk_write(const char *const dir, const size_t frame,
                              const struct dig_grains *const grains,
                              const struct dig_tool *const   tool)
{
    FILE *const grain_file = begin(dir, "grains", frame);
    if (grain_file == NULL) {
        return DIG_EIO;
    }
    write_grains(grain_file, grains);
    if (end(grain_file) != DIG_OK) {
        return DIG_EIO;
    }
    FILE *const bucket_file = begin(dir, "bucket", frame);
    if (bucket_file == NULL) {
        return DIG_EIO;
    }
    write_bucket(bucket_file, tool);
    return end(bucket_file);
}
