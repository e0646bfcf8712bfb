// A program with two commands that share some options.

#ifndef DIG_TESTS_CORE_COMMAND_LINE_FIXTURE_H
#define DIG_TESTS_CORE_COMMAND_LINE_FIXTURE_H

#include "core/command_line.h"

struct cup {
    uint64_t    beans;
    double      heat_C;
    bool        milk, json, fast, sour;
    const char *output, *json_file;
    char        grind; // 'a' to 'z'
};

extern const struct dig_program coffee;

#endif // DIG_TESTS_CORE_COMMAND_LINE_FIXTURE_H
