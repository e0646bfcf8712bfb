// The grain kernel alone, for tests/bench/dem.sh: makes a bed in a box without a tool, and steps
// it.
//   dem pour GRAINS BED.csv        drops about so many grains into a square box and lets them
//                                  settle
//   dem step BED.csv SIDE_m STEPS [THREADS]
//                                  steps them after a start of 200; prints grains, particle-steps a
//                                  second of processor time, kB of memory at the most, and the
//                                  seconds that passed
// Gravel and time step are those of config/scenes/rig.yaml.

#include "core/chance.h"
#include "offline_dem/kernel/crew.h"
#include "offline_dem/world/world.h"
#include "tests/dem_grains.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#define RADIUS_m 0.00375
#define PITCH_m  (2.3 * RADIUS_m)
#define LAYERS   11 // as deep as the rig's bed
#define WARM     200
#define SETTLE   6400

static void build(struct dig_world *const world, struct dig_grains *const grains,
                  const double side_m)
{
    const struct dig_law_material gravel = {
        .young_Pa                    = 5e6,
        .poisson                     = 0.2,
        .restitution                 = 0.2,
        .characteristic_velocity_mps = 2.0,
        .friction                    = 0.5,
        .rolling                     = 0.5,
    };
    const struct dig_wall wall[] = { { { 1.0, 0.0, 0.0 }, 0.0 },
                                     { { -1.0, 0.0, 0.0 }, -side_m },
                                     { { 0.0, 1.0, 0.0 }, 0.0 },
                                     { { 0.0, -1.0, 0.0 }, -side_m },
                                     { { 0.0, 0.0, 1.0 }, 0.0 } };
    world->dt_s                  = 6.25e-5;
    world->gravity_mps2[2]       = -9.81;
    world->isa                   = dig_kernel_best();
    world->single                = true;
    world->walls                 = sizeof wall / sizeof wall[0];
    memcpy(world->wall, wall, sizeof wall);
    dig_world_init(world, grains);
    dem_set_material(world, &gravel);
}

static int run(struct dig_world *const world, const size_t steps)
{
    for (size_t s = 0; s < steps; s++) {
        if (dig_world_step(world) != DIG_OK) {
            (void)fprintf(stderr, "dem: step %zu failed\n", s);
            return 1;
        }
    }
    return 0;
}

static int place(const size_t n, const double x[], struct dig_grains *const grains)
{
    double *const radius_m = malloc((n + 1) * sizeof *radius_m);
    if (radius_m == NULL) {
        return 1;
    }
    for (size_t i = 0; i < n; i++) {
        radius_m[i] = RADIUS_m;
    }
    const enum dig_status status =
        dem_create_grains(n, x, x + n, x + 2 * n, radius_m, 2500.0, grains);
    free(radius_m);
    return status == DIG_OK ? 0 : 1;
}

// A loose lattice, jittered, falls and settles. The first line of the bed names the box's side.
static int pour(const size_t want, const char *const path)
{
    const size_t  across = (size_t)ceil(sqrt((double)want / LAYERS));
    const size_t  n      = across * across * LAYERS;
    double *const x      = malloc((3 * n + 1) * sizeof *x);
    if (x == NULL) {
        return 1;
    }
    uint64_t random = 1;
    for (size_t i = 0; i < n; i++) {
        const size_t at[3] = { i % across, i / across % across, i / across / across };
        for (size_t k = 0; k < 3; k++) {
            x[k * n + i] = ((double)at[k] + 0.5) * PITCH_m +
                           dig_chance_between(&random, -0.12, 0.12) * RADIUS_m;
        }
    }
    static struct dig_world world;
    struct dig_grains       grains;
    const double            side_m = (double)across * PITCH_m;
    if (place(n, x, &grains) != 0) {
        free(x);
        return 1;
    }
    free(x);
    build(&world, &grains, side_m);
    int         bad  = run(&world, SETTLE);
    FILE *const file = fopen(path, "w");
    bad |= file == NULL;
    for (size_t i = 0; i < world.grains.n && !bad; i++) {
        const double *const at = world.grains.motion[i].x_m;
        bad                    = fprintf(file, "%.17g,%.17g,%.17g\n", at[0], at[1], at[2]) < 0;
    }
    if (file != NULL) {
        bad |= fclose(file) != 0;
    }
    (void)printf("%.17g\n", side_m);
    dig_world_finish(&world);
    return bad;
}

static double clock_s(const clockid_t clock)
{
    struct timespec t;
    (void)clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double cpu_s(void)
{
    return clock_s(CLOCK_PROCESS_CPUTIME_ID);
}

static double now_s(void)
{
    return clock_s(CLOCK_MONOTONIC);
}

static size_t read_bed(const char *const path, double **const x)
{
    FILE *const file = fopen(path, "r");
    size_t      n    = 0;
    size_t      room = 0;
    double     *row  = NULL;
    double      p[3];
    while (file != NULL && fscanf(file, "%lf,%lf,%lf", &p[0], &p[1], &p[2]) == 3) {
        if (n == room) {
            room               = 2 * room + 1024;
            double *const more = realloc(row, 3 * room * sizeof *row);
            if (more == NULL) {
                break;
            }
            row = more;
        }
        memcpy(row + 3 * n, p, sizeof p);
        n++;
    }
    if (file != NULL) {
        (void)fclose(file);
    }
    *x = malloc((3 * n + 1) * sizeof **x);
    for (size_t i = 0; i < n && *x != NULL; i++) {
        for (size_t k = 0; k < 3; k++) {
            (*x)[k * n + i] = row[3 * i + k];
        }
    }
    free(row);
    return *x == NULL ? 0 : n;
}

static int step(const char *const path, const double side_m, const size_t steps,
                const size_t threads)
{
    double                 *x;
    const size_t            n = read_bed(path, &x);
    static struct dig_world world;
    struct dig_grains       grains;
    if (n == 0 || place(n, x, &grains) != 0) {
        (void)fprintf(stderr, "dem: %s: no bed\n", path);
        free(x);
        return 1;
    }
    free(x);
    build(&world, &grains, side_m);
    if (threads > 1 && dig_crew_create(threads, &world.crew) != DIG_OK) {
        return 1;
    }
    int          bad    = run(&world, WARM);
    const double from_s = cpu_s();
    const double wall_s = now_s();
    bad |= run(&world, steps);
    const double  took_s = cpu_s() - from_s;
    const double  wait_s = now_s() - wall_s;
    struct rusage usage;
    (void)getrusage(RUSAGE_SELF, &usage);
    (void)printf("%zu %.6g %ld %.4g\n", n, (double)n * (double)steps / took_s, usage.ru_maxrss,
                 wait_s);
    dig_crew_destroy(world.crew);
    dig_world_finish(&world);
    return bad;
}

int main(const int count, char **const word)
{
    if (count == 4 && strcmp(word[1], "pour") == 0) {
        return pour(strtoul(word[2], NULL, 10), word[3]);
    }
    if ((count == 5 || count == 6) && strcmp(word[1], "step") == 0) {
        return step(word[2], strtod(word[3], NULL), strtoul(word[4], NULL, 10),
                    count == 6 ? strtoul(word[5], NULL, 10) : 1);
    }
    (void)fprintf(stderr,
                  "usage: dem pour GRAINS BED.csv | dem step BED.csv SIDE_m STEPS [THREADS]\n");
    return 2;
}
