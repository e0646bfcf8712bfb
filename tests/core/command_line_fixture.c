#include "tests/core/command_line_fixture.h"

static const struct dig_command commands[] = {
    { "brew", "CUP... [OPTION]...\nPOT", "Brews coffee.",
      "The water is to be hot, and the cup is to be clean; no words are left out when this line is "
      "broken.\n\nA second paragraph.",
      "coffee brew cup\n" },
    { "roast", "SACK", "Roasts beans.", NULL, "coffee roast sack\n" },
};

static enum dig_status take_grind(const char *const text, void *const into,
                                  struct dig_error *const error)
{
    if (text[0] < 'a' || text[0] > 'z') {
        return dig_error_set(error, DIG_EINVAL, "--grind %s: expected a letter", text);
    }
    ((struct cup *)into)->grind = text[0];
    return DIG_OK;
}

#define INTO(field) DIG_INTO(struct cup, field)

static const struct dig_option options[] = {
    { "beans", "N", NULL, "how many", INTO(beans) },
    { "milk", NULL, " brew ", "with milk", INTO(milk) },
    { "output", "SOME/VERY/LONG/FILE.txt", " brew ", "where to", INTO(output), .letter = 'o',
      .writes = true },
    { "json", NULL, " brew ", "to standard output", INTO(json) },
    { "json", "FILE", " roast ", "to a file", INTO(json_file) },
    { "fast", NULL, " roast ", "hot", INTO(fast), .letter = 'f' },
    { "bitter", NULL, " roast ", "not sour", INTO(sour), .clears = true },
    { "heat", "C", " roast ", "how hot", INTO(heat_C), 150.0, 250.0, "C" },
    { "cups", "N", " roast ", "beans for so many", INTO(beans), 1, 12 },
    { "grind", "A", " roast ", "how fine", .take = take_grind },
};

const struct dig_program coffee = {
    .self        = { "coffee", "COMMAND", "Makes coffee.", NULL, "coffee brew cup\n" },
    .exit_status = "0  done\n",
    .commands    = 2,
    .command     = commands,
    .options     = sizeof options / sizeof options[0],
    .option      = options,
};
