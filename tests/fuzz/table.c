// A table that is sealed and sound but for some bytes or cells: the input is a list of patches of a
// good one, each three bytes of where, one of length and the bytes. Where begins with bit 7 of the
// third byte clear: an offset into the file; set: a column of any table, and its row. Then the
// table is sealed again, so that what a seal would find reaches what lies behind it; an input of
// odd length is not.

#include "tables/load.h"
#include "tests/fuzz/as_file.h"
#include "tests/seal_all.h"

#include <sqlite3.h>
#include <string.h>

#define GOOD      "tests/data/formats/table.sqlite"
#define BYTES_MAX (1 << 18)
#define HEAD      4
#define OF_A_CELL 0x80

static uint8_t good[BYTES_MAX];
static size_t  good_size;

static void load_good(void)
{
    FILE *const file = fopen(GOOD, "rb");
    good_size        = file != NULL ? fread(good, 1, sizeof good, file) : 0;
    if (file == NULL || fclose(file) != 0 || good_size == 0) {
        (void)fprintf(stderr, GOOD ": missing\n");
        exit(2);
    }
}

// The next patch, and what is left of the input behind it.
struct patch {
    const uint8_t *where, *bytes;
    size_t         count;
};

static bool next_patch(const uint8_t **const data, size_t *const size, struct patch *const patch)
{
    if (*size <= HEAD) {
        return false;
    }
    const size_t left  = *size - HEAD;
    const size_t asked = (*data)[3];
    *patch             = (struct patch){ *data, *data + HEAD, asked < left ? asked : left };
    *data += HEAD + patch->count;
    *size -= HEAD + patch->count;
    return true;
}

static void patch_bytes(uint8_t patched[], const struct patch *const p)
{
    const size_t at =
        (p->where[0] | (size_t)p->where[1] << 8 | (size_t)p->where[2] << 16) % good_size;
    memcpy(patched + at, p->bytes, p->count < good_size - at ? p->count : good_size - at);
}

// A number where there are eight bytes or one, else a blob.
static void bind_value(sqlite3_stmt *const s, const struct patch *const p)
{
    double number;
    if (p->count == sizeof number) {
        memcpy(&number, p->bytes, sizeof number);
        (void)sqlite3_bind_double(s, 1, number);
    } else if (p->count == 1) {
        (void)sqlite3_bind_int(s, 1, (int8_t)p->bytes[0]);
    } else if ((p->where[2] & 1) != 0) {
        (void)sqlite3_bind_text(s, 1, (const char *)p->bytes, (int)p->count, SQLITE_STATIC);
    } else {
        (void)sqlite3_bind_blob(s, 1, p->bytes, (int)p->count, SQLITE_STATIC);
    }
}

// What the table's own constraints refuse stays as it was.
static void patch_cell(sqlite3 *const db, const struct patch *const p)
{
    static const char columns_sql[] =
        "SELECT format('UPDATE \"%w\" SET \"%w\" = ?1 WHERE rowid = %d', t.name, c.name, ?2) "
        "FROM sqlite_schema t JOIN pragma_table_info(t.name) c WHERE t.type = 'table' "
        "ORDER BY t.name, c.cid LIMIT 1 OFFSET ?1";
    sqlite3_stmt *column = NULL, *update = NULL;
    if (sqlite3_prepare_v2(db, columns_sql, -1, &column, NULL) == SQLITE_OK) {
        (void)sqlite3_bind_int(column, 1, p->where[0] % 64);
        (void)sqlite3_bind_int(column, 2, p->where[1] % 8);
        if (sqlite3_step(column) == SQLITE_ROW &&
            sqlite3_prepare_v2(db, (const char *)sqlite3_column_text(column, 0), -1, &update,
                               NULL) == SQLITE_OK) {
            bind_value(update, p);
            (void)sqlite3_step(update);
        }
    }
    (void)sqlite3_finalize(update);
    (void)sqlite3_finalize(column);
}

static void patch_cells_and_seal(const char *const path, const uint8_t *data, size_t size)
{
    sqlite3     *db     = NULL;
    const bool   sealed = size % 2 == 0;
    struct patch p;
    if (sqlite3_open_v2(path, &db, SQLITE_OPEN_READWRITE, NULL) == SQLITE_OK) {
        (void)sqlite3_exec(db,
                           "PRAGMA synchronous = OFF; PRAGMA journal_mode = OFF; "
                           "PRAGMA ignore_check_constraints = ON; BEGIN",
                           NULL, NULL, NULL);
        while (next_patch(&data, &size, &p)) {
            if ((p.where[2] & OF_A_CELL) != 0) {
                patch_cell(db, &p);
            }
        }
        if (sealed) {
            seal_all_of(db, path);
        }
        (void)sqlite3_exec(db, "COMMIT", NULL, NULL, NULL);
    }
    (void)sqlite3_close(db);
}

int LLVMFuzzerTestOneInput(const uint8_t *const data, const size_t size)
{
    if (good_size == 0) {
        load_good();
    }
    static uint8_t patched[BYTES_MAX];
    memcpy(patched, good, good_size);
    const uint8_t *rest = data;
    size_t         left = size;
    struct patch   p;
    while (next_patch(&rest, &left, &p)) {
        if ((p.where[2] & OF_A_CELL) == 0) {
            patch_bytes(patched, &p);
        }
    }
    const char *const path = as_file(patched, good_size);
    patch_cells_and_seal(path, data, size);

    struct dig_error      error   = { "" };
    struct dig_curve_set *set     = NULL;
    struct dig_entry_set *effects = NULL;
    const enum dig_status status  = dig_table_list(path, &set, &effects, &error);
    expect_word(status, &error);
    dig_curve_set_destroy(set);
    dig_entry_set_destroy(effects);
    return 0;
}
