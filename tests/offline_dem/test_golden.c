// A short dig whose every bit is kept: nothing about the plain law, the lists or the order of sums
// may change unnoticed, because tables are made of many thousand digs that must stay one set.
//
// The constants are written out and the tool does not turn, so that only operations enter that
// IEEE 754 rounds in one way: the number holds for every compiler, libm and processor. Where it
// changes on purpose, say so under "Numbers changed" in CHANGELOG.md.

#include "core/chance.h"
#include "tests/dem_fixture.h"

#define SIDE   7
#define HIGH   6
#define GRAINS ((size_t)SIDE * SIDE * HIGH)

static struct dig_law plain_law(const double reach_m, const double lever_j_m)
{
    return (struct dig_law){
        .reach_m         = reach_m,
        .lever_i_m       = GRAIN_m,
        .lever_j_m       = lever_j_m,
        .normal_Npm      = 5000.0,
        .damping_Nspm    = 1.0,
        .rolling_Nmprad  = 0.0175,
        .tangential_Npm  = 5000.0,
        .friction        = 0.5,
        .rolling_lever_m = 0.0009,
    };
}

static struct dig_world make_bed(void)
{
    uint64_t random = 7;
    double   x[GRAINS][3];
    for (size_t i = 0; i < GRAINS; i++) {
        const size_t at[3] = { i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE };
        for (size_t k = 0; k < 3; k++) {
            x[i][k] = (2.3 * (double)at[k] + 1.15) * GRAIN_m +
                      dig_chance_between(&random, -0.1, 0.1) * GRAIN_m;
        }
    }
    struct dig_world world = dem_world(GRAINS, (const double(*)[3])x, dem_material(0.5, 0.5));
    world.gravity_mps2[2]  = -GRAVITY;
    world.pair_law[0]      = plain_law(2.0 * GRAIN_m, GRAIN_m);
    world.wall_law[0]      = plain_law(GRAIN_m, 0.0);
    world.tool_law[0]      = world.wall_law[0];
    const double width_m   = 2.3 * SIDE * GRAIN_m;
    dem_add_wall(&world, 0.0, 0.0, 1.0, 0.0);
    dem_add_wall(&world, 1.0, 0.0, 0.0, 0.0);
    dem_add_wall(&world, -1.0, 0.0, 0.0, -width_m);
    dem_add_wall(&world, 0.0, 1.0, 0.0, 0.0);
    dem_add_wall(&world, 0.0, -1.0, 0.0, -width_m);
    return world;
}

static uint64_t mix(uint64_t hash, const double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int byte = 0; byte < 8; byte++) {
        hash = (hash ^ (bits >> (8 * byte) & 0xff)) * UINT64_C(1099511628211); // FNV-1a
    }
    return hash;
}

// Lets the bed fall, then drags a bucket through it.
static uint64_t dig(const enum dig_isa isa, const bool single)
{
    const struct dig_bucket bucket = { .points  = 4,
                                       .x_m     = { 0.0, -0.01, -0.01, 0.0 },
                                       .z_m     = { -0.03, -0.025, -0.01, 0.0 },
                                       .width_m = 0.02 };
    struct dig_tool         tool   = dig_tool_make(&bucket);
    struct dig_world        world  = make_bed();
    world.isa                      = isa;
    world.single                   = single;
    dem_run(&world, 1200);
    world.tool = &tool;
    dig_world_mark_stale(&world);
    uint64_t hash   = UINT64_C(14695981039346656037);
    double   push_N = 0.0;
    for (int s = 0; s < 1600; s++) {
        const struct dig_pose pose = { .x_m = 0.012 + 1.25e-5 * s, .z_m = 0.045, .theta_rad = 0.0 };
        dig_tool_place(&tool, pose, 0.2, 0.0, 0.0);
        dem_run(&world, 1);
        push_N += world.on_tool.f_N[0];
        for (int k = 0; k < 3; k++) {
            hash = mix(mix(hash, world.on_tool.f_N[k]), world.on_tool.t_Nm[k]);
        }
    }
    assert_true(push_N < -1.0);
    assert_int_equal(dig_world_sync_motion(&world), DIG_OK);
    for (uint32_t i = 0; i < GRAINS; i++) {
        for (int k = 0; k < 3; k++) {
            hash = mix(mix(hash, dem_grain(&world, i)->x_m[k]), dem_grain(&world, i)->w_radps[k]);
        }
    }
    dig_world_finish(&world);
    return hash;
}

TEST(a_short_dig_keeps_its_bits)
{
    for (enum dig_isa isa = DIG_ISA_BASE; isa <= dig_kernel_best(); isa++) {
        const uint64_t exact = dig(isa, false);
        const uint64_t rough = dig(isa, true);
        if (exact != UINT64_C(0xdd76c5a58b508d51) || rough != UINT64_C(0xb9d02003fc44e1bc)) {
            fail_msg("variant %d: %016llx %016llx", (int)isa, (unsigned long long)exact,
                     (unsigned long long)rough);
        }
    }
}
