#include "tables/store.h"

#include "tables/open.h"
#include "tables/store_private.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define WRITER_WAIT_ms 60000
#define LOCK_PAUSE_ns  50000000
#define LOCK_TRIES     40 // two seconds: workers of a killed writer need a moment to die

// In one transaction with what is read next: what was checked is what is read.
static enum dig_status begin_checked(const struct dig_db *const   db,
                                     struct dig_table_head *const head,
                                     struct dig_error *const      error)
{
    const enum dig_status status = dig_sql_run(db, "BEGIN", error);
    return status == DIG_OK ? dig_schema_check(db, head, error) : status;
}

enum dig_status dig_sql_open_read(const char *const path, struct dig_db *const db,
                                  struct dig_table_head *const head, struct dig_error *const error)
{
    struct stat file;
    if (stat(path, &file) != 0) {
        return dig_error_set(error, DIG_EIO, "%s: %s", path, strerror(errno));
    }
    if (!S_ISREG(file.st_mode)) {
        return dig_error_set(error, DIG_EINVAL, "%s: not a digsight table, expected a regular file",
                             path);
    }
    struct dig_db   opened = { .sql = NULL };
    enum dig_status status = dig_sql_open(path, SQLITE_OPEN_READONLY, &opened, error);
    if (status != DIG_OK) {
        return status;
    }
    status = begin_checked(&opened, head, error);

    // A journal left by a crash can only be rolled back by one who may write.
    if (status == DIG_EIO && sqlite3_extended_errcode(opened.sql) == SQLITE_READONLY_ROLLBACK) {
        (void)sqlite3_close(opened.sql);
        opened.sql = NULL;
        status     = dig_sql_open(path, SQLITE_OPEN_READWRITE, &opened, error);
        if (status == DIG_OK) {
            status = begin_checked(&opened, head, error);
        }
    }
    if (status != DIG_OK) {
        (void)sqlite3_close(opened.sql);
        return status;
    }
    *db = opened;
    return DIG_OK;
}

static enum dig_status make_store(const char *const path, struct dig_store **const store,
                                  struct dig_error *const error)
{
    struct dig_store *const made = calloc(1, sizeof *made);
    if (made == NULL) {
        (void)dig_error_set(error, DIG_ENOMEM, "%s: no memory", path);
        return DIG_ENOMEM;
    }
    made->lock_fd = -1;
    if (strlen(path) >= sizeof made->path) {
        free(made);
        (void)dig_error_set(error, DIG_EINVAL, "%s: the name is too long", path);
        return DIG_EINVAL;
    }
    memcpy(made->path, path, strlen(path) + 1);
    made->db.path = made->path;
    *store        = made;
    return DIG_OK;
}

enum dig_status dig_store_open(const char *const path, struct dig_store **const store,
                               struct dig_error *const error)
{
    assert(path != NULL && store != NULL);
    struct dig_store *made   = NULL;
    enum dig_status   status = make_store(path, &made, error);
    if (status == DIG_OK) {
        status = dig_sql_open_read(path, &made->db, &made->head, error);
    }
    // A reader that stays open must not keep a writer from committing.
    if (status == DIG_OK) {
        status = dig_sql_run(&made->db, "COMMIT", error);
    }
    if (status != DIG_OK) {
        dig_store_close(made);
        return status;
    }
    *store = made;
    return DIG_OK;
}

// Opens the file, or makes it: never through a link to nothing, which would make a file elsewhere.
static int open_or_make(const char *const path, bool *const made)
{
    const int there = open(path, O_RDWR | O_CLOEXEC);
    if (there >= 0 || errno != ENOENT) {
        *made = false;
        return there;
    }
    const int fd = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    *made        = fd >= 0;
    return fd >= 0 || errno != EEXIST ? fd : open(path, O_RDWR | O_CLOEXEC); // another's, by now
}

// SQLite locks byte ranges by fcntl; this is the other kind, for the whole life of a writer.
static enum dig_status lock(struct dig_store *const store, bool *const created,
                            struct dig_error *const error)
{
    bool made      = false;
    store->lock_fd = open_or_make(store->path, &made);
    if (store->lock_fd < 0) {
        return dig_error_set(error, DIG_EIO, "%s: %s", store->path, strerror(errno));
    }
    const struct timespec pause = { .tv_nsec = LOCK_PAUSE_ns };
    for (int tries = 0; flock(store->lock_fd, LOCK_EX | LOCK_NB) != 0; tries++) {
        if (errno != EWOULDBLOCK && errno != EINTR) {
            return dig_error_set(error, DIG_EIO, "%s: %s", store->path, strerror(errno));
        }
        if (tries >= LOCK_TRIES) {
            return dig_error_set(error, DIG_EIO,
                                 "%s: another process is adding to this table, expected one writer",
                                 store->path);
        }
        (void)nanosleep(&pause, NULL);
    }

    struct stat file;
    struct stat named;
    if (fstat(store->lock_fd, &file) != 0 || !S_ISREG(file.st_mode)) {
        return dig_error_set(error, DIG_EINVAL, "%s: not a digsight table, expected a regular file",
                             store->path);
    }
    if (file.st_size == 0 && lstat(store->path, &named) == 0 && S_ISLNK(named.st_mode)) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: a link to an empty file, expected a table or a new file",
                             store->path);
    }
    // Not ours to remove if another writer filled it while we waited.
    *created = made && file.st_size == 0;
    return DIG_OK;
}

static enum dig_status check_same_scene(const struct dig_store *const store,
                                        const struct dig_scene *const scene,
                                        struct dig_error *const       error)
{
    struct dig_table_head wanted;
    dig_table_head_of(scene, &wanted);
    if (strcmp(wanted.scene_hash, store->head.scene_hash) == 0) {
        return DIG_OK;
    }
    return dig_error_set(error, DIG_EINVAL,
                         "%s: scene: holds \"%s\" (%.12s…), not \"%s\" (%.12s…), expected the same "
                         "scene or a new table",
                         store->path, store->head.scene_name, store->head.scene_hash,
                         wanted.scene_name, wanted.scene_hash);
}

// Not before the file is checked: it would write into one that is not ours. A reader that dawdles
// must not end a computation of hours.
static enum dig_status prepare_writing(struct dig_store *const store, struct dig_error *const error)
{
    (void)sqlite3_busy_timeout(store->db.sql, WRITER_WAIT_ms);
    return dig_sql_run(&store->db, "PRAGMA journal_mode = DELETE; PRAGMA synchronous = FULL;",
                       error);
}

// A file of length 0 is a table not begun: what a crash between making and filling leaves.
static enum dig_status open_or_fill(struct dig_store *const       store,
                                    const struct dig_scene *const scene,
                                    struct dig_error *const       error)
{
    struct stat file;
    if (fstat(store->lock_fd, &file) != 0) {
        return dig_error_set(error, DIG_EIO, "%s: %s", store->path, strerror(errno));
    }
    enum dig_status status = dig_sql_open(store->path, SQLITE_OPEN_READWRITE, &store->db, error);
    if (status != DIG_OK) {
        return status;
    }
    if (file.st_size == 0) {
        status = dig_schema_create(&store->db, scene, error);
    }
    if (status == DIG_OK) {
        status = dig_schema_check(&store->db, &store->head, error);
    }
    if (status == DIG_OK) {
        status = prepare_writing(store, error);
    }
    return status == DIG_OK ? check_same_scene(store, scene, error) : status;
}

enum dig_status dig_store_create(const char *const path, const struct dig_scene *const scene,
                                 struct dig_store **const store, struct dig_error *const error)
{
    assert(path != NULL && scene != NULL && store != NULL);
    enum dig_status status = dig_scene_check(scene, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_store *made    = NULL;
    bool              created = false;
    status                    = make_store(path, &made, error);
    if (status == DIG_OK) {
        status = lock(made, &created, error);
    }
    if (status == DIG_OK) {
        status = open_or_fill(made, scene, error);
    }
    if (status != DIG_OK) {
        dig_store_close(made);
        if (created) {
            (void)unlink(path);
        }
        return status;
    }
    *store = made;
    return DIG_OK;
}

static enum dig_status seal(struct dig_store *const store, struct dig_error *const error)
{
    struct dig_store_report report;
    enum dig_status status = dig_sql_open(store->path, SQLITE_OPEN_READWRITE, &store->db, error);
    if (status == DIG_OK) {
        status = dig_schema_check(&store->db, &store->head, error);
    }
    if (status == DIG_OK) {
        status = prepare_writing(store, error);
    }
    // What is damaged already must not be sealed so.
    if (status == DIG_OK) {
        status = dig_store_check(store, &report, error);
    }
    return status == DIG_OK && store->head.version < DIG_TABLE_VERSION
               ? dig_schema_upgrade(&store->db, store->head.version, error)
               : status;
}

enum dig_status dig_store_seal(const char *const path, bool *const was,
                               struct dig_error *const error)
{
    assert(path != NULL && was != NULL);
    if (access(path, F_OK) != 0) {
        return dig_error_set(error, DIG_EIO, "%s: %s", path, strerror(errno));
    }
    struct dig_store *store   = NULL;
    bool              created = false;
    enum dig_status   status  = make_store(path, &store, error);
    if (status == DIG_OK) {
        status = lock(store, &created, error);
    }
    if (status == DIG_OK) {
        status = seal(store, error);
    }
    if (status == DIG_OK) {
        *was = store->head.version >= DIG_TABLE_VERSION;
    }
    dig_store_close(store);
    return status;
}

void dig_store_close(struct dig_store *const store)
{
    if (store != NULL) {
        (void)sqlite3_close(store->db.sql);
        // Last: closing any descriptor of a file drops the process's fcntl locks on it.
        if (store->lock_fd >= 0) {
            (void)close(store->lock_fd);
        }
        free(store);
    }
}

void dig_store_forget(struct dig_store *const store)
{
    if (store != NULL && store->lock_fd >= 0) {
        (void)close(store->lock_fd);
        store->lock_fd = -1;
    }
}

const struct dig_trajectory *dig_store_trajectories(const struct dig_store *const store,
                                                    size_t *const                 count)
{
    *count = store->head.trajectories;
    return store->head.trajectory;
}
