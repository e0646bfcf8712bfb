// A program with two commands that share some options.

#ifndef DIG_TESTS_CORE_COMMAND_LINE_FIXTURE_H
#define DIG_TESTS_CORE_COMMAND_LINE_FIXTURE_H

#include "core/command_line.h"

enum { BEANS = 256, MILK, JSON, JSON_FILE };

extern const struct dig_program coffee;

#endif // DIG_TESTS_CORE_COMMAND_LINE_FIXTURE_H
