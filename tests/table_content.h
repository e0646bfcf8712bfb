// One number for all that readers get of a table, to tell whether it changed.

#ifndef DIG_TESTS_TABLE_CONTENT_H
#define DIG_TESTS_TABLE_CONTENT_H

#include "core/entry_set.h"
#include "tables/load.h"
#include "tables/store.h"

#include <string.h>

// Of what a reader gets: every curve, covariance and run (FNV-1a).
static inline void table_mix(uint64_t *const sum, const void *const bytes, const size_t size)
{
    const unsigned char *const b = bytes;
    for (size_t i = 0; i < size; i++) {
        *sum = (*sum ^ b[i]) * 1099511628211U;
    }
}

static inline enum dig_status table_mix_run(void *const context, const struct dig_run *const run,
                                            struct dig_error *const error)
{
    (void)error;
    uint64_t *const sum = context;
    table_mix(sum, run->origin.gravel.value, sizeof run->origin.gravel.value);
    table_mix(sum, run->origin.effect, strlen(run->origin.effect));
    table_mix(sum, run->origin.version, strlen(run->origin.version));
    table_mix(sum, &run->origin.seed, sizeof run->origin.seed);
    table_mix(sum, &run->origin.trajectory, sizeof run->origin.trajectory);
    table_mix(sum, &run->origin.packing, sizeof run->origin.packing);
    table_mix(sum, &run->first_s, sizeof run->first_s);
    table_mix(sum, &run->step_s, sizeof run->step_s);
    table_mix(sum, run->value, DIG_CHANNELS * run->windows * sizeof *run->value);
    return DIG_OK;
}

static inline void table_mix_set(uint64_t *const sum, const struct dig_curve_set *const set)
{
    const size_t n = set->entries * set->trajectories;
    table_mix(sum, set->scene_name, strlen(set->scene_name));
    table_mix(sum, &set->tooth_m, sizeof set->tooth_m);
    table_mix(sum, &set->young_Pa, sizeof set->young_Pa);
    table_mix(sum, &set->bucket_width_m, sizeof set->bucket_width_m);
    for (size_t t = 0; t < set->trajectories; t++) {
        table_mix(sum, set->trajectory[t].name, strlen(set->trajectory[t].name));
        table_mix(sum, &set->trajectory[t].theta0_rad, sizeof set->trajectory[t].theta0_rad);
        table_mix(sum, &set->trajectory[t].phase[0].vx_mps,
                  sizeof set->trajectory[t].phase[0].vx_mps);
    }
    table_mix(sum, set->gravel, set->entries * sizeof *set->gravel);
    table_mix(sum, set->packings, n * sizeof *set->packings);
    table_mix(sum, set->curve, n * sizeof *set->curve);
    if (set->approaches != NULL) {
        const struct dig_entry_set *const other = set->approaches;
        const size_t                      m     = other->entries * other->trajectories;
        table_mix(sum, other->entry, other->entries * sizeof *other->entry);
        table_mix(sum, other->packings, m * sizeof *other->packings);
        table_mix(sum, other->curve, m * sizeof *other->curve);
    }
    table_mix(sum, set->covariance, set->trajectories * sizeof *set->covariance);
}

/// False when a reader refuses the file.
static inline bool table_content(const char *const path, uint64_t *const sum)
{
    struct dig_curve_set *set     = NULL;
    struct dig_entry_set *effects = NULL;
    struct dig_store     *store   = NULL;
    if (dig_table_list(path, &set, &effects, NULL) != DIG_OK) {
        return false;
    }
    *sum = 14695981039346656037U;
    table_mix_set(sum, set);
    const size_t n = effects->entries * effects->trajectories;
    for (size_t e = 0; e < effects->entries; e++) {
        table_mix(sum, &effects->entry[e].effect, sizeof effects->entry[e].effect);
        table_mix(sum, &effects->entry[e].magnitude, sizeof effects->entry[e].magnitude);
        table_mix(sum, &effects->entry[e].gravel, sizeof effects->entry[e].gravel);
    }
    table_mix(sum, effects->packings, n * sizeof *effects->packings);
    table_mix(sum, effects->curve, n * sizeof *effects->curve);
    dig_curve_set_destroy(set);
    dig_entry_set_destroy(effects);
    const struct dig_run_visitor visitor = { table_mix_run, sum };
    enum dig_status              status  = dig_store_open(path, &store, NULL);
    if (status == DIG_OK) {
        status = dig_store_walk(store, &visitor, NULL);
    }
    dig_store_close(store);
    return status == DIG_OK;
}

#endif // DIG_TESTS_TABLE_CONTENT_H
