// Loads tables and tables of effects from files, for the other folders.

#include "tables/load.h"

#include "tables/grounds.h"
#include "tables/store_private.h"

#include <assert.h>
#include <string.h>

// as_dug: a density that stands for all stays one.
static enum dig_status read_table(const char *const path, const bool as_dug,
                                  struct dig_curve_set **const plain,
                                  struct dig_entry_set **const effects,
                                  struct dig_error *const      error)
{
    struct dig_table_head head      = { .trajectories = 0 };
    struct dig_db         db        = dig_sql_open_read(path, &head, error);
    struct dig_entry_set *varied    = NULL;
    head.density_scales             = head.density_scales && !as_dug;
    struct dig_curve_set *const set = dig_sql_load(&db, &head);
    if (set != NULL) {
        dig_sql_load_covariance(&db, &head, set);
    }
    if (effects != NULL) {
        varied = dig_grounds_load(&db, &head, DIG_GROUNDS_VARIED);
    }
    if (varied != NULL) {
        dig_grounds_pool_spread(NULL, varied);
    }
    (void)sqlite3_close(db.sql);
    if (db.status != DIG_OK) {
        dig_curve_set_destroy(set);
        return db.status;
    }
    *plain = set;
    if (effects != NULL) {
        *effects = varied;
    }
    return DIG_OK;
}

enum dig_status dig_table_list(const char *const path, struct dig_curve_set **const plain,
                               struct dig_entry_set **const effects, struct dig_error *const error)
{
    assert(path != NULL && plain != NULL);
    return read_table(path, true, plain, effects, error);
}

enum dig_status dig_table_load(const char *const path, struct dig_curve_set **const set,
                               struct dig_error *const error)
{
    assert(path != NULL && set != NULL);

    struct dig_curve_set *made   = NULL;
    const enum dig_status status = read_table(path, false, &made, NULL, error);
    if (status != DIG_OK || made == NULL) {
        return status;
    }
    if (made->entries == 0) {
        dig_curve_set_destroy(made);
        return dig_error_set(error, DIG_EINVAL,
                             "%s: ground: no rows without an effect, expected at least one entry "
                             "(is it generated?)",
                             path);
    }
    *set = made;
    return DIG_OK;
}

enum dig_status dig_effects_load(const char *const path, const struct dig_curve_set *const plain,
                                 struct dig_entry_set **const set, struct dig_error *const error)
{
    assert(path != NULL && plain != NULL && set != NULL);

    struct dig_curve_set *beside = NULL;
    struct dig_entry_set *made   = NULL;
    enum dig_status       status = dig_table_list(path, &beside, &made, error);
    if (status != DIG_OK || beside == NULL || made == NULL) {
        return status;
    }
    if (strcmp(made->scene_hash, plain->scene_hash) != 0) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%s: scene: holds \"%s\" (%.12s…), expected the scene of the table "
                               "it goes with, \"%s\" (%.12s…)",
                               path, beside->scene_name, beside->scene_hash, plain->scene_name,
                               plain->scene_hash);
    } else if (made->entries == 0) {
        status = dig_error_set(error, DIG_EINVAL,
                               "%s: ground: no rows with an effect, expected at least one", path);
    }
    dig_curve_set_destroy(beside);
    if (status != DIG_OK) {
        dig_entry_set_destroy(made);
        return status;
    }
    *set = made;
    return DIG_OK;
}
