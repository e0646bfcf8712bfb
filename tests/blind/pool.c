#include "tests/blind/pool.h"

#include "core/effect.h"
#include "core/units.h"
#include "files/recording_csv.h"
#include "tables/store.h"

#include <assert.h>
#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GROUPS_MAX 256

const char *blind_path_name(const enum blind_path path)
{
    static const char *const name[BLIND_PATHS] = { "simpleA", "actual", "simpleB" };
    return name[path];
}

static int path_find(const char *const name)
{
    for (int p = 0; p < BLIND_PATHS; p++) {
        if (strcmp(name, blind_path_name((enum blind_path)p)) == 0) {
            return p;
        }
    }
    return -1;
}

static bool same(const double a, const double b)
{
    return fabs(a - b) <= 1e-6 * (1.0 + fabs(b));
}

static bool alike(const struct blind_group *const a, const struct blind_group *const b)
{
    bool is = strcmp(a->source, b->source) == 0;
    for (int i = 0; i < DIG_AXES; i++) {
        is = is && same(a->gravel.value[i], b->gravel.value[i]);
    }
    return is;
}

// The bed of that packing in the group like *what, made when it is new; NULL when all is full.
static struct blind_bed *bed_of(struct blind_pool *const pool, const struct blind_group *const what,
                                const unsigned packing)
{
    struct blind_group *group = NULL;
    for (size_t g = 0; g < pool->groups && group == NULL; g++) {
        struct blind_group *const at = &pool->group[g];
        if (alike(at, what) && strcmp(at->effect, what->effect) == 0 &&
            same(at->magnitude, what->magnitude)) {
            group = at;
        }
    }
    if (group == NULL) {
        if (pool->groups == GROUPS_MAX) {
            return NULL;
        }
        group  = &pool->group[pool->groups++];
        *group = *what;
    }
    for (size_t b = 0; b < group->beds; b++) {
        if (group->bed[b].packing == packing) {
            return &group->bed[b];
        }
    }
    if (group->beds == BLIND_BEDS_MAX) {
        return NULL;
    }
    struct blind_bed *const bed = &group->bed[group->beds++];
    *bed                        = (struct blind_bed){ .packing = packing };
    return bed;
}

// What LIGGGHTS' digs are made of, by the make.sh of liggghts_digs.
static bool liggghts_gravel(const char *const name, struct blind_group *const group)
{
    static const struct {
        const char       *name, *effect;
        double            magnitude;
        struct dig_gravel gravel;
    } known[] = {
        { "plain", "", 0.0, { { 0.5, 0.5, 2500.0 } } },
        { "poly", "polydispersity", 1.667, { { 0.5, 0.5, 2500.0 } } },
        { "cohesion", "cohesion", 1e5, { { 0.5, 0.5, 2500.0 } } },
        { "cohesion_all", "cohesion", 1.001e5, { { 0.5, 0.5, 2500.0 } } },
        { "cohesion_2e5", "cohesion", 2e5, { { 0.5, 0.5, 2500.0 } } },
        { "obstacle", "obstacle", 0.03, { { 0.5, 0.5, 2500.0 } } },
        { "clump", "grain_shape", 1.5, { { 0.5, 0.5, 2500.0 } } },
        { "other", "", 0.0, { { 0.7, 0.5, 1500.0 } } },
        { "slope_up", "ground_slope", 8.0, { { 0.5, 0.5, 2500.0 } } },
        { "slope_down", "ground_slope", -8.0, { { 0.5, 0.5, 2500.0 } } },
    };
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
        if (strcmp(known[i].name, name) == 0) {
            *group = (struct blind_group){ .source    = "liggghts",
                                           .magnitude = known[i].magnitude,
                                           .gravel    = known[i].gravel };
            (void)snprintf(group->effect, sizeof group->effect, "%s", known[i].effect);
            return true;
        }
    }
    return false;
}

// "mu0.5_mur0.3_rho2500_seed2__actual.csv" or "poly_seed2__actual.csv"; false for any other file.
static bool liggghts_name(const char *const file, struct blind_group *const group,
                          unsigned *const packing, int *const path)
{
    char              trajectory[DIG_NAME_SIZE] = "";
    char              name[64]                  = "";
    struct dig_gravel g;
    int               used = 0;
    *packing               = 1;
    if (sscanf(file, "mu%lf_mur%lf_rho%lf%n", &g.value[0], &g.value[1], &g.value[2], &used) == 3) {
        *group = (struct blind_group){ .source = "liggghts", .gravel = g };
    } else if (sscanf(file, "%63[^.]", name) == 1 && strstr(name, "_seed") != NULL) {
        char *const at = strstr(name, "_seed");
        used           = (int)(at - name);
        *at            = '\0';
        if (!liggghts_gravel(name, group)) {
            return false;
        }
        // Seeds of the two folders are told apart.
        (void)sscanf(file + used, "_seed%u", packing);
        *packing += 100;
    } else {
        return false;
    }
    if (*packing < 100) {
        (void)sscanf(file + used, "_seed%u", packing);
    }
    const char *const two = strstr(file, "__");
    if (two == NULL || sscanf(two, "__%31[A-Za-z].csv", trajectory) != 1) {
        return false;
    }
    *path = path_find(trajectory);
    return *path >= 0;
}

static enum dig_status read_liggghts(const char *const folder, struct blind_pool *const pool,
                                     struct dig_error *const error)
{
    enum dig_status status = DIG_OK;
    DIR *const      dir    = opendir(folder);
    for (struct dirent *e; dir != NULL && status == DIG_OK && (e = readdir(dir)) != NULL;) {
        struct blind_group what;
        unsigned           packing = 1;
        int                path    = -1;
        char               file[2048];
        if (!liggghts_name(e->d_name, &what, &packing, &path)) {
            continue;
        }
        struct blind_bed *const bed = bed_of(pool, &what, packing);
        if (bed == NULL || bed->dig[path].rows > 0) {
            continue;
        }
        (void)snprintf(file, sizeof file, "%s/%s", folder, e->d_name);
        status = dig_recording_read(file, &bed->dig[path], error);
    }
    if (dir != NULL) {
        (void)closedir(dir);
    }
    return status;
}

struct walk {
    struct blind_pool           *pool;
    const struct dig_trajectory *trajectory;
    const char                  *name; // of the file, up to a dash
    double                       magnitude;
};

static enum dig_status take_run(void *const context, const struct dig_run *const run,
                                struct dig_error *const error)
{
    const struct walk *const           walk = context;
    const struct dig_trajectory *const t    = &walk->trajectory[run->origin.trajectory];
    struct blind_group                 what = { .source = "ours", .gravel = run->origin.gravel };
    const int                          path = path_find(t->name);
    // Digs for comparison with LIGGGHTS share their first bed with the table of effects.
    const bool shared = strcmp(walk->name, "ours") == 0 &&
                        (run->origin.packing == 0 || run->origin.effect[0] == '\0');
    if (path < 0 || shared) {
        return DIG_OK;
    }
    if (run->origin.effect[0] != '\0') {
        (void)snprintf(what.effect, sizeof what.effect, "%s", run->origin.effect);
        what.magnitude = run->origin.magnitude;
    } else if (strncmp(walk->name, "plain", 5) != 0) {
        (void)snprintf(what.effect, sizeof what.effect, "%s", walk->name);
        what.outside   = dig_effect_find(what.effect) < 0;
        what.magnitude = walk->magnitude;
    }
    struct blind_bed *const bed = bed_of(walk->pool, &what, (unsigned)run->origin.packing);
    if (bed == NULL || bed->dig[path].rows > 0) {
        return DIG_OK;
    }
    struct dig_force_row *const row = calloc(run->windows, sizeof *row);
    if (row == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    for (size_t i = 0; i < run->windows; i++) {
        const double          t_s  = run->first_s + (double)i * run->step_s;
        const struct dig_pose pose = dig_trajectory_pose(t, t_s);
        row[i]                     = (struct dig_force_row){ .t_s        = t_s,
                                                             .pin_x_m    = pose.x_m,
                                                             .pin_z_m    = pose.z_m,
                                                             .theta_deg  = pose.theta_rad / DIG_RAD_PER_DEG,
                                                             .My_Nm      = (double)run->value[i],
                                                             .Fx_N       = (double)run->value[run->windows + i],
                                                             .Fz_N       = (double)run->value[2 * run->windows + i],
                                                             .carried_kg = (double)NAN };
    }
    bed->dig[path] = (struct dig_recording){ run->windows, row };
    return DIG_OK;
}

static enum dig_status read_table(const char *const folder, const char *const file,
                                  struct blind_pool *const pool, struct dig_error *const error)
{
    char path[2048];
    char name[64];
    (void)snprintf(path, sizeof path, "%s/%s", folder, file);
    (void)snprintf(name, sizeof name, "%s", file);
    const char *const magnitude = strchr(file, '=');
    name[strcspn(name, ".-")]   = '\0';
    struct dig_store *store     = NULL;
    enum dig_status   status    = dig_store_open(path, &store, error);
    if (status != DIG_OK) {
        return status;
    }
    size_t                       count = 0;
    struct walk                  walk  = { pool, dig_store_trajectories(store, &count), name,
                         magnitude != NULL ? strtod(magnitude + 1, NULL) : 1.0 };
    const struct dig_run_visitor by    = { take_run, &walk };
    status                             = dig_store_walk(store, &by, error);
    dig_store_close(store);
    return status;
}

static enum dig_status read_tables(const char *const folder, struct blind_pool *const pool,
                                   struct dig_error *const error)
{
    enum dig_status status = DIG_OK;
    struct dirent **entry  = NULL;
    const int       n      = scandir(folder, &entry, NULL, alphasort);
    for (int i = 0; i < n; i++) {
        const size_t length = strlen(entry[i]->d_name);
        if (status == DIG_OK && length > 7 &&
            strcmp(entry[i]->d_name + length - 7, ".sqlite") == 0) {
            status = read_table(folder, entry[i]->d_name, pool, error);
        }
        free(entry[i]);
    }
    free(entry);
    return status;
}

// Keeps beds dug along the first two paths, in the order of their packings, whatever the folder's
// order.
static void tidy(struct blind_group *const group)
{
    size_t kept = 0;
    for (size_t b = 0; b < group->beds; b++) {
        struct blind_bed *const bed = &group->bed[b];
        if (bed->dig[BLIND_SIMPLE].rows > 0 && bed->dig[BLIND_ACTUAL].rows > 0) {
            const struct blind_bed whole = *bed;
            size_t                 at    = kept++;
            for (; at > 0 && group->bed[at - 1].packing > whole.packing; at--) {
                group->bed[at] = group->bed[at - 1];
            }
            group->bed[at] = whole;
        } else {
            for (int p = 0; p < BLIND_PATHS; p++) {
                dig_recording_finish(&bed->dig[p]);
            }
        }
    }
    group->beds = kept;
}

static int compare(const void *const left, const void *const right)
{
    const struct blind_group *const a = left;
    const struct blind_group *const b = right;

    int order = strcmp(a->source, b->source);
    order     = order == 0 ? strcmp(a->effect, b->effect) : order;
    for (int i = 0; i < DIG_AXES && order == 0; i++) {
        order =
            (a->gravel.value[i] > b->gravel.value[i]) - (a->gravel.value[i] < b->gravel.value[i]);
    }
    return order == 0 ? (a->magnitude > b->magnitude) - (a->magnitude < b->magnitude) : order;
}

enum dig_status blind_pool_read(const char *const data, const bool to_judge,
                                struct blind_pool *const pool, struct dig_error *const error)
{
    char              folder[1024];
    struct blind_pool p = { 0, calloc(GROUPS_MAX, sizeof *p.group) };
    if (p.group == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "out of memory");
    }
    static const char *const of_liggghts[] = { "reference", "liggghts_digs", "liggghts_more" };
    enum dig_status          status        = DIG_OK;
    for (size_t i = 0; i < sizeof of_liggghts / sizeof of_liggghts[0] && status == DIG_OK; i++) {
        (void)snprintf(folder, sizeof folder, "%s/%s", data, of_liggghts[i]);
        status = read_liggghts(folder, &p, error);
    }
    if (status == DIG_OK) {
        (void)snprintf(folder, sizeof folder, "%s/liggghts_digs", data);
        status = read_tables(folder, &p, error);
    }
    if (status == DIG_OK) {
        (void)snprintf(folder, sizeof folder, "%s/blind", data);
        status = read_tables(folder, &p, error);
    }
    if (status == DIG_OK && to_judge) {
        (void)snprintf(folder, sizeof folder, "%s/blind/judge", data);
        status = read_tables(folder, &p, error);
    }
    if (status != DIG_OK) {
        blind_pool_finish(&p);
        return status;
    }
    for (size_t g = 0; g < p.groups; g++) {
        tidy(&p.group[g]);
    }
    qsort(p.group, p.groups, sizeof *p.group, compare);
    *pool = p;
    return DIG_OK;
}

void blind_pool_finish(struct blind_pool *const pool)
{
    for (size_t g = 0; pool->group != NULL && g < pool->groups; g++) {
        for (size_t b = 0; b < pool->group[g].beds; b++) {
            for (int p = 0; p < BLIND_PATHS; p++) {
                dig_recording_finish(&pool->group[g].bed[b].dig[p]);
            }
        }
    }
    free(pool->group);
    *pool = (struct blind_pool){ 0, NULL };
}

bool blind_group_has(const struct blind_group *const group, const enum blind_path path)
{
    bool all = group->beds > 0;
    for (size_t b = 0; b < group->beds; b++) {
        all = all && group->bed[b].dig[path].rows > 0;
    }
    return all;
}

const struct blind_group *blind_pool_plain(const struct blind_pool *const  pool,
                                           const struct blind_group *const like)
{
    for (size_t g = 0; g < pool->groups; g++) {
        if (pool->group[g].effect[0] == '\0' && pool->group[g].beds > 0 &&
            alike(&pool->group[g], like)) {
            return &pool->group[g];
        }
    }
    return NULL;
}
