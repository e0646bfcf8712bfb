// What blind campaigns came to, counted: how often rightly named, how often wrongly, and whether
// each of the acceptance criteria holds.

#ifndef DIG_TESTS_BLIND_TALLY_H
#define DIG_TESTS_BLIND_TALLY_H

#include "tests/blind/oracle.h"
#include "tests/blind/verdict.h"

#include <stdio.h>

enum blind_state {
    BLIND_UNMADE, // the campaign could not be made
    BLIND_FAILED, // the trace failed
    BLIND_TRACED
};

/// One campaign and what came of it. Plain data: it travels through a pipe.
struct blind_result {
    struct blind_order   order;
    enum blind_state     state;
    char                 why[160]; // when it was not traced
    char                 source[16];
    struct dig_gravel    gravel;
    double               magnitude; // of a pool effect
    bool                 by_machine;
    size_t               digs;
    struct blind_truth   truth;
    struct blind_verdict verdict;
    double               cpu_s, peak_B;
};

/// How a trace answered.
enum blind_answer {
    BLIND_RIGHT,  // named, and nothing else
    BLIND_IN_SET, // within a reported set that is small enough
    BLIND_EXTRA,  // named, and something wrong beside it
    BLIND_SAID_NONE,
    BLIND_SAID_UNLISTED,
    BLIND_WRONG,
    BLIND_ANSWERS
};

enum blind_answer blind_answer_of(const struct blind_result *result);

/// Size of its smallest effect: the larger of what the soil and what free air shows.
double blind_size_of(const struct blind_result *result);

/// A share with its 95 % interval (Wilson, 1927).
struct blind_share {
    size_t k, n;
    double low, high;
};

struct blind_share blind_share_of(size_t k, size_t n);

/// The tables and criteria for people.
void blind_tally_print(size_t n, const struct blind_result result[], FILE *to);

/// The same, and every campaign, as one JSON object.
void blind_tally_json(size_t n, const struct blind_result result[], const char *split, FILE *to);

#endif // DIG_TESTS_BLIND_TALLY_H
