#include "tables/scene.h"

#include "tables/schema/canonical_scene.h"
#include "tables/store_private.h"

#include <assert.h>
#include <string.h>

static void read_canonical(struct dig_db *const db, struct dig_scene *const scene)
{
    sqlite3_stmt *const s    = dig_sql_first(db, "SELECT canonical FROM scene");
    const char *const   text = (const char *)sqlite3_column_text(s, 0);
    if (text != NULL) {
        dig_scene_from_canonical(text, scene);
    }
    (void)sqlite3_finalize(s);
    const struct dig_box *const b = &scene->box;
    if (!(scene->bucket.points >= 2 && b->x_max_m > b->x_min_m && b->y_max_m > b->y_min_m &&
          b->z_max_m > b->z_min_m && scene->material.diameter_m > 0.0 &&
          scene->material.young_Pa > 0.0 && scene->gravity_mps2 > 0.0)) {
        dig_db_fail(db, DIG_EINVAL,
                    "scene.canonical: expected profile_m, box_m, material and gravity_mps2 of a "
                    "scene");
    }
}

enum dig_status dig_table_scene(const char *const path, struct dig_scene *const scene,
                                struct dig_error *const error)
{
    assert(path != NULL && scene != NULL);
    struct dig_table_head head = { .trajectories = 0 };
    struct dig_db         db   = dig_sql_open_read(path, &head, error);
    struct dig_scene      read = { .trajectories = head.trajectories };
    memcpy(read.name, head.scene_name, sizeof read.name);
    memcpy(read.trajectory, head.trajectory, sizeof read.trajectory);
    read_canonical(&db, &read);
    (void)sqlite3_close(db.sql);
    if (db.status == DIG_OK) {
        *scene = read;
    }
    return db.status;
}
