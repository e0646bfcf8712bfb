// Tests for closed_loop/report/machine_check_report.c, machine_check_words.c and
// machine_check_page.c

#include "closed_loop/report/machine_check_report.h"

#include "core/units.h"
#include "files/yaml/yaml_tree.h"
#include "tests/read.h"
#include "tests/written.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { POINTS = 40 };

static struct dig_machine             machine;
static struct dig_machine_air_check   check;
static const struct dig_check_subject subject = { &machine, "/home/somebody/<my>.yaml",
                                                  "/tmp/x/air.csv", &check };

static struct dig_check_item *add(const enum dig_check_question question, const int of,
                                  const enum dig_check_verdict verdict)
{
    check.item[check.items] = (struct dig_check_item){
        .question  = question,
        .of        = of,
        .verdict   = verdict,
        .value     = -0.0698,
        .sigma     = 0.003,
        .tolerance = 0.0087,
        .excess    = 12.3,
        .at_rod    = 3e5,
        .answer    = DIG_JOINT_ARM,
        .or_item   = -1,
    };
    return &check.item[check.items++];
}

// Every question, once as it should be and once wrong.
static int make(void **state)
{
    (void)state;
    machine = read_machine("zx200");
    check   = (struct dig_machine_air_check){ .duration_s = 61.0, .verdict = DIG_CHECK_WRONG };
    for (int q = 0; q < DIG_CHECK_QUESTIONS; q++) {
        add((enum dig_check_question)q, DIG_JOINT_BUCKET, DIG_CHECK_OK);
        add((enum dig_check_question)q, DIG_JOINT_BUCKET, DIG_CHECK_WRONG);
    }
    double *const read    = malloc(7 * POINTS * sizeof(double));
    double *const mended  = malloc(6 * POINTS * sizeof(double));
    double *const curve[] = { read, read + 3 * POINTS, mended, mended + 3 * POINTS };
    check.curves = (struct dig_check_curves){ POINTS,   curve[0], curve[1], read + 6 * POINTS,
                                              curve[2], curve[3] };
    for (int p = 0; p < POINTS; p++) {
        check.curves.time_s[p] = 0.025 * p;
        for (int c = 0; c < 4; c++) {
            for (int j = 0; j < DIG_JOINTS; j++) {
                curve[c][3 * p + j] = p < 5 ? (double)NAN : 1e3 * sin(0.1 * p + c);
            }
        }
    }
    return 0;
}

static int drop(void **state)
{
    (void)state;
    dig_machine_air_check_finish(&check);
    return 0;
}

static char *written(void (*const put)(const struct dig_check_subject *, FILE *))
{
    char       *text = NULL;
    FILE *const to   = written_begin(&text);
    put(&subject, to);
    written_end(to);
    return text;
}

TEST(every_question_is_asked_answered_and_when_wrong_says_what_to_do)
{
    for (size_t i = 0; i < check.items; i++) {
        struct dig_check_words words;
        dig_check_say(&subject, &check.item[i], &words);
        assert_true(strlen(words.question) > 5);
        assert_true(strlen(words.answer) > 2);
        assert_int_equal(check.item[i].verdict == DIG_CHECK_WRONG, words.todo[0] != '\0');
    }
    struct dig_check_item *const offset = add(DIG_CHECK_OFFSET, DIG_JOINT_BOOM, DIG_CHECK_WRONG);
    struct dig_check_words       words;
    offset->value     = 19.7e5;
    offset->sigma     = 0.4e5;
    offset->tolerance = 1.7e5;
    dig_check_say(&subject, offset, &words);
    assert_string_equal(words.question, "boom head reads more by");
    assert_string_equal(words.answer, "+19.70 +-0.40 bar (allowed 1.70)");
    assert_non_null(strstr(words.todo, "of boom_head_Pa -1.97e+06 Pa more"));
    assert_non_null(strstr(words.todo, "of boom_rod_Pa -3e+05"));
    check.items--;
}

TEST(an_offset_is_told_for_either_sign_of_the_map)
{
    struct dig_check_item *const zero = add(DIG_CHECK_ZERO, DIG_JOINT_ARM, DIG_CHECK_WRONG);
    struct dig_check_words       words;
    zero->value = 0.25;
    dig_check_say(&subject, zero, &words);
    assert_string_equal(words.todo, "offset of arm_rad in the signal map: -0.2500 rad more; with "
                                    "sign: -1, +0.2500");
    check.items--;
}

TEST(a_range_says_how_it_was_read)
{
    struct dig_machine_air_check   turned = { .items = 0 };
    const struct dig_check_subject read   = { &machine, "m.yaml", "a.csv", &turned };
    const struct dig_check_item    item   = { .question = DIG_CHECK_MOVES,
                                              .of       = DIG_JOINT_BOOM,
                                              .verdict  = DIG_CHECK_OK };
    struct dig_check_words         words;
    dig_check_say(&read, &item, &words);
    assert_null(strchr(words.answer, '('));
    turned.reading.best.turned[DIG_JOINT_BOOM] = true;
    dig_check_say(&read, &item, &words);
    assert_non_null(strstr(words.answer, "(sign turned)"));
    turned.reading.best.zero_rad[DIG_JOINT_BOOM] = DIG_RAD_PER_DEG * 10.0;
    dig_check_say(&read, &item, &words);
    assert_non_null(strstr(words.answer, "(sign turned, then -10 deg)"));
    turned.reading.best.turned[DIG_JOINT_BOOM] = false;
    dig_check_say(&read, &item, &words);
    assert_non_null(strstr(words.answer, "(-10 deg on what was read)"));
}

TEST(nothing_is_wider_than_80_columns)
{
    char *const text   = written(dig_machine_check_text);
    int         column = 0;
    for (const char *c = text; *c != '\0'; c++) {
        column = *c == '\n' ? 0 : column + 1;
        if (column > 80) {
            fail_msg("too wide: ...%.40s", c - 40);
        }
    }
    assert_non_null(strstr(text, "wrong     bucket angle reads more by   -4.00 +-0.17 deg"));
    free(text);
}

TEST(what_cannot_be_told_apart_is_told_together)
{
    const size_t                 items  = check.items;
    struct dig_check_item *const factor = add(DIG_CHECK_FACTOR, DIG_JOINT_ARM, DIG_CHECK_DOUBTFUL);
    struct dig_check_item *const offset = add(DIG_CHECK_OFFSET, DIG_JOINT_ARM, DIG_CHECK_WRONG);
    factor->or_item                     = (int)(offset - check.item);
    offset->or_item                     = (int)(factor - check.item);
    char sentence[8000];
    dig_check_sentence(&subject, sizeof sentence, sentence);
    assert_non_null(strstr(sentence, "or arm pressures read more by"));
    assert_null(strstr(sentence, "Doubtful"));
    char *const text = written(dig_machine_check_text);
    assert_non_null(strstr(text, "or arm head reads more by: this recording cannot tell"));
    free(text);
    check.items = items;
}

TEST(a_file_without_fault_fits_in_one_sentence)
{
    struct dig_machine_air_check   good = { .items = 0 };
    const struct dig_check_subject fine = { &machine, "m.yaml", "a.csv", &good };
    char                           sentence[300];
    dig_check_sentence(&fine, sizeof sentence, sentence);
    assert_string_equal(sentence, "zx200 fits this recording in free air.");
    char cut[12];
    dig_check_sentence(&fine, sizeof cut, cut);
    assert_int_equal(strlen(cut), sizeof cut - 1);
}

TEST(json_is_read_back_and_holds_every_line)
{
    char *const      text = written(dig_machine_check_json);
    yaml_document_t  document;
    struct dig_error error = { "" };
    assert_ok(dig_yaml_parse("check.json", text, strlen(text), &document, &error), error);
    int                      found = 0;
    const yaml_node_t *const node  = dig_yaml_find(&document, "verdict", &found);
    assert_string_equal(dig_yaml_text_of(node), "wrong");
    yaml_document_delete(&document);
    assert_int_equal(count_of(text, "\"question\": \""), check.items);
    assert_non_null(strstr(text, "\"verdict\": \"wrong\""));
    assert_non_null(strstr(text, "\"found_in\": \"arm\""));
    free(text);
}

TEST(the_page_escapes_texts_names_no_folder_and_has_a_picture_a_joint)
{
    char            *text  = NULL;
    FILE *const      to    = written_begin(&text);
    struct dig_error error = { "" };
    assert_ok(dig_machine_check_html(&subject, to, &error), error);
    written_end(to);
    assert_non_null(strstr(text, "&lt;my&gt;.yaml"));
    assert_null(strstr(text, "somebody"));
    assert_null(strstr(text, "/tmp/x"));
    assert_int_equal(count_of(text, "<figure>"), 2 * DIG_JOINTS);
    assert_non_null(strstr(text, "push of the rod, kN"));
    free(text);
}

TESTS_WITH(make, drop)
