#include "tests/core/command_line_fixture.h"

static const struct dig_command commands[] = {
    { "brew", "CUP... [OPTION]...\nPOT", "Brews coffee.",
      "The water is to be hot, and the cup is to be clean; no words are left out when this line is "
      "broken.\n\nA second paragraph.",
      "coffee brew cup\n" },
    { "roast", "SACK", "Roasts beans.", NULL, "coffee roast sack\n" },
};

static const struct dig_option options[] = {
    { "beans", BEANS, "N", NULL, "how many" },
    { "milk", MILK, NULL, " brew ", "with milk" },
    { "output", 'o', "SOME/VERY/LONG/FILE", " brew ", "where to" },
    { "json", JSON, NULL, " brew ", "to standard output" },
    { "json", JSON_FILE, "FILE", " roast ", "to a file" },
    { "fast", 'f', NULL, " roast ", "hot" },
};

const struct dig_program coffee = {
    .self        = { "coffee", "COMMAND", "Makes coffee.", NULL, "coffee brew cup\n" },
    .exit_status = "0  done\n",
    .commands    = 2,
    .command     = commands,
    .options     = sizeof options / sizeof options[0],
    .option      = options,
};
