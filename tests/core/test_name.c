// Tests for core/name.c

#include "core/name.h"

#include "tests/testlib.h"

#include <string.h>

TEST(names_of_scenes_and_trajectories_pass)
{
    static const char *const good[] = {
        "a", "simpleA", "rig", "tub-of-everything", "zx200_trench", "v1.2", "0.5_x", "_a", "7",
    };
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        assert_true(dig_name_ok(good[i]));
    }
}

// With what may begin one, below, no markup, command, option or path is one.
TEST(every_byte_but_those_told_is_refused_within_a_name_and_a_label)
{
    size_t names = 0, labels = 0;
    for (int c = 1; c < 256; c++) {
        const char text[] = { 'a', (char)c, 'b', '\0' };
        names += dig_name_ok(text) ? 1 : 0;
        labels += dig_label_ok(text) ? 1 : 0;
    }
    assert_int_equal(names, 26 + 26 + 10 + 3);
    assert_int_equal(labels, 26 + 26 + 10 + 3 + 6);
    assert_false(dig_name_ok("") || dig_label_ok("") || dig_label_ok("a "));
}

TEST(labels_for_people_may_have_blanks)
{
    static const char *const good[] = {
        "example 20 t", "0.1.0+6d34da11e608", "2026-11-22T20:34:33Z", "LIGGGHTS 3.8 (MPI)", "a/b",
    };
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        assert_true(dig_label_ok(good[i]));
    }
}

// CSVs hold no other text, and a spreadsheet computes what begins with = + - @ or a tab.
TEST(no_name_and_no_label_is_a_formula)
{
    for (int c = 1; c < 256; c++) {
        const char text[] = { (char)c, '1', '\0' };
        const bool digit  = c >= '0' && c <= '9';
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        assert_int_equal(dig_label_ok(text), letter || digit);
        assert_int_equal(dig_name_ok(text), letter || digit || c == '_');
    }
}

TEST(files_are_named_in_one_printable_line)
{
    assert_true(dig_path_ok("a b/it's (1) $x \xc3\xa9.csv"));
    static const char *const bad[] = { "", "a\nb", "a\tb", "a\x1b", "\xff", "\xc2\x85", "a\r" };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_false(dig_path_ok(bad[i]));
    }
}

TEST(a_relative_path_with_dots_leaves_its_folder)
{
    static const char *const stay[]  = { "a.csv", "a/b.csv", "./a", "a..b", "..a/b", "a/..b/..." };
    static const char *const leave[] = { "..", "../a", "a/../b", "a/..", "./../a", "a//../../b" };
    for (size_t i = 0; i < sizeof stay / sizeof stay[0]; i++) {
        assert_true(dig_path_stays(stay[i]));
        assert_false(dig_path_stays(leave[i]));
    }
    assert_true(dig_path_stays("/srv/a/../b.csv"));
}

TEST(a_path_beside_a_file_begins_with_its_folder)
{
    static const char *const all[][3] = { { "maps/can.yaml", "a.dbc", "maps/a.dbc" },
                                          { "/srv/maps/can.yaml", "up/a.dbc",
                                            "/srv/maps/up/a.dbc" },
                                          { "can.yaml", "a.dbc", "a.dbc" },
                                          { "maps/can.yaml", "/srv/a.dbc", "/srv/a.dbc" } };
    char                     path[32];
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        assert_true(dig_path_beside(all[i][0], all[i][1], sizeof path, path));
        assert_string_equal(path, all[i][2]);
    }
    assert_true(dig_path_beside("maps/can.yaml", "a.dbc", 11, path));
    assert_false(dig_path_beside("maps/can.yaml", "a.dbc", 10, path));
    assert_string_equal(dig_path_last("maps/can.yaml"), "can.yaml");
    assert_string_equal(dig_path_last("can.yaml"), "can.yaml");
    assert_string_equal(dig_path_last("maps/"), "");
}
