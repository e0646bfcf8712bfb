// The model that the closed loop found and the daemon applies: a gravel, and the effects that the
// table lacks, with their parameters. Read and written by files/model_json.h.

#ifndef DIG_CORE_MODEL_H
#define DIG_CORE_MODEL_H

#include "core/curve.h"
#include "core/effect.h"

#include <stdbool.h>

#define DIG_MODEL_EFFECTS_MAX    8
#define DIG_MODEL_PARAMETERS_MAX 16
#define DIG_MODEL_PATH_SIZE      512

/// A fitted parameter and its 90 % interval.
struct dig_model_parameter {
    char   name[DIG_NAME_SIZE]; // with its unit: "coulomb_N"
    double value, low, high;
};

struct dig_model_effect {
    enum dig_effect_id         effect;
    double                     probability; // that it is part of the model
    size_t                     parameters;
    struct dig_model_parameter parameter[DIG_MODEL_PARAMETERS_MAX];
};

/// What an effect that has no name adds, per trajectory of the table: a curve over path progress,
/// as a factor of the rms of the table's own curve of that channel and trajectory.
struct dig_model_unlisted {
    bool  any;             // false: nothing
    char  depends_on[128]; // what it was found to depend on, for people
    float share[DIG_TRAJECTORY_MAX][DIG_FORCE_CHANNELS][DIG_CURVE_POINTS];
};

struct dig_model {
    char                      table[DIG_MODEL_PATH_SIZE];         // as the program may open it
    char                      effects_table[DIG_MODEL_PATH_SIZE]; // "" when none is needed
    char                      scene_hash[65];
    struct dig_gravel         gravel, low, high; // refitted together with the effects
    double                    noise_floor;
    double                    error_before, error_after; // on the holdout digs
    char                      provenance[256];           // campaign and version it came from
    size_t                    effects;
    struct dig_model_effect   effect[DIG_MODEL_EFFECTS_MAX];
    struct dig_model_unlisted unlisted;

    // Named by the trace, and not made part of the model: for people, nothing applies them.
    size_t                  not_applied;
    struct dig_model_effect left_out[DIG_MODEL_EFFECTS_MAX];
};

#endif // DIG_CORE_MODEL_H
