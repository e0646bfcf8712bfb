#include "tables/grounds.h"

#include "core/effect.h"
#include "core/table_step.h"
#include "tables/derive.h"
#include "tables/load.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if defined __GNUC__ && !defined __clang__
// GCC 12's analyzer takes what calloc() returned for uninitialised.
#pragma GCC diagnostic ignored "-Wanalyzer-use-of-uninitialized-value"
#endif

#define GROUNDS_MAX  1000000
#define PACKINGS_MAX 1000000

// Of the curve's own rms, where no entry of the table has a second packing: about what one dig
// differs from the mean in the reference digs (relative L2 of two runs .13 to .35, over root two).
#define SPREAD_WITHOUT_PACKINGS 0.2

#define PLAINLY "depth = 1 AND attack_rad = 0"

// An effect's place among those of core/effect.h; 0: none of them.
#define LISTED(id, name) #name ","
#define EFFECT_PLACE                                                                               \
    "instr('," DIG_EFFECTS_OF_MACHINE(LISTED)                                                      \
        DIG_EFFECTS_OF_SOIL(LISTED) "unlisted,', ',' || effect || ',')"

static const char *where_of(const enum dig_grounds_kind kind)
{
    switch (kind) {
    case DIG_GROUNDS_PLAIN: return "effect = '' AND " PLAINLY;
    case DIG_GROUNDS_VARIED: return "effect <> '' AND " PLAINLY;
    case DIG_GROUNDS_APPROACHED: return "effect = '' AND NOT (" PLAINLY ")";
    case DIG_GROUNDS_ALL: break;
    }
    return "1";
}

static sqlite3_stmt *prepare(struct dig_db *const db, const enum dig_grounds_kind kind,
                             const char *const columns, const char *const from,
                             const char *const order)
{
    char sql[800];
    (void)snprintf(sql, sizeof sql, "SELECT %s FROM %s WHERE %s %s", columns, from, where_of(kind),
                   order);
    return dig_sql_prepare(db, sql);
}

static size_t count_rows(struct dig_db *const db, const enum dig_grounds_kind kind)
{
    sqlite3_stmt *const s    = prepare(db, kind, "count(*)", "ground", "");
    const sqlite3_int64 rows = dig_sql_row(db, s) ? sqlite3_column_int64(s, 0) : 0;
    if (rows > GROUNDS_MAX) {
        dig_db_fail(db, DIG_EINVAL, "ground: more than %d rows", GROUNDS_MAX);
    }
    (void)sqlite3_finalize(s);
    return (size_t)rows;
}

struct dig_entry_set *dig_grounds_create(const struct dig_table_head *const head,
                                         const size_t                       entries)
{
    const size_t                size = entries * head->trajectories;
    struct dig_entry_set *const made = calloc(1, sizeof *made);
    if (made == NULL) {
        return NULL;
    }
    memcpy(made->scene_hash, head->scene_hash, sizeof made->scene_hash);
    memcpy(made->depth_m, head->depth_m, sizeof made->depth_m);
    made->trajectories = head->trajectories;
    made->entries      = entries;
    made->entry        = calloc(entries + 1, sizeof *made->entry);
    made->packings     = calloc(size + 1, sizeof *made->packings);
    made->curve        = calloc(size + 1, sizeof *made->curve);
    if (made->entry == NULL || made->packings == NULL || made->curve == NULL) {
        dig_entry_set_destroy(made);
        return NULL;
    }
    return made;
}

static void read_ground(struct dig_db *const db, sqlite3_stmt *const s,
                        struct dig_entry *const entry)
{
    entry->ground = sqlite3_column_int64(s, 0);
    for (int a = 0; a < DIG_AXES; a++) {
        const double value     = sqlite3_column_double(s, a + 1);
        entry->gravel.value[a] = value;
        if (!isfinite(value) || value < 0.0) {
            dig_db_fail(db, DIG_EINVAL, "ground.%s: %g, expected >= 0",
                        dig_axis_name((enum dig_axis)a), value);
        }
    }
    const char *const text   = (const char *)sqlite3_column_text(s, DIG_AXES + 1);
    const char *const effect = text != NULL ? text : "";
    const int         found  = effect[0] != '\0' ? dig_effect_find(effect) : DIG_EFFECTS;
    entry->magnitude         = sqlite3_column_double(s, DIG_AXES + 2);
    if (text == NULL || found < 0 || !isfinite(entry->magnitude)) {
        dig_db_fail(db, DIG_EINVAL,
                    "ground.effect: \"%.40s\" of magnitude %g, expected an effect this program "
                    "knows, of a finite one",
                    effect, entry->magnitude);
    }
    entry->effect   = (enum dig_effect_id)found;
    entry->approach = (struct dig_approach){ sqlite3_column_double(s, DIG_AXES + 3),
                                             sqlite3_column_double(s, DIG_AXES + 4) };
    if (!(entry->approach.depth > 0.0) || !isfinite(entry->approach.attack_rad)) {
        dig_db_fail(db, DIG_EINVAL, "ground.depth: %g, attack_rad: %g, expected > 0, and finite",
                    entry->approach.depth, entry->approach.attack_rad);
    }
}

static void read_grounds(struct dig_db *const db, const enum dig_grounds_kind kind,
                         struct dig_entry_set *const into)
{
    sqlite3_stmt *const s = prepare(
        db, kind, "id, friction, rolling, density_kgpm3, effect, magnitude, depth, attack_rad",
        "ground",
        "ORDER BY " EFFECT_PLACE
        ", friction, rolling, density_kgpm3, magnitude, depth, attack_rad");
    for (size_t i = 0; db->status == DIG_OK && i < into->entries; i++) {
        if (!dig_sql_row(db, s)) {
            dig_db_fail(db, DIG_EINVAL, "ground: fewer rows than counted");
        }
        read_ground(db, s, &into->entry[i]);
    }
    (void)sqlite3_finalize(s);
}

static size_t index_of(const struct dig_entry_set *const g, const sqlite3_int64 id)
{
    size_t i = 0;
    while (i < g->entries && g->entry[i].ground != id) {
        i++;
    }
    return i;
}

// One blob of DIG_CHANNELS x DIG_CURVE_POINTS numbers.
static bool read_blob(sqlite3_stmt *const s, const int column, float *const into)
{
    enum { NUMBERS = DIG_CHANNELS * DIG_CURVE_POINTS };
    const uint8_t *const bytes = sqlite3_column_blob(s, column);
    if (bytes == NULL || sqlite3_column_bytes(s, column) != NUMBERS * 4) {
        return false;
    }
    dig_floats_unpack(NUMBERS, bytes, into);
    return dig_channels_sound(DIG_CURVE_POINTS, into);
}

static void read_entry(struct dig_db *const db, sqlite3_stmt *const s,
                       struct dig_entry_set *const g, size_t *const hint)
{
    const sqlite3_int64 ground     = sqlite3_column_int64(s, 0);
    const sqlite3_int64 trajectory = sqlite3_column_int64(s, 1);
    const sqlite3_int64 packings   = sqlite3_column_int64(s, 2);
    // Rows come in the order the grounds were made, which is seldom far from ours.
    const size_t at =
        *hint < g->entries && g->entry[*hint].ground == ground ? *hint : index_of(g, ground);
    *hint = at;
    if (at >= g->entries || trajectory < 0 || trajectory >= (sqlite3_int64)g->trajectories ||
        packings < 1 || packings > PACKINGS_MAX) {
        dig_db_fail(db, DIG_EINVAL,
                    "entry: expected a ground and a trajectory of the table, packings 1 to %d",
                    PACKINGS_MAX);
        return;
    }
    const size_t            entry = at * g->trajectories + (size_t)trajectory;
    struct dig_curve *const curve = &g->curve[entry];
    if (!read_blob(s, 3, &curve->mean[0][0]) ||
        (packings > 1 && !read_blob(s, 4, &curve->sd[0][0]))) {
        dig_db_fail(db, DIG_EINVAL, "entry.mean, entry.spread: expected %d finite float32 each",
                    DIG_CHANNELS * DIG_CURVE_POINTS);
    }
    g->packings[entry] = (int)packings;
}

static void read_entries(struct dig_db *const db, const enum dig_grounds_kind kind,
                         struct dig_entry_set *const into)
{
    size_t              hint = 0;
    sqlite3_stmt *const s =
        prepare(db, kind, "ground, trajectory, packings, mean, spread",
                "entry JOIN ground g ON g.id = entry.ground", "ORDER BY ground, trajectory");
    while (dig_sql_row(db, s)) {
        read_entry(db, s, into, &hint);
    }
    (void)sqlite3_finalize(s);
}

struct dig_entry_set *dig_grounds_load(struct dig_db *const               db,
                                       const struct dig_table_head *const head,
                                       const enum dig_grounds_kind        kind)
{
    const size_t                rows = count_rows(db, kind);
    struct dig_entry_set *const into = db->status == DIG_OK ? dig_grounds_create(head, rows) : NULL;
    if (into == NULL) {
        dig_db_fail(db, DIG_ENOMEM, "no memory for the table");
        return NULL;
    }
    read_grounds(db, kind, into);
    read_entries(db, kind, into);
    if (db->status != DIG_OK) {
        dig_entry_set_destroy(into);
        return NULL;
    }
    return into;
}

struct dig_table_step dig_grounds_step(const struct dig_entry_set *const  grounds,
                                       const struct dig_table_head *const head)
{
    double lightest_kgpm3 = INFINITY;
    for (size_t i = 0; i < grounds->entries; i++) {
        lightest_kgpm3 =
            fmin(lightest_kgpm3, grounds->entry[i].gravel.value[DIG_AXIS_DENSITY_kgpm3]);
    }
    return dig_table_step_of(&head->finest, head->normal, lightest_kgpm3, head->time_step_s);
}

void dig_entry_set_destroy(struct dig_entry_set *const set)
{
    if (set != NULL) {
        free(set->entry);
        free(set->packings);
        free(set->curve);
        free(set);
    }
}

// Variances at each point, relative to the curve's mean square, times their degrees of freedom.
struct pool {
    double variance[DIG_CURVE_POINTS];
    double freedom;
};

static void add_channel(const struct dig_entry_set *const g, const size_t trajectory,
                        const size_t c, struct pool *const pool)
{
    for (size_t e = 0; e < g->entries; e++) {
        const size_t                  at    = e * g->trajectories + trajectory;
        const struct dig_curve *const curve = &g->curve[at];
        const double                  scale = dig_curve_mean_square(curve->mean[c]);
        if (g->packings[at] < 2 || !(scale > 0.0)) {
            continue;
        }
        const double weight = (double)(g->packings[at] - 1);
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double sd = (double)curve->sd[c][k];
            pool->variance[k] += weight * sd * sd / scale;
        }
        pool->freedom += weight;
    }
}

static void spread_channel(struct dig_entry_set *const g, const size_t trajectory, const size_t c,
                           const struct pool *const pool)
{
    for (size_t e = 0; e < g->entries; e++) {
        const size_t            at    = e * g->trajectories + trajectory;
        struct dig_curve *const curve = &g->curve[at];
        if (g->packings[at] != 1) {
            continue;
        }
        const double rms = sqrt(dig_curve_mean_square(curve->mean[c]));
        for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
            const double relative = pool->freedom > 0.0 ? sqrt(pool->variance[k] / pool->freedom)
                                                        : SPREAD_WITHOUT_PACKINGS;
            curve->sd[c][k]       = (float)(relative * rms);
        }
    }
}

void dig_grounds_pool_spread(const struct dig_entry_set *const others,
                             struct dig_entry_set *const       grounds)
{
    for (size_t t = 0; t < grounds->trajectories; t++) {
        for (size_t c = 0; c < DIG_CHANNELS; c++) {
            struct pool pool = { .freedom = 0.0 };
            add_channel(grounds, t, c, &pool);
            if (others != NULL) {
                add_channel(others, t, c, &pool);
            }
            spread_channel(grounds, t, c, &pool);
        }
    }
}
