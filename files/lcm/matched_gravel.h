// The gravel a MATCH tells of. A message may hold anything: it is checked once, here.

#ifndef DIG_FILES_LCM_MATCHED_GRAVEL_H
#define DIG_FILES_LCM_MATCHED_GRAVEL_H

#include "core/curve.h"

#include "messages/digsight_match_t.h"

#include <stdbool.h>
#include <stdint.h>

struct dig_matched_gravel {
    bool              known, outside, forces, going_on;
    struct dig_gravel gravel, low, high, nearest; // numbers where it is known
    int32_t           digs;                       // matched together
    int64_t           expires_ns;
    char              untold[256], untold_words[256]; // axes by their names; without units
    char              wanted[256];
};

/// False, and nothing is written, where a gravel is said to be known by what are no numbers of one.
bool dig_matched_gravel_take(const digsight_match_t *message, struct dig_matched_gravel *matched);

#endif // DIG_FILES_LCM_MATCHED_GRAVEL_H
