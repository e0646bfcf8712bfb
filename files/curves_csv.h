// Reads digs out of a CSV that somebody else wrote, as a map says: one line a sample, the samples
// of one dig one after another.

#ifndef DIG_FILES_CURVES_CSV_H
#define DIG_FILES_CURVES_CSV_H

#include "core/approach.h"
#include "core/curve.h"
#include "core/recording.h"
#include "files/curve_map_yaml.h"

/// One dig as it stands in the file.
struct dig_foreign_dig {
    struct dig_gravel    gravel;
    char                 trajectory[DIG_NAME_SIZE];
    struct dig_approach  approach; // how the trajectory was dug; zeroed: as it stands
    size_t               packing;
    size_t               line; // of its first sample
    struct dig_recording recording;
};

/// Called for each dig; the recording is freed afterwards. Anything but DIG_OK ends the reading and
/// is returned.
struct dig_foreign_visitor {
    enum dig_status (*visit)(void *context, const struct dig_foreign_dig *dig,
                             struct dig_error *error);
    void *context;
};

/// Columns the map does not name are skipped. A dig ends where gravel, trajectory, depth,
/// attack or packing change. DIG_EINVAL: "FILE:LINE: column NAME: …"; DIG_EIO; DIG_ENOMEM. What was
/// visited before an error was visited.
DIG_MUST_CHECK enum dig_status dig_curves_read(const char *path, const struct dig_curve_map *map,
                                               const struct dig_foreign_visitor *visitor,
                                               struct dig_error                 *error);

#endif // DIG_FILES_CURVES_CSV_H
