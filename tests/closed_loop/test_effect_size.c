#include "closed_loop/accuracy/effect_size.h"

#include "tests/closed_loop/world_fixture.h"

#include <stdlib.h>
#include <string.h>

enum { DIGS = 8 };

static const struct dig_gravel gravel = { { 0.6, 0.55, 2500 } };
static struct dig_measured     measured[DIGS];
static struct dig_batch        batch;
static struct dig_fitted       plain;

static int make(void **state)
{
    uint64_t seed = 3;
    if (world_setup(state) != DIG_OK) {
        return 1;
    }
    dig_in_turn(DIGS, &gravel, 0, NULL, NULL, &seed, measured);
    batch_digs(DIGS, measured, &gravel, &batch);
    plain = fit_plain(&batch);
    return 0;
}

static double size_of_machine(const struct dig_fitted *const fitted)
{
    double machine[DIGS][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
    for (size_t i = 0; i < DIGS; i++) {
        memcpy(machine[i], measured[i].machine, sizeof machine[i]);
    }
    return dig_effect_size_of_machine(
        &batch, fitted, (const double(*)[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS])machine);
}

// The machine adds this share of the scatter of one dig, changing sign ten times along each dig: no
// gravel does that.
static void add_wave(const double share)
{
    for (size_t i = 0; i < DIGS; i++) {
        const enum made_trajectory which = i % 2 == 0 ? MADE_SIMPLE_A : MADE_ACTUAL;
        double                     rms   = 0.0;
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double p = (double)k / (DIG_CURVE_POINTS - 1);
            rms += pow(made_moment_Nm(&gravel, which, p, 0.0), 2.0) / DIG_CURVE_POINTS;
        }
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double p = (double)k / (DIG_CURVE_POINTS - 1);
            measured[i].machine[DIG_CHANNEL_MY_Nm][k] =
                share * MADE_SCATTER * sqrt(rms) * sqrt(2.0) * sin(31.0 * p);
        }
    }
}

TEST(without_the_machine_there_is_no_size)
{
    add_wave(0.0);
    assert_close(size_of_machine(&plain), 0.0, 1e-12);
}

// Four digs of each trajectory: their mean scatters by half as much as one; what all share (.05 for
// the DEM and the surface's) makes the floor 1 / .55 to 1 / .6 of that.
TEST(what_no_gravel_does_counts_in_floors)
{
    add_wave(2.0);
    const double size = size_of_machine(&plain);
    assert_in_range(1000.0 * size, 3000, 4000);
    add_wave(4.0);
    assert_close(size_of_machine(&plain), 2.0 * size, 0.05 * size);
}

TEST(what_another_gravel_does_is_no_size)
{
    const struct dig_gravel other = { { 0.6, 0.55, 3000 } };
    double                  here[DIG_AXES];
    double                  there[DIG_AXES];
    dig_response_surface_place(world.surface, &gravel, here);
    dig_response_surface_place(world.surface, &other, there);
    struct dig_fitted at = plain;
    memcpy(at.number, here, sizeof here);
    for (size_t i = 0; i < DIGS; i++) {
        double a[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        double b[DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
        dig_response_surface_curve(world.surface, (size_t)measured[i].trajectory, here, a);
        dig_response_surface_curve(world.surface, (size_t)measured[i].trajectory, there, b);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            measured[i].machine[DIG_CHANNEL_MY_Nm][k] =
                b[DIG_CHANNEL_MY_Nm][k] - a[DIG_CHANNEL_MY_Nm][k];
        }
    }
    assert_close(size_of_machine(&at), 0.0, 0.02);
    // Twice of it is beyond the table's grid.
    for (size_t i = 0; i < DIGS; i++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            measured[i].machine[DIG_CHANNEL_MY_Nm][k] *= 20.0;
        }
    }
    assert_true(size_of_machine(&at) > 3.0);
}

// The digs are measured with what the machine adds; whether that is known to be the machine's.
static void add_to_value(const bool known)
{
    for (size_t i = 0; i < DIGS; i++) {
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            measured[i].value[DIG_CHANNEL_MY_Nm][k] += measured[i].machine[DIG_CHANNEL_MY_Nm][k];
            measured[i].machine[DIG_CHANNEL_MY_Nm][k] *= known ? 1.0 : 0.0;
        }
    }
}

// A wave of the digs that no gravel makes leaves the size it has by itself, whatever the digs'
// scatter does; where it is known to be the machine's it leaves nothing more.
TEST(what_no_gravel_explains_is_left)
{
    static struct dig_measured as_dug[DIGS];
    add_wave(0.0);
    memcpy(as_dug, measured, sizeof as_dug);
    const double plainly = dig_effect_size_left(&batch, &plain);
    add_wave(2.0);
    const double size = size_of_machine(&plain);
    add_to_value(true);
    const double known = dig_effect_size_left(&batch, &plain);
    memcpy(measured, as_dug, sizeof as_dug);
    add_wave(2.0);
    add_to_value(false);
    const double left = dig_effect_size_left(&batch, &plain);
    memcpy(measured, as_dug, sizeof as_dug);
    assert_true(plainly < 1.0);
    assert_close(known, plainly, 1e-6);
    assert_close(left, size, 1.0);
}

// Digs of a plain gravel leave, over their floor, no more on average than that.
TEST(digs_of_a_plain_gravel_leave_nothing)
{
    enum { CAMPAIGNS = 30 };
    static struct dig_measured as_dug[DIGS];
    memcpy(as_dug, measured, sizeof as_dug);
    uint64_t seed   = 77;
    int      beyond = 0;
    for (int c = 0; c < CAMPAIGNS; c++) {
        dig_in_turn(DIGS, &gravel, 0, NULL, NULL, &seed, measured);
        beyond += dig_effect_size_left(&batch, &plain) > 1.0 ? 1 : 0;
    }
    memcpy(measured, as_dug, sizeof as_dug);
    assert_true(beyond <= 2);
}

static double size_of(const double layer, const double cohesion)
{
    struct dig_fitted chosen = plain;
    chosen.hypothesis =
        (struct dig_hypothesis){ .effects = 2,
                                 .effect  = { DIG_EFFECT_COHESION, DIG_EFFECT_LAYERING } };
    chosen.number[DIG_AT_U(0)]        = cohesion;
    chosen.number[DIG_AT_CONTRAST(0)] = 1.0;
    chosen.number[DIG_AT_U(1)]        = layer;
    chosen.number[DIG_AT_CONTRAST(1)] = 1.0;
    return dig_effect_size_of_soil(&batch, &chosen, 1, plain.noise);
}

// The layer of the made world is a bump that no gravel has: it counts in proportion, and by itself.
TEST(an_effect_of_the_soil_counts_by_itself)
{
    const double size = size_of(0.05, 0.0);
    assert_close(size_of(0.0, 0.0), 0.0, 1e-12);
    assert_close(size_of(0.0, 1.0), 0.0, 1e-12);
    assert_true(size > 0.0);
    assert_close(size_of(0.1, 0.0), 2.0 * size, 0.1 * size);
    assert_close(size_of(0.05, 1.0), size, 1e-9);
}

TEST(at_the_floor_the_odds_are_even)
{
    assert_close(dig_effect_size_chance(1.0), 0.5, 1e-12);
    assert_true(dig_effect_size_chance(0.3) < 0.01);
    assert_true(dig_effect_size_chance(1.5) > 0.95);
}

TESTS_WITH(make, world_teardown)
