#include "tables/load_approaches.h"

#include "tables/density_scale.h"
#include "tables/grounds.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#if defined __GNUC__ && !defined __clang__
// GCC 12's analyzer takes what calloc() returned for uninitialised, and loses sight of set->entry.
#pragma GCC diagnostic ignored "-Wanalyzer-use-of-uninitialized-value"
#pragma GCC diagnostic ignored "-Wanalyzer-malloc-leak"
#endif

// Takes over what the grounds hold.
static struct dig_approach_set *take(struct dig_grounds *const          grounds,
                                     const struct dig_table_head *const head)
{
    struct dig_approach_set *const   set   = calloc(1, sizeof *set);
    struct dig_approach_entry *const entry = calloc(grounds->grounds, sizeof *entry);
    if (set == NULL || entry == NULL) {
        free(set);
        free(entry);
        return NULL;
    }
    for (size_t i = 0; i < grounds->grounds; i++) {
        entry[i] =
            (struct dig_approach_entry){ grounds->ground[i].gravel, grounds->ground[i].approach };
    }
    *set = (struct dig_approach_set){
        .trajectories = grounds->trajectories,
        .entries      = grounds->grounds,
        .entry        = entry,
        .packings     = grounds->packings,
        .curve        = grounds->curve,
    };
    memcpy(set->depth_m, head->depth_m, sizeof set->depth_m);
    grounds->packings = NULL;
    grounds->curve    = NULL;
    return set;
}

enum dig_status dig_sql_load_approaches(sqlite3 *const db, const char *const path,
                                        const struct dig_table_head *const head,
                                        struct dig_approach_set **const    set,
                                        struct dig_error *const            error)
{
    assert(head != NULL && set != NULL);
    struct dig_grounds plain  = { .grounds = 0 };
    struct dig_grounds other  = { .grounds = 0 };
    size_t             copies = 1;
    enum dig_status    status =
        dig_grounds_load(db, path, head, DIG_GROUNDS_APPROACHED, &other, error);
    if (status == DIG_OK && other.grounds == 0) {
        dig_grounds_finish(&other);
        *set = NULL;
        return DIG_OK;
    }
    if (status == DIG_OK) {
        status = dig_grounds_load(db, path, head, DIG_GROUNDS_PLAIN, &plain, error);
    }
    if (status == DIG_OK) {
        dig_grounds_pool_spread(&plain, &other);
        status = dig_grounds_spread_density(head, path, &other, &copies, error);
    }
    if (status == DIG_OK) {
        struct dig_approach_set *const made = take(&other, head);
        if (made == NULL) {
            status = dig_error_set(error, DIG_ENOMEM, "%s: no memory for the table", path);
        } else {
            *set = made;
        }
    }
    dig_grounds_finish(&plain);
    dig_grounds_finish(&other);
    return status;
}

void dig_approach_set_destroy(struct dig_approach_set *const set)
{
    if (set != NULL) {
        free(set->entry);
        free(set->packings);
        free(set->curve);
        free(set);
    }
}
