// Tests for tests/blind/: who judges must be right.

#include "tests/blind/front.h"
#include "tests/blind/inject.h"
#include "tests/blind/pool.h"
#include "tests/blind/tally.h"
#include "tests/read.h"

#include <stdlib.h>
#include <string.h>

#define MACHINE "config/machines/zx200_trench.yaml"

TEST(draws_are_even_and_normal_and_repeat)
{
    struct blind_draw a        = blind_draw_init(1, 2);
    struct blind_draw b        = blind_draw_init(1, 2);
    struct blind_draw other    = blind_draw_init(1, 3);
    double            mean     = 0.0;
    double            square   = 0.0;
    double            together = 0.0;
    for (int i = 0; i < 20000; i++) {
        const double x = blind_normal(&a);
        assert_close(x, blind_normal(&b), 0.0);
        mean += x / 20000.0;
        square += x * x / 20000.0;
        together += x * blind_normal(&other) / 20000.0;
    }
    assert_close(mean, 0.0, 0.03);
    assert_close(square, 1.0, 0.04);
    assert_close(together, 0.0, 0.03);
    size_t counts[7] = { 0 };
    for (int i = 0; i < 7000; i++) {
        counts[blind_below(&a, 7)]++;
    }
    for (int i = 0; i < 7; i++) {
        assert_true(counts[i] > 850 && counts[i] < 1150);
    }
}

TEST(pressures_undo_pushes)
{
    const struct dig_machine m = read_machine("zx200_trench");
    for (double push = -80e3; push <= 80e3; push += 7e3) {
        double head = 0.0;
        double rod  = 0.0;
        blind_pressures(&m.cylinder[DIG_JOINT_BOOM], push, &head, &rod);
        assert_close(blind_push_N(&m.cylinder[DIG_JOINT_BOOM], head, rod), push, 1e-6);
        assert_true(fmin(head, rod) >= m.cylinder[DIG_JOINT_BOOM].back_Pa - 1e-6);
    }
}

// The machine at rest in one pose, as a recording of one second.
static struct dig_machine_recording rest(const struct dig_machine *const m,
                                         const double                    angle_rad[DIG_JOINTS])
{
    const size_t                 rows = 200;
    struct dig_machine_recording r    = { rows, calloc(rows, sizeof *r.row) };
    assert_non_null(r.row);
    for (size_t i = 0; i < rows; i++) {
        double *const v  = r.row[i].value;
        r.row[i].time_ns = (int64_t)i * 5000000;
        for (int j = 0; j < DIG_JOINTS; j++) {
            v[DIG_SIGNAL_BOOM_rad + j] = angle_rad[j];
            blind_pressures(&m->cylinder[j], 30e3, &v[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j],
                            &v[DIG_SIGNAL_BOOM_ROD_Pa + 2 * j]);
        }
    }
    return r;
}

// A mass at rest in the bucket: its weight times its horizontal distance, on every joint.
TEST(a_heavy_bucket_needs_the_moment_of_its_weight)
{
    const struct dig_machine     m        = read_machine("zx200_trench");
    const double                 angle[3] = { 0.3, -1.2, -0.5 };
    struct dig_machine_recording r        = rest(&m, angle);
    struct blind_fault           f        = { BLIND_BUCKET_WEIGHT, { 100.0, 0.5, 0.5 } };
    const struct blind_place     place    = { .lambda = 10.0, .contact_s = 5.0, .released_s = 9.0 };
    assert_int_equal(blind_inject(&m, &f, &place, &r), DIG_OK);

    const double phi              = angle[0] + angle[1] + angle[2];
    const double com_x            = 0.55 * 0.9;
    const double com_y            = 0.175 * 0.9;
    const double arm_x            = m.link[0].length_m * cos(angle[0]);
    const double pin_x            = arm_x + m.link[1].length_m * cos(angle[0] + angle[1]);
    const double com              = pin_x + com_x * cos(phi) - com_y * sin(phi);
    const double away[DIG_JOINTS] = { com, com - arm_x, com - pin_x };
    for (int j = 0; j < DIG_JOINTS; j++) {
        const double *const v    = r.row[100].value;
        const double        push = blind_push_N(&m.cylinder[j], v[DIG_SIGNAL_BOOM_HEAD_Pa + 2 * j],
                                                v[DIG_SIGNAL_BOOM_ROD_Pa + 2 * j]);
        const double        moment = (push - 30e3) * blind_lever_m(&m, (enum dig_joint)j, angle);
        assert_close(moment, 100.0 * 9.81 * away[j], 0.5);
    }
    dig_machine_recording_finish(&r);
}

TEST(a_payload_is_not_there_before_the_first_dig)
{
    const struct dig_machine m        = read_machine("zx200_trench");
    const double             angle[3] = { 0.3, -1.2, -0.5 };
    struct blind_fault       f        = { BLIND_PAYLOAD, { 100.0, 0.5, 0.5, 0.5 } };
    for (size_t order = 0; order < 2; order++) {
        struct dig_machine_recording r     = rest(&m, angle);
        const double                 was   = r.row[10].value[DIG_SIGNAL_BUCKET_HEAD_Pa];
        const struct blind_place     place = {
                .order = order, .lambda = 10.0, .contact_s = 0.3, .released_s = 0.6
        };
        assert_int_equal(blind_inject(&m, &f, &place, &r), DIG_OK);
        const double before = fabs(r.row[10].value[DIG_SIGNAL_BUCKET_HEAD_Pa] - was);
        const double after  = fabs(r.row[190].value[DIG_SIGNAL_BUCKET_HEAD_Pa] - was);
        assert_true(order == 0 ? before < 1.0 : before > 1e3);
        assert_true(after > 1e3);
        dig_machine_recording_finish(&r);
    }
}

TEST(intervals_are_those_of_wilson)
{
    // Newcombe 1998, table I: 81 of 263, 15 of 148, 0 of 20, 1 of 29.
    const struct blind_share a = blind_share_of(81, 263);
    assert_close(a.low, 0.2553, 5e-5);
    assert_close(a.high, 0.3662, 5e-5);
    const struct blind_share b = blind_share_of(15, 148);
    assert_close(b.low, 0.0624, 5e-5);
    assert_close(b.high, 0.1605, 5e-5);
    const struct blind_share c = blind_share_of(0, 20);
    assert_close(c.low, 0.0, 1e-9);
    assert_close(c.high, 0.1611, 5e-5);
    const struct blind_share d = blind_share_of(1, 29);
    assert_close(d.low, 0.0061, 5e-5);
    assert_close(d.high, 0.1718, 5e-5);
}

// A campaign with one effect of the soil, answered so.
static struct blind_result answered(const char *const truth, const char *const verdict,
                                    const double probability)
{
    struct blind_result r = { .state = BLIND_TRACED };
    if (truth != NULL) {
        r.order.kind          = BLIND_SINGLE;
        r.order.effects       = 1;
        r.order.effect[0].how = BLIND_BY_GROUND;
        (void)snprintf(r.order.effect[0].name, DIG_NAME_SIZE, "%s", truth);
        r.truth.size[0] = 5.0;
    }
    r.verdict.names = 1;
    (void)snprintf(r.verdict.name[0], DIG_NAME_SIZE, "%s", verdict);
    if (strcmp(verdict, "none") != 0) {
        r.verdict.effects = 1;
        (void)snprintf(r.verdict.effect[0], DIG_NAME_SIZE, "%s", verdict);
        r.verdict.probability[0] = probability;
    }
    return r;
}

static void put_set(struct blind_result *const r, const size_t n, const char *const name[])
{
    r->verdict.sets        = 1;
    r->verdict.set_size[0] = n;
    for (size_t i = 0; i < n; i++) {
        (void)snprintf(r->verdict.set[0][i], DIG_NAME_SIZE, "%s", name[i]);
    }
}

TEST(answers_are_told_apart)
{
    struct blind_result r = answered("wear", "wear", 0.9);
    assert_int_equal(blind_answer_of(&r), BLIND_RIGHT);
    r = answered("wear", "cohesion", 0.9);
    assert_int_equal(blind_answer_of(&r), BLIND_WRONG);
    const char *const three[] = { "cohesion", "wear", "layering", "adhesion" };
    put_set(&r, 3, three);
    assert_int_equal(blind_answer_of(&r), BLIND_IN_SET);
    put_set(&r, 4, three);
    assert_int_equal(blind_answer_of(&r), BLIND_WRONG);
    r.order.effect[0].how = BLIND_BY_MACHINE; // whose sets hold two
    put_set(&r, 3, three);
    assert_int_equal(blind_answer_of(&r), BLIND_WRONG);
    r = answered("wear", "none", 0.0);
    assert_int_equal(blind_answer_of(&r), BLIND_SAID_NONE);
    r = answered("wear", "unlisted", 0.9);
    assert_int_equal(blind_answer_of(&r), BLIND_SAID_UNLISTED);
    r = answered(NULL, "none", 0.0);
    assert_int_equal(blind_answer_of(&r), BLIND_RIGHT);
    r = answered("wear", "wear", 0.9);
    (void)snprintf(r.verdict.name[r.verdict.names++], DIG_NAME_SIZE, "layering");
    assert_int_equal(blind_answer_of(&r), BLIND_EXTRA);
}

TEST(a_verdict_is_read_from_the_documented_json)
{
    struct blind_verdict v;
    struct dig_error     error = { "" };
    assert_ok(blind_verdict_read("tests/data/formats/trace.json", &v, &error), error);
    assert_true(v.significant);
    assert_int_equal(v.names, 2);
    assert_string_equal(v.name[0], "cylinder_friction");
    assert_string_equal(v.effect[1], "unlisted");
    assert_close(v.probability[0], 0.98, 1e-12);
    assert_close(v.low[0], 760.0, 1e-9);
    assert_close(v.high[0], 861.0, 1e-9);
    assert_true(isnan(v.low[1])); // it has no parameter
    assert_close(v.gravel_low.value[DIG_AXIS_DENSITY_kgpm3], 2100.0, 1e-9);
    assert_close(v.gravel_high.value[DIG_AXIS_FRICTION], 0.63, 1e-12);
    assert_int_equal(v.sets, 1);
    assert_int_equal(v.set_size[0], 2);
    assert_string_equal(v.set[0][1], "ground_slope");
    assert_close(v.after, 0.14, 1e-12);
    assert_int_equal(blind_verdict_read("tests/data/formats/identity.json", &v, &error),
                     DIG_EINVAL);
    assert_int_equal(blind_verdict_read("tests/data/formats/none.json", &v, &error), DIG_EIO);
}

static const struct blind_criterion *criterion(const char *const begins)
{
    for (size_t i = 0; i < BLIND_CRITERIA; i++) {
        if (strncmp(blind_criterion[i].title, begins, strlen(begins)) == 0) {
            return &blind_criterion[i];
        }
    }
    fail_msg("no criterion %s", begins);
    return NULL;
}

// Of gravel three numbers count, of an effect that was found its first parameter; of one that was
// not found, neither.
TEST(intervals_are_judged_number_by_number)
{
    struct blind_result r = answered("wear", "wear", 0.9);
    r.order.effect[0].how = BLIND_BY_GROUND;
    r.gravel              = (struct dig_gravel){ { 0.5, 0.5, 2500.0 } };
    r.verdict.gravel_low  = (struct dig_gravel){ { 0.4, 0.6, 2400.0 } };
    r.verdict.gravel_high = (struct dig_gravel){ { 0.6, 0.7, 2600.0 } };
    r.magnitude           = 0.04;
    r.verdict.effects     = 1;
    r.verdict.low[0]      = 0.05;
    r.verdict.high[0]     = 0.06;
    (void)snprintf(r.verdict.effect[0], DIG_NAME_SIZE, "wear");
    (void)snprintf(r.source, sizeof r.source, "ours");
    struct blind_share s = blind_criterion_judge(criterion("beside an effect"), 1, &r);
    assert_int_equal(s.k, 2);
    assert_int_equal(s.n, 3);
    s = blind_criterion_judge(criterion("  of its magnitude, our DEM"), 1, &r);
    assert_int_equal(s.k, 0);
    assert_int_equal(s.n, 1);
    r.verdict.low[0] = 0.03;
    assert_int_equal(blind_criterion_judge(criterion("  of its magnitude, our DEM"), 1, &r).k, 1);
    assert_int_equal(blind_criterion_judge(criterion("plain gravel"), 1, &r).n, 0);
    (void)snprintf(r.verdict.name[0], DIG_NAME_SIZE, "layering");
    (void)snprintf(r.verdict.effect[0], DIG_NAME_SIZE, "layering");
    assert_int_equal(blind_criterion_judge(criterion("beside an effect"), 1, &r).n, 0);
    assert_int_equal(blind_criterion_judge(criterion("  of its magnitude, our DEM"), 1, &r).n, 0);
}

// Large by what shows in free air alone, and so not in the soil.
TEST(a_criterion_is_about_its_kind_and_size_alone)
{
    struct blind_result r = answered("wear", "wear", 0.9);
    r.truth.size[0]       = 0.5;
    assert_int_equal(blind_criterion_judge(criterion("one effect, size below 1"), 1, &r).n, 1);
    r.truth.size_air[0] = 3.0;
    assert_int_equal(blind_criterion_judge(criterion("one effect, size below 1"), 1, &r).n, 0);
    assert_int_equal(blind_criterion_judge(criterion("one effect, size 3"), 1, &r).k, 1);
    assert_int_equal(blind_criterion_judge(criterion("the same by the size"), 1, &r).n, 0);
    assert_int_equal(blind_criterion_judge(criterion("pairs"), 1, &r).n, 0);
}

// It found nothing, and so not what is there, and named nothing wrong.
TEST(a_refusal_is_an_answer_that_is_never_right)
{
    struct blind_result r = answered("wear", "wear", 0.9);
    r.state               = BLIND_REFUSED;
    r.verdict             = (struct blind_verdict){ .names = 0 };
    assert_int_equal(blind_answer_of(&r), BLIND_SAID_NOTHING);
    const struct blind_share found = blind_criterion_judge(criterion("one effect, size 3"), 1, &r);
    assert_int_equal(found.k, 0);
    assert_int_equal(found.n, 1);
    assert_int_equal(
        blind_criterion_judge(criterion("one effect, size 3 and more: error"), 1, &r).n, 0);
    assert_int_equal(blind_criterion_judge(criterion("holdout error"), 1, &r).n, 0);
    assert_int_equal(blind_criterion_judge(criterion("traced in"), 1, &r).n, 0);
    r.order.kind = BLIND_OUTSIDE;
    assert_int_equal(blind_criterion_judge(criterion("outside the catalogue: a"), 1, &r).k, 0);
    assert_int_equal(blind_criterion_judge(criterion("outside the catalogue, size"), 1, &r).k, 0);
    assert_int_equal(blind_criterion_judge(criterion("outside the catalogue, size"), 1, &r).n, 1);
    r.order.kind    = BLIND_NONE;
    r.order.effects = 0;
    assert_int_equal(blind_criterion_judge(criterion("no effect"), 1, &r).k, 1);
    assert_int_equal(blind_criterion_judge(criterion("plain gravel"), 1, &r).n, 0);
    r.state = BLIND_FAILED;
    assert_int_equal(blind_criterion_judge(criterion("no effect"), 1, &r).n, 0);
}

TEST(the_pool_holds_whole_beds_of_known_gravel)
{
    struct blind_pool pool  = { 0, NULL };
    struct blind_pool more  = { 0, NULL };
    struct dig_error  error = { "" };
    assert_ok(blind_pool_read("tests/data", false, &pool, &error), error);
    assert_ok(blind_pool_read("tests/data", true, &more, &error), error);
    assert_true(more.groups > pool.groups);
    blind_pool_finish(&more);
    size_t plain = 0;
    for (size_t g = 0; g < pool.groups; g++) {
        const struct blind_group *const group = &pool.group[g];
        plain += group->effect[0] == '\0' && group->beds >= 3 ? 1 : 0;
        for (size_t b = 0; b < group->beds; b++) {
            assert_true(group->bed[b].dig[BLIND_SIMPLE].rows > 100);
            assert_true(group->bed[b].dig[BLIND_ACTUAL].rows > 100);
            assert_true(b == 0 || group->bed[b].packing > group->bed[b - 1].packing);
        }
    }
    assert_true(plain >= 3);
    // Beds of ours were dug along simpleB, too, those of LIGGGHTS were not.
    size_t ours = 0;
    for (size_t g = 0; g < pool.groups; g++) {
        const struct blind_group *const group     = &pool.group[g];
        const bool                      has_other = blind_group_has(group, BLIND_OTHER_SIMPLE);
        const bool                      is_ours   = strcmp(group->source, "ours") == 0;
        ours += is_ours && has_other ? 1 : 0;
        assert_true(is_ours || !has_other);
    }
    assert_true(ours > 3);
    blind_pool_finish(&pool);
}
