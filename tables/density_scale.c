#include "tables/density_scale.h"

#include "tables/load.h"

#include <assert.h>
#include <math.h>

// Of gravel at 2500 kg/m3: 1500 to 4000.
static const double times[] = { 0.6, 1.0, 1.6 };

enum { COPIES = sizeof times / sizeof times[0] };

static bool is_of_one_density(const struct dig_entry_set *const g)
{
    bool same = true;
    for (size_t i = 1; i < g->entries; i++) {
        same = same && fabs(g->entry[i].gravel.value[DIG_AXIS_DENSITY_kgpm3] -
                            g->entry[0].gravel.value[DIG_AXIS_DENSITY_kgpm3]) <= 0.0;
    }
    return same;
}

// Whether two grounds are of one gravel, dug in other ways.
static bool is_of_one_gravel(const struct dig_entry *const a, const struct dig_entry *const b)
{
    return fabs(a->gravel.value[DIG_AXIS_FRICTION] - b->gravel.value[DIG_AXIS_FRICTION]) <= 0.0 &&
           fabs(a->gravel.value[DIG_AXIS_ROLLING] - b->gravel.value[DIG_AXIS_ROLLING]) <= 0.0;
}

static void copy(const struct dig_entry_set *const from, const size_t i, const double factor,
                 struct dig_entry_set *const to, const size_t at)
{
    const size_t each = from->trajectories;
    to->entry[at]     = from->entry[i];
    to->entry[at].gravel.value[DIG_AXIS_DENSITY_kgpm3] *= factor;
    for (size_t t = 0; t < each; t++) {
        const struct dig_curve *const dug    = &from->curve[i * each + t];
        struct dig_curve *const       scaled = &to->curve[at * each + t];
        to->packings[at * each + t]          = from->packings[i * each + t];
        for (size_t c = 0; c < DIG_CHANNELS; c++) {
            for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
                scaled->mean[c][k] = (float)(factor * (double)dug->mean[c][k]);
                scaled->sd[c][k]   = (float)(factor * (double)dug->sd[c][k]);
            }
        }
    }
}

size_t dig_grounds_spread_density(struct dig_db *const db, const struct dig_table_head *const head,
                                  struct dig_entry_set **const grounds)
{
    assert(head != NULL && grounds != NULL);
    const struct dig_entry_set *const dug = *grounds;
    if (db->status != DIG_OK || !head->density_scales || dug->entries == 0 ||
        !is_of_one_density(dug)) {
        return 1;
    }
    struct dig_entry_set *const made = dig_grounds_create(head, COPIES * dug->entries);
    if (made == NULL) {
        dig_db_fail(db, DIG_ENOMEM, "no memory for the table");
        return 1;
    }
    size_t at   = 0;
    size_t next = 0;
    for (size_t first = 0; first < dug->entries; first = next) {
        while (next < dug->entries && is_of_one_gravel(&dug->entry[first], &dug->entry[next])) {
            next++;
        }
        for (size_t c = 0; c < COPIES; c++) {
            for (size_t i = first; i < next; i++) {
                copy(dug, i, times[c], made, at++);
            }
        }
    }
    dig_entry_set_destroy(*grounds);
    *grounds = made;
    return COPIES;
}
