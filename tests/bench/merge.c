// What `digtable merge` costs by the number of shards: 10, 100, … MOST made tables of DIGS digs
// each (1), as long as a mean dig of tables/reference_rig.sqlite, merged by the product's own code.
// A line each: seconds, milliseconds a shard, the most memory so far, the merged table's size, and
// how long it takes to open it. Processor time: a busy machine disturbs it less.
//
//   merge SCENE.yaml MOST [DIGS [FOLDER]]      FOLDER: 42 kB a shard and 40 kB a dig (/dev/shm)

#include "tables/merge.h"

#include "files/scene_yaml.h"
#include "tables/queue.h"
#include "tables/store.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { WINDOWS = 880, FIRST = 10 };

static double now_s(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// The i-th dig: a gravel of its own, and a curve that is nowhere flat.
static enum dig_status put(struct dig_store *const store, const size_t i,
                           struct dig_error *const error)
{
    static struct dig_force_row row[WINDOWS];
    struct dig_run_origin       origin = {
              .gravel = { { .01 * (double)(i % 100), .01 * (double)(i / 100 % 100),
                            1000.0 + 10.0 * (double)(i / 10000) } },
              .grains = 7000,
              .wall_s = 1.0,
    };
    origin.seed = dig_bed_seed(&origin.gravel, 0);
    (void)snprintf(origin.engine, sizeof origin.engine, "bench");
    (void)snprintf(origin.version, sizeof origin.version, "1");
    (void)snprintf(origin.made_utc, sizeof origin.made_utc, "2026-01-01T00:00:00Z");
    for (size_t k = 0; k < WINDOWS; k++) {
        const double t_s = 0.005 * (double)k;
        const double my  = sin(1.3 * t_s + 0.001 * (double)i) + 0.1 * sin(97.0 * t_s);
        row[k]           = (struct dig_force_row){
                      .t_s = t_s, .Fx_N = 9.0 * my, .Fz_N = -4.0 * my, .My_Nm = my, .carried_kg = 0.1 * t_s
        };
    }
    const struct dig_recording recording = { .rows = WINDOWS, .row = row };
    return dig_store_put(store, &origin, &recording, error);
}

static enum dig_status make(const struct dig_scene *const scene, const char *const path,
                            const size_t first, const size_t digs, struct dig_error *const error)
{
    struct dig_store *store  = NULL;
    enum dig_status   status = dig_store_create(path, scene, &store, error);
    for (size_t i = 0; status == DIG_OK && i < digs; i++) {
        status = put(store, first + i, error);
    }
    dig_store_close(store);
    return status;
}

static enum dig_status merge(const char *const folder, const size_t shards, char *const path[],
                             struct dig_error *const error)
{
    char out[512];
    (void)snprintf(out, sizeof out, "%s/merged.sqlite", folder);
    const double          from_s = now_s();
    const enum dig_status status = dig_store_merge(out, shards, (const char *const *)path, error);
    const double          took_s = now_s() - from_s;
    struct rusage         used;
    struct stat           file  = { .st_size = 0 };
    struct dig_store     *store = NULL;
    if (status != DIG_OK || getrusage(RUSAGE_SELF, &used) != 0 || stat(out, &file) != 0) {
        return status;
    }
    const double          opened_s = now_s();
    const enum dig_status open     = dig_store_open(out, &store, error);
    dig_store_close(store);
    (void)printf("merge of %zu shards: %.2f s, %.3f ms a shard, %.0f MB of memory, a table of %.1f "
                 "MB, opened in %.2f s\n",
                 shards, took_s, 1e3 * took_s / (double)shards, (double)used.ru_maxrss / 1e3,
                 (double)file.st_size / 1e6, now_s() - opened_s);
    (void)fflush(stdout);
    (void)unlink(out);
    return open;
}

static enum dig_status run(const char *const scene_path, const size_t most, const size_t digs,
                           const char *const folder, char *path[const],
                           struct dig_error *const error)
{
    struct dig_scene scene;
    enum dig_status  status = dig_scene_read(scene_path, &scene, error);
    const double     from_s = now_s();
    size_t           made   = 0;
    double           make_s = 0.0;
    for (size_t shards = FIRST; status == DIG_OK && shards <= most; shards *= 10) {
        const double begun_s = now_s();
        for (; status == DIG_OK && made < shards; made++) {
            char name[600];
            (void)snprintf(name, sizeof name, "%s/%zu.sqlite", folder, made + 1);
            path[made] = strdup(name);
            status     = make(&scene, name, made * digs, digs, error);
        }
        make_s += now_s() - begun_s;
        if (status == DIG_OK) {
            status = merge(folder, shards, path, error);
        }
    }
    (void)printf("made %zu shards of %zu digs at %.2f ms a dig; %.0f s in all\n", made, digs,
                 1e3 * make_s / (double)(made * digs), now_s() - from_s);
    for (size_t i = 0; i < made; i++) {
        (void)unlink(path[i]);
        free(path[i]);
    }
    return status;
}

int main(const int argc, char **const argv)
{
    const size_t digs = argc > 3 ? strtoul(argv[3], NULL, 10) : 1;
    if (argc < 3 || argc > 5 || digs < 1 || strtoul(argv[2], NULL, 10) < FIRST) {
        (void)fprintf(stderr, "usage: merge SCENE.yaml MOST [DIGS [FOLDER]], MOST at least %d\n",
                      FIRST);
        return 2;
    }
    const size_t most = strtoul(argv[2], NULL, 10);
    char         folder[256];
    (void)snprintf(folder, sizeof folder, "%s/dig_merge_XXXXXX", argc > 4 ? argv[4] : "/dev/shm");
    char **const path = calloc(most, sizeof *path);
    if (path == NULL || mkdtemp(folder) == NULL) {
        (void)fprintf(stderr, "merge: cannot make a folder like %s\n", folder);
        free(path);
        return 1;
    }
    struct dig_error      error  = { "" };
    const enum dig_status status = run(argv[1], most, digs, folder, path, &error);
    if (status != DIG_OK) {
        (void)fprintf(stderr, "merge: %s\n", error.text);
    }
    (void)rmdir(folder);
    free(path);
    return status == DIG_OK ? 0 : 1;
}
