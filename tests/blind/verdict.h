// What a trace said, read from its JSON as any script would read it.

#ifndef DIG_TESTS_BLIND_VERDICT_H
#define DIG_TESTS_BLIND_VERDICT_H

#include "core/curve.h"
#include "core/error.h"

#include <stdbool.h>

#define BLIND_NAMES_MAX 8
#define BLIND_SETS_MAX  8

struct blind_verdict {
    bool   significant;
    size_t names; // of the verdict; "none" is one
    char   name[BLIND_NAMES_MAX][DIG_NAME_SIZE];
    size_t effects;
    char   effect[BLIND_NAMES_MAX][DIG_NAME_SIZE];
    double probability[BLIND_NAMES_MAX];
    double low[BLIND_NAMES_MAX], high[BLIND_NAMES_MAX]; // of its first parameter; NaN: it has none
    struct dig_gravel gravel_low, gravel_high;
    size_t            sets;
    size_t            set_size[BLIND_SETS_MAX];
    char              set[BLIND_SETS_MAX][BLIND_NAMES_MAX][DIG_NAME_SIZE];
    double            noise_floor, before, after; // NaN: null
};

/// DIG_EINVAL: a key of the contract is missing; *error names it.
DIG_MUST_CHECK enum dig_status blind_verdict_read(const char *path, struct blind_verdict *verdict,
                                                  struct dig_error *error);

#endif // DIG_TESTS_BLIND_VERDICT_H
