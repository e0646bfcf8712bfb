// Tests for closed_loop/report/trace_report.c, closed_loop/report/trace_page.c and
// closed_loop/report/html.c

#include "closed_loop/report/trace_report.h"

#include "closed_loop/report/html.h"
#include "closed_loop/report/residual_report.h"
#include "files/yaml/yaml_tree.h"
#include "tests/made_table.h"
#include "tests/scratch.h"
#include "tests/written.h"

#define EXAMPLE "tests/data/formats/trace.json"

enum { DIGS = 3 };

struct example {
    struct dig_trace         trace;
    struct dig_trace_curves  curves[DIGS];
    struct dig_measured      measured[DIGS];
    struct dig_residuals     residuals;
    struct dig_curve_set    *set;
    struct dig_trace_subject subject;
};

static void fill_digs(struct example *const e)
{
    static const double shrink[DIGS] = { 1.0, 1.02, 0.97 };
    for (size_t d = 0; d < DIGS; d++) {
        struct dig_measured *const m = &e->measured[d];
        (void)snprintf(m->name, sizeof m->name, "dig <%zu>.csv", d + 1);
        m->order      = d;
        m->trajectory = d == 0 ? MADE_SIMPLE_A : MADE_ACTUAL;
        m->use        = (enum dig_use)d;
        m->pass       = d == 2 ? 2 : 1;
        m->pace       = 1.0;
        m->taken_off  = d == 1 ? (struct dig_approach){ 1.25, 0.1 } : dig_approach_plain();
        m->first      = 0.05;
        m->last       = 0.9;
        m->measured[DIG_CHANNEL_MY_Nm] = true;
        m->measured[DIG_CHANNEL_FZ_N]  = d == 1;
        for (int k = 0; k < DIG_CURVE_POINTS; k++) {
            const struct dig_gravel gravel = { { 0.5, 0.5, 2500.0 } };
            const double            p      = (double)k / (DIG_CURVE_POINTS - 1);
            const double y = made_moment_Nm(&gravel, d == 0 ? MADE_SIMPLE_A : MADE_ACTUAL, p, 0.0);
            m->value[DIG_CHANNEL_MY_Nm][k] = y * (shrink[d] + 0.05 * sin(40.0 * p));
            e->curves[d].before.value[DIG_CHANNEL_MY_Nm][k] = 0.8 * y;
            e->curves[d].after.value[DIG_CHANNEL_MY_Nm][k]  = y;
            e->curves[d].after.sd[DIG_CHANNEL_MY_Nm][k]     = 0.1 * y;
        }
    }
}

static struct dig_residual left(const double rms)
{
    return (struct dig_residual){ rms, rms / 4.0, 5.0 * rms };
}

// Of all but the first, which were not lifted, the moment alone was measured.
static void fill_residuals(struct dig_residuals *const r)
{
    const struct dig_residual none = left((double)NAN);
    for (size_t i = 0; i < DIGS; i++) {
        struct dig_residuals_dig *const dig = &r->dig[i];
        for (int p = 0; p < DIG_TRACE_PHASES; p++) {
            for (size_t c = 0; c < DIG_FORCE_CHANNELS; c++) {
                const bool known  = p != DIG_PART_AIR && (i == 0 || (c == 0 && p == DIG_PART_SOIL));
                dig->before[p][c] = known ? left(0.5 * (double)(c + 1)) : none;
                dig->after[p][c]  = known ? left(0.125 * (double)(c + 1)) : none;
            }
        }
        dig->air_sigmas = i == 0 ? 2.5 : (double)NAN;
    }
    r->known[DIG_CHANNEL_MY_Nm] = true;
    for (int s = 0; s < DIG_REGRESSORS; s++) {
        r->trend[DIG_CHANNEL_MY_Nm][s] = (struct dig_trend){
            .slope       = s == DIG_REGRESSOR_PASS ? (double)NAN : 0.5,
            .correlation = s == DIG_REGRESSOR_PASS ? (double)NAN : 0.375,
            .bins        = 2,
            .bin         = { { 0.25, -0.125, 0.0625, 2 }, { 0.75, 0.125, (double)NAN, 1 } },
        };
    }
}

// On the heap: the curves are large.
static struct example *make(void)
{
    struct example *const e = calloc(1, sizeof *e);
    assert_non_null(e);
    e->trace = (struct dig_trace){
        .significant   = true,
        .p_complete    = 0.0004,
        .false_alarm   = 0.01,
        .noise_floor   = 0.11,
        .residual      = { 2.5, 1.25, (double)NAN },
        .applied       = true,
        .effects       = 2,
        .effect        = { { .effect      = DIG_EFFECT_CYLINDER_FRICTION,
                             .probability = 0.98,
                             .parameters  = 1,
                             .parameter   = { { "coulomb_N", 812.0, 760.0, 861.0 } } },
                           { .effect = DIG_EFFECT_UNLISTED, .probability = 0.75 } },
        .seen_in       = { DIG_PART_AIR, DIG_PART_SOIL },
        .unlisted      = { .any = true, .depends_on = "speed and depth" },
        .candidates    = 2,
        .candidate     = { { .as           = { .effect      = DIG_EFFECT_CYLINDER_FRICTION,
                                               .probability = 0.97,
                                               .parameters  = 1,
                                               .parameter   = { { "coulomb_N", 812.0, 760.0, 861.0 } } },
                             .log_evidence = 31.5,
                             .p_fit        = 0.4,
                             .error        = 0.13,
                             .seen_in      = DIG_PART_AIR },
                           { .as.effect    = DIG_EFFECT_COHESION,
                             .log_evidence = -2.0,
                             .p_fit        = 0.001,
                             .error        = 0.25,
                             .seen_in      = DIG_PART_SOIL } },
        .sets          = 1,
        .set           = { { 2, { DIG_EFFECT_COHESION, DIG_EFFECT_GROUND_SLOPE } } },
        .tells         = 2,
        .tell          = { { { DIG_EFFECT_COHESION, DIG_EFFECT_GROUND_SLOPE },
                             false,
                             "a dig along <simpleB>",
                             1.5,
                             4.0 },
                           { { DIG_EFFECT_PRESSURE_OFFSET, DIG_EFFECT_BUCKET_WEIGHT },
                             true,
                             "",
                             0.0,
                             0.0 } },
        .gravel_before = { { 0.41, 0.5, 2300.0 } },
        .gravel        = { { 0.52, 0.47, 2431.0 } },
        .low           = { { 0.44, 0.31, 2100.0 } },
        .high          = { { 0.63, 0.66, 2800.0 } },
        .before        = { 0.31, 0.27, 0.36 },
        .after         = { 0.14, 0.12, 0.17 },
        .holdouts      = 2,
        .command       = "cat >g.yaml <<'END'\npoints: []\nEND\n",
        .residuals     = &e->residuals,
        .advice        = "dig \"simpleB\" & see <again>",
    };
    const struct made_options options = { .relative_sd = 0.1, .packings = 3 };
    e->set                            = made_table(&options);
    e->trace.judged                   = (struct dig_judged){ e->set, DIGS, e->measured, e->curves };
    e->subject = (struct dig_trace_subject){ .campaign = "pit <7>", .table = "rig.sqlite" };
    fill_digs(e);
    fill_residuals(&e->residuals);
    return e;
}

static void drop(struct example *const e)
{
    made_table_destroy(e->set);
    free(e);
}

static char *json_of(const struct dig_trace *const trace)
{
    char       *text = NULL;
    FILE *const to   = written_begin(&text);
    dig_trace_json(trace, to);
    written_end(to);
    return text;
}

// What stands at a dotted key of a JSON text, which is YAML too.
static void expect(const char *const text, const char *const key, const char *const value)
{
    yaml_document_t  document;
    struct dig_error error = { "" };
    assert_ok(dig_yaml_parse("trace.json", text, strlen(text), &document, &error), error);
    int                      found = 0;
    const yaml_node_t *const node  = dig_yaml_find(&document, key, &found);
    if (node == NULL || node->type != YAML_SCALAR_NODE) {
        fail_msg("%s: not there, expected %s", key, value);
    } else {
        assert_string_equal(dig_yaml_text_of(node), value);
    }
    yaml_document_delete(&document);
}

// To the byte: whatever people script against is in it.
TEST(json_is_the_documented_example)
{
    struct example *const e    = make();
    char *const           text = json_of(&e->trace);
    size_t                size = 0;
    char *const           kept = scratch_read(EXAMPLE, &size);
    assert_string_equal(text, kept);
    free(kept);
    free(text);
    drop(e);
}

TEST(no_effect_is_the_verdict_none_and_no_holdout_is_null)
{
    struct dig_trace trace = { .before = { (double)NAN, (double)NAN, (double)NAN },
                               .after  = { (double)NAN, (double)NAN, (double)NAN } };
    char *const      text  = json_of(&trace);
    assert_contains(text, "\"verdict\": [\"none\"]");
    assert_contains(text, "\"indistinguishable\": []");
    expect(text, "error_after.holdout", "null");
    expect(text, "significant", "false");
    expect(text, "no_air", "false");
    assert_contains(text, "\"residuals\": [],\n \"residual_against\": [],");
    free(text);
    trace.no_air      = true;
    char *const blind = json_of(&trace);
    expect(blind, "no_air", "true");
    free(blind);
}

TEST(control_characters_stay_inside_a_json_string)
{
    struct dig_trace trace = { .advice = "a\nb\\c" };
    char *const      text  = json_of(&trace);
    assert_contains(text, "\"advice\": \"a\\u000ab\\\\c\"");
    free(text);
}

TEST(a_sentence_says_the_verdict)
{
    char                  text[1024];
    struct example *const e = make();
    dig_trace_sentence(&e->trace, sizeof text, text);
    assert_string_equal(text,
                        "Missing: cylinder_friction (probability 0.98, seen in air): friction of "
                        "the cylinders' seals, against the rod's motion; and an effect that has no "
                        "name here, which depends on speed and depth (probability 0.75, seen in "
                        "soil).");
    e->trace.effects = 0;
    dig_trace_sentence(&e->trace, sizeof text, text);
    assert_contains(text, "none of the effects known");
    e->trace.significant = false;
    dig_trace_sentence(&e->trace, sizeof text, text);
    assert_contains(text, "Nothing is missing");
    e->trace.no_air = true;
    dig_trace_sentence(&e->trace, sizeof text, text);
    assert_contains(text, "no free air tells of the machine");
    e->trace.no_air = false;
    dig_trace_sentence(&e->trace, sizeof text, text);
    // Cut, not overrun.
    dig_trace_sentence(&e->trace, 8, text);
    assert_string_equal(text, "Nothing");
    drop(e);
}

TEST(the_terminal_gets_parameters_sets_errors_and_advice)
{
    struct example *const e    = make();
    char                 *text = NULL;
    FILE *const           to   = written_begin(&text);
    dig_trace_text(&e->trace, to);
    e->trace.before.value = (double)NAN;
    e->trace.holdouts     = 1;
    dig_trace_text(&e->trace, to);
    written_end(to);
    assert_contains(text, "coulomb_N 812   90 %: 760 to 861");
    assert_contains(text, "cannot tell apart: cohesion, ground_slope");
    assert_contains(text, "error after  0.140   90 %: 0.120 to 0.170");
    assert_contains(text,
                    "dig <2>.csv: dug at depth 1.25, attack 5.7 deg, as its path tells; taken off");
    assert_null(strstr(text, "dig <1>.csv: dug at"));
    assert_contains(text, "error before unknown: no holdout dig");
    assert_contains(text, "error after  0.140   one dig: no interval");
    assert_null(strstr(text, "not applied"));
    assert_contains(text, "next: dig \"simpleB\"");
    assert_contains(text, "to tell apart: cohesion and ground_slope differ most by a dig along "
                          "<simpleB>: 1.5 scatters of one dig; 4 of them would tell them apart");
    assert_contains(text, "pressure_offset and bucket_weight: nothing that was tried");
    // To be pasted: each line where a shell wants it.
    assert_contains(text, "\n\ncat >g.yaml <<'END'\npoints: []\nEND\n");
    free(text);
    drop(e);
}

static char *page_of(const struct example *const e)
{
    struct dig_error error = { "" };
    char            *page  = NULL;
    FILE *const      to    = written_begin(&page);
    assert_ok(dig_trace_html(&e->trace, &e->subject, to, &error), error);
    written_end(to);
    return page;
}

// What a person knows of a bucket is its friction, not what it lacks; of a layer how hard it
// resists. Whether the prediction was changed or not.
TEST(effects_are_told_by_what_people_know_of_them)
{
    struct example *const e    = make();
    char                 *text = NULL;
    FILE *const           to   = written_begin(&text);
    e->trace.ground            = (struct dig_effect_ground){ .bucket_friction = 0.6,
                                                             .bucket_rolling  = 0.4,
                                                             .layer           = { 4.0, 0.25 } };
    e->trace.effect[0]         = (struct dig_model_effect){
                .effect     = DIG_EFFECT_BUCKET_FRICTION,
                .parameters = 1,
                .parameter  = { { "bucket_smoothness", 0.75, 0.6, 0.9 } },
    };
    dig_trace_text(&e->trace, to);
    e->trace.applied   = false;
    e->trace.effect[0] = (struct dig_model_effect){
        .effect     = DIG_EFFECT_LAYERING,
        .parameters = 2,
        .parameter  = { { "layer_m", -0.04, -0.05, -0.03 }, { "contrast", 0.5, 0.25, 0.9 } },
    };
    dig_trace_text(&e->trace, to);
    dig_trace_json(&e->trace, to);
    written_end(to);
    assert_contains(text, "bucket: friction 0.15, rolling 0.1, where the table's has 0.6, 0.4\n");
    assert_contains(
        text, "layer: its top 0.04 m above the floor (rig scale), resists 0.62 times as hard");
    assert_contains(text, "\"meaning\": \"layer: its top 0.04 m");
    free(text);
    e->trace.judged.digs = 0;
    char *const page     = page_of(e);
    assert_contains(page,
                    "<p>layer: its top 0.04 m above the floor (rig scale), resists 0.62 times");
    free(page);
    drop(e);
}

// A rig is no times the rig.
TEST(the_size_of_what_dug_is_told_where_it_is_another)
{
    static const struct {
        double      lambda;
        const char *said;
    } of[] = { { 10.0, "what dug is 10 times the rig" }, { 1.0, NULL }, { 0.0, NULL } };
    struct example *const e = make();
    e->trace.judged.digs    = 0;
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        e->subject.lambda = of[i].lambda;
        char *const page  = page_of(e);
        if (of[i].said != NULL) {
            assert_contains(page, of[i].said);
        } else {
            assert_null(strstr(page, "times the rig"));
        }
        free(page);
    }
    drop(e);
}

// A change that was not made is told in every form of the report.
TEST(what_is_named_and_not_applied_is_told)
{
    struct example *const e    = make();
    char                 *text = NULL;
    FILE *const           to   = written_begin(&text);
    e->trace.applied           = false;
    e->trace.judged.digs       = 0;
    dig_trace_text(&e->trace, to);
    written_end(to);
    assert_contains(text, "named, not applied: cylinder_friction, unlisted;");
    free(text);
    char *const json = json_of(&e->trace);
    expect(json, "applied", "false");
    free(json);
    e->trace.holdouts = 1;
    char *const page  = page_of(e);
    assert_contains(page, "named, not applied: cylinder_friction, unlisted;");
    assert_contains(page, "On 1 dig that took no part in the fit (one dig: no interval).");
    free(page);
    // Nothing was found: nothing was refused either.
    char sentence[64];
    e->trace.effects = 0;
    dig_trace_not_applied(&e->trace, sizeof sentence, sentence);
    assert_string_equal(sentence, "");
    drop(e);
}

TEST(a_gravel_beyond_the_table_is_not_called_noise)
{
    struct example *const e = make();
    char                  sentence[256];
    e->trace.effects     = 0;
    e->trace.significant = false;
    e->trace.beyond      = true;
    dig_trace_sentence(&e->trace, sizeof sentence, sentence);
    assert_string_equal(sentence, "No effect is missing: the gravel lies beyond the table, and the "
                                  "prediction is made with it.");
    e->trace.applied = false;
    dig_trace_sentence(&e->trace, sizeof sentence, sentence);
    assert_contains(sentence, "stays as it was");
    drop(e);
}

TEST(the_page_stands_alone_and_draws_every_dig)
{
    struct example *const e    = make();
    char *const           page = page_of(e);
    assert_contains(page, "pit &lt;7&gt;");
    assert_contains(page, "Missing: cylinder_friction");
    assert_contains(page, "dig &quot;simpleB&quot; &amp; see &lt;again&gt;");
    assert_contains(page, "<th>cohesion<br>ground_slope</th>");
    assert_contains(page, ">a dig along &lt;simpleB&gt;</td><td>1.50</td><td>4</td>");
    assert_contains(page, "bucket_weight</th>");
    assert_contains(page, ">nothing that was tried</td>");
    assert_contains(page, "cohesion, ground_slope");
    assert_contains(page, "<th>noise floor</th><td><b>0.110</b></td>");
    assert_contains(page, "On 2 digs that took no part in the fit, with 90 % intervals");
    assert_contains(page, "<pre>cat &gt;g.yaml &lt;&lt;&#39;END&#39;\npoints: []\nEND\n</pre>");
    // Each dig's moment, one dig's force, and the residual over path and depth.
    assert_int_equal(count_of(page, "<svg"), DIGS + 1 + 2);
    assert_contains(page, "actual, fit, depth 1.25, attack 5.7 deg taken off, Fz");
    assert_contains(
        page, "<th>dig &lt;1&gt;.csv<br><span class=muted>identify</span></th><td>moment</td><td>"
              "2.5</td>");
    assert_contains(page, "<tr><th>speed</th><td>0.38</td></tr>");
    assert_contains(page, "<tr><th>pass</th><td>–</td></tr>");
    check_page_stands_alone(page);
    free(page);
    drop(e);
}

TEST(no_folder_of_a_file_is_shown)
{
    char        text[128] = "";
    FILE *const to        = fmemopen(text, sizeof text, "w");
    dig_html_without_folders(to, "a / b: /home/x y/run.csv, cp /home/x/g.yaml -o=/tmp/a/ ../t.csv");
    (void)fclose(to);
    assert_string_equal(text, "a / b: x run.csv, cp g.yaml -o=a t.csv");
}

TEST(a_trace_without_holdout_or_findings_has_a_page_too)
{
    struct example *const e = make();
    e->trace.significant    = false;
    e->trace.effects        = 0;
    e->trace.candidates     = 0;
    e->trace.sets           = 0;
    e->trace.tells          = 0;
    e->trace.judged.digs    = 0;
    e->trace.residuals      = NULL;
    e->trace.before.value   = (double)NAN;
    e->trace.advice[0]      = '\0';
    e->trace.command[0]     = '\0';
    char *const page        = page_of(e);
    assert_contains(page, "No dig was held out");
    assert_null(strstr(page, "What to do next"));
    assert_null(strstr(page, "Residual dig by dig"));
    free(page);
    drop(e);
}
