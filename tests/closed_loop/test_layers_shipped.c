// Layers of materials that no table has, dug by our DEM (tests/data/blind/layering-*.sqlite, to
// develop with) and traced with the tables that ship: where the layer begins, and how hard it
// resists.

#include "closed_loop/verdict/trace.h"
#include "tests/closed_loop/shipped_fixture.h"

#include <math.h>

// From tests/blind/pool/make.sh: what lies in the gravel, and how high.
struct layer {
    const char       *file;
    double            top_m;
    struct dig_gravel material;
    bool              is_named; // a thin difference in so few digs is none
};

static const struct dig_gravel gravel = { { 0.4, 0.6, 2000 } };

static const struct layer layers[] = {
    { "tests/data/blind/layering-coarse=0.053.sqlite", 0.053, { { 0.8, 0.5, 3200 } }, true },
    { "tests/data/blind/layering-gritty=0.045.sqlite", 0.045, { { 0.6, 0.7, 2800 } }, false },
    { "tests/data/blind/layering-sandy=-0.057.sqlite", -0.057, { { 0.35, 0.35, 1600 } }, false },
};

// The mean of a layer's two beds along each trajectory, taken for one dig.
static size_t take_digs(const struct layer *const layer, struct dig_measured dig[])
{
    struct dig_curve_set *dug = NULL;
    struct dig_error      error;
    assert_ok(dig_table_load(layer->file, &dug, &error), error);
    for (size_t t = 0; t < dug->trajectories; t++) {
        dig[t] = shipped_dig(&dug->curve[t], t);
    }
    const size_t digs = dug->trajectories;
    dig_curve_set_destroy(dug);
    return digs;
}

// How hard one gravel resists over another, along the trajectories' geometric mean.
static double ratio_of(const struct dig_gravel *const above, const struct dig_gravel *const below)
{
    double sum = 0.0;
    for (size_t t = 0; t < set->trajectories; t++) {
        double feature[DIG_FEATURES];
        double size[2][DIG_FORCE_CHANNELS];
        for (int i = 0; i < 2; i++) {
            double place[DIG_AXES];
            dig_response_surface_place(surface, i == 0 ? above : below, place);
            dig_response_surface_features(surface, t, place, feature, size[i]);
        }
        sum += log(size[0][DIG_CHANNEL_MY_Nm] / size[1][DIG_CHANNEL_MY_Nm]);
    }
    return exp(sum / (double)set->trajectories);
}

TEST(a_layer_is_told_by_its_top_and_its_resistance)
{
    for (size_t i = 0; i < sizeof layers / sizeof layers[0]; i++) {
        const struct layer *const layer = &layers[i];
        struct dig_measured       dig[DIG_TRAJECTORY_MAX];
        const size_t              digs = take_digs(layer, dig);
        struct dig_trace_settings by   = dig_trace_settings_default();
        struct dig_trace          trace;
        assert_int_equal(dig_trace_run(set, RIG, effects, &by, NULL, digs, dig, &trace, NULL),
                         DIG_OK);
        const double truth = ratio_of(&layer->material, &gravel);
        const bool   named = trace.effects == 1 && trace.effect[0].effect == DIG_EFFECT_LAYERING;
        // No other name.
        assert_true(named || trace.effects == 0 ||
                    (trace.effects == 1 && trace.effect[0].effect == DIG_EFFECT_UNLISTED));
        assert_int_equal(named, layer->is_named);
        if (named) {
            const struct dig_model_parameter *const top      = &trace.effect[0].parameter[0];
            const struct dig_model_parameter *const contrast = &trace.effect[0].parameter[1];
            const double table = trace.ground.layer[top->value < 0.0 ? 1 : 0];
            const double ratio = 1.0 + contrast->value * (table - 1.0);
            print_message("%s: top %.4f m (%.4f to %.4f), contrast %.2f (%.2f to %.2f), resists "
                          "%.2f times as hard for %.2f; gravel %.3f/%.3f/%.0f\n",
                          layer->file, top->value, top->low, top->high, contrast->value,
                          contrast->low, contrast->high, ratio, truth, trace.gravel.value[0],
                          trace.gravel.value[1], trace.gravel.value[2]);
            assert_close(ratio, truth, 0.2 * truth);
            assert_close(top->value, layer->top_m, 0.012); // a grain is 7.5 mm
            assert_true(contrast->high < 1.5);
        } else {
            print_message("%s: %s, of a layer that resists %.2f times as hard\n", layer->file,
                          trace.effects == 0 ? "none" : "unlisted", truth);
        }
        dig_trace_finish(&trace);
    }
}

TESTS_WITH(shipped_rig_effects_setup, shipped_teardown)
