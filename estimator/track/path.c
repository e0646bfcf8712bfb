#include "estimator/track/path.h"

#include <assert.h>

// Drops every other vertex and doubles the spacing.
static void thin(struct dig_path *const path)
{
    size_t kept = 0;
    for (size_t i = 0; i < path->vertices; i += 2) {
        path->vertex[kept++] = path->vertex[i];
    }
    path->vertices = kept;
    path->contact /= 2;
    path->end = (path->end + 1) / 2;
    path->spacing_m *= 2.0;
}

static void append(struct dig_path *const path, const struct dig_path_point *const point)
{
    if (path->vertices == DIG_PATH_MAX) {
        thin(path);
    }
    path->vertex[path->vertices++] = *point;
}

bool dig_path_add(struct dig_path *const path, const struct dig_path_point *const point,
                  const bool in_soil)
{
    assert(path != NULL && point != NULL && path->spacing_m > 0.0);
    bool away = true;
    if (path->vertices > 0) {
        const struct dig_path_point step =
            dig_path_point_sub(*point, path->vertex[path->vertices - 1]);
        away = dig_path_point_dot(step, step) >= path->spacing_m * path->spacing_m;
    }
    if (away) {
        append(path, point);
    }
    if (in_soil) {
        path->end = path->vertices;
    }
    return away;
}

void dig_path_add_contact(struct dig_path *const path, const struct dig_path_point *const point)
{
    assert(path != NULL && point != NULL);
    append(path, point);
    path->contact = path->vertices - 1;
    path->end     = path->vertices;
}
