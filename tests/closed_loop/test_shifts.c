#include "closed_loop/fit/common_error.h"

#include "tests/closed_loop/world_fixture.h"

#include <string.h>

enum { DIGS = 2 };

static struct dig_measured     measured[DIGS];
static struct dig_batch        batch;
static const struct dig_gravel gravel = { { 0.6, 0.55, 2500 } };

// A dig of either trajectory.
static void make_batch(double place[DIG_AXES])
{
    uint64_t seed = 3;
    dig_in_turn(DIGS, &gravel, 0, NULL, NULL, &seed, measured);
    dig_response_surface_place(world.surface, &gravel, place);
    batch_digs(DIGS, measured, &gravel, &batch);
}

static void fill(const struct dig_hypothesis *const hypothesis, const double number[],
                 struct dig_shifts *const shifts)
{
    const struct dig_plain plain = dig_plain_of(soil, batch.group[0].trajectory, number);
    double                 added[DIG_FEATURES];
    (void)dig_forward_added(&batch, 0, &plain, hypothesis, number, added);
    dig_shifts_fill(&batch, 0, hypothesis, number, &plain, added, shifts);
}

// How large a shift is beside a dig, rms over the amplitude.
static double size_of(const double shift[DIG_FEATURES])
{
    const struct dig_group *const group = &batch.group[0];
    double                        sum   = 0.0;
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        sum += pow(shift[f] / group->amplitude[f / DIG_FEATURE_BINS], 2.0) / DIG_FEATURES;
    }
    return sqrt(sum);
}

TEST(a_plain_gravel_is_off_along_its_axes_alone)
{
    const struct dig_hypothesis plain                          = { .effects = 0 };
    double                      number[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    double                      sigma[DIG_HYPOTHESIS_NUMBERS];
    struct dig_shifts           shifts;
    make_batch(number);
    fill(&plain, number, &shifts);
    assert_int_equal(shifts.shifts, DIG_AXES);
    dig_shifts_common(&batch, &plain, number, sigma);
    for (size_t a = 0; a < DIG_AXES; a++) {
        assert_true(size_of(shifts.of[a]) > 0.0);
        assert_true(fabs(sigma[a]) <= 0.0);
    }
}

// Of half the steps between two values, by the square of that.
TEST(a_table_of_fewer_values_is_off_by_more)
{
    const struct dig_hypothesis       plain                          = { .effects = 0 };
    double                            number[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    const struct dig_curve_set *const many                           = world.surface->set;
    struct dig_curve_set              few                            = *many;
    struct dig_shifts                 shifts[2];
    make_batch(number);
    few.axis_count[DIG_AXIS_FRICTION]      = 3;
    few.axis_count[DIG_AXIS_DENSITY_kgpm3] = 2;
    fill(&plain, number, &shifts[0]);
    world.surface->set = &few;
    fill(&plain, number, &shifts[1]);
    world.surface->set = many;
    double more[DIG_AXES];
    for (size_t a = 0; a < DIG_AXES; a++) {
        more[a] = size_of(shifts[1].of[a]) / size_of(shifts[0].of[a]);
    }
    assert_close(more[DIG_AXIS_FRICTION], 2.25, 0.3);
    assert_close(more[DIG_AXIS_ROLLING], 1.0, 1e-12);
    assert_close(more[DIG_AXIS_DENSITY_kgpm3], 1.0, 1e-12);
}

// Squares of what beds differ by as other gravels do, over one dig's scatter.
static double squares_of_beds(const struct dig_scatter *const scatter, const size_t digs)
{
    const struct dig_hypothesis plain                          = { .effects = 0 };
    double                      number[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    struct dig_shifts           shifts;
    double                      y[DIG_FEATURES];
    double                      sum = 0.0;
    make_batch(number);
    batch.scatter       = scatter;
    batch.group[0].digs = digs;
    fill(&plain, number, &shifts);
    for (size_t a = 0; a < DIG_AXES; a++) {
        dig_batch_whiten(&batch.group[0], shifts.as_gravels[a], y);
        for (size_t f = 0; f < DIG_FEATURES; f++) {
            sum += y[f] * y[f];
        }
    }
    return sum;
}

// Of a gravel away from the middle, the first direction is that of the first axis there.
TEST(the_first_direction_of_beds_is_what_friction_changes_there)
{
    static struct dig_scatter   scatter;
    const struct dig_hypothesis plain                          = { .effects = 0 };
    double                      number[DIG_HYPOTHESIS_NUMBERS] = { 0.5, 0.6, -0.4 };
    struct dig_shifts           shifts;
    double                      along = 0.0, beds = 0.0, axis = 0.0;
    make_batch(number);
    scatter                                       = *world.scatter;
    scatter.as_gravels[batch.group[0].trajectory] = 0.8;
    batch.scatter                                 = &scatter;
    fill(&plain, number, &shifts);
    for (size_t f = 0; f < DIG_FEATURES; f++) {
        along += shifts.as_gravels[0][f] * shifts.of[0][f];
        beds += pow(shifts.as_gravels[0][f], 2.0);
        axis += pow(shifts.of[0][f], 2.0);
    }
    assert_close(fabs(along) / sqrt(beds * axis), 1.0, 1e-9);
}

// As much in each of three directions as the scatter says, less the more beds there are; and the
// surface is a mean of beds.
TEST(beds_differ_as_gravels_do)
{
    static struct dig_scatter scatter;
    double                    place[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    make_batch(place);
    const size_t t        = batch.group[0].trajectory;
    scatter               = *world.scatter;
    scatter.as_gravels[t] = 0.8;
    const double surface  = dig_response_surface_noise(world.surface, t, place);
    assert_true(surface > 0.01);
    assert_close(squares_of_beds(&scatter, 1), DIG_AXES * 0.8 * (1.0 + surface), 1e-6);
    assert_close(squares_of_beds(&scatter, 4), DIG_AXES * 0.8 * (1.0 / 4.0 + surface), 1e-6);
    scatter.as_gravels[t] = 0.0;
    assert_close(squares_of_beds(&scatter, 1), 0.0, 0.0);
}

TEST(an_effect_is_off_by_what_it_adds)
{
    const struct dig_hypothesis slope = { .effects = 1, .effect = { DIG_EFFECT_GROUND_SLOPE } };
    double                      number[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    double                      size[2], of_u[2], sigma[2][DIG_HYPOTHESIS_NUMBERS];
    make_batch(number);
    number[DIG_AT_CONTRAST(0)] = 1.0;
    for (int i = 0; i < 2; i++) {
        struct dig_shifts shifts;
        number[DIG_AT_U(0)] = i == 0 ? 0.3 : 0.6;
        fill(&slope, number, &shifts);
        assert_int_equal(shifts.shifts, 2 * DIG_AXES + 1);
        size[i] = size_of(shifts.of[DIG_AXES]);
        of_u[i] = size_of(shifts.of[2 * DIG_AXES]);
        dig_shifts_common(&batch, &slope, number, sigma[i]);
    }
    // Twice as much ground that slopes is as off twice, nearly: by the gravel, and by the angle.
    assert_close(size[1] / size[0], 2.0, 0.6);
    assert_close(of_u[1] / of_u[0], 2.0, 0.6);
    for (size_t a = 0; a < DIG_AXES; a++) {
        assert_close(sigma[1][a] / sigma[0][a], 2.0, 0.6);
    }
    assert_close(sigma[1][DIG_AT_U(0)], 2.0 * sigma[0][DIG_AT_U(0)], 1e-12);
    // An effect of a formula, not of beds, is what it says.
    const struct dig_hypothesis wear = { .effects = 1, .effect = { DIG_EFFECT_WEAR } };
    struct dig_shifts           shifts;
    fill(&wear, number, &shifts);
    assert_int_equal(shifts.shifts, DIG_AXES);
}

TESTS_WITH(world_setup, world_teardown)
