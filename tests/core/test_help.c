// Tests for core/help.c

#include "core/help.h"

#include "tests/core/command_line_fixture.h"
#include "tests/testlib.h"

#include <stdlib.h>
#include <string.h>

static void assert_help(const struct dig_command *const command, const char *const expected)
{
    char       *text = NULL;
    size_t      size = 0;
    FILE *const to   = open_memstream(&text, &size);
    assert_non_null(to);
    dig_help_print(&coffee, command, to);
    assert_int_equal(fclose(to), 0);
    assert_string_equal(text, expected);
    free(text);
}

TEST(help_of_a_command_is_its_own)
{
    assert_help(&coffee.command[0],
                "Usage: coffee brew CUP... [OPTION]...\n"
                "  or:  coffee brew POT\n"
                "\n"
                "Brews coffee.\n"
                "\n"
                "The water is to be hot, and the cup is to be clean; no words are left out when\n"
                "this line is broken.\n"
                "\n"
                "A second paragraph.\n"
                "\n"
                "Options:\n"
                "      --beans N             how many\n"
                "      --milk                with milk\n"
                "  -o, --output SOME/VERY/LONG/FILE.txt\n"
                "                            where to\n"
                "      --json                to standard output\n"
                "  -h, --help                this text\n"
                "      --version             name and version\n"
                "\n"
                "Examples:\n"
                "  coffee brew cup\n"
                "\n"
                "Exit status:\n"
                "  0  done\n");
}

TEST(help_of_a_program_lists_its_commands)
{
    assert_help(&coffee.self,
                "Usage: coffee COMMAND\n"
                "\n"
                "Makes coffee.\n"
                "\n"
                "Commands:\n"
                "  brew        Brews coffee.\n"
                "  roast       Roasts beans.\n"
                "\n"
                "Options:\n"
                "  -h, --help                this text; behind a command, the command's\n"
                "      --version             name and version\n"
                "\n"
                "Examples:\n"
                "  coffee brew cup\n"
                "\n"
                "Exit status:\n"
                "  0  done\n");
}
