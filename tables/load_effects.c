#include "tables/load_effects.h"

#include "tables/grounds.h"
#include "tables/load.h"
#include "tables/store_private.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

// Where a ground of the loaded rows goes in the set's order.
struct place {
    enum dig_effect_id       effect;
    const struct dig_ground *ground;
    size_t                   from;
};

// By effect, gravel, magnitude.
static int compare(const void *const a, const void *const b)
{
    const struct place *const x = a;
    const struct place *const y = b;
    if (x->effect != y->effect) {
        return x->effect < y->effect ? -1 : 1;
    }
    for (int i = 0; i < DIG_AXES; i++) {
        const double u = x->ground->gravel.value[i];
        const double v = y->ground->gravel.value[i];
        if (u < v || u > v) {
            return u < v ? -1 : 1;
        }
    }
    return (x->ground->magnitude > y->ground->magnitude) -
           (x->ground->magnitude < y->ground->magnitude);
}

static void fill(struct dig_effect_set *const set, const struct dig_grounds *const varied,
                 struct place place[const])
{
    const size_t each = set->trajectories;
    for (size_t i = 0; i < set->entries; i++) {
        const struct dig_ground *const ground = &varied->ground[i];
        place[i] = (struct place){ (enum dig_effect_id)dig_effect_find(ground->effect), ground, i };
    }
    qsort(place, set->entries, sizeof *place, compare);
    for (size_t i = 0; i < set->entries; i++) {
        const struct place *const p = &place[i];
        set->entry[i] =
            (struct dig_effect_entry){ p->effect, p->ground->magnitude, p->ground->gravel };
        memcpy(set->packings + i * each, varied->packings + p->from * each,
               each * sizeof *set->packings);
        memcpy(set->curve + i * each, varied->curve + p->from * each, each * sizeof *set->curve);
    }
}

enum dig_status dig_sql_load_effects(sqlite3 *const db, const char *const path,
                                     const struct dig_table_head *const head,
                                     struct dig_effect_set **const      set,
                                     struct dig_error *const            error)
{
    struct dig_grounds varied = { .grounds = 0 };
    enum dig_status status = dig_grounds_load(db, path, head, DIG_GROUNDS_VARIED, &varied, error);
    if (status != DIG_OK) {
        return status;
    }
    dig_grounds_pool_spread(NULL, &varied);
    const size_t                 n     = varied.grounds;
    const size_t                 each  = varied.trajectories;
    struct dig_effect_set *const made  = calloc(1, sizeof *made);
    struct place *const          place = calloc(n + 1, sizeof *place);
    if (made != NULL) {
        made->trajectories = each;
        made->entries      = n;
        made->entry        = calloc(n + 1, sizeof *made->entry);
        made->packings     = calloc(n * each + 1, sizeof *made->packings);
        made->curve        = calloc(n * each + 1, sizeof *made->curve);
        memcpy(made->scene_hash, head->scene_hash, sizeof made->scene_hash);
    }
    if (made == NULL || place == NULL || made->entry == NULL || made->packings == NULL ||
        made->curve == NULL) {
        status = dig_error_set(error, DIG_ENOMEM, "%s: no memory for the table", path);
        dig_effect_set_destroy(made);
    } else {
        fill(made, &varied, place);
        *set = made;
    }
    free(place);
    dig_grounds_finish(&varied);
    return status;
}

void dig_effect_set_destroy(struct dig_effect_set *const set)
{
    if (set != NULL) {
        free(set->entry);
        free(set->packings);
        free(set->curve);
        free(set);
    }
}
