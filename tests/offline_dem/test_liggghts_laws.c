// The laws beside the plain one against LIGGGHTS-PUBLIC 3.8, step by step: grains of unlike size,
// density and constants, each law alone and all together.

#include "tests/offline_dem/liggghts_fixture.h"

#define FINE_s    3e-5
#define LARGE_m   0.0045
#define COHESION  1e5
#define BIG_KGPM3 4000.0

static struct dig_law_material unlike(const enum dig_normal_law  normal,
                                      const enum dig_rolling_law rolling, const double cohesion)
{
    struct dig_law_material m = dem_material(0.3, 0.2);
    m.restitution             = 0.6;
    m.normal_law              = normal;
    m.rolling_law             = rolling;
    m.cohesion_Jpm3           = cohesion;
    return m;
}

static void meet_pair(const struct dig_law_material m, const char *const path)
{
    const double     x[2][3] = { { 0.0, 0.0, 0.0 }, { 0.00798, 0.0011, 0.0022 } };
    struct dig_world world   = dem_world(2, x, m);
    // dem_world() makes like grains: the second is another kind, and their law is made anew.
    struct dig_grains *const g = &world.grains;
    g->types                   = 2;
    g->type[1]                 = dem_sphere(LARGE_m, BIG_KGPM3);
    g->type_of[1]              = 1;
    dem_set_material(&world, &m);
    world.dt_s = FINE_s;
    g->motion[0] =
        (struct dig_motion){ .v_mps = { 0.2, 0.03, 0.01 }, .w_radps = { 3.0, 5.0, -7.0 } };
    g->motion[1] = (struct dig_motion){ .x_m     = { 0.00798, 0.0011, 0.0022 },
                                        .v_mps   = { -0.1, 0.02, -0.05 },
                                        .w_radps = { -20.0, 4.0, 11.0 } };
    follow(&world, path, (struct tolerance){ 1e-14, 1e-11, 1e-13 });
    dig_world_finish(&world);
}

static void meet_wall(const struct dig_law_material m, const char *const path)
{
    const double     x[1][3] = { { 0.0, 0.0, 0.0 } };
    struct dig_world world   = dem_world(1, x, m);
    dem_add_wall(&world, 0.0, 0.0, 1.0, -0.0038);
    world.dt_s = FINE_s;
    world.grains.motion[0] =
        (struct dig_motion){ .v_mps = { 0.2, 0.1, -0.6 }, .w_radps = { 3.0, 5.0, -7.0 } };
    follow(&world, path, (struct tolerance){ 1e-14, 1e-11, 1e-13 });
    dig_world_finish(&world);
}

TEST(unlike_grains_meet_as_in_liggghts_under_each_law_and_all_together)
{
    meet_pair(unlike(DIG_NORMAL_HOOKE, DIG_ROLLING_EPSD2, 0.0), FOLDER "pair_unlike.csv");
    meet_pair(unlike(DIG_NORMAL_HERTZ, DIG_ROLLING_EPSD2, 0.0), FOLDER "pair_hertz.csv");
    meet_pair(unlike(DIG_NORMAL_HOOKE, DIG_ROLLING_CDT, 0.0), FOLDER "pair_cdt.csv");
    meet_pair(unlike(DIG_NORMAL_HOOKE, DIG_ROLLING_EPSD2, COHESION), FOLDER "pair_sjkr.csv");
    meet_pair(unlike(DIG_NORMAL_HERTZ, DIG_ROLLING_CDT, COHESION),
              FOLDER "pair_hertz_cdt_sjkr.csv");
}

TEST(walls_answer_as_in_liggghts)
{
    meet_wall(unlike(DIG_NORMAL_HERTZ, DIG_ROLLING_NONE, 0.0), FOLDER "wall_hertz.csv");
    meet_wall(unlike(DIG_NORMAL_HOOKE, DIG_ROLLING_CDT, 0.0), FOLDER "wall_cdt.csv");
    meet_wall(unlike(DIG_NORMAL_HOOKE, DIG_ROLLING_NONE, COHESION), FOLDER "wall_sjkr.csv");
}

// Grains of three sizes in turn, all laws at once.
static struct dig_world mixed_cluster(const struct table *const start)
{
    struct dig_law_material m      = dem_material(0.5, 0.3);
    m.normal_law                   = DIG_NORMAL_HERTZ;
    m.rolling_law                  = DIG_ROLLING_CDT;
    m.cohesion_Jpm3                = 3e4;
    struct dig_world         world = world_of(start, m);
    const double             r[]   = { 0.003, 0.0034, 0.00375 };
    struct dig_grains *const g     = &world.grains;
    g->types                       = 3;
    for (size_t k = 0; k < 3; k++) {
        g->type[k] = dem_sphere(r[k], DENSITY);
    }
    for (size_t i = 0; i < start->rows; i++) {
        g->type_of[i]         = (uint8_t)((i + 1) % 3);
        g->motion[i].v_mps[2] = -1.0;
    }
    dem_set_material(&world, &m);
    world.dt_s            = FINE_s;
    world.gravity_mps2[2] = -GRAVITY;
    dem_add_wall(&world, 0.0, 0.0, 1.0, 0.0);
    return world;
}

// As a_cluster_falls_apart_as_in_liggghts(): alike to the digits of the file until a pair that has
// parted meets again.
TEST(a_mixed_sticky_cluster_falls_apart_as_in_liggghts)
{
    struct table *const start = read_table(FOLDER "cluster_start.csv");
    struct table *const then  = read_table(FOLDER "cluster_laws.csv");
    struct dig_world    world = mixed_cluster(start);
    size_t              step  = 0;
    for (size_t row = 0; row < then->rows; row++) {
        const size_t at = (size_t)then->value[row][0];
        dem_run(&world, at - step);
        step                            = at;
        const double            worst_m = at <= 160 ? 1e-11 : at <= 200 ? 1e-6 : 5e-5;
        const struct dig_motion ours    = *dem_grain(&world, (uint32_t)(row % start->rows));
        for (int k = 0; k < 3; k++) {
            assert_close(ours.x_m[k], then->value[row][1 + k], worst_m);
        }
    }
    dig_world_finish(&world);
    free(start);
    free(then);
}
