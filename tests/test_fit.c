// Tests for firmware_host/fit.c: which digs identify, and what becomes of those that cannot.

#include "firmware_host/fit.h"

#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

#define GRAVELS      8
#define TRAJECTORIES 2

// Gravels at the corners of a cube, whose curves differ by a factor; only simpleA has curves.
struct bench {
    struct dig_config      config;
    struct dig_curve_set   set;
    struct dig_gravel      gravel[GRAVELS];
    double                 axis[DIG_AXES][2];
    int                    cell[GRAVELS], packings[GRAVELS * TRAJECTORIES];
    struct dig_curve       curve[GRAVELS * TRAJECTORIES];
    struct dig_ring        digs, results;
    struct dig_latest      match, notes;
    struct dig_observation dig_memory[4];
    struct dig_fit_result  result_memory[4];
    struct dig_match       match_memory[3];
    struct dig_note        note_memory[3];
    atomic_bool            stop;
    struct dig_fit         fit;
};

static double moment_Nm(const int gravel, const int point)
{
    const double p = point / (double)(DIG_CURVE_POINTS - 1);
    return p * (1.0 - p) * (1.0 + (gravel / 4) + 0.5 * (gravel / 2 % 2) * p + 0.25 * (gravel % 2));
}

static struct bench *bench_create(void)
{
    struct bench *const b = calloc(1, sizeof *b);
    assert_non_null(b);
    struct dig_curve_set *const set = &b->set;
    set->tooth_m                    = 0.09;
    set->bucket_width_m             = 0.07;
    set->smooth_half_s              = DIG_SMOOTH_HALF_s;
    set->trajectories               = TRAJECTORIES;
    (void)strcpy(set->trajectory[0].name, "simpleA");
    (void)strcpy(set->trajectory[1].name, "actual");
    for (int t = 0; t < TRAJECTORIES; t++) {
        set->trajectory[t].phases   = 1;
        set->trajectory[t].phase[0] = (struct dig_phase){ .duration_s = 2.0, .vx_mps = 0.05 };
    }
    set->entries  = GRAVELS;
    set->gravel   = b->gravel;
    set->packings = b->packings;
    set->curve    = b->curve;
    set->cell     = b->cell;
    for (int axis = 0; axis < DIG_AXES; axis++) {
        b->axis[axis][0]      = axis == DIG_AXIS_DENSITY_kgpm3 ? 1500.0 : 0.3;
        b->axis[axis][1]      = axis == DIG_AXIS_DENSITY_kgpm3 ? 2500.0 : 0.9;
        set->axis_count[axis] = 2;
        set->axis[axis]       = b->axis[axis];
    }
    for (int g = 0; g < GRAVELS; g++) {
        b->cell[g] = g;
        b->gravel[g] =
            (struct dig_gravel){ { b->axis[0][g / 4], b->axis[1][g / 2 % 2], b->axis[2][g % 2] } };
        b->packings[g * TRAJECTORIES] = 3;
        for (int p = 0; p < DIG_CURVE_POINTS; p++) {
            b->curve[g * TRAJECTORIES].mean[DIG_CHANNEL_MY_Nm][p] = (float)moment_Nm(g, p);
            b->curve[g * TRAJECTORIES].sd[DIG_CHANNEL_MY_Nm][p]   = 0.01F;
        }
    }
    b->config.estimator         = dig_estimator_settings_default();
    b->config.match_evaluations = 300;
    dig_ring_init(&b->digs, sizeof b->dig_memory[0], 4, b->dig_memory);
    dig_ring_init(&b->results, sizeof b->result_memory[0], 4, b->result_memory);
    dig_latest_init(&b->match, sizeof b->match_memory[0], b->match_memory);
    dig_latest_init(&b->notes, sizeof b->note_memory[0], b->note_memory);
    b->fit = (struct dig_fit){ .config  = &b->config,
                               .set     = set,
                               .digs    = &b->digs,
                               .match   = &b->match,
                               .results = &b->results,
                               .notes   = &b->notes,
                               .stop    = &b->stop };
    return b;
}

static void dig_in(struct bench *const b, const int gravel, const int trajectory)
{
    struct dig_observation dig = {
        .dig_count = 5, .trajectory = trajectory, .first = 0.0, .last = 1.0
    };
    for (int p = 0; p < DIG_CURVE_POINTS; p++) {
        dig.moment_Nm[p] = moment_Nm(gravel, p);
        dig.sigma_Nm[p]  = 0.005;
    }
    assert_true(dig_ring_push(&b->digs, &dig));
}

static void a_simple_dig_identifies_the_gravel_it_was_made_of(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    for (int gravel = 0; gravel < GRAVELS; gravel++) {
        struct dig_match      match;
        struct dig_fit_result result;
        dig_in(b, gravel, 0);
        assert_true(dig_fit_once(&b->fit));
        assert_true(dig_latest_take(&b->match, &match));
        assert_true(match.valid);
        assert_int_equal(match.nearest, gravel);
        assert_int_equal(match.dig_count, 5);
        assert_true(dig_ring_pop(&b->results, &result));
        assert_int_equal(result.match.nearest, gravel);
        assert_int_equal(result.trajectory, 0);
    }
    assert_int_equal(atomic_load(&b->fit.matches), GRAVELS);
    assert_false(dig_fit_once(&b->fit));
    free(b);
}

static void a_dig_that_does_not_identify_is_passed_over(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    struct dig_match    match;
    struct dig_note     note;
    dig_in(b, 0, 1);
    assert_true(dig_fit_once(&b->fit));
    assert_false(dig_latest_take(&b->match, &match));
    assert_false(dig_latest_take(&b->notes, &note));
    assert_int_equal(atomic_load(&b->fit.seen), 1);
    assert_int_equal(atomic_load(&b->fit.matches), 0);
    free(b);
}

static void a_dig_the_table_has_no_curve_for_is_said_and_matches_nothing(void **state)
{
    (void)state;
    struct bench *const b = bench_create();
    struct dig_match    match;
    struct dig_note     note;
    (void)strcpy(b->config.identify_trajectory[0], "actual");
    b->config.identify_trajectories = 1;
    dig_in(b, 0, 1);
    assert_true(dig_fit_once(&b->fit));
    assert_false(dig_latest_take(&b->match, &match));
    assert_true(dig_latest_take(&b->notes, &note));
    assert_non_null(strstr(note.text, "dig 5 (actual): no match"));
    free(b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_simple_dig_identifies_the_gravel_it_was_made_of),
        cmocka_unit_test(a_dig_that_does_not_identify_is_passed_over),
        cmocka_unit_test(a_dig_the_table_has_no_curve_for_is_said_and_matches_nothing),
    };
    return cmocka_run_group_tests_name("fit", tests, NULL, NULL);
}
