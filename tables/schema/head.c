// Checks that a file is a whole table of this version, and reads its head.

#include "core/approach.h"
#include "core/name.h"
#include "core/sha256.h"
#include "tables/schema/canonical_scene.h"
#include "tables/schema/schema.h"
#include "tables/schema/seal.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define SMOOTH_MOST_s 60.0

// The one integer a PRAGMA answers.
static int pragma_int(struct dig_db *const db, const char *const sql)
{
    sqlite3_stmt *const s     = dig_sql_first(db, sql);
    const int           value = sqlite3_column_int(s, 0);
    (void)sqlite3_finalize(s);
    return value;
}

static void check_identity(struct dig_db *const db)
{
    const int id      = pragma_int(db, "PRAGMA main.application_id");
    const int version = pragma_int(db, "PRAGMA main.user_version");
    if (id != DIG_TABLE_APPLICATION_ID) {
        dig_db_fail(db, DIG_EINVAL, "not a digsight table (application_id %d, expected %d)", id,
                    DIG_TABLE_APPLICATION_ID);
    }
    if (version != DIG_TABLE_VERSION) {
        dig_db_fail(db, DIG_ESCHEMA,
                    "user_version: table format %d, expected %d (the digtable generate command "
                    "that made the table makes it anew)",
                    version, DIG_TABLE_VERSION);
    }
}

static void check_integrity(struct dig_db *const db)
{
    sqlite3_stmt     *s     = dig_sql_first(db, "PRAGMA integrity_check(1)");
    const char *const found = (const char *)sqlite3_column_text(s, 0);
    if (found == NULL || strcmp(found, "ok") != 0) {
        // SQLite says in which database first, on a line of its own.
        const char *const line = found != NULL ? strchr(found, '\n') : NULL;
        dig_db_fail(db, DIG_EINVAL, "damaged: %s, expected an intact table",
                    line != NULL    ? line + 1
                    : found != NULL ? found
                                    : "?");
    }
    (void)sqlite3_finalize(s);
    s = dig_sql_prepare(db, "PRAGMA foreign_key_check");
    if (dig_sql_row(db, s)) {
        dig_db_fail(db, DIG_EINVAL,
                    "damaged: a row of %s refers to nothing, expected an intact table",
                    (const char *)sqlite3_column_text(s, 0));
    }
    (void)sqlite3_finalize(s);
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

// The scene's row. Returns its canonical text, malloc'ed; NULL where that fails.
static char *read_scene(struct dig_db *const db, struct dig_table_head *const head)
{
    sqlite3_stmt *const s =
        dig_sql_prepare(db, "SELECT name, hash, canonical, tooth_m, bucket_width_m, young_Pa, "
                            "smooth_half_s, points FROM scene");
    char *canonical = NULL;
    if (!dig_sql_row(db, s)) {
        dig_db_fail(db, DIG_EINVAL, "scene: no row, expected one");
    }
    const char *const hash         = (const char *)sqlite3_column_text(s, 1);
    const char *const text         = (const char *)sqlite3_column_text(s, 2);
    head->tooth_m                  = sqlite3_column_double(s, 3);
    head->bucket_width_m           = sqlite3_column_double(s, 4);
    head->young_Pa                 = sqlite3_column_double(s, 5);
    head->smooth_half_s            = sqlite3_column_double(s, 6);
    const sqlite3_int64 points     = sqlite3_column_int64(s, 7);
    char                actual[65] = "";
    if (text != NULL) {
        dig_sha256_hex(text, strlen(text), actual);
    }
    if (!column_name(s, 0, head->scene_name)) {
        dig_db_fail(db, DIG_EINVAL, "scene.name: expected at most 31 characters: " DIG_NAME_RULE);
    } else if (hash == NULL || text == NULL || strcmp(hash, actual) != 0) {
        dig_db_fail(db, DIG_EINVAL,
                    "scene.hash: %.64s, expected %s, the SHA-256 of scene.canonical",
                    hash != NULL ? hash : "nothing", actual);
    } else if (!positive(head->tooth_m) || !positive(head->bucket_width_m) ||
               !positive(head->young_Pa) ||
               !(head->smooth_half_s >= 0.0 && head->smooth_half_s <= SMOOTH_MOST_s)) {
        dig_db_fail(db, DIG_EINVAL, "scene: tooth_m, bucket_width_m, young_Pa: expected > 0");
    } else if (points != DIG_CURVE_POINTS) {
        dig_db_fail(db, DIG_ESCHEMA, "scene.points: %lld, expected %d", (long long)points,
                    DIG_CURVE_POINTS);
    } else {
        memcpy(head->scene_hash, hash, sizeof head->scene_hash);
        canonical = strdup(text);
        if (canonical == NULL) {
            dig_db_fail(db, DIG_ENOMEM, "no memory");
        }
    }
    (void)sqlite3_finalize(s);
    return canonical;
}

static void read_trajectories(struct dig_db *const db, struct dig_table_head *const head)
{
    sqlite3_stmt *const s = dig_sql_prepare(
        db, "SELECT t.id, t.name, theta0_rad, start_x_m, start_z_m, number, p.name, duration_s, "
            "vx_mps, vz_mps, omega_radps FROM trajectory t JOIN phase p ON p.trajectory = t.id "
            "ORDER BY t.id, number");
    while (dig_sql_row(db, s)) {
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
            dig_db_fail(db, DIG_EINVAL,
                        "trajectory: expected rows numbered from 0, with their phases");
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
            dig_db_fail(db, DIG_EINVAL, "phase.duration_s: expected > 0");
        } else if (!isfinite(t->theta0_rad) || !isfinite(t->start_x_m) || !isfinite(t->start_z_m) ||
                   !isfinite(p->vx_mps) || !isfinite(p->vz_mps) || !isfinite(p->omega_radps)) {
            dig_db_fail(db, DIG_EINVAL, "trajectory, phase: expected finite numbers");
        }
    }
    (void)sqlite3_finalize(s);
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

void dig_schema_check(struct dig_db *const db, struct dig_table_head *const head)
{
    struct dig_table_head read = { .trajectories = 0 };
    check_identity(db);
    dig_schema_compare(db);
    check_integrity(db);
    char *const canonical = read_scene(db, &read);
    read_trajectories(db, &read);
    if (canonical != NULL && db->status == DIG_OK) {
        if (!trajectories_agree(&read, canonical)) {
            dig_db_fail(db, DIG_EINVAL,
                        "trajectory: the rows differ from scene.canonical, expected the same");
        }
        read_canonical(&read, canonical);
    }
    free(canonical);
    dig_seal_check(db);
    if (db->status == DIG_OK) {
        *head = read;
    }
}
