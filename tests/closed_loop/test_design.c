// Tests for closed_loop/design/design*.c

#include "closed_loop/design/design.h"

#include "closed_loop/report/design_report.h"
#include "core/chance.h"
#include "tests/made_table.h"
#include "tests/written.h"

struct bench {
    struct dig_curve_set        *set;
    struct dig_response_surface *surface;
    struct dig_scatter          *scatter;
};

// A made table with its surface and the scatter that its standard deviations tell.
static struct bench make(const double relative_sd, const double family)
{
    const struct made_options options = { .family      = family,
                                          .relative_sd = relative_sd,
                                          .packings    = 5 };
    struct bench              b = { made_table(&options), calloc(1, sizeof *b.surface), NULL };
    assert_non_null(b.surface);
    assert_int_equal(dig_response_surface_fit(b.set, b.surface), DIG_OK);
    assert_int_equal(dig_scatter_pool(b.surface, 0, NULL, &b.scatter), DIG_OK);
    return b;
}

static void drop(struct bench *const b)
{
    dig_scatter_destroy(b->scatter);
    free(b->surface);
    made_table_destroy(b->set);
}

static struct dig_design run(const struct bench *const b, const size_t draws)
{
    struct dig_design design;
    assert_int_equal(dig_design_run(b->surface, b->scatter, draws, 3, &design), DIG_OK);
    return design;
}

// What is the same everywhere says nothing; what is dug twice as exactly says a bit more per axis.
TEST(less_scatter_tells_more)
{
    struct bench            rough = make(0.2, 0.0);
    struct bench            fine  = make(0.05, 0.0);
    const struct dig_design a     = run(&rough, 200);
    const struct dig_design b     = run(&fine, 200);
    for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
        assert_true(b.dig[t].bits > a.dig[t].bits + 0.5);
        assert_true(b.dig[t].error < a.dig[t].error);
        assert_true(b.dig[t].target_error < a.dig[t].target_error);
        assert_true(a.dig[t].bits_partner > a.dig[t].bits);
        for (int axis = 0; axis < DIG_AXES; axis++) {
            assert_true(b.dig[t].sd[axis] < a.dig[t].sd[axis]);
        }
    }
    drop(&rough);
    drop(&fine);
}

// Makes every curve of one trajectory that of the first entry.
static void flatten(const struct bench *const b, const size_t t)
{
    for (size_t e = 1; e < b->set->entries; e++) {
        b->set->curve[e * b->set->trajectories + t] = b->set->curve[t];
    }
    assert_int_equal(dig_response_surface_fit(b->set, b->surface), DIG_OK);
}

TEST(a_dig_that_every_gravel_resists_alike_comes_last)
{
    struct bench b = make(0.1, 0.0);
    flatten(&b, MADE_SIMPLE_A);
    const struct dig_design d = run(&b, 300);
    assert_int_equal(d.ranked, 2);
    assert_int_equal(d.rank[0], MADE_SIMPLE_B);
    assert_int_equal(d.rank[1], MADE_SIMPLE_A);
    assert_int_equal(d.reference, MADE_SIMPLE_A);
    assert_int_equal(d.target, MADE_ACTUAL);
    assert_true(d.dig[MADE_SIMPLE_A].bits < 0.05);
    // Nothing was learnt: what is left is what was there.
    assert_close(d.dig[MADE_SIMPLE_A].error, 1.0, 0.05);
    assert_int_equal(d.dig[MADE_SIMPLE_A].partner, MADE_SIMPLE_B);
    assert_true(d.confirmed);
    assert_true(d.gain_low > 0.0 && d.gain < d.gain_high);
    drop(&b);
}

// Where the same dig stands under two names, neither is better, and the simulation must not say so.
TEST(equal_digs_are_not_confirmed)
{
    struct bench b                   = make(0.15, 0.0);
    b.set->trajectory[MADE_SIMPLE_B] = b.set->trajectory[MADE_SIMPLE_A];
    for (size_t e = 0; e < b.set->entries; e++) {
        struct dig_curve *const curve = &b.set->curve[e * b.set->trajectories];
        curve[MADE_SIMPLE_B]          = curve[MADE_SIMPLE_A];
    }
    assert_int_equal(dig_response_surface_fit(b.set, b.surface), DIG_OK);
    dig_scatter_destroy(b.scatter);
    assert_int_equal(dig_scatter_pool(b.surface, 0, NULL, &b.scatter), DIG_OK);
    const struct dig_design d = run(&b, 300);
    assert_close(d.dig[MADE_SIMPLE_A].bits, d.dig[MADE_SIMPLE_B].bits, 1e-9);
    assert_false(d.confirmed);
    drop(&b);
}

// Friction and rolling friction act as one: whatever is dug, their difference stays unknown.
TEST(what_no_dig_can_tell_stays_unknown)
{
    struct bench            one   = make(0.02, 1.0);
    struct bench            apart = make(0.02, 0.0);
    const struct dig_design a     = run(&one, 200);
    const struct dig_design b     = run(&apart, 200);
    for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
        for (int axis = DIG_AXIS_FRICTION; axis <= DIG_AXIS_ROLLING; axis++) {
            // Of two numbers of which only the sum is known, each keeps 1 / sqrt(2) of its spread.
            assert_true(a.dig[t].sd[axis] > 0.65);
            assert_true(a.dig[t].error_axis[axis] > 0.55);
            assert_true(b.dig[t].sd[axis] < a.dig[t].sd[axis]);
        }
    }
    assert_true(b.dig[MADE_ACTUAL].sd[DIG_AXIS_ROLLING] < 0.5);
    drop(&one);
    drop(&apart);
}

// Where the scatter is small the simulated error is what Fisher's information allows, per axis.
TEST(simulation_and_theory_agree_where_theory_is_exact)
{
    struct bench            b = make(0.12, 0.0);
    const struct dig_design d = run(&b, 600);
    for (size_t t = 0; t < MADE_TRAJECTORIES; t++) {
        for (int axis = 0; axis < DIG_AXES; axis++) {
            const double ratio = d.dig[t].error_axis[axis] / d.dig[t].sd[axis];
            if (!(ratio > 0.6 && ratio < 1.4)) {
                fail_msg("dig %zu axis %d: simulated %.3f, theory %.3f", t, axis,
                         d.dig[t].error_axis[axis], d.dig[t].sd[axis]);
            }
        }
    }
    drop(&b);
}

TEST(a_table_without_a_simple_dig_is_refused)
{
    struct bench b = make(0.1, 0.0);
    for (size_t t = 0; t < b.set->trajectories; t++) {
        b.set->trajectory[t].phases = DIG_DESIGN_SIMPLE_PHASES + 1;
    }
    struct dig_design design = { .digs = 77 };
    assert_int_equal(dig_design_run(b.surface, b.scatter, 400, 1, &design), DIG_EINVAL);
    assert_int_equal(design.digs, 77);
    drop(&b);
}

TEST(the_reports_name_the_recommended_dig)
{
    struct bench b = make(0.1, 0.0);
    flatten(&b, MADE_SIMPLE_A);
    const struct dig_design d    = run(&b, 100);
    char                   *text = NULL;
    FILE *const             to   = written_begin(&text);
    dig_design_text(&d, b.set, to);
    dig_design_json(&d, b.set, to);
    written_end(to);
    assert_contains(text, "recommended: simpleB");
    assert_contains(text, "it identifies better");
    assert_contains(text, "{\"recommended\": \"simpleB\", \"reference\": \"simpleA\", "
                          "\"target\": \"actual\", \"draws\": 100,");
    assert_contains(text, "\"ranking\": [\"simpleB\", \"simpleA\"]");
    assert_contains(text, "\"confirmed\": true");
    free(text);

    const struct dig_design alone = { .ranked = 1, .reference = d.rank[1], .rank = { d.rank[1] } };
    FILE *const             again = written_begin(&text);
    dig_design_text(&alone, b.set, again);
    written_end(again);
    assert_contains(text, "simpleA is the dig that others are compared with: nothing to confirm\n");
    free(text);
    drop(&b);
}
