#include "tables/schema/seal.h"

#include "core/sha256.h"
#include "tables/schema/schema.h"

#include <stdint.h>
#include <string.h>

static const char entry_sql[] =
    "SELECT s.name, s.hash, s.tooth_m, s.bucket_width_m, s.young_Pa, s.smooth_half_s, s.points, "
    "g.friction, g.rolling, g.density_kgpm3, g.effect, g.magnitude, g.depth, g.attack_rad, "
    "e.trajectory, e.packings, e.mean, e.spread "
    "FROM entry e JOIN ground g ON g.id = e.ground JOIN scene s "
    "WHERE e.ground = ?1 AND e.trajectory = ?2";

static const char runs_sql[] =
    "SELECT packing, seed, engine, version, grains, windows, first_s, step_s, curve, made_utc, "
    "wall_s FROM run WHERE ground = ?1 AND trajectory = ?2 ORDER BY packing";

// Both statements, used again for one entry after the other.
struct sealer {
    struct dig_db *db;
    sqlite3_stmt  *entry, *runs;
};

static struct sealer begin(struct dig_db *const db)
{
    return (struct sealer){ db, dig_sql_prepare(db, entry_sql), dig_sql_prepare(db, runs_sql) };
}

static void end(const struct sealer *const s)
{
    (void)sqlite3_finalize(s->entry);
    (void)sqlite3_finalize(s->runs);
}

static void add_number(struct dig_sha256 *const hash, const uint64_t bits)
{
    uint8_t bytes[8];
    for (size_t b = 0; b < sizeof bytes; b++) {
        bytes[b] = (uint8_t)(bits >> (8 * b));
    }
    dig_sha256_add(hash, bytes, sizeof bytes);
}

// Every column of the row a statement stands on: its type, its length where it has one, its value.
static void add_row(struct dig_sha256 *const hash, sqlite3_stmt *const s)
{
    for (int i = 0; i < sqlite3_column_count(s); i++) {
        const int type = sqlite3_column_type(s, i);
        add_number(hash, (uint64_t)type);
        if (type == SQLITE_INTEGER) {
            add_number(hash, (uint64_t)sqlite3_column_int64(s, i));
        } else if (type == SQLITE_FLOAT) {
            const double value = sqlite3_column_double(s, i);
            uint64_t     bits;
            memcpy(&bits, &value, sizeof bits);
            add_number(hash, bits);
        } else if (type != SQLITE_NULL) {
            const void *const bytes = sqlite3_column_blob(s, i);
            const int         size  = sqlite3_column_bytes(s, i);
            add_number(hash, (uint64_t)size);
            if (size > 0) {
                dig_sha256_add(hash, bytes, (size_t)size);
            }
        }
    }
}

// Adds all rows of a statement bound to an entry.
static void add_rows(const struct sealer *const s, sqlite3_stmt *const rows,
                     const sqlite3_int64 ground, const sqlite3_int64 trajectory,
                     struct dig_sha256 *const hash)
{
    (void)sqlite3_reset(rows);
    (void)sqlite3_bind_int64(rows, 1, ground);
    (void)sqlite3_bind_int64(rows, 2, trajectory);
    while (dig_sql_row(s->db, rows)) {
        add_row(hash, rows);
    }
}

static sqlite3_int64 sum_of(const struct sealer *const s, const sqlite3_int64 ground,
                            const sqlite3_int64 trajectory)
{
    struct dig_sha256 hash;
    dig_sha256_init(&hash);
    add_rows(s, s->entry, ground, trajectory, &hash);
    add_rows(s, s->runs, ground, trajectory, &hash);
    return (sqlite3_int64)dig_sha256_finish_number(&hash);
}

void dig_seal_write(struct dig_db *const db, const sqlite3_int64 ground, const size_t trajectory)
{
    const struct sealer s   = begin(db);
    const sqlite3_int64 sum = sum_of(&s, ground, (sqlite3_int64)trajectory);
    sqlite3_stmt *const into =
        dig_sql_prepare(db, "INSERT INTO seal (ground, trajectory, sum) VALUES (?1, ?2, ?3) "
                            "ON CONFLICT (ground, trajectory) DO UPDATE SET sum = ?3");
    (void)sqlite3_bind_int64(into, 1, ground);
    (void)sqlite3_bind_int64(into, 2, (sqlite3_int64)trajectory);
    (void)sqlite3_bind_int64(into, 3, sum);
    dig_sql_done(db, into);
    end(&s);
}

static void check_one(const struct sealer *const s, sqlite3_stmt *const entry)
{
    const sqlite3_int64 ground     = sqlite3_column_int64(entry, 0);
    const sqlite3_int64 trajectory = sqlite3_column_int64(entry, 1);
    const sqlite3_int64 sum        = sum_of(s, ground, trajectory);
    if (sqlite3_column_type(entry, 2) != SQLITE_INTEGER || sqlite3_column_int64(entry, 2) != sum) {
        dig_db_fail(s->db, DIG_EINVAL,
                    "damaged: entry of ground %lld on trajectory %lld, or one of its runs, is not "
                    "what was stored, expected what its seal says",
                    (long long)ground, (long long)trajectory);
    }
}

// Does something to every entry.
static void each(const struct sealer *const s, const char *const sql,
                 void (*const what)(const struct sealer *, sqlite3_stmt *))
{
    sqlite3_stmt *const entry = dig_sql_prepare(s->db, sql);
    while (dig_sql_row(s->db, entry)) {
        what(s, entry);
    }
    (void)sqlite3_finalize(entry);
}

static void refuse_run(const struct sealer *const s, sqlite3_stmt *const run)
{
    dig_db_fail(s->db, DIG_EINVAL,
                "damaged: run %lld is of no entry, expected one of its ground and trajectory",
                (long long)sqlite3_column_int64(run, 0));
}

void dig_seal_check(struct dig_db *const db)
{
    const struct sealer s = begin(db);
    each(&s,
         "SELECT e.ground, e.trajectory, s.sum FROM entry e LEFT JOIN seal s ON s.ground = "
         "e.ground AND s.trajectory = e.trajectory ORDER BY 1, 2",
         check_one);
    each(&s,
         "SELECT r.id FROM run r LEFT JOIN entry e ON e.ground = r.ground AND e.trajectory = "
         "r.trajectory WHERE e.ground IS NULL LIMIT 1",
         refuse_run);
    end(&s);
}
