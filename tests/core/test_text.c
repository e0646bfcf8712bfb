// Tests for core/text.c and core/error.c: what a terminal may be shown.

#include "core/error.h"
#include "core/text.h"

#include "tests/testlib.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

TEST(a_list_has_commas_between_its_words_and_ends_where_there_is_no_room)
{
    char list[12] = "";
    dig_text_list(sizeof list, list, "boom");
    assert_string_equal(list, "boom");
    dig_text_list(sizeof list, list, "arm");
    assert_string_equal(list, "boom, arm");
    dig_text_list(sizeof list, list, "bucket");
    assert_string_equal(list, "boom, arm, ");
    dig_text_list(sizeof list, list, "swing");
    assert_string_equal(list, "boom, arm, ");
}

TEST(a_copy_is_cut_and_clean)
{
    char to[8] = "";
    dig_text_copy(sizeof to, to, "ab\x1b[31mcd");
    assert_string_equal(to, "ab?[31m");
}

TEST(characters_are_told_from_bytes_that_are_none)
{
    static const struct {
        const char *text;
        size_t      bytes;
    } all[] = {
        { "a", 1 },
        { "\n", 1 },
        { "\t", 1 },
        { "\xc3\xa9", 2 },         // é
        { "\xe2\x82\xac", 3 },     // €
        { "\xf0\x9f\x98\x80", 4 }, // an emoji
        { "\x1b[31m", 0 },         // ESC
        { "\r", 0 },
        { "\x07", 0 },
        { "\x7f", 0 },
        { "\xc2\x9b", 0 }, // CSI as one character
        { "\xff", 0 },
        { "\xc0\xaf", 0 },         // '/' in two bytes
        { "\xe0\x80\xaf", 0 },     // and in three
        { "\xed\xa0\x80", 0 },     // half a surrogate pair
        { "\xf4\x90\x80\x80", 0 }, // beyond U+10FFFF
        { "\xe2\x80\xae", 0 },     // what follows would be shown from right to left
        { "\xe2\x81\xa6", 0 },
        { "\xef\xbf\xbe", 0 }, // U+FFFE
        { "\xef\xbf\xbd", 3 },
        { "\xe2\x82", 0 }, // cut off
    };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        assert_int_equal(dig_text_character(all[i].text), all[i].bytes);
    }
}

TEST(cleaned_text_keeps_its_length_and_its_characters)
{
    char text[] = "a\x1b[2J\xc3\xa9\xff\n\xc2\x9b z\xe2\x82";
    dig_text_clean(text);
    assert_string_equal(text, "a?[2J\xc3\xa9?\n?? z??");
}

TEST(an_error_is_one_line)
{
    struct dig_error error = { "" };
    (void)dig_error_set(&error, DIG_EINVAL, "trigger \"%s\" is none", "\nrm x\n\treturn #");
    assert_string_equal(error.text, "trigger \"?rm x??return #\" is none");
}

TEST(what_failed_is_named_before_why_and_nothing_else_is)
{
    struct dig_error error = { "row 3" };
    assert_int_equal(dig_error_name(&error, DIG_OK, "%s", "a.csv"), DIG_OK);
    assert_string_equal(error.text, "row 3");
    assert_int_equal(dig_error_name(&error, DIG_EIO, "%s:%d", "a.csv", 7), DIG_EIO);
    assert_string_equal(error.text, "a.csv:7: row 3");
    assert_int_equal(dig_error_name(NULL, DIG_ENOMEM, "%s", "a.csv"), DIG_ENOMEM);
}

TEST(an_error_holds_no_escape_sequence_and_no_half_character)
{
    struct dig_error error = { "" };
    assert_int_equal(
        dig_error_set(&error, DIG_EINVAL, "\"%s\", expected a name", "\x1b]0;owned\x07\x9b"),
        DIG_EINVAL);
    assert_string_equal(error.text, "\"?]0;owned??\", expected a name");

    char wide[2 * sizeof error.text];
    memset(wide, 'x', sizeof wide);
    wide[sizeof wide - 1] = '\0';
    memcpy(wide + sizeof error.text - 2, "\xc3\xa9", 2); // falls over the end
    (void)dig_error_set(&error, DIG_EIO, "%s", wide);
    assert_int_equal(error.text[sizeof error.text - 2], '?');
}

static void assert_json(const char *const text, const char *const expected)
{
    char  said[256] = "";
    FILE *to        = fmemopen(said, sizeof said, "w");
    assert_non_null(to);
    dig_text_put_json(to, text);
    assert_int_equal(fclose(to), 0);
    assert_string_equal(said, expected);
}

TEST(json_strings_end_where_they_should_and_are_utf8)
{
    assert_json("plain \xc3\xa9", "\"plain \xc3\xa9\"");
    assert_json("a\"b\\c\nd\t", "\"a\\\"b\\\\c\\u000ad\\u0009\"");
    assert_json("\x1b\x7f\xc2\x9b", "\"\\u001b\\u007f\\u009b\"");
    assert_json("\xff\xc3", "\"\xef\xbf\xbd\xef\xbf\xbd\"");
}

TEST(a_text_put_is_one_line_of_characters)
{
    char  said[64] = "";
    FILE *to       = fmemopen(said, sizeof said, "w");
    assert_non_null(to);
    dig_text_put(to, "a\nb\tc\x1b[0m\xff \xe2\x82\xac");
    assert_int_equal(fclose(to), 0);
    assert_string_equal(said, "a?b?c?[0m? \xe2\x82\xac");
}

TEST(what_is_printed_for_people_holds_no_escape_sequence)
{
    char       *bytes = NULL;
    size_t      size  = 0;
    FILE *const to    = open_memstream(&bytes, &size);
    assert_non_null(to);
    dig_text_print(to, "%s: %d\n", "a\x1b]0;owned\x07.csv", 3);
    static char wide[20000];
    memset(wide, 'x', sizeof wide - 1);
    dig_text_print(to, "%s", wide);
    assert_int_equal(fclose(to), 0);
    assert_int_equal(strncmp(bytes, "a?]0;owned?.csv: 3\nxxx", 22), 0);
    assert_in_range(strlen(bytes), 8000, 8300);
    free(bytes);
}

TEST(a_time_is_told_in_utc)
{
    char text[21] = "?";
    dig_text_utc(951782399, sizeof text, text); // date -u -d @951782399 of coreutils
    assert_string_equal(text, "2000-02-28T23:59:59Z");
    dig_text_utc(951782400, sizeof text, text);
    assert_string_equal(text, "2000-02-29T00:00:00Z");
    dig_text_utc(-1, sizeof text, text);
    assert_string_equal(text, "1969-12-31T23:59:59Z");
    dig_text_utc(INT64_MAX, sizeof text, text);
    assert_string_equal(text, "");
}

TEST(the_first_condition_that_does_not_hold_is_told)
{
    struct dig_error      error = { .text = "" };
    struct dig_conditions c     = { .error = &error };
    dig_require(&c, true, "boom");
    assert_int_equal(c.status, DIG_OK);
    assert_string_equal(error.text, "");
    dig_require(&c, false, "%s: %d\n", "arm", 2);
    dig_require(&c, false, "bucket");
    dig_require(&c, true, "swing");
    assert_int_equal(c.status, DIG_EINVAL);
    assert_string_equal(error.text, "arm: 2?");
}
