// Tests for core/command_line.c

#include "core/command_line.h"

#include "tests/core/command_line_fixture.h"
#include "tests/testlib.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>

// What the line's options are, in order, with their values; what is wrong with them at the end.
static const char *read_line(const char *const line)
{
    static char text[200], seen[400];
    char       *argv[20] = { NULL };
    int         argc     = 0;
    (void)snprintf(text, sizeof text, "%s", line);
    for (char *word = strtok(text, " "); word != NULL; word = strtok(NULL, " ")) {
        argv[argc++] = word;
    }
    struct dig_error                error   = { "" };
    const struct dig_command *const command = dig_command_find(&coffee, argv[1], &error);
    optind                                  = 0;
    seen[0]                                 = '\0';
    for (int option = 0; command != NULL && option != DIG_OPTION_END && error.text[0] == '\0';) {
        option            = dig_option_next(&coffee, command, argc, argv, &error);
        const size_t used = strlen(seen);
        if (option != DIG_OPTION_END && option != DIG_OPTION_WRONG) {
            (void)snprintf(seen + used, sizeof seen - used, "%d=%s ", option,
                           optarg != NULL ? optarg : "");
        }
    }
    for (int i = optind; i < argc && error.text[0] == '\0'; i++) {
        (void)snprintf(seen + strlen(seen), sizeof seen - strlen(seen), "%s ", argv[i]);
    }
    return strcat(seen, error.text);
}

TEST(options_are_those_of_the_command)
{
    assert_string_equal(read_line("coffee brew cup --beans 3 pot --milk -o x"),
                        "256=3 257= 111=x cup pot ");
    assert_string_equal(read_line("coffee brew --json cup"), "258= cup ");
    assert_string_equal(read_line("coffee roast --json file sack -f"), "259=file 102= sack ");
    assert_string_equal(read_line("coffee roast --be=7"), "256=7 ");
    assert_string_equal(read_line("coffee roast -- --json"), "--json ");
    assert_string_equal(read_line("coffee --help"), "104= expected a command: brew or roast");
    assert_string_equal(read_line("coffee brew -h --version"), "104= 1= ");
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
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        assert_string_equal(read_line(wrong[i][0]), wrong[i][1]);
    }
}

TEST(some_programs_are_called_without_command_too)
{
    struct dig_program both   = coffee;
    char               name[] = "coffee";
    char              *argv[] = { name, NULL };
    struct dig_error   error  = { "" };
    both.alone                = true;
    optind                    = 0;
    assert_int_equal(dig_option_next(&both, &both.self, 1, argv, &error), DIG_OPTION_END);
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
