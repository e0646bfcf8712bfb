// Tests for core/command_line.c

#include "core/command_line.h"

#include "tests/core/command_line_fixture.h"
#include "tests/testlib.h"

#include <getopt.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

// What the line makes of the cup, the command, and what is no option; or what is wrong with it.
static const char *read_line(const char *const line)
{
    static char text[200], seen[600];
    char       *argv[20] = { NULL };
    int         argc     = 0;
    (void)snprintf(text, sizeof text, "%s", line);
    for (char *word = strtok(text, " "); word != NULL; word = strtok(NULL, " ")) {
        argv[argc++] = word;
    }
    struct dig_error error = { "" };
    struct cup       cup   = {
                .beans = 1, .heat_C = 200.0, .sour = true, .output = "", .json_file = "", .grind = '-'
    };
    const struct dig_command *const command = dig_options_read(&coffee, argc, argv, &cup, &error);
    if (command == NULL) {
        (void)snprintf(seen, sizeof seen, "%s", error.text);
        return seen;
    }
    (void)snprintf(seen, sizeof seen, "%s: %" PRIu64 " %g %d%d%d%d %c<%s<%s", command->name,
                   cup.beans, cup.heat_C, cup.milk, cup.json, cup.fast, cup.sour, cup.grind,
                   cup.output, cup.json_file);
    for (int i = optind; i < argc; i++) {
        (void)snprintf(seen + strlen(seen), sizeof seen - strlen(seen), " %s", argv[i]);
    }
    return seen;
}

TEST(options_are_those_of_the_command)
{
    assert_string_equal(read_line("coffee brew cup --beans 3 pot --milk -o x"),
                        "brew: 3 200 1001 -<x< cup pot");
    assert_string_equal(read_line("coffee brew --json cup"), "brew: 1 200 0101 -<< cup");
    assert_string_equal(read_line("coffee roast --json file sack -f"),
                        "roast: 1 200 0011 -<<file sack");
    assert_string_equal(read_line("coffee roast --be=7"), "roast: 7 200 0001 -<<");
    assert_string_equal(read_line("coffee roast -- --json"), "roast: 1 200 0001 -<< --json");
    assert_string_equal(read_line("coffee brew - -o -"), "brew: 1 200 0001 -<-< -");
}

TEST(values_go_where_their_rows_say)
{
    assert_string_equal(read_line("coffee roast --heat 2.5e2 --bitter --grind f --cups 12"),
                        "roast: 12 250 0000 f<<");
    assert_string_equal(
        read_line("coffee roast --heat 150 --heat 160 --beans 18446744073709551615"),
        "roast: 18446744073709551615 160 0001 -<<");
}

TEST(what_is_wrong_is_said_with_what_was_meant)
{
    static const char *const wrong[][2] = {
        { "coffee", "expected a command: brew or roast" },
        { "coffee --", "expected a command: brew or roast" },
        { "coffee berw", "berw: unknown command, did you mean \"brew\"?" },
        { "coffee tea", "tea: unknown command, expected brew or roast" },
        { "coffee brew --mlik", "--mlik: unknown option, did you mean \"--milk\"?" },
        { "coffee brew --baens=3", "--baens: unknown option, did you mean \"--beans\"?" },
        { "coffee brew --hepl", "--hepl: unknown option, did you mean \"--help\"?" },
        { "coffee brew --sugar", "--sugar: unknown option" },
        { "coffee brew -x", "-x: unknown option" },
        { "coffee roast --milk", "roast takes no --milk" },
        { "coffee roast -o x", "roast takes no -o" },
        { "coffee brew --beans", "--beans: needs a value" },
        { "coffee brew cup -o", "-o: needs a value" },
        { "coffee brew --milk=3", "--milk=3: takes no value" },
        { "coffee --milk", "coffee takes no --milk" },
        { "coffee brew --beans x", "--beans x: expected a whole number" },
        { "coffee brew --beans -1", "--beans -1: expected a whole number" },
        { "coffee brew --beans 1.5", "--beans 1.5: expected a whole number" },
        { "coffee roast --cups 0", "--cups 0: expected 1 to 12" },
        { "coffee roast --cups 13", "--cups 13: expected 1 to 12" },
        { "coffee roast --heat 149.9", "--heat 149.9: expected 150 to 250 C" },
        { "coffee roast --heat nan", "--heat nan: expected 150 to 250 C" },
        { "coffee roast --grind 7", "--grind 7: expected a letter" },
        { "coffee brew cup x -o x",
          "x: to be written, and named for something else, too; expected another name" },
        { "coffee brew -o x --output x",
          "x: to be written, and named for something else, too; expected another name" },
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_string_equal(read_line(wrong[i][0]), wrong[i][1]);
    }
}

TEST(some_programs_are_called_without_command_too)
{
    struct dig_program both       = coffee;
    struct cup         cup        = { .beans = 1 };
    char               words[][8] = { "coffee", "pot" };
    struct dig_error   error      = { "" };
    both.alone                    = true;
    for (int argc = 1; argc <= 2; argc++) {
        char *argv[] = { words[0], argc == 1 ? NULL : words[1], NULL };
        assert_ptr_equal(dig_options_read(&both, argc, argv, &cup, &error), &both.self);
        assert_int_equal(optind, 1);
    }
    assert_string_equal(error.text, "");
}

TEST(a_number_is_all_of_its_text_and_in_range)
{
    double value = 0.0;
    assert_true(dig_number_read("-1.5e1", -15.0, 0.0, &value));
    assert_close(value, -15.0, 0.0);
    static const char *const bad[] = { "", "x", "3x", "3 4", "nan", "3.1", "inf", "-0.1" };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_false(dig_number_read(bad[i], 0.0, 3.0, &value));
        assert_close(value, -15.0, 0.0);
    }
}

TEST(a_count_is_a_whole_number_in_range)
{
    uint64_t value = 0;
    assert_true(dig_count_read("3", 3, 3, &value));
    assert_int_equal(value, 3);
    static const char *const bad[] = { "", "x", "3x", "3 4", " 3", "+3", "-3", "2", "4", "3.0" };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_false(dig_count_read(bad[i], 3, 3, &value));
        assert_int_equal(value, 3);
    }
}

static void assert_refuses(const char *const word, const char *const expected)
{
    char       *text = NULL;
    size_t      size = 0;
    FILE *const to   = open_memstream(&text, &size);
    assert_non_null(to);
    dig_options_refuse(&coffee, word, "no cup", to);
    assert_int_equal(fclose(to), 0);
    assert_string_equal(text, expected);
    free(text);
}

TEST(who_is_refused_is_told_whose_help_to_read)
{
    assert_refuses("brew", "coffee: no cup\nTry coffee brew --help.\n");
    assert_refuses("brewer", "coffee: no cup\nTry coffee --help.\n");
    assert_refuses("--milk", "coffee: no cup\nTry coffee --help.\n");
    assert_refuses(NULL, "coffee: no cup\nTry coffee --help.\n");
}
