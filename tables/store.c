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
static void begin_checked(struct dig_db *const db, struct dig_table_head *const head)
{
    dig_sql_run(db, "BEGIN");
    dig_schema_check(db, head);
}

struct dig_db dig_sql_open_read(const char *const path, struct dig_table_head *const head,
                                struct dig_error *const error)
{
    struct dig_db db = { .path = path, .error = error };
    struct stat   file;
    if (stat(path, &file) != 0) {
        dig_db_fail(&db, DIG_EIO, "%s", strerror(errno));
    } else if (!S_ISREG(file.st_mode)) {
        dig_db_fail(&db, DIG_EINVAL, "not a digsight table, expected a regular file");
    }
    dig_sql_open(&db, SQLITE_OPEN_READONLY);
    begin_checked(&db, head);
    // A journal left by a crash can only be rolled back by one who may write.
    if (db.status == DIG_EIO && sqlite3_extended_errcode(db.sql) == SQLITE_READONLY_ROLLBACK) {
        (void)sqlite3_close(db.sql);
        db = (struct dig_db){ .path = path, .error = error };
        dig_sql_open(&db, SQLITE_OPEN_READWRITE);
        begin_checked(&db, head);
    }
    return db;
}

static enum dig_status make_store(const char *const path, struct dig_store **const store,
                                  struct dig_error *const error)
{
    struct dig_store *const made = calloc(1, sizeof *made);
    if (made == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%s: no memory", path);
    }
    made->lock_fd = -1;
    if (strlen(path) >= sizeof made->path) {
        free(made);
        return dig_error_set(error, DIG_EINVAL, "%s: the name is too long", path);
    }
    memcpy(made->path, path, strlen(path) + 1);
    made->db = (struct dig_db){ .path = made->path, .error = error };
    *store   = made;
    return DIG_OK;
}

enum dig_status dig_store_open(const char *const path, struct dig_store **const store,
                               struct dig_error *const error)
{
    assert(path != NULL && store != NULL);
    struct dig_store *made   = NULL;
    enum dig_status   status = make_store(path, &made, error);
    if (made == NULL) {
        return status;
    }
    made->db = dig_sql_open_read(made->path, &made->head, error);
    // A reader that stays open must not keep a writer from committing.
    dig_sql_run(&made->db, "COMMIT");
    status = made->db.status;
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

// SQLite locks byte ranges by fcntl; this is the other kind, for the whole life of a writer. True:
// the file was made for it.
static bool lock(struct dig_store *const store)
{
    struct dig_db *const db   = &store->db;
    bool                 made = false;
    store->lock_fd            = open_or_make(store->path, &made);
    if (store->lock_fd < 0) {
        dig_db_fail(db, DIG_EIO, "%s", strerror(errno));
        return false;
    }
    const struct timespec pause = { .tv_nsec = LOCK_PAUSE_ns };
    for (int tries = 0; flock(store->lock_fd, LOCK_EX | LOCK_NB) != 0; tries++) {
        if (errno != EWOULDBLOCK && errno != EINTR) {
            dig_db_fail(db, DIG_EIO, "%s", strerror(errno));
            return false;
        }
        if (tries >= LOCK_TRIES) {
            dig_db_fail(db, DIG_EIO,
                        "another process is adding to this table, expected one writer");
            return false;
        }
        (void)nanosleep(&pause, NULL);
    }
    struct stat file;
    struct stat named;
    if (fstat(store->lock_fd, &file) != 0 || !S_ISREG(file.st_mode)) {
        dig_db_fail(db, DIG_EINVAL, "not a digsight table, expected a regular file");
    } else if (file.st_size == 0 && lstat(store->path, &named) == 0 && S_ISLNK(named.st_mode)) {
        dig_db_fail(db, DIG_EINVAL, "a link to an empty file, expected a table or a new file");
    }
    // Not ours to remove if another writer filled it while we waited.
    return db->status == DIG_OK && made && file.st_size == 0;
}

static void check_same_scene(struct dig_store *const store, const struct dig_scene *const scene)
{
    struct dig_table_head wanted;
    dig_table_head_of(scene, &wanted);
    if (strcmp(wanted.scene_hash, store->head.scene_hash) != 0) {
        dig_db_fail(&store->db, DIG_EINVAL,
                    "scene: holds \"%s\" (%.12s…), not \"%s\" (%.12s…), expected the same scene or "
                    "a new table",
                    store->head.scene_name, store->head.scene_hash, wanted.scene_name,
                    wanted.scene_hash);
    }
}

// Not before the file is checked: it would write into one that is not ours. A reader that dawdles
// must not end a computation of hours.
static void prepare_writing(struct dig_db *const db)
{
    (void)sqlite3_busy_timeout(db->sql, WRITER_WAIT_ms);
    dig_sql_run(db, "PRAGMA journal_mode = DELETE; PRAGMA synchronous = FULL;");
}

// A file of length 0 is a table not begun: what a crash between making and filling leaves.
static void open_or_fill(struct dig_store *const store, const struct dig_scene *const scene)
{
    struct dig_db *const db = &store->db;
    struct stat          file;
    if (db->status == DIG_OK && fstat(store->lock_fd, &file) != 0) {
        dig_db_fail(db, DIG_EIO, "%s", strerror(errno));
    }
    if (db->status != DIG_OK) {
        return;
    }
    dig_sql_open(db, SQLITE_OPEN_READWRITE);
    if (file.st_size == 0) {
        dig_schema_create(db, scene);
    }
    dig_schema_check(db, &store->head);
    if (db->status == DIG_OK) {
        prepare_writing(db);
        check_same_scene(store, scene);
    }
}

enum dig_status dig_store_create(const char *const path, const struct dig_scene *const scene,
                                 struct dig_store **const store, struct dig_error *const error)
{
    assert(path != NULL && scene != NULL && store != NULL);
    struct dig_store *made   = NULL;
    enum dig_status   status = dig_scene_check(scene, error);
    status                   = status == DIG_OK ? make_store(path, &made, error) : status;
    if (made == NULL) {
        return status;
    }
    const bool created = lock(made);
    open_or_fill(made, scene);
    status = made->db.status;
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
