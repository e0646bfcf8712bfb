// The path of the bucket in one dig, as vertices a fixed distance apart: a pause adds none, noise
// of the angles hardly any.

#ifndef DIG_ESTIMATOR_TRACK_PATH_H
#define DIG_ESTIMATOR_TRACK_PATH_H

#include "estimator/track/route.h"

#include <stdbool.h>
#include <stddef.h>

#define DIG_PATH_MAX 384 // vertices kept of one dig

/// The vertices of a dig. Zeroed with a spacing it is empty.
struct dig_path {
    double                spacing_m; // doubles when the array is full
    size_t                vertices;
    size_t                contact; // first vertex in contact; those before it only support the fit
    size_t                end;     // vertices up to the last one in soil: fits use these
    struct dig_path_point vertex[DIG_PATH_MAX];
};

/// Appends a vertex if it is spacing_m away from the last; true if it did. in_soil: the soil
/// resists at this point.
bool dig_path_add(struct dig_path *path, const struct dig_path_point *point, bool in_soil);

/// Appends the vertex of contact, however near the last.
void dig_path_add_contact(struct dig_path *path, const struct dig_path_point *point);

#endif // DIG_ESTIMATOR_TRACK_PATH_H
