#include "firmware_host/matching/gravel_state.h"

#include "core/units.h"
#include "estimator/approach/approach_slots.h"
#include "estimator/match/match.h"
#include "files/identity_json.h"
#include "files/text/whole.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

// A file this much younger than now is of a clock that was set back: its age is not known.
static const double clock_back_s = 3600.0;

enum dig_status dig_gravel_state_write(const char *const                    path,
                                       const struct dig_gravel_track *const track,
                                       const struct dig_curve_set *const    set,
                                       const struct dig_pool *const         pool,
                                       struct dig_error *const              error)
{
    assert(path != NULL && track != NULL && set != NULL && pool != NULL);
    _Static_assert(DIG_POOL_MAX <= DIG_IDENTITY_DIGS_MAX, "a pool must fit");
    struct dig_identity identity = {
        .made             = track->made,
        .matched          = track->matched,
        .match            = track->match,
        .nearest          = track->nearest,
        .weighted_nearest = track->weighted,
        .family           = dig_match_is_family(&track->match),
        .recorded         = pool->digs,
    };
    memcpy(identity.scene_hash, track->table, sizeof identity.scene_hash);
    memcpy(identity.trajectory, track->trajectory, sizeof identity.trajectory);
    for (size_t i = 0; i < pool->digs; i++) {
        struct dig_identity_dig *const to = &identity.recording[i];
        to->seen                          = pool->dig[i];
        memcpy(to->trajectory, set->trajectory[to->seen.trajectory].name, sizeof to->trajectory);
    }

    struct dig_out        out    = { 0 };
    const enum dig_status status = dig_out_open(&out, path, error);
    if (status != DIG_OK) {
        return status;
    }
    dig_identity_write(out.file, &identity);
    return dig_out_commit(&out, error);
}

static enum dig_status check_age(const char *const path, const double most_s, double *const age_s,
                                 struct dig_error *const error)
{
    struct stat     file;
    struct timespec wall;
    if (stat(path, &file) != 0) {
        // NOLINTNEXTLINE(concurrency-mt-unsafe): messages for people, one thread
        return dig_error_set(error, DIG_EIO, "%s: %s", path, strerror(errno));
    }
    (void)clock_gettime(CLOCK_REALTIME, &wall);
    *age_s = difftime(wall.tv_sec, file.st_mtim.tv_sec);
    if (*age_s < -clock_back_s) {
        return dig_error_set(error, DIG_ESTALE,
                             "%s: dated %.1f h ahead of the clock, expected no such file (is the "
                             "clock right?): a simple dig is wanted",
                             path, -*age_s / 3600.0);
    }
    if (!(*age_s <= most_s)) {
        return dig_error_set(error, DIG_ESTALE,
                             "%s: %.1f h old, expected at most %.1f h: a simple dig is wanted",
                             path, *age_s / 3600.0, most_s / 3600.0);
    }
    *age_s = fmax(*age_s, 0.0);
    return DIG_OK;
}

// Fills the pool with the file's digs. Empty when one is of a trajectory the table lacks, or of a
// depth or attack the table was not dug at.
static void take_pool(const struct dig_curve_set *const set,
                      const struct dig_identity *const identity, struct dig_pool *const pool)
{
    pool->digs = 0;
    for (size_t i = 0; i < identity->recorded && i < DIG_POOL_MAX; i++) {
        struct dig_observation dig = identity->recording[i].seen;
        dig.trajectory             = dig_curve_set_find(set, identity->recording[i].trajectory);
        const bool held            = dig_observations_check(set, 1, &dig) == DIG_OK &&
                          (dig_approach_is_plain(&dig.approach) ||
                           dig_approach_varies(set, (size_t)dig.trajectory));
        if (!held) {
            pool->digs = 0;
            return;
        }
        dig_pool_add(pool, &dig);
    }
}

enum dig_status dig_gravel_state_read(const char *const path, const struct dig_curve_set *const set,
                                      const int64_t                                 now_ns,
                                      const struct dig_gravel_track_settings *const settings,
                                      struct dig_gravel_track *const                track,
                                      struct dig_pool *const pool, struct dig_error *const error)
{
    assert(path != NULL && set != NULL && settings != NULL && track != NULL && pool != NULL);
    double              age_s  = 0.0;
    enum dig_status     status = check_age(path, settings->expires_s, &age_s, error);
    struct dig_identity i;
    status = status == DIG_OK ? dig_identity_read(path, &i, error) : status;
    if (status != DIG_OK) {
        return status;
    }
    struct dig_gravel_track read = {
        .any        = true,
        .valid      = true,
        .restored   = true,
        .time_ns    = now_ns - dig_ns(age_s),
        .expires_ns = now_ns + dig_ns(settings->expires_s - age_s),
        .drift      = (double)NAN,

        .path_measured = (double)NAN,
        .made          = i.made,
        .matched       = i.matched,
        .match         = i.match, // its entries are found below
        .weighted      = i.weighted_nearest,
    };
    memcpy(read.trajectory, i.trajectory, sizeof read.trajectory);
    memcpy(read.table, i.scene_hash, sizeof read.table);
    if (!dig_gravel_track_set_table(&read, set)) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: scene_hash: %.12s, or a gravel out of range; expected one of the "
                             "table's, scene %.12s",
                             path, read.table, set->scene_hash);
    }
    *track = read;
    take_pool(set, &i, pool);
    return DIG_OK;
}
