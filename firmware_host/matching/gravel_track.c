#include "firmware_host/matching/gravel_track.h"

#include "estimator/approach/approach_slots.h"
#include "estimator/match/match.h"
#include "files/identity_json.h"
#include "files/whole.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#define NS_PER_S 1000000000LL

static int64_t ns(const double seconds)
{
    return (int64_t)llround(fmin(seconds, 3e9) * (double)NS_PER_S);
}

struct dig_gravel_track dig_gravel_track_of(const struct dig_curve_set *const             set,
                                            const struct dig_match *const                 match,
                                            const struct dig_observation *const           dig,
                                            const int64_t                                 now_ns,
                                            const struct dig_gravel_track_settings *const settings)
{
    assert(set != NULL && match != NULL && dig != NULL && settings != NULL && match->nearest >= 0);
    struct dig_gravel_track known = {
        .any        = true,
        .valid      = match->valid,
        .match      = *match,
        .nearest    = set->gravel[match->nearest],
        .time_ns    = now_ns,
        .expires_ns = now_ns + ns(settings->expires_s),
        .drift      = (double)NAN,

        .path_measured = dig->last - dig->first,
        .ending        = dig->ending,
        .made          = dig->made,
        .matched       = dig->approach,
    };
    if (match->weighted >= 0) {
        known.weighted = set->gravel[match->weighted];
    }
    (void)snprintf(known.trajectory, sizeof known.trajectory, "%s",
                   set->trajectory[dig->trajectory].name);
    (void)snprintf(known.table, sizeof known.table, "%s", set->scene_hash);
    return known;
}

void dig_gravel_track_end(struct dig_gravel_track *const known, const char *const why)
{
    assert(known != NULL && why != NULL);
    known->valid       = false;
    known->going_on    = false;
    known->match.valid = false;
    (void)snprintf(known->wanted, sizeof known->wanted, "%s: dig a simple dig", why);
}

// Distance of a dig from a curve over the points measured, in what noise alone would make it.
static double floors_between(const struct dig_observation *const dig,
                             const struct dig_curve *const       curve)
{
    double miss2  = 0.0;
    double floor2 = 0.0;
    for (size_t k = 0; k < DIG_CURVE_POINTS; k++) {
        const double at = (double)k / (DIG_CURVE_POINTS - 1);
        if (at < dig->first || at > dig->last) {
            continue;
        }
        const double mean = (double)curve->mean[DIG_CHANNEL_MY_Nm][k];
        const double sd   = (double)curve->sd[DIG_CHANNEL_MY_Nm][k];
        miss2 += (dig->moment_Nm[k] - mean) * (dig->moment_Nm[k] - mean);
        floor2 += sd * sd + dig->sigma_Nm[k] * dig->sigma_Nm[k];
    }
    return sqrt(miss2 / floor2);
}

// Compares a dig with what was expected of it; false when that cannot be.
static bool compare(struct dig_gravel_track *const known, const struct dig_observation *const dig,
                    const struct dig_expected *const              expected,
                    const struct dig_gravel_track_settings *const settings)
{
    if (!known->valid || !expected->valid) {
        return false;
    }
    const double floors = floors_between(dig, &expected->curve);
    if (!isfinite(floors)) {
        return false;
    }
    known->drift    = floors;
    known->differed = floors > settings->drift_floors ? known->differed + 1 : 0;
    if (known->differed == 0) {
        known->wanted[0] = '\0';
    }
    return true;
}

enum dig_gating dig_gravel_track_judge(struct dig_gravel_track *const                known,
                                       const struct dig_observation *const           dig,
                                       const struct dig_expected *const              expected,
                                       const struct dig_gravel_track_settings *const settings)
{
    assert(known != NULL && dig != NULL && expected != NULL && settings != NULL);
    if (!compare(known, dig, expected, settings)) {
        return DIG_REJECTED;
    }
    if (known->differed == 0) {
        return DIG_ACCEPTED;
    }
    if (known->differed >= DIG_DRIFT_DIGS || known->match.digs < 2 ||
        known->drift > DIG_DRIFT_FAR * settings->drift_floors) {
        return DIG_REJECTED;
    }
    (void)snprintf(known->wanted, sizeof known->wanted,
                   "a simple dig differed from those before: dig another");
    return DIG_HELD;
}

bool dig_gravel_track_watch(struct dig_gravel_track *const                known,
                            const struct dig_observation *const           dig,
                            const struct dig_expected *const              expected,
                            const struct dig_gravel_track_settings *const settings)
{
    assert(known != NULL && dig != NULL && expected != NULL && settings != NULL);
    if (!compare(known, dig, expected, settings)) {
        return false;
    }
    if (known->differed >= DIG_DRIFT_DIGS) {
        dig_gravel_track_end(known, "the ground has changed");
    }
    return true;
}

bool dig_gravel_track_age(struct dig_gravel_track *const known, const int64_t now_ns)
{
    assert(known != NULL);
    if (!known->valid || now_ns < known->expires_ns) {
        return false;
    }
    dig_gravel_track_end(known, "the gravel known is too old");
    return true;
}

static void put_pool(const struct dig_curve_set *const set, const struct dig_pool *const pool,
                     struct dig_identity *const identity)
{
    identity->recorded = pool->digs;
    for (size_t i = 0; i < pool->digs; i++) {
        const struct dig_observation *const dig = &pool->dig[i];
        struct dig_identity_dig *const      to  = &identity->recording[i];
        memcpy(to->trajectory, set->trajectory[dig->trajectory].name, sizeof to->trajectory);
        memcpy(to->moment_Nm, dig->moment_Nm, sizeof to->moment_Nm);
        memcpy(to->sigma_Nm, dig->sigma_Nm, sizeof to->sigma_Nm);
        to->approach = dig->approach;
        to->first    = dig->first;
        to->last     = dig->last;
        to->forces   = dig->forces;
        if (dig->forces) {
            memcpy(to->force_N, dig->force_N, sizeof to->force_N);
            memcpy(to->force_sigma_N, dig->force_sigma_N, sizeof to->force_sigma_N);
        }
    }
}

enum dig_status dig_gravel_track_write(const char *const                    path,
                                       const struct dig_gravel_track *const known,
                                       const struct dig_curve_set *const    set,
                                       const struct dig_pool *const         pool,
                                       struct dig_error *const              error)
{
    assert(path != NULL && known != NULL && set != NULL && pool != NULL &&
           known->match.samples <= DIG_IDENTITY_SAMPLES_MAX);
    _Static_assert(DIG_POOL_MAX <= DIG_IDENTITY_DIGS_MAX, "a pool must fit");
    const struct dig_match *const m        = &known->match;
    struct dig_identity           identity = {
                  .digs             = m->digs,
                  .forces           = m->forces,
                  .gravel           = m->gravel,
                  .mean             = m->mean,
                  .low              = m->low,
                  .high             = m->high,
                  .nearest          = known->nearest,
                  .distance         = m->distance,
                  .nearest_distance = m->nearest_distance,
                  .weighted         = m->weighted >= 0,
                  .weighted_nearest = known->weighted,

                  .weighted_distance = m->weighted_distance,
                  .noise_floor       = m->noise_floor,
                  .outside           = m->outside,
                  .family            = dig_match_is_family(m),
                  .samples           = m->samples,
                  .made              = known->made,
                  .matched           = known->matched,
    };
    memcpy(identity.scene_hash, known->table, sizeof identity.scene_hash);
    memcpy(identity.trajectory, known->trajectory, sizeof identity.trajectory);
    memcpy(identity.sample, m->sample, m->samples * sizeof m->sample[0]);
    put_pool(set, pool, &identity);

    struct dig_out        out    = { 0 };
    const enum dig_status status = dig_out_open(&out, path, error);
    if (status != DIG_OK) {
        return status;
    }
    dig_identity_write(out.file, &identity);
    return dig_out_commit(&out, error);
}

static int nearest_entry(const struct dig_curve_set *const set, const struct dig_gravel *const g)
{
    int    nearest = -1;
    double least   = INFINITY;
    for (size_t e = 0; e < set->entries; e++) {
        double distance2 = 0.0;
        for (int a = 0; a < DIG_AXES; a++) {
            const double from = set->axis[a][0];
            const double span = set->axis[a][set->axis_count[a] - 1] - from;
            const double off  = set->gravel[e].value[a] - g->value[a];
            distance2 += span > 0.0 ? off * off / (span * span) : 0.0;
        }
        if (distance2 < least) {
            least   = distance2;
            nearest = (int)e;
        }
    }
    return nearest;
}

static bool holds(const struct dig_curve_set *const set, const struct dig_gravel *const g)
{
    for (int a = 0; a < DIG_AXES; a++) {
        const double margin = 1e-6 * g->value[a];
        if (!(g->value[a] >= set->axis[a][0] - margin &&
              g->value[a] <= set->axis[a][set->axis_count[a] - 1] + margin)) {
            return false;
        }
    }
    return set->entries > 0;
}

bool dig_gravel_track_move(struct dig_gravel_track *const    known,
                           const struct dig_curve_set *const set)
{
    assert(known != NULL && set != NULL);
    if (!known->any || strcmp(known->table, set->scene_hash) != 0 ||
        !holds(set, &known->match.gravel)) {
        return false;
    }
    known->match.nearest = nearest_entry(set, &known->match.gravel);
    known->nearest       = set->gravel[known->match.nearest];
    if (known->match.weighted >= 0) {
        known->match.weighted = nearest_entry(set, &known->weighted);
        known->weighted       = set->gravel[known->match.weighted];
    }
    dig_match_tell_family(set, &known->match);
    return true;
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
    if (!(*age_s <= most_s && *age_s >= -3600.0)) {
        return dig_error_set(error, DIG_ESTALE,
                             "%s: %.1f h old, expected at most %.1f h: a simple dig is wanted",
                             path, *age_s / 3600.0, most_s / 3600.0);
    }
    *age_s = fmax(*age_s, 0.0);
    return DIG_OK;
}

// The digs of the file, unless one is of a trajectory the table does not have, or made in a way the
// table knows nothing of.
static void take_pool(const struct dig_curve_set *const set,
                      const struct dig_identity *const identity, struct dig_pool *const pool)
{
    pool->digs = 0;
    for (size_t i = 0; i < identity->recorded && i < DIG_POOL_MAX; i++) {
        const struct dig_identity_dig *const from = &identity->recording[i];
        struct dig_observation               dig  = { .trajectory = -1 };
        for (size_t t = 0; t < set->trajectories; t++) {
            if (strcmp(set->trajectory[t].name, from->trajectory) == 0) {
                dig.trajectory = (int)t;
            }
        }
        memcpy(dig.moment_Nm, from->moment_Nm, sizeof dig.moment_Nm);
        memcpy(dig.sigma_Nm, from->sigma_Nm, sizeof dig.sigma_Nm);
        memcpy(dig.force_N, from->force_N, sizeof dig.force_N);
        memcpy(dig.force_sigma_N, from->force_sigma_N, sizeof dig.force_sigma_N);
        dig.approach    = from->approach;
        dig.first       = from->first;
        dig.last        = from->last;
        dig.forces      = from->forces;
        const bool held = dig_observation_check(set, &dig) == DIG_OK &&
                          (dig_approach_is_plain(&dig.approach) ||
                           dig_approach_varies(set, (size_t)dig.trajectory));
        if (!held) {
            pool->digs = 0;
            return;
        }
        dig_pool_add(pool, &dig);
    }
}

enum dig_status dig_gravel_track_read(const char *const path, const struct dig_curve_set *const set,
                                      const int64_t                                 now_ns,
                                      const struct dig_gravel_track_settings *const settings,
                                      struct dig_gravel_track *const                known,
                                      struct dig_pool *const pool, struct dig_error *const error)
{
    assert(path != NULL && set != NULL && settings != NULL && known != NULL && pool != NULL);
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
        .time_ns    = now_ns - ns(age_s),
        .expires_ns = now_ns + ns(settings->expires_s - age_s),
        .drift      = (double)NAN,

        .path_measured = (double)NAN,
        .made          = i.made,
        .matched       = i.matched,
    };
    struct dig_match *const m = &read.match;
    m->digs                   = i.digs;
    m->forces                 = i.forces;
    m->valid                  = true;
    m->gravel                 = i.gravel;
    m->mean                   = i.mean;
    m->low                    = i.low;
    m->high                   = i.high;
    m->distance               = i.distance;
    m->nearest_distance       = i.nearest_distance;
    m->weighted               = i.weighted ? 0 : -1; // which, the table says below
    m->weighted_distance      = i.weighted ? i.weighted_distance : (double)NAN;
    read.weighted             = i.weighted_nearest;
    m->noise_floor            = i.noise_floor;
    m->outside                = i.outside;
    m->samples                = i.samples < DIG_MATCH_SAMPLES ? i.samples : DIG_MATCH_SAMPLES;
    memcpy(m->sample, i.sample, m->samples * sizeof m->sample[0]);
    memcpy(read.trajectory, i.trajectory, sizeof read.trajectory);
    memcpy(read.table, i.scene_hash, sizeof read.table);
    if (!dig_gravel_track_move(&read, set)) {
        return dig_error_set(error, DIG_EINVAL,
                             "%s: scene_hash: %.12s, or a gravel out of range; expected one of the "
                             "table's, scene %.12s",
                             path, read.table, set->scene_hash);
    }
    *known = read;
    take_pool(set, &i, pool);
    return DIG_OK;
}

int dig_gravel_track_hint(const struct dig_curve_set *const set,
                          const struct dig_forecast *const forecast, const double lambda,
                          double *const J_per_kg)
{
    assert(set != NULL && forecast != NULL && J_per_kg != NULL);
    double carried_kg[DIG_TRAJECTORY_MAX] = { 0 };
    double most_kg                        = 0.0;
    for (size_t t = 0; t < set->trajectories; t++) {
        const struct dig_expected *const along = &forecast->along[t];
        const double                     kg    = pow(lambda, 3.0) *
                          (double)along->curve.mean[DIG_CHANNEL_CARRIED_kg][DIG_CURVE_POINTS - 1];
        carried_kg[t] = along->valid && kg > 0.0 ? kg : 0.0; // NaN: not known
        most_kg       = fmax(most_kg, carried_kg[t]);
    }
    int    best  = -1;
    double least = INFINITY;
    for (size_t t = 0; t < set->trajectories; t++) {
        const double each = forecast->along[t].energy_J / carried_kg[t];
        if (carried_kg[t] > 0.0 && carried_kg[t] >= 0.5 * most_kg && each < least) {
            best  = (int)t;
            least = each;
        }
    }
    if (best >= 0) {
        *J_per_kg = least;
    }
    return best;
}
