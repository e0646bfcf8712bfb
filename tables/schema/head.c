// Checks that a file is a whole table of a known version, and reads its head.

#include "core/approach.h"
#include "core/name.h"
#include "core/sha256.h"
#include "tables/schema/canonical_scene.h"
#include "tables/schema/schema.h"
#include "tables/schema/seal.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define SMOOTH_MOST_s 60.0

// The one integer a PRAGMA answers.
static enum dig_status pragma_int(const struct dig_db *const db, const char *const sql,
                                  int *const value, struct dig_error *const error)
{
    sqlite3_stmt         *s      = NULL;
    const enum dig_status status = dig_sql_first(db, sql, &s, error);
    if (status == DIG_OK) {
        *value = sqlite3_column_int(s, 0);
        (void)sqlite3_finalize(s);
    }
    return status;
}

static enum dig_status check_identity(const struct dig_db *const db, int *const version,
                                      struct dig_error *const error)
{
    int             id     = 0;
    enum dig_status status = pragma_int(db, "PRAGMA main.application_id", &id, error);
    if (status == DIG_OK) {
        status = pragma_int(db, "PRAGMA main.user_version", version, error);
    }
    if (status != DIG_OK) {
        return status;
    }
    if (id != DIG_TABLE_APPLICATION_ID) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: not a digsight table (application_id %d, expected %d)", db->path,
                             id, DIG_TABLE_APPLICATION_ID);
    }
    if (*version < DIG_TABLE_VERSION_PLAIN || *version > DIG_TABLE_VERSION) {
        return dig_error_set(error, DIG_ESCHEMA,
                             "%s: user_version: table format %d, expected %d to %d as this program "
                             "knows them (the digtable generate command that made the table makes "
                             "it anew)",
                             db->path, *version, DIG_TABLE_VERSION_PLAIN, DIG_TABLE_VERSION);
    }
    return DIG_OK;
}

static enum dig_status check_integrity(const struct dig_db *const db, struct dig_error *const error)
{
    sqlite3_stmt   *s      = NULL;
    enum dig_status status = dig_sql_first(db, "PRAGMA integrity_check(1)", &s, error);
    if (status != DIG_OK) {
        return status;
    }
    const char *const found = (const char *)sqlite3_column_text(s, 0);
    if (found == NULL || strcmp(found, "ok") != 0) {
        // SQLite says in which database first, on a line of its own.
        const char *const line = found != NULL ? strchr(found, '\n') : NULL;
        status =
            dig_error_set(error, DIG_EINVAL, "%s: damaged: %s, expected an intact table", db->path,
                          line != NULL    ? line + 1
                          : found != NULL ? found
                                          : "?");
    }
    (void)sqlite3_finalize(s);

    if (status != DIG_OK) {
        return status;
    }
    s      = NULL;
    status = dig_sql_prepare(db, "PRAGMA foreign_key_check", &s, error);
    if (status == DIG_OK && sqlite3_step(s) == SQLITE_ROW) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%s: damaged: a row of %s refers to nothing, expected an intact "
                               "table",
                               db->path, (const char *)sqlite3_column_text(s, 0));
    }
    (void)sqlite3_finalize(s);
    return status;
}

// Copies a text column into a name; false when it is missing, too long, or no name.
static bool column_name(sqlite3_stmt *const s, const int column, char name[const DIG_NAME_SIZE])
{
    const char *const text = (const char *)sqlite3_column_text(s, column);
    if (text == NULL || strlen(text) >= DIG_NAME_SIZE || !dig_name_ok(text)) {
        return false;
    }
    memcpy(name, text, strlen(text) + 1);
    return true;
}

static bool positive(const double value)
{
    return value > 0.0 && isfinite(value);
}

static enum dig_status damaged(const char *const path, const char *const what,
                               struct dig_error *const error)
{
    return dig_error_set(error, DIG_EINVAL, "%s: %s", path, what);
}

// The scene's row; *canonical is malloc'ed.
static enum dig_status read_scene(const struct dig_db *const db, struct dig_table_head *const head,
                                  char **const canonical, struct dig_error *const error)
{
    sqlite3_stmt   *s = NULL;
    enum dig_status status =
        dig_sql_prepare(db,
                        "SELECT name, hash, canonical, tooth_m, bucket_width_m, young_Pa, "
                        "smooth_half_s, points FROM scene",
                        &s, error);
    if (status != DIG_OK) {
        return status;
    }
    if (sqlite3_step(s) != SQLITE_ROW) {
        (void)sqlite3_finalize(s);
        return damaged(db->path, "scene: no row, expected one", error);
    }
    const char *const hash     = (const char *)sqlite3_column_text(s, 1);
    const char *const text     = (const char *)sqlite3_column_text(s, 2);
    head->tooth_m              = sqlite3_column_double(s, 3);
    head->bucket_width_m       = sqlite3_column_double(s, 4);
    head->young_Pa             = sqlite3_column_double(s, 5);
    head->smooth_half_s        = sqlite3_column_double(s, 6);
    const sqlite3_int64 points = sqlite3_column_int64(s, 7);

    char actual[65] = "";
    if (text != NULL) {
        dig_sha256_hex(text, strlen(text), actual);
    }
    if (!column_name(s, 0, head->scene_name)) {
        status =
            damaged(db->path, "scene.name: expected at most 31 characters: " DIG_NAME_RULE, error);
    } else if (hash == NULL || text == NULL || strcmp(hash, actual) != 0) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%s: scene.hash: %.64s, expected %s, the SHA-256 of scene.canonical",
                               db->path, hash != NULL ? hash : "nothing", actual);
    } else if (!positive(head->tooth_m) || !positive(head->bucket_width_m) ||
               !positive(head->young_Pa) ||
               !(head->smooth_half_s >= 0.0 && head->smooth_half_s <= SMOOTH_MOST_s)) {
        status = damaged(db->path, "scene: tooth_m, bucket_width_m, young_Pa: expected > 0", error);
    } else if (points != DIG_CURVE_POINTS) {
        status = dig_error_set(error, DIG_ESCHEMA, "%s: scene.points: %lld, expected %d", db->path,
                               (long long)points, DIG_CURVE_POINTS);
    } else {
        memcpy(head->scene_hash, hash, sizeof head->scene_hash);
        *canonical = malloc(strlen(text) + 1);
        if (*canonical == NULL) {
            status = dig_error_set(error, DIG_ENOMEM, "%s: no memory", db->path);
        } else {
            memcpy(*canonical, text, strlen(text) + 1);
        }
    }
    (void)sqlite3_finalize(s);
    return status;
}

static enum dig_status read_trajectories(const struct dig_db *const   db,
                                         struct dig_table_head *const head,
                                         struct dig_error *const      error)
{
    sqlite3_stmt   *s = NULL;
    enum dig_status status =
        dig_sql_prepare(db,
                        "SELECT t.id, t.name, theta0_rad, start_x_m, start_z_m, number, p.name, "
                        "duration_s, vx_mps, vz_mps, omega_radps FROM trajectory t JOIN phase p "
                        "ON p.trajectory = t.id ORDER BY t.id, number",
                        &s, error);
    if (status != DIG_OK) {
        return status;
    }
    while (dig_sql_row(db, s, &status, error)) {
        const sqlite3_int64 id     = sqlite3_column_int64(s, 0);
        const sqlite3_int64 number = sqlite3_column_int64(s, 5);
        if (number == 0) {
            head->trajectories++;
        }
        struct dig_trajectory *const t =
            head->trajectories >= 1 && head->trajectories <= DIG_TRAJECTORY_MAX
                ? &head->trajectory[head->trajectories - 1]
                : NULL;
        if (t == NULL || id != (sqlite3_int64)head->trajectories - 1 || number >= DIG_PHASES_MAX ||
            number != (sqlite3_int64)t->phases || !column_name(s, 1, t->name) ||
            !column_name(s, 6, t->phase[t->phases].name)) {
            status = damaged(db->path,
                             "trajectory: expected rows numbered from 0, with their phases", error);
            break;
        }
        struct dig_phase *const p = &t->phase[t->phases++];
        t->theta0_rad             = sqlite3_column_double(s, 2);
        t->start_x_m              = sqlite3_column_double(s, 3);
        t->start_z_m              = sqlite3_column_double(s, 4);
        p->duration_s             = sqlite3_column_double(s, 7);
        p->vx_mps                 = sqlite3_column_double(s, 8);
        p->vz_mps                 = sqlite3_column_double(s, 9);
        p->omega_radps            = sqlite3_column_double(s, 10);
        if (!positive(p->duration_s)) {
            status = damaged(db->path, "phase.duration_s: expected > 0", error);
        } else if (!isfinite(t->theta0_rad) || !isfinite(t->start_x_m) || !isfinite(t->start_z_m) ||
                   !isfinite(p->vx_mps) || !isfinite(p->vz_mps) || !isfinite(p->omega_radps)) {
            status = damaged(db->path, "trajectory, phase: expected finite numbers", error);
        }
    }
    (void)sqlite3_finalize(s);
    return status;
}

// The trajectories stand twice, as rows for people and in the text the hash is of: they must agree.
static bool trajectories_agree(const struct dig_table_head *const head, const char *const canonical)
{
    static const char first[] = "trajectory=";
    struct dig_scene  scene   = { .trajectories = head->trajectories };
    memcpy(scene.trajectory, head->trajectory, sizeof scene.trajectory);
    char text[DIG_SCENE_TEXT_SIZE];
    dig_scene_canonical(&scene, text);
    const char *const here  = strstr(text, first);
    const char *const there = strstr(canonical, first);
    if (here == NULL || there == NULL || strncmp(here, there, strlen(here)) != 0) {
        return false;
    }
    // What is not plain in the scene stands behind them.
    const char *const rest = there + strlen(here);
    return strncmp(rest, first, strlen(first)) != 0 && strncmp(rest, "phase=", 6) != 0;
}

// Two beds are similar where springs go with the density and nothing else has a size of its own.
static bool density_scales(const struct dig_material *const material, const char *const canonical)
{
    static const char *const fixed[] = { "\ncohesion_Jpm3=", "\nadhesion_Jpm3=", "\nother=",
                                         "\npreload_Pa=", " movable " };
    bool                     scales  = material->young_at_kgpm3 > 0.0;
    for (size_t i = 0; i < sizeof fixed / sizeof fixed[0]; i++) {
        scales = scales && strstr(canonical, fixed[i]) == NULL;
    }
    return scales;
}

static void read_canonical(struct dig_table_head *const head, const char *const canonical)
{
    struct dig_scene scene = { .trajectories = 0 };
    dig_scene_from_canonical(canonical, &scene);

    head->time_step_s    = scene.time_step_s;
    head->normal         = scene.laws.normal;
    head->finest         = scene.material;
    head->density_scales = density_scales(&scene.material, canonical);
    for (size_t i = 0; i < scene.bed.sizes; i++) {
        head->finest.diameter_m = fmin(head->finest.diameter_m, scene.bed.size[i].diameter_m);
    }

    // Along the length that the table itself gives the bucket.
    scene.bucket = (struct dig_bucket){ .points = 1, .z_m = { -head->tooth_m } };
    for (size_t t = 0; t < head->trajectories; t++) {
        head->depth_m[t] = dig_approach_depth_m(&scene, &head->trajectory[t]);
    }
}

// A dig of a version without depth and attack is plain.
static const char plain_ground_sql[] =
    "CREATE TEMP VIEW ground AS SELECT id, friction, rolling, density_kgpm3, effect, magnitude, "
    "1.0 AS depth, 0.0 AS attack_rad FROM main.ground";

enum dig_status dig_schema_check(const struct dig_db *const db, struct dig_table_head *const head,
                                 struct dig_error *const error)
{
    struct dig_table_head read      = { .trajectories = 0 };
    char                 *canonical = NULL;
    enum dig_status       status    = check_identity(db, &read.version, error);
    if (status == DIG_OK) {
        status = dig_schema_compare(db, read.version, error);
    }
    if (status == DIG_OK) {
        status = check_integrity(db, error);
    }
    if (status == DIG_OK) {
        status = read_scene(db, &read, &canonical, error);
    }
    if (status == DIG_OK) {
        status = read_trajectories(db, &read, error);
    }
    if (status == DIG_OK && canonical != NULL && !trajectories_agree(&read, canonical)) {
        status = damaged(
            db->path, "trajectory: the rows differ from scene.canonical, expected the same", error);
    }
    if (status == DIG_OK && canonical != NULL) {
        read_canonical(&read, canonical);
    }
    free(canonical);
    if (status == DIG_OK && read.version == DIG_TABLE_VERSION_PLAIN) {
        status = dig_sql_run(db, plain_ground_sql, error);
    }
    if (status == DIG_OK && read.version >= DIG_TABLE_VERSION) {
        status = dig_seal_check(db, error);
    }
    if (status == DIG_OK) {
        *head = read;
    }
    return status;
}
