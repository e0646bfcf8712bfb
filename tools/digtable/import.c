// digtable import: stores digs of another program in a table.

#include "core/text.h"
#include "files/curves_csv.h"
#include "files/scene_yaml.h"
#include "tables/store.h"
#include "tools/digtable/commands.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

struct import {
    const char                 *path;
    const struct dig_scene     *scene;
    const struct dig_curve_map *map;
    struct dig_store           *store;
    size_t                      digs;
};

static enum dig_status put(const struct import *const          import,
                           const struct dig_foreign_dig *const dig, struct dig_error *const error)
{
    const struct dig_trajectory *const t = dig_scene_find(import->scene, dig->trajectory);
    if (t == NULL) {
        return dig_error_set(error, DIG_EINVAL, "trajectory \"%s\", expected one of the scene's",
                             dig->trajectory);
    }
    struct dig_trajectory dug;
    if (dig_approach_make(import->scene, t, &dig->approach, &dug, error) != DIG_OK) {
        return DIG_EINVAL;
    }
    struct dig_run_origin origin = {
        .gravel     = dig->gravel,
        .approach   = dig->approach,
        .packing    = dig->packing,
        .trajectory = (size_t)(t - import->scene->trajectory),
    };
    (void)snprintf(origin.engine, sizeof origin.engine, "%.39s", import->map->engine);
    (void)snprintf(origin.version, sizeof origin.version, "%.39s", import->map->version);
    dig_text_utc(time(NULL), sizeof origin.made_utc, origin.made_utc);
    return dig_store_put(import->store, &origin, &dig->recording, error);
}

static enum dig_status store_dig(void *const context, const struct dig_foreign_dig *const dig,
                                 struct dig_error *const error)
{
    struct import *const  import = context;
    const enum dig_status status = put(import, dig, error);
    import->digs += status == DIG_OK ? 1 : 0;
    return dig_error_name(error, status, "%s:%zu", import->path, dig->line);
}

int dig_cli_import(const struct dig_arguments *const a)
{
    if (a->output == NULL || a->map == NULL) {
        return dig_cli_bad_usage(a, "import: %s missing",
                                 a->map == NULL ? "--map MAP.yaml" : "-o TABLE.sqlite");
    }
    struct dig_error     error = { "" };
    struct dig_scene     scene;
    struct dig_curve_map map;
    enum dig_status      status = dig_curve_map_read(a->map, &map, &error);
    if (status == DIG_OK) {
        status = dig_scene_read(map.scene, &scene, &error);
    }
    if (status != DIG_OK) {
        return dig_cli_bad_input(status, &error);
    }
    struct import import = { .path = a->positional[0], .scene = &scene, .map = &map };
    const bool    is_new = access(a->output, F_OK) != 0;
    status               = dig_store_create(a->output, &scene, &import.store, &error);
    if (status != DIG_OK) {
        return dig_cli_work_failed(status, &error);
    }
    const struct dig_foreign_visitor visitor = { store_dig, &import };
    status                                   = dig_store_begin(import.store, &error);
    if (status == DIG_OK) {
        status = dig_curves_read(a->positional[0], &map, &visitor, &error);
    }
    if (status == DIG_OK) {
        status = dig_store_commit(import.store, &error);
    }
    dig_store_close(import.store);
    if (status != DIG_OK) {
        if (is_new) {
            (void)unlink(a->output);
        }
        return dig_cli_work_failed(status, &error);
    }
    if (!a->quiet) {
        dig_text_print(stderr, "%s: %zu digs of %s\n", a->output, import.digs, a->positional[0]);
    }
    return EXIT_DONE;
}
