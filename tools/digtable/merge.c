// digtable merge.

#include "tables/merge.h"

#include "tools/digtable/commands.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Paths of tables, each malloc'ed.
struct inputs {
    size_t count;
    char **path;
};

static void finish(struct inputs *const in)
{
    for (size_t i = 0; i < in->count; i++) {
        free(in->path[i]);
    }
    free(in->path);
}

// "FOLDER/NAME", or NAME alone with an empty folder.
static enum dig_status add(struct inputs *const in, const char *const folder,
                           const char *const name, struct dig_error *const error)
{
    const size_t size = strlen(folder) + strlen(name) + 2;
    char **const more = realloc(in->path, (in->count + 1) * sizeof *more);
    in->path          = more != NULL ? more : in->path;
    char *const path  = more != NULL ? malloc(size) : NULL;
    if (path == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "no memory for %zu tables", in->count);
    }
    (void)snprintf(path, size, "%s%s%s", folder, folder[0] != '\0' ? "/" : "", name);
    in->path[in->count++] = path;
    return DIG_OK;
}

static bool is_table(const char *const name)
{
    static const char end[]  = ".sqlite";
    const size_t      length = strlen(name);
    return length > sizeof end - 1 && strcmp(name + length - (sizeof end - 1), end) == 0;
}

// A folder stands for its tables: a shell's list of them has an end.
static enum dig_status add_folder(struct inputs *const in, const char *const folder,
                                  struct dig_error *const error)
{
    DIR *const dir = opendir(folder);
    if (dir == NULL) {
        return dig_error_set(error, DIG_EIO, "%s: %s", folder, strerror(errno));
    }
    const size_t    before = in->count;
    enum dig_status status = DIG_OK;
    for (const struct dirent *entry; status == DIG_OK && (entry = readdir(dir)) != NULL;) {
        if (is_table(entry->d_name)) {
            status = add(in, folder, entry->d_name, error);
        }
    }
    (void)closedir(dir);
    return status == DIG_OK && in->count == before
               ? dig_error_set(error, DIG_EINVAL, "%s: holds no table, expected files NAME.sqlite",
                               folder)
               : status;
}

static enum dig_status gather(const struct dig_arguments *const a, struct inputs *const in,
                              struct dig_error *const error)
{
    enum dig_status status = DIG_OK;
    for (int i = 1; status == DIG_OK && i < a->positionals; i++) {
        struct stat       file;
        const char *const path = a->positional[i];
        if (access(path, R_OK) != 0 || stat(path, &file) != 0) {
            return dig_error_set(error, DIG_EIO, "%s: %s", path, strerror(errno));
        }
        status = S_ISDIR(file.st_mode) ? add_folder(in, path, error) : add(in, "", path, error);
    }
    return status;
}

int dig_cli_merge(const struct dig_arguments *const a)
{
    struct inputs    in     = { .count = 0 };
    struct dig_error error  = { "" };
    enum dig_status  status = gather(a, &in, &error);
    int              code   = EXIT_DONE;
    if (status != DIG_OK) {
        code = dig_cli_bad_input(status, &error);
    } else {
        status = dig_store_merge(a->positional[0], in.count, (const char *const *)in.path, &error);
        code   = status == DIG_OK ? EXIT_DONE : dig_cli_work_failed(status, &error);
    }
    finish(&in);
    return code;
}
