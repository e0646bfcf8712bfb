// What blind campaigns came to, counted: how often rightly named, how often wrongly, and whether
// each of the acceptance criteria holds.

#ifndef DIG_TESTS_BLIND_TALLY_H
#define DIG_TESTS_BLIND_TALLY_H

#include "tests/blind/criteria.h"

#include <stdio.h>

/// The tables and criteria for people.
void blind_tally_print(size_t n, const struct blind_result result[], FILE *to);

/// The same, and every campaign, as one JSON object.
void blind_tally_json(size_t n, const struct blind_result result[], const char *split, FILE *to);

#endif // DIG_TESTS_BLIND_TALLY_H
