// An effect as it competed, whether of the machine or of the soil.

#ifndef DIG_CLOSED_LOOP_MODEL_CANDIDATE_H
#define DIG_CLOSED_LOOP_MODEL_CANDIDATE_H

#include "core/effect.h"
#include "core/model.h"

#include <stddef.h>

#define DIG_TRACE_CANDIDATES_MAX 64
#define DIG_TRACE_SETS_MAX       4 // of effects that are alike
#define DIG_TRACE_PHASES         3 // of enum dig_part

/// Where a residual shows: free air before, in the soil, lifted out.
enum dig_part { DIG_PART_AIR, DIG_PART_SOIL, DIG_PART_LIFTED };

/// One effect as it competed: refitted jointly with the gravel. Its probability is the share of
/// bootstrap samples of digs in which it was chosen ("inclusion" of docs/formats/trace.md).
struct dig_candidate {
    struct dig_model_effect as;
    double                  log_evidence; // - BIC / 2 less that of no effect
    double                  p_fit; // chance of a residual this large if this were the whole truth
    double                  error; // of the fitted digs' prediction with it (docs/numerics.md)
    enum dig_part           seen_in;
};

/// Effects that these digs cannot tell apart.
struct dig_candidate_set {
    size_t             effects;
    enum dig_effect_id effect[DIG_EFFECTS];
};

#endif // DIG_CLOSED_LOOP_MODEL_CANDIDATE_H
