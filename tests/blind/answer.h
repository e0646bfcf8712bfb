// What came of a blind campaign: how large its effects are, and whether the trace answered rightly.

#ifndef DIG_TESTS_BLIND_ANSWER_H
#define DIG_TESTS_BLIND_ANSWER_H

#include "tests/blind/oracle.h"
#include "tests/blind/verdict.h"

#define BLIND_CLASSES 4 // of size: below 1, 1 to 2.25, 2.25 to 3, 3 and more

enum blind_state {
    BLIND_UNMADE,  // the campaign could not be made
    BLIND_FAILED,  // the trace failed
    BLIND_REFUSED, // it refused a recording: an answer, and never the right one
    BLIND_TRACED
};

/// One campaign and what came of it. Plain data: it travels through a pipe.
struct blind_result {
    struct blind_order   order;
    enum blind_state     state;
    char                 why[160]; // when it was not traced
    char                 source[16];
    struct dig_gravel    gravel;
    double               magnitude;                // of a pool effect
    bool                 by_machine, other_simple; // some simple digs along the other path
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
    BLIND_SAID_NOTHING, // it refused
    BLIND_ANSWERS
};

enum blind_answer blind_answer_of(const struct blind_result *result);

/// Size of its smallest effect: the larger of what the soil and what free air shows.
double blind_size_of(const struct blind_result *result);

/// The same by what the soil shows alone: what the best refit of the gravel leaves of it.
double blind_size_in_soil(const struct blind_result *result);

/// The class of a size, and of a campaign by blind_size_of().
int blind_class_of_size(double size);
int blind_class_of(const struct blind_result *result);

/// True when the verdict says so.
bool blind_says(const struct blind_result *r, const char *name);

/// True when this effect is in the verdict, or in a set that is small enough beside one that is.
bool blind_found(const struct blind_result *r, const struct blind_choice *truth);

/// True when a name is that of an effect which is there, or in such a set with one.
bool blind_justified(const struct blind_result *r, const char *name);

#endif // DIG_TESTS_BLIND_ANSWER_H
