// Tests for closed_loop/verdict/machine_choice.c and machine_steps.c: digs of the reference's
// gravel on the shipped table, by a machine that is not as its file says.

#include "closed_loop/verdict/trace.h"
#include "tables/load.h"
#include "tests/closed_loop/machine_campaign.h"

static const char *const table = "tables/reference_rig.sqlite";

// By a machine that is as its file says.
static struct dig_trace oracle;

static struct dig_trace traced(const struct fault *const fault)
{
    struct dig_trace_settings settings = dig_trace_settings_default();
    struct dig_error          error    = { "" };
    struct dig_trace          result;
    settings.bootstraps      = test_is_quick() ? 40 : settings.bootstraps;
    struct campaign *const c = trace(fault, 3);
    assert_ok(
        dig_trace_run(set, table, NULL, &settings, c->side, DIGS, c->measured, &result, &error),
        error);
    end(c);
    return result;
}

static int build_on_table(void **state)
{
    const struct fault none  = { .gain = 0.0 };
    struct dig_error   error = { "" };
    if (build(state) != 0) {
        return -1;
    }
    made_table_destroy(set);
    assert_ok(dig_table_load(table, &set, &error), error);
    oracle = traced(&none);
    return 0;
}

static int end_oracle(void **state)
{
    dig_trace_finish(&oracle);
    dig_curve_set_destroy(set);
    set = NULL;
    return tear_down(state);
}

static const struct dig_model_parameter *parameter(const struct dig_model_effect *const effect,
                                                   const char *const                    name)
{
    for (size_t p = 0; p < effect->parameters; p++) {
        if (strcmp(effect->parameter[p].name, name) == 0) {
            return &effect->parameter[p];
        }
    }
    fail_msg("no parameter %s", name);
    return NULL;
}

// The gain reads little in free air, where the drive pushes little, and much in every dig.
TEST(a_gain_that_free_air_leaves_open_is_told_by_the_digs)
{
    const struct fault fault  = { .gain = 0.08 };
    struct dig_trace   result = traced(&fault);
    assert_int_equal(result.effects, 1);
    assert_int_equal(result.effect[0].effect, DIG_EFFECT_PRESSURE_OFFSET);
    const struct dig_model_parameter *const gain = parameter(&result.effect[0], "bucket_head_gain");
    print_message("a gain of .08: %.3f (%.3f to %.3f), error %.3f to %.3f\n", gain->value,
                  gain->low, gain->high, result.before.value, result.after.value);
    assert_true(gain->low <= 0.08 && 0.08 <= gain->high && gain->low > 0.0);
    // As near as where the sensor reads what is there.
    assert_true(result.applied && result.after.value < 0.9 * result.before.value);
    assert_true(result.after.value < 1.15 * oracle.after.value);
    dig_trace_finish(&result);
}

// In free air it is a boom and an arm that are heavier, within their tolerance; in digs it is not.
TEST(what_free_air_leaves_open_of_an_effect_without_a_name_is_open_in_the_gravel)
{
    const struct fault fault  = { .boom_gain = 0.06 };
    struct dig_trace   result = traced(&fault);
    assert_int_equal(result.effects, 0);
    for (size_t a = 0; a < DIG_AXES; a++) {
        const double low = result.low.value[a], high = result.high.value[a];
        print_message("%.4g (%.4g to %.4g), without it %.4g (%.4g to %.4g)\n",
                      result.gravel.value[a], low, high, oracle.gravel.value[a],
                      oracle.low.value[a], oracle.high.value[a]);
        assert_true(low <= oracle.gravel.value[a] && oracle.gravel.value[a] <= high);
    }
    dig_trace_finish(&result);
}

// It has no name, but the digs are told with its pitch.
TEST(a_machine_that_leans_says_so_and_leaves_the_gravel)
{
    const struct fault leans  = { .pitched_rad = 3.0 * DIG_RAD_PER_DEG };
    struct dig_trace   result = traced(&leans);
    print_message("%s; error %.3f to %.3f, of a level one %.3f\n", result.advice,
                  result.before.value, result.after.value, oracle.after.value);
    assert_int_equal(result.effects, 1);
    assert_int_equal(result.effect[0].effect, DIG_EFFECT_UNLISTED);
    assert_string_equal(result.unlisted.depends_on, "the machine's pitch");
    assert_non_null(strstr(result.advice, "pitched by"));
    assert_true(result.significant && result.after.value < 1.15 * oracle.after.value);
    for (size_t a = 0; a < DIG_AXES; a++) {
        assert_true(result.low.value[a] <= oracle.gravel.value[a] &&
                    oracle.gravel.value[a] <= result.high.value[a]);
    }
    dig_trace_finish(&result);
}

TEST(a_machine_as_its_file_says_is_left_alone)
{
    assert_int_equal(oracle.effects, 0);
    assert_false(oracle.significant);
}

TESTS_WITH(build_on_table, end_oracle)
