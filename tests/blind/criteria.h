// The acceptance criteria of the blind bench, each a share of campaigns and its bound.

#ifndef DIG_TESTS_BLIND_CRITERIA_H
#define DIG_TESTS_BLIND_CRITERIA_H

#include "tests/blind/answer.h"

#define BLIND_CRITERIA 20

/// A share with its 95 % interval (Wilson, 1927).
struct blind_share {
    size_t k, n;
    double low, high;
};

struct blind_share blind_share_of(size_t k, size_t n);

/// One acceptance criterion: the campaigns it is about, how many things of each (none: not about
/// it), how many of them count, and what the share is to be. -1 for kind, class or code: any.
struct blind_criterion {
    const char *title;
    int         kind;
    int class;    // of size
    bool in_soil; // of blind_size_in_soil(), not blind_size_of()
    int  code;    // 1: dug by our DEM, 0: by another
    size_t (*about)(const struct blind_result *);
    size_t (*counts)(const struct blind_result *);
    double bound;
    bool   at_least;
};

extern const struct blind_criterion blind_criterion[BLIND_CRITERIA];

/// How many of the traced campaigns that a criterion is about count for it.
struct blind_share blind_criterion_judge(const struct blind_criterion *c, size_t n,
                                         const struct blind_result result[]);

/// "holds", "DOES NOT HOLD" or "not tried".
const char *blind_criterion_holds(const struct blind_criterion *c, const struct blind_share *s);

#endif // DIG_TESTS_BLIND_CRITERIA_H
