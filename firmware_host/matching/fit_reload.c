#include "firmware_host/matching/fit_reload.h"

#include "estimator/approach/approach_slots.h"
#include "firmware_host/config/load.h"
#include "firmware_host/matching/fit_publish.h"
#include "tables/load.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

// Checks a table as the daemon does at start: by an estimator that is thrown away.
static enum dig_status check_table(const struct dig_fit *const       fit,
                                   const struct dig_curve_set *const set,
                                   struct dig_error *const           error)
{
    struct dig_estimator *const scratch = calloc(1, dig_estimator_size());
    if (scratch == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "no memory");
    }
    const enum dig_status status =
        dig_estimator_init(scratch, fit->machine, set, &fit->config->estimator);
    free(scratch);
    return status == DIG_OK ? DIG_OK
                            : dig_error_set(error, status, "%s: table: %s", fit->config_path,
                                            dig_status_str(status));
}

// Pooled digs fit both tables: the same trajectories, each dug in several ways or in one.
static bool has_same_trajectories(const struct dig_curve_set *const a,
                                  const struct dig_curve_set *const b)
{
    bool same = a->trajectories == b->trajectories;
    for (size_t t = 0; same && t < a->trajectories; t++) {
        same = strcmp(a->trajectory[t].name, b->trajectory[t].name) == 0 &&
               dig_approach_varies(a, t) == dig_approach_varies(b, t);
    }
    return same;
}

void dig_fit_reload(struct dig_fit *const fit)
{
    assert(fit != NULL);
    struct dig_error             error = { "" };
    struct dig_curve_set        *set   = NULL;
    struct dig_corrected_machine corrected;
    enum dig_status              status =
        dig_load_table(fit->config_path, fit->machine, &set, &corrected, &error);
    status = status == DIG_OK ? check_table(fit, set, &error) : status;
    if (status != DIG_OK) {
        dig_curve_set_destroy(set);
        dig_fit_log(fit, "reload refused, the table before stays: %.150s",
                    error.text[0] != '\0' ? error.text : dig_status_str(status));
        atomic_fetch_add(&fit->count.reloads_refused, 1);
        return;
    }
    if (!has_same_trajectories(fit->matcher.set, set)) {
        fit->pool.digs = 0;
    }
    dig_matcher_exchange(&fit->matcher, set,
                         fit->machine->link[DIG_JOINT_BUCKET].length_m / set->tooth_m);
    fit->basis.machine = corrected;
    dig_early_match_clear(fit->early, set);
    if (!dig_gravel_track_set_table(&fit->track, set)) {
        dig_gravel_track_invalidate(&fit->track, "another table");
    }
    const struct dig_table_update update = { set, fit->matcher.generation };
    dig_latest_put(&fit->handoffs->tables, &update);
    dig_fit_publish_track(fit);
    dig_fit_log(fit, "%s", "");
    atomic_fetch_add(&fit->count.reloads, 1);
}
