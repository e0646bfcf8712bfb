#include "tables/open.h"

#include <assert.h>
#include <limits.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <sys/stat.h>

// SQLite keeps what is registered as long as the process lives.
static sqlite3_vfs    guarded;
static pthread_once_t registered = PTHREAD_ONCE_INIT;

// Those that SQLite names itself; of an own temporary file it makes sure.
static bool stands_beside(const int flags)
{
    return (flags & (SQLITE_OPEN_MAIN_JOURNAL | SQLITE_OPEN_WAL)) != 0;
}

static int open_file(sqlite3_vfs *const vfs, const char *const path, sqlite3_file *const file,
                     const int flags, int *const flags_out)
{
    sqlite3_vfs *const system = sqlite3_vfs_find(NULL);
    struct stat        found;
    (void)vfs;
    file->pMethods = NULL; // nothing for SQLite to close
    if ((flags & SQLITE_OPEN_SUPER_JOURNAL) != 0 ||
        (stands_beside(flags) && lstat(path, &found) == 0 && !S_ISREG(found.st_mode))) {
        return SQLITE_CANTOPEN;
    }
    return system->xOpen(system, path, file, flags, flags_out);
}

static void guard(void)
{
    const sqlite3_vfs *const system = sqlite3_vfs_find(NULL);
    if (system != NULL) {
        guarded       = *system;
        guarded.zName = "digsight";
        guarded.xOpen = open_file;
        (void)sqlite3_vfs_register(&guarded, 0);
    }
}

// A path that SQLite takes for nothing else: a relative one could be ":memory:", or "file:" with
// words behind it that name another file, or none of our guard.
static bool plain_path(const char *const path, const size_t size, char plain[const])
{
    const int length = snprintf(plain, size, "%s%s", path[0] == '/' ? "" : "./", path);
    return path[0] != '\0' && length > 0 && (size_t)length < size;
}

void dig_sql_open(struct dig_db *const db, const int flags)
{
    assert(db != NULL && db->path != NULL);
    char plain[PATH_MAX];
    if (db->status != DIG_OK) {
        return;
    }
    if (!plain_path(db->path, sizeof plain, plain)) {
        db->status = dig_error_set(db->error, DIG_EINVAL, "%.200s: no name of a file, expected one",
                                   db->path);
        return;
    }
    // Where it could not be registered SQLite says so, and opens nothing.
    (void)pthread_once(&registered, guard);
    if (sqlite3_open_v2(plain, &db->sql, flags, "digsight") != SQLITE_OK) {
        dig_db_fail(db, DIG_EIO, "%s", db->sql != NULL ? sqlite3_errmsg(db->sql) : "no memory");
    }
    dig_sql_setup(db);
}
