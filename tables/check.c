// Checks the derived rows of a table against its runs.

#include "core/sort.h"
#include "tables/grounds.h"
#include "tables/load.h"
#include "tables/store.h"
#include "tables/store_private.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// Of the curve's largest value: another compiler may round the last bits otherwise.
#define AGREE_RELATIVE 1e-5

// a and b hold DIG_CHANNELS curves each. What is not known must be so in both.
static bool agree(const float a[], const float b[])
{
    for (size_t c = 0; c < DIG_CHANNELS; c++) {
        double most = 0.0;
        double off  = 0.0;
        for (size_t i = c * DIG_CURVE_POINTS; i < (c + 1) * DIG_CURVE_POINTS; i++) {
            if (isnan(a[i]) != isnan(b[i])) {
                return false;
            }
            most = fmax(most, fabs((double)b[i]));
            off  = fmax(off, fabs((double)a[i] - (double)b[i]));
        }
        if (!(off <= AGREE_RELATIVE * most)) {
            return false;
        }
    }
    return true;
}

// Room for one entry computed anew.
struct scratch {
    struct dig_ensemble ensemble;
    struct dig_curve    curve;
};

static void check_entry(struct dig_store *const store, const struct dig_entry_set *const all,
                        const size_t ground, const size_t trajectory, struct scratch *const scratch)
{
    const size_t                  at = ground * all->trajectories + trajectory;
    const struct dig_entry *const g  = &all->entry[ground];
    dig_entry_derive(store, g->ground, trajectory, &scratch->ensemble);
    const size_t runs = scratch->ensemble.packings;
    dig_ensemble_curve(&scratch->ensemble, &scratch->curve);
    const struct dig_curve *const stored = &all->curve[at];
    const struct dig_curve *const actual = &scratch->curve;
    const bool                    same   = (size_t)all->packings[at] == runs &&
                      (runs == 0 || agree(&stored->mean[0][0], &actual->mean[0][0])) &&
                      (runs < 2 || agree(&stored->sd[0][0], &actual->sd[0][0]));
    if (!same) {
        struct dig_run_origin origin = { .gravel     = g->gravel,
                                         .approach   = g->approach,
                                         .trajectory = trajectory };
        char                  text[DIG_RUN_TEXT_SIZE];
        if (g->effect != DIG_EFFECTS) {
            (void)snprintf(origin.effect, sizeof origin.effect, "%s", dig_effect_name(g->effect));
        }
        dig_run_text(store, &origin, text);
        dig_db_fail(&store->db, DIG_EINVAL,
                    "entry: %s: of %d packings, differs from its %zu runs, expected their mean and "
                    "spread; digtable merge into a new table makes them anew",
                    text, all->packings[at], runs);
    }
}

// Entries are compared with those of their kind: plain, with an effect, or dug another way.
enum kind { KIND_PLAIN, KIND_VARIED, KIND_APPROACHED, KINDS };

static enum kind kind_of(const struct dig_entry_set *const all, const size_t ground)
{
    if (all->entry[ground].effect != DIG_EFFECTS) {
        return KIND_VARIED;
    }
    return dig_approach_is_plain(&all->entry[ground].approach) ? KIND_PLAIN : KIND_APPROACHED;
}

// The number of packings that most entries of the kind have; of two as frequent, the larger. There
// is room for every entry's.
static int usual_packings(const struct dig_entry_set *const all, const enum kind kind,
                          double packings[])
{
    size_t n = 0;
    for (size_t i = 0; i < all->entries * all->trajectories; i++) {
        if (all->packings[i] > 0 && kind_of(all, i / all->trajectories) == kind) {
            packings[n++] = all->packings[i];
        }
    }
    dig_sort(n, packings);
    int    usual = 0;
    size_t best  = 0;
    for (size_t i = 0, first = 0; i < n; i++) {
        first = packings[i] > packings[first] ? i : first;
        if (i - first + 1 >= best) {
            usual = (int)packings[i];
            best  = i - first + 1;
        }
    }
    return usual;
}

// packings[] is room for every entry's.
static void count_entries(const struct dig_entry_set *const all, double packings[],
                          struct dig_store_report *const report)
{
    bool used[KINDS][DIG_TRAJECTORY_MAX] = { { false } };
    int  usual[KINDS];
    for (int kind = 0; kind < KINDS; kind++) {
        usual[kind] = usual_packings(all, (enum kind)kind, packings);
    }
    for (size_t i = 0; i < all->entries * all->trajectories; i++) {
        report->entries += all->packings[i] > 0 ? 1 : 0;
        report->runs += (size_t)all->packings[i];
        used[kind_of(all, i / all->trajectories)][i % all->trajectories] |= all->packings[i] > 0;
    }
    // A trajectory no ground was dug with is not missing: the grid did not ask for it.
    for (size_t i = 0; i < all->entries * all->trajectories; i++) {
        const enum kind kind = kind_of(all, i / all->trajectories);
        report->incomplete +=
            used[kind][i % all->trajectories] && all->packings[i] < usual[kind] ? 1 : 0;
    }
    for (size_t g = 0; g < all->entries; g++) {
        const enum kind kind = kind_of(all, g);
        report->points += kind == KIND_PLAIN ? 1 : 0;
        report->effects += kind == KIND_VARIED ? 1 : 0;
        report->approaches += kind == KIND_APPROACHED ? 1 : 0;
    }
}

static size_t count_holes(const struct dig_curve_set *const set)
{
    size_t cells = 1;
    size_t holes = 0;
    for (int a = 0; a < DIG_AXES; a++) {
        cells *= set->axis_count[a];
    }
    for (size_t i = 0; set->entries > 0 && i < cells; i++) {
        holes += set->cell[i] < 0 ? 1 : 0;
    }
    return holes;
}

static size_t count_builds(struct dig_db *const db)
{
    sqlite3_stmt *const s =
        dig_sql_first(db, "SELECT count(*) FROM (SELECT DISTINCT engine, version FROM run)");
    const size_t builds = (size_t)sqlite3_column_int64(s, 0);
    (void)sqlite3_finalize(s);
    return builds;
}

static void check_all(struct dig_store *const store, struct dig_store_report *const report)
{
    struct dig_db *const        db       = &store->db;
    struct dig_entry_set *const all      = dig_grounds_load(db, &store->head, DIG_GROUNDS_ALL);
    struct dig_curve_set *const set      = dig_sql_load(db, &store->head);
    struct scratch *const       scratch  = calloc(1, sizeof *scratch);
    const size_t                entries  = all != NULL ? all->entries * all->trajectories : 0;
    double *const               packings = calloc(entries + 1, sizeof *packings);
    if (scratch == NULL || packings == NULL) {
        dig_db_fail(db, DIG_ENOMEM, "no memory");
    }
    for (size_t i = 0; db->status == DIG_OK && scratch != NULL && i < entries; i++) {
        check_entry(store, all, i / all->trajectories, i % all->trajectories, scratch);
    }
    struct dig_store_report made = { .builds = count_builds(db) };
    if (db->status == DIG_OK && all != NULL && set != NULL) {
        made.holes = count_holes(set);
        made.step  = dig_grounds_step(all, &store->head);
        count_entries(all, packings, &made);
        *report = made;
    }
    free(packings);
    free(scratch);
    dig_curve_set_destroy(set);
    dig_entry_set_destroy(all);
}

enum dig_status dig_store_check(struct dig_store *const        store,
                                struct dig_store_report *const report,
                                struct dig_error *const        error)
{
    assert(store != NULL && report != NULL);
    struct dig_db *const db = dig_store_ask(store, error);
    // One transaction: a writer may be adding runs.
    dig_sql_run(db, "BEGIN");
    check_all(store, report);
    (void)sqlite3_exec(db->sql, "ROLLBACK", NULL, NULL, NULL);
    return db->status;
}
