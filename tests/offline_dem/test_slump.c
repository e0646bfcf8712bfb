// The angle at which gravel comes to rest, against LIGGGHTS: columns of 1500 grains that it settled
// (tests/data/liggghts/in.slump) lose a wall and slump along a channel 0.04 m wide, in both codes.
// One column for each rolling friction; with DIG_TEST_LONG in the environment all three.

#include "tests/offline_dem/liggghts_fixture.h"

#define CHANNEL_m 0.04
#define STEPS     20000
#define BIN_m     (2.0 * GRAIN_m)
#define BINS      100
#define TOP       3 // the surface is the mean height of a bin's highest grains
#define SEEDS     3

struct bin {
    double top_m[TOP]; // highest first
    size_t grains;
};

static void add_height(struct bin *const bin, double z_m)
{
    for (int k = 0; k < TOP; k++) {
        if (z_m > bin->top_m[k]) {
            const double lower = bin->top_m[k];
            bin->top_m[k]      = z_m;
            z_m                = lower;
        }
    }
    bin->grains++;
}

// Slope of the line through the surface between a fifth and four fifths of its height, deg.
static double angle_deg(const struct bin bin[BINS])
{
    double height_m[BINS] = { 0.0 };
    double most_m         = 0.0;
    for (size_t b = 0; b < BINS; b++) {
        for (int k = 0; k < TOP && bin[b].grains >= TOP; k++) {
            height_m[b] += bin[b].top_m[k] / TOP;
        }
        most_m = fmax(most_m, height_m[b]);
    }
    double n = 0.0, sum_x = 0.0, sum_z = 0.0, sum_xx = 0.0, sum_xz = 0.0;
    for (size_t b = 0; b < BINS; b++) {
        if (height_m[b] >= 0.2 * most_m && height_m[b] <= 0.8 * most_m) {
            const double x = ((double)b + 0.5) * BIN_m;
            n += 1.0;
            sum_x += x;
            sum_z += height_m[b];
            sum_xx += x * x;
            sum_xz += x * height_m[b];
        }
    }
    assert_true(n > 8.0);
    return -atan((n * sum_xz - sum_x * sum_z) / (n * sum_xx - sum_x * sum_x)) / DIG_RAD_PER_DEG;
}

static size_t bin_of(const double x_m)
{
    return x_m < 0.0 ? 0 : x_m >= BINS * BIN_m ? BINS - 1 : (size_t)(x_m / BIN_m);
}

static double their_angle(const double rolling, const int seed)
{
    char path[64];
    (void)snprintf(path, sizeof path, FOLDER "slump_end_%.1f_%d.csv", rolling, seed);
    struct table *const end       = read_table(path);
    struct bin          bin[BINS] = { { { 0.0 }, 0 } };
    for (size_t i = 0; i < end->rows; i++) {
        add_height(&bin[bin_of(end->value[i][0])], end->value[i][1]);
    }
    free(end);
    return angle_deg(bin);
}

static double our_angle(const double rolling, const int seed)
{
    char path[64];
    (void)snprintf(path, sizeof path, FOLDER "slump_start_%.1f_%d.csv", rolling, seed);
    struct table *const start = read_table(path);
    const size_t        n     = start->rows;
    double(*const x_m)[3]     = calloc(n, sizeof *x_m);
    assert_non_null(x_m);
    for (size_t i = 0; i < n; i++) {
        memcpy(x_m[i], start->value[i], sizeof x_m[i]);
    }
    struct dig_world world = dem_world(n, (const double(*)[3])x_m, dem_material(0.5, rolling));
    world.gravity_mps2[2]  = -GRAVITY;
    dem_add_wall(&world, 1.0, 0.0, 0.0, 0.0);
    dem_add_wall(&world, 0.0, 1.0, 0.0, 0.0);
    dem_add_wall(&world, 0.0, -1.0, 0.0, -CHANNEL_m);
    dem_add_wall(&world, 0.0, 0.0, 1.0, 0.0);
    dem_run(&world, STEPS);
    struct bin bin[BINS] = { { { 0.0 }, 0 } };
    for (size_t i = 0; i < n; i++) {
        const double *const at_m = world.grains.motion[i].x_m;
        add_height(&bin[bin_of(at_m[0])], at_m[2]);
    }
    dig_world_finish(&world);
    free(x_m);
    free(start);
    return angle_deg(bin);
}

TEST(slump_angles_are_those_of_liggghts_within_three_degrees)
{
    const double rolling[] = { 0.0, 0.3, 0.9 };
    const int    seeds     = getenv("DIG_TEST_LONG") != NULL ? SEEDS : 1;
    double       before    = 0.0;
    for (size_t r = test_is_quick() ? 2 : 0; r < 3; r++) {
        double ours = 0.0, theirs = 0.0;
        for (int seed = 1; seed <= seeds; seed++) {
            const double our   = our_angle(rolling[r], seed);
            const double their = their_angle(rolling[r], seed);
            print_message("rolling friction %.1f, column %d: %.1f deg, LIGGGHTS %.1f deg\n",
                          rolling[r], seed, our, their);
            ours += our / seeds;
            theirs += their / seeds;
        }
        assert_close(ours, theirs, 3.0);
        // The measure tells gravels apart at all.
        assert_true(theirs > before + 3.0);
        before = theirs;
    }
}
