// A gravel that was identified, as a JSON file (docs/formats.md): written by `digloop identify
// --json`, read back by `digloop predict --identified`.

#ifndef DIG_FILES_IDENTITY_JSON_H
#define DIG_FILES_IDENTITY_JSON_H

#include "core/approach.h"
#include "core/curve.h"
#include "core/error.h"

#include <stdbool.h>
#include <stdio.h>

#define DIG_IDENTITY_SAMPLES_MAX 64
#define DIG_IDENTITY_DIGS_MAX    8

/// A dig it was identified from, as it was observed (docs/numerics/estimator.md): rig scale, on the
/// table's grid of progress, 0 where nothing was measured.
struct dig_identity_dig {
    char                trajectory[DIG_NAME_SIZE];
    struct dig_approach approach;    // how it was dug; zeroed: as the trajectory stands
    double              first, last; // progress that was measured
    double              moment_Nm[DIG_CURVE_POINTS];
    double              sigma_Nm[DIG_CURVE_POINTS];
    bool                forces; // the forces were measured, too: Fx and Fz, below; else 0
    double              force_N[DIG_FORCE_CHANNELS - 1][DIG_CURVE_POINTS];
    double              force_sigma_N[DIG_FORCE_CHANNELS - 1][DIG_CURVE_POINTS];
};

struct dig_identity {
    char                scene_hash[65];            // of the table it was identified with
    char                trajectory[DIG_NAME_SIZE]; // of the dig it was identified on
    size_t              digs;                      // how many were pooled
    bool                forces;  // matched by moment and forces; else by the moment
    struct dig_approach made;    // how that dig was made, from its own path; depth 0: not known
    struct dig_approach matched; // the nearest to that the table knows; zeroed: the plain one
    struct dig_gravel   gravel;  // between the grid points
    struct dig_gravel   mean, low, high;   // posterior mean and 5 %, 95 % of each axis
    struct dig_gravel   nearest;           // entry of the table
    double              distance;          // relative Euclidean norm to the fitted curve
    double              nearest_distance;  // to the nearest entry
    bool                weighted;          // the next two are known
    struct dig_gravel   weighted_nearest;  // entry nearest by the noise-weighted distance,
    double              weighted_distance; // which is expected to be 1
    double              noise_floor;       // what another packing would be away
    bool                outside;           // none of the table's gravels
    bool                family;            // the digs do not resolve an axis: one of a family
    size_t              samples;           // gravels that stand for the posterior
    struct dig_gravel   sample[DIG_IDENTITY_SAMPLES_MAX];
    // The last of the digs, oldest first, for who goes on with them; 0: they are not kept.
    size_t                  recorded;
    struct dig_identity_dig recording[DIG_IDENTITY_DIGS_MAX];
};

/// One JSON object and a line feed; "recorded" only where there is one.
void dig_identity_write(FILE *to, const struct dig_identity *identity);

/// DIG_EINVAL names file, line, key and what was expected; DIG_EIO: it cannot be opened. Writes on
/// success only.
DIG_MUST_CHECK enum dig_status dig_identity_read(const char *path, struct dig_identity *identity,
                                                 struct dig_error *error);

#endif // DIG_FILES_IDENTITY_JSON_H
