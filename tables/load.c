#include "tables/load.h"

#include "tables/store_private.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#if defined __GNUC__ && !defined __clang__
// GCC 12's analyzer takes what calloc() returned for uninitialised, and loses sight of set->cell.
#pragma GCC diagnostic ignored "-Wanalyzer-use-of-uninitialized-value"
#pragma GCC diagnostic ignored "-Wanalyzer-malloc-leak"
#endif

#define ENTRIES_MAX 1000000
#define CELLS_MAX   10000000

// Of the curve's own rms, where no entry of the table has a second packing: about what one dig
// differs from the mean in the reference digs (relative L2 of two runs .13 to .35, over root two).
#define SPREAD_WITHOUT_PACKINGS 0.2

struct loader {
    const char           *path;
    sqlite3              *db;
    struct dig_error     *error;
    struct dig_curve_set *set;
    sqlite3_int64        *id; // [entries], the gravels' keys, ascending by axis
};

static enum dig_status refuse_row(const struct loader *const l, const char *const what)
{
    return dig_error_set(l->error, DIG_EINVAL, "%s: %s", l->path, what);
}

static enum dig_status no_memory(const struct loader *const l)
{
    (void)dig_error_set(l->error, DIG_ENOMEM, "%s: no memory for the table", l->path);
    return DIG_ENOMEM;
}

static enum dig_status count_rows(const struct loader *const l, size_t *const rows)
{
    sqlite3_stmt   *s      = NULL;
    enum dig_status status = DIG_OK;
    if (sqlite3_prepare_v2(l->db, "SELECT count(*) FROM gravel", -1, &s, NULL) != SQLITE_OK ||
        sqlite3_step(s) != SQLITE_ROW) {
        status = dig_sql_refuse(l->db, l->path, l->error);
    } else if (sqlite3_column_int64(s, 0) < 1 || sqlite3_column_int64(s, 0) > ENTRIES_MAX) {
        status = refuse_row(l, "gravel: no rows, expected at least one entry (is it generated?)");
    } else {
        *rows = (size_t)sqlite3_column_int64(s, 0);
    }
    (void)sqlite3_finalize(s);
    return status;
}

static enum dig_status allocate(struct loader *const l)
{
    struct dig_curve_set *const set  = l->set;
    const size_t                size = set->entries * set->trajectories;
    set->gravel                      = calloc(set->entries, sizeof *set->gravel);
    set->packings                    = calloc(size, sizeof *set->packings);
    set->curve                       = calloc(size, sizeof *set->curve);
    l->id                            = calloc(set->entries, sizeof *l->id);
    for (int a = 0; a < DIG_AXES; a++) {
        set->axis[a] = calloc(set->entries, sizeof *set->axis[a]);
        if (set->axis[a] == NULL) {
            return no_memory(l);
        }
    }
    return set->gravel != NULL && set->packings != NULL && set->curve != NULL && l->id != NULL
               ? DIG_OK
               : no_memory(l);
}

static enum dig_status read_gravels(struct loader *const l)
{
    sqlite3_stmt *s = NULL;
    if (sqlite3_prepare_v2(l->db,
                           "SELECT id, friction, rolling, density_kgpm3 FROM gravel ORDER BY "
                           "friction, rolling, density_kgpm3",
                           -1, &s, NULL) != SQLITE_OK) {
        return dig_sql_refuse(l->db, l->path, l->error);
    }
    enum dig_status status = DIG_OK;
    int             step   = SQLITE_DONE;
    size_t          i      = 0;
    for (; i < l->set->entries && (step = sqlite3_step(s)) == SQLITE_ROW; i++) {
        l->id[i] = sqlite3_column_int64(s, 0);
        for (int a = 0; a < DIG_AXES; a++) {
            const double value         = sqlite3_column_double(s, a + 1);
            l->set->gravel[i].value[a] = value;
            l->set->axis[a][i]         = value;
            if (!isfinite(value) || value < 0.0) {
                status = dig_error_set(l->error, DIG_EINVAL, "%s: gravel.%s: %g, expected >= 0",
                                       l->path, dig_axis_name((enum dig_axis)a), value);
            }
        }
    }
    if (status == DIG_OK && i < l->set->entries) {
        status = step == SQLITE_DONE ? refuse_row(l, "gravel: fewer rows than counted")
                                     : dig_sql_refuse(l->db, l->path, l->error);
    }
    (void)sqlite3_finalize(s);
    return status;
}

static size_t index_of(const struct loader *const l, const sqlite3_int64 id)
{
    size_t i = 0;
    while (i < l->set->entries && l->id[i] != id) {
        i++;
    }
    return i;
}

// One blob of DIG_CHANNELS x DIG_CURVE_POINTS numbers.
static bool read_blob(sqlite3_stmt *const s, const int column, float *const into)
{
    enum { NUMBERS = DIG_CHANNELS * DIG_CURVE_POINTS };
    const uint8_t *const bytes = sqlite3_column_blob(s, column);
    return bytes != NULL && sqlite3_column_bytes(s, column) == NUMBERS * 4 &&
           dig_floats_unpack(NUMBERS, bytes, into);
}

static enum dig_status read_entry(struct loader *const l, sqlite3_stmt *const s, size_t *const hint)
{
    struct dig_curve_set *const set        = l->set;
    const sqlite3_int64         gravel     = sqlite3_column_int64(s, 0);
    const sqlite3_int64         trajectory = sqlite3_column_int64(s, 1);
    const int                   packings   = sqlite3_column_int(s, 2);

    // Rows come in the order the gravels were made, which is seldom far from the axes' order.
    const size_t at = *hint < set->entries && l->id[*hint] == gravel ? *hint : index_of(l, gravel);
    *hint           = at;
    if (at >= set->entries || trajectory < 0 || trajectory >= (sqlite3_int64)set->trajectories ||
        packings < 1) {
        return refuse_row(l,
                          "entry: expected a gravel and a trajectory of the table, packings > 0");
    }
    const size_t            entry = at * set->trajectories + (size_t)trajectory;
    struct dig_curve *const curve = &set->curve[entry];
    if (!read_blob(s, 3, &curve->mean[0][0]) ||
        (packings > 1 && !read_blob(s, 4, &curve->sd[0][0]))) {
        return dig_error_set(l->error, DIG_EINVAL,
                             "%s: entry.mean, entry.spread: expected %d finite float32 each",
                             l->path, DIG_CHANNELS * DIG_CURVE_POINTS);
    }
    set->packings[entry] = packings;
    return DIG_OK;
}

static enum dig_status read_entries(struct loader *const l)
{
    sqlite3_stmt *s = NULL;
    if (sqlite3_prepare_v2(l->db,
                           "SELECT gravel, trajectory, packings, mean, spread FROM entry ORDER BY "
                           "gravel, trajectory",
                           -1, &s, NULL) != SQLITE_OK) {
        return dig_sql_refuse(l->db, l->path, l->error);
    }
    enum dig_status status = DIG_OK;
    int             step   = SQLITE_DONE;
    size_t          hint   = 0;
    while (status == DIG_OK && (step = sqlite3_step(s)) == SQLITE_ROW) {
        status = read_entry(l, s, &hint);
    }
    if (status == DIG_OK && step != SQLITE_DONE) {
        status = dig_sql_refuse(l->db, l->path, l->error);
    }
    (void)sqlite3_finalize(s);
    return status;
}

static int compare(const void *const a, const void *const b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

// The sorted different values of one axis, and where each gravel stands among them.
static void build_axis(struct dig_curve_set *const set, const int a)
{
    double *const axis = set->axis[a];
    qsort(axis, set->entries, sizeof *axis, compare);
    size_t count = 0;
    for (size_t i = 0; i < set->entries; i++) {
        if (count == 0 || axis[i] > axis[count - 1]) {
            axis[count++] = axis[i];
        }
    }
    set->axis_count[a] = count;
}

static size_t place_on(const struct dig_curve_set *const set, const int a, const double value)
{
    size_t i = 0;
    while (set->axis[a][i] < value) {
        i++;
    }
    return i;
}

static enum dig_status build_grid(struct loader *const l)
{
    struct dig_curve_set *const set   = l->set;
    size_t                      cells = 1;
    for (int a = 0; a < DIG_AXES; a++) {
        build_axis(set, a);
        cells *= set->axis_count[a];
        if (cells > CELLS_MAX) {
            return refuse_row(l, "gravel: the values do not form a grid");
        }
    }
    set->cell = malloc(cells * sizeof *set->cell);
    if (set->cell == NULL) {
        return no_memory(l);
    }
    for (size_t i = 0; i < cells; i++) {
        set->cell[i] = -1;
    }
    for (size_t i = 0; i < set->entries; i++) {
        size_t at = 0;
        for (int a = 0; a < DIG_AXES; a++) {
            at = at * set->axis_count[a] + place_on(set, a, set->gravel[i].value[a]);
        }
        set->cell[at] = (int)i;
    }
    return DIG_OK;
}

static double mean_square(const float y[const DIG_CURVE_POINTS])
{
    double sum = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        sum += (double)y[k] * (double)y[k];
    }
    return sum / DIG_CURVE_POINTS;
}

// Entries with one packing take the spread the others have at the same point of the path, relative
// to the curve's rms: variances pooled by their degrees of freedom.
static void fill_spread(struct dig_curve_set *const set, const size_t trajectory, const size_t c)
{
    double variance[DIG_CURVE_POINTS] = { 0.0 };
    double freedom                    = 0.0;
    for (size_t e = 0; e < set->entries; e++) {
        const size_t                  at    = e * set->trajectories + trajectory;
        const struct dig_curve *const curve = &set->curve[at];
        const double                  scale = mean_square(curve->mean[c]);
        if (set->packings[at] < 2 || !(scale > 0.0)) {
            continue;
        }
        const double weight = (double)(set->packings[at] - 1);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double sd = (double)curve->sd[c][k];
            variance[k] += weight * sd * sd / scale;
        }
        freedom += weight;
    }
    for (size_t e = 0; e < set->entries; e++) {
        const size_t            at    = e * set->trajectories + trajectory;
        struct dig_curve *const curve = &set->curve[at];
        if (set->packings[at] != 1) {
            continue;
        }
        const double rms = sqrt(mean_square(curve->mean[c]));
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double relative =
                freedom > 0.0 ? sqrt(variance[k] / freedom) : SPREAD_WITHOUT_PACKINGS;
            curve->sd[c][k] = (float)(relative * rms);
        }
    }
}

static void copy_head(struct dig_curve_set *const set, const struct dig_table_head *const head)
{
    memcpy(set->scene_name, head->scene_name, sizeof set->scene_name);
    memcpy(set->scene_hash, head->scene_hash, sizeof set->scene_hash);
    memcpy(set->trajectory, head->trajectory, sizeof set->trajectory);
    set->tooth_m        = head->tooth_m;
    set->bucket_width_m = head->bucket_width_m;
    set->young_Pa       = head->young_Pa;
    set->smooth_half_s  = head->smooth_half_s;
    set->trajectories   = head->trajectories;
}

static enum dig_status load(struct loader *const l)
{
    enum dig_status status = count_rows(l, &l->set->entries);
    if (status == DIG_OK) {
        status = allocate(l);
    }
    if (status == DIG_OK) {
        status = read_gravels(l);
    }
    if (status == DIG_OK) {
        status = read_entries(l);
    }
    if (status == DIG_OK) {
        status = build_grid(l);
    }
    for (size_t t = 0; status == DIG_OK && t < l->set->trajectories; t++) {
        for (size_t c = 0; c < DIG_CHANNELS; c++) {
            fill_spread(l->set, t, c);
        }
    }
    return status;
}

enum dig_status dig_sql_load(sqlite3 *const db, const char *const path,
                             const struct dig_table_head *const head,
                             struct dig_curve_set **const set, struct dig_error *const error)
{
    struct loader l = { .path = path, .db = db, .error = error };
    l.set           = calloc(1, sizeof *l.set);
    if (l.set == NULL) {
        return no_memory(&l);
    }
    copy_head(l.set, head);
    const enum dig_status status = load(&l);
    free(l.id);
    if (status != DIG_OK) {
        dig_curve_set_destroy(l.set);
        return status;
    }
    *set = l.set;
    return DIG_OK;
}

enum dig_status dig_table_load(const char *const path, struct dig_curve_set **const set,
                               struct dig_error *const error)
{
    assert(path != NULL && set != NULL);

    sqlite3              *db     = NULL;
    struct dig_table_head head   = { .trajectories = 0 };
    enum dig_status       status = dig_sql_open_read(path, &db, &head, error);
    if (status != DIG_OK) {
        return status;
    }
    // One transaction, so that a writer's commit cannot fall between two statements.
    status = dig_sql_run(db, path, "BEGIN", error);
    if (status == DIG_OK) {
        status = dig_sql_load(db, path, &head, set, error);
    }
    (void)sqlite3_close(db);
    return status;
}

void dig_curve_set_destroy(struct dig_curve_set *const set)
{
    if (set != NULL) {
        free(set->gravel);
        free(set->packings);
        free(set->curve);
        for (int a = 0; a < DIG_AXES; a++) {
            free(set->axis[a]);
        }
        free(set->cell);
        free(set);
    }
}
