#include "tools/digtable/job_folder.h"

#include "core/name.h"

#include <assert.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

static const char suffix[] = ".jobs";

#define NAME_ROOM 40 // for the longest name in the folder

const char *dig_job_folder_file(const struct dig_job_folder *const folder, const char *const name,
                                char path[const PATH_MAX])
{
    const int length = snprintf(path, PATH_MAX, "%s/%s", folder->path, name);
    assert(length > 0 && length < PATH_MAX);
    (void)length;
    return path;
}

const char *dig_job_folder_of(const struct dig_job_folder *const folder, const char *const kind,
                              const size_t task, const char *const end, char path[const PATH_MAX])
{
    char name[64];
    if (task == DIG_JOB_MERGE) {
        (void)snprintf(name, sizeof name, "%s/merge.%s", kind, end);
    } else {
        (void)snprintf(name, sizeof name, "%s/%zu.%s", kind, task, end);
    }
    return dig_job_folder_file(folder, name, path);
}

// Names table and folder, with their whole paths; neither need be there.
static enum dig_status find(const char *const table, struct dig_job_folder *const folder,
                            struct dig_error *const error)
{
    char              here[PATH_MAX] = "";
    const char *const name           = dig_path_last(table);
    if (!dig_path_ok(table) || strcmp(name, "") == 0 || strcmp(name, ".") == 0 ||
        strcmp(name, "..") == 0) {
        return dig_error_set(error, DIG_EINVAL, "%s: expected " DIG_PATH_RULE, table);
    }
    if (table[0] != '/' && getcwd(here, sizeof here) == NULL) {
        return dig_error_set(error, DIG_EIO, "the working folder: %s", strerror(errno));
    }
    const int length = snprintf(folder->path, sizeof folder->path, "%s%s%s%s", here,
                                here[0] != '\0' ? "/" : "", table, suffix);
    if (length < 0 || (size_t)length + NAME_ROOM >= sizeof folder->path) {
        return dig_error_set(error, DIG_EINVAL, "%s: the name is too long", table);
    }
    memcpy(folder->table, folder->path, (size_t)length + 1);
    folder->table[(size_t)length - (sizeof suffix - 1)] = '\0';
    return DIG_OK;
}

// Folders in the folder.
static const char *const rooms[] = { "part", "shards", "log" };

static bool is_room(const char *const name)
{
    bool is = false;
    for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; i++) {
        is = is || strcmp(name, rooms[i]) == 0;
    }
    return is;
}

// What is opened or written there is of its own kind: a link would lead elsewhere, a pipe would
// wait. has_rooms: the folders in it are those of a folder of jobs.
static enum dig_status check_entries(const char *const path, const bool has_rooms,
                                     struct dig_error *const error)
{
    DIR *const      dir    = opendir(path);
    enum dig_status status = DIG_OK;
    if (dir == NULL) {
        return errno == ENOENT ? DIG_OK
                               : dig_error_set(error, DIG_EIO, "%s: %s", path, strerror(errno));
    }
    for (const struct dirent *entry; status == DIG_OK && (entry = readdir(dir)) != NULL;) {
        const char *const name = entry->d_name;
        const bool        room = has_rooms && is_room(name);
        struct stat       is;
        // Gone since: another submit's.
        if (strcmp(name, ".") == 0 || strcmp(name, "..") == 0 ||
            fstatat(dirfd(dir), name, &is, AT_SYMLINK_NOFOLLOW) != 0) {
            continue;
        }
        if (room ? !S_ISDIR(is.st_mode) : !S_ISREG(is.st_mode)) {
            status = dig_error_set(error, DIG_EINVAL,
                                   "%s/%s: expected a %s of digtable submit's, not a link or "
                                   "another kind of file",
                                   path, name, room ? "folder" : "file");
        }
    }
    (void)closedir(dir);
    return status;
}

static enum dig_status check_folder(const struct dig_job_folder *const folder,
                                    struct dig_error *const            error)
{
    char            path[PATH_MAX];
    enum dig_status status = check_entries(folder->path, true, error);
    for (size_t i = 0; i < sizeof rooms / sizeof rooms[0] && status == DIG_OK; i++) {
        status = check_entries(dig_job_folder_file(folder, rooms[i], path), false, error);
    }
    return status;
}

enum dig_status dig_job_folder_open(const char *const table, struct dig_job_folder *const folder,
                                    struct dig_error *const error)
{
    assert(table != NULL && folder != NULL);
    char                  file[PATH_MAX];
    struct dig_job_folder found  = { .lock_fd = -1 };
    enum dig_status       status = find(table, &found, error);
    if (status == DIG_OK) {
        status = check_folder(&found, error);
    }
    if (status == DIG_OK && access(dig_job_folder_file(&found, "plan.yaml", file), F_OK) != 0) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: no such file, expected a table that "
                             "`digtable submit` computes",
                             file);
    }
    if (status == DIG_OK) {
        status = dig_job_plan_read(file, &found.plan, error);
    }
    if (status == DIG_OK) {
        *folder = found;
    }
    return status;
}

void dig_job_folder_close(struct dig_job_folder *const folder)
{
    if (folder->lock_fd >= 0) {
        (void)close(folder->lock_fd);
        folder->lock_fd = -1;
    }
}

// Nothing in it but what `digtable submit` makes first.
static bool is_ours(const char *const path)
{
    DIR *const dir  = opendir(path);
    size_t     seen = 0;
    bool       lock = false;
    for (const struct dirent *entry; dir != NULL && (entry = readdir(dir)) != NULL;) {
        lock = lock || strcmp(entry->d_name, "lock") == 0;
        seen += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0 ? 1 : 0;
    }
    const bool ours = dir != NULL && (lock || seen == 0);
    if (dir != NULL) {
        (void)closedir(dir);
    }
    return ours;
}

// Made where there is none.
static enum dig_status make_and_lock(struct dig_job_folder *const       folder,
                                     const volatile sig_atomic_t *const stop,
                                     struct dig_error *const            error)
{
    char lock[PATH_MAX];
    (void)dig_job_folder_file(folder, "lock", lock);
    if (mkdir(folder->path, 0777) != 0 && errno != EEXIST) {
        return dig_error_set(error, DIG_EIO, "%s: %s", folder->path, strerror(errno));
    }
    if (!is_ours(folder->path)) {
        return dig_error_set(error, DIG_EINVAL, "%s: is in the way, and not of digtable submit",
                             folder->path);
    }
    const enum dig_status checked = check_folder(folder, error);
    if (checked != DIG_OK) {
        return checked;
    }
    folder->lock_fd = open(lock, O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (folder->lock_fd < 0) {
        return dig_error_set(error, DIG_EIO, "%s: %s", lock, strerror(errno));
    }
    if (flock(folder->lock_fd, LOCK_EX | LOCK_NB) == 0) {
        return DIG_OK;
    }
    if (errno == EWOULDBLOCK) {
        (void)fprintf(stderr, "digtable: waiting for another `digtable submit` of this folder\n");
    }
    while (flock(folder->lock_fd, LOCK_EX) != 0) {
        if (errno != EINTR || *stop != 0) {
            return dig_error_set(error, DIG_EIO, "%s: %s", lock, strerror(errno));
        }
    }
    return DIG_OK;
}

enum dig_status dig_job_folder_make(const char *const                  table,
                                    const volatile sig_atomic_t *const stop,
                                    struct dig_job_folder *const       folder,
                                    struct dig_error *const            error)
{
    assert(table != NULL && folder != NULL);
    struct dig_job_folder made   = { .lock_fd = -1 };
    enum dig_status       status = find(table, &made, error);
    if (status == DIG_OK) {
        status = make_and_lock(&made, stop, error);
    }
    if (status == DIG_OK) {
        *folder = made;
    } else {
        dig_job_folder_close(&made);
    }
    return status;
}

enum dig_status dig_job_folder_make_rooms(const struct dig_job_folder *const folder,
                                          struct dig_error *const            error)
{
    assert(folder != NULL);
    char path[PATH_MAX];
    for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; i++) {
        if (mkdir(dig_job_folder_file(folder, rooms[i], path), 0777) != 0 && errno != EEXIST) {
            return dig_error_set(error, DIG_EIO, "%s: %s", path, strerror(errno));
        }
    }
    return DIG_OK;
}
