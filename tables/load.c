#include "tables/load.h"

#include "core/contact.h"
#include "core/outline.h"
#include "core/sort.h"
#include "tables/density_scale.h"
#include "tables/grounds.h"
#include "tables/store_private.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#if defined __GNUC__ && !defined __clang__
// GCC 12's analyzer takes what calloc() returned for uninitialised, and loses sight of set->cell.
#pragma GCC diagnostic ignored "-Wanalyzer-use-of-uninitialized-value"
#pragma GCC diagnostic ignored "-Wanalyzer-malloc-leak"
#endif

#define CELLS_MAX 10000000

// The sorted different values of one axis.
static void build_axis(struct dig_curve_set *const set, const int a)
{
    double *const axis = set->axis[a];
    for (size_t i = 0; i < set->entries; i++) {
        axis[i] = set->gravel[i].value[a];
    }
    dig_sort(set->entries, axis);
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

static void build_grid(struct dig_curve_set *const set, struct dig_db *const db)
{
    size_t cells = 1;
    for (int a = 0; a < DIG_AXES; a++) {
        build_axis(set, a);
        cells *= set->axis_count[a];
        if (cells > CELLS_MAX) {
            dig_db_fail(db, DIG_EINVAL, "ground: the values do not form a grid");
            return;
        }
    }
    set->cell = malloc((cells + 1) * sizeof *set->cell);
    if (set->cell == NULL) {
        dig_db_fail(db, DIG_ENOMEM, "no memory for the table");
        return;
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
}

static void copy_head(struct dig_curve_set *const set, const struct dig_table_head *const head)
{
    memcpy(set->scene_name, head->scene_name, sizeof set->scene_name);
    memcpy(set->scene_hash, head->scene_hash, sizeof set->scene_hash);
    memcpy(set->trajectory, head->trajectory, sizeof set->trajectory);
    set->tooth_m         = head->tooth_m;
    set->bucket_width_m  = head->bucket_width_m;
    set->young_Pa        = head->young_Pa;
    set->smooth_half_s   = head->smooth_half_s;
    set->stiffness_power = dig_contact_stiffness_power(&head->finest, head->normal);
    set->trajectories    = head->trajectories;
}

// Takes over what the plain grounds hold.
static void fill(struct dig_curve_set *const set, struct dig_entry_set *const plain,
                 struct dig_db *const db)
{
    set->entries    = plain->entries;
    set->packings   = plain->packings;
    set->curve      = plain->curve;
    plain->packings = NULL;
    plain->curve    = NULL;

    set->gravel = calloc(set->entries + 1, sizeof *set->gravel);
    set->outline =
        calloc(DIG_FORCE_CHANNELS * set->entries * set->trajectories + 1, sizeof *set->outline);
    bool complete = set->gravel != NULL && set->outline != NULL;
    for (int a = 0; a < DIG_AXES; a++) {
        set->axis[a] = calloc(set->entries + 1, sizeof *set->axis[a]);
        complete     = complete && set->axis[a] != NULL;
    }
    if (!complete) {
        dig_db_fail(db, DIG_ENOMEM, "no memory for the table");
        return;
    }
    for (size_t i = 0; i < set->entries; i++) {
        set->gravel[i] = plain->entry[i].gravel;
    }
    dig_outlines_draw(set);
    build_grid(set, db);
}

struct dig_curve_set *dig_sql_load(struct dig_db *const db, const struct dig_table_head *const head)
{
    struct dig_curve_set *made = calloc(1, sizeof *made);
    if (made == NULL) {
        dig_db_fail(db, DIG_ENOMEM, "no memory for the table");
        return NULL;
    }
    copy_head(made, head);
    struct dig_entry_set *plain = dig_grounds_load(db, head, DIG_GROUNDS_PLAIN);
    made->approaches            = dig_grounds_load(db, head, DIG_GROUNDS_APPROACHED);
    if (plain != NULL && made->approaches != NULL) {
        dig_grounds_pool_spread(NULL, plain);
        dig_grounds_pool_spread(plain, made->approaches);
        made->step   = dig_grounds_step(plain, head);
        made->copies = dig_grounds_spread_density(db, head, &made->approaches);
        made->copies = dig_grounds_spread_density(db, head, &plain);
        if (db->status == DIG_OK) {
            fill(made, plain, db);
        }
        if (made->approaches->entries == 0) {
            dig_entry_set_destroy(made->approaches);
            made->approaches = NULL;
        }
    }
    dig_entry_set_destroy(plain);
    if (db->status != DIG_OK) {
        dig_curve_set_destroy(made);
        return NULL;
    }
    return made;
}

void dig_curve_set_destroy(struct dig_curve_set *const set)
{
    if (set != NULL) {
        free(set->gravel);
        free(set->packings);
        free(set->curve);
        free(set->outline);
        for (int a = 0; a < DIG_AXES; a++) {
            free(set->axis[a]);
        }
        free(set->cell);
        free(set->covariance);
        dig_entry_set_destroy(set->approaches);
        free(set);
    }
}
