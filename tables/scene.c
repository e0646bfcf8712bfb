#include "tables/scene.h"

#include "tables/schema/canonical_scene.h"
#include "tables/store_private.h"

#include <assert.h>
#include <string.h>

static enum dig_status read_canonical(const struct dig_db *const db, struct dig_scene *const scene,
                                      struct dig_error *const error)
{
    sqlite3_stmt         *s      = NULL;
    const enum dig_status status = dig_sql_first(db, "SELECT canonical FROM scene", &s, error);
    if (status != DIG_OK) {
        return status;
    }
    const char *const text = (const char *)sqlite3_column_text(s, 0);
    if (text != NULL) {
        dig_scene_from_canonical(text, scene);
    }
    (void)sqlite3_finalize(s);
    const struct dig_box *const b = &scene->box;
    return scene->bucket.points >= 2 && b->x_max_m > b->x_min_m && b->y_max_m > b->y_min_m &&
                   b->z_max_m > b->z_min_m && scene->material.diameter_m > 0.0 &&
                   scene->material.young_Pa > 0.0 && scene->gravity_mps2 > 0.0
               ? DIG_OK
               : dig_error_set(error, DIG_EINVAL,
                               "%s: scene.canonical: expected profile_m, box_m, material and "
                               "gravity_mps2 of a scene",
                               db->path);
}

enum dig_status dig_table_scene(const char *const path, struct dig_scene *const scene,
                                struct dig_error *const error)
{
    assert(path != NULL && scene != NULL);
    struct dig_db         db     = { .sql = NULL };
    struct dig_table_head head   = { .trajectories = 0 };
    enum dig_status       status = dig_sql_open_read(path, &db, &head, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_scene read = { .trajectories = head.trajectories };
    memcpy(read.name, head.scene_name, sizeof read.name);
    memcpy(read.trajectory, head.trajectory, sizeof read.trajectory);
    status = read_canonical(&db, &read, error);
    (void)sqlite3_close(db.sql);
    if (status == DIG_OK) {
        *scene = read;
    }
    return status;
}
