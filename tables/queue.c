#include "tables/queue.h"

#include "core/sha256.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define JOBS_MAX 10000000

uint64_t dig_bed_seed(const struct dig_gravel *const gravel, const size_t packing)
{
    char      text[200];
    const int length = snprintf(text, sizeof text,
                                "bed friction=%.17g rolling=%.17g density_kgpm3=%.17g packing=%zu",
                                gravel->value[DIG_AXIS_FRICTION], gravel->value[DIG_AXIS_ROLLING],
                                gravel->value[DIG_AXIS_DENSITY_kgpm3], packing);
    assert(length > 0 && (size_t)length < sizeof text);

    struct dig_sha256 hash;
    dig_sha256_init(&hash);
    dig_sha256_add(&hash, text, (size_t)length);
    return dig_sha256_finish_number(&hash);
}

// Fills what the bed still lacks into job->trajectory.
static enum dig_status find_missing(struct dig_store *const      store,
                                    const struct dig_plan *const plan, struct dig_job *const job,
                                    struct dig_error *const error)
{
    struct dig_run_origin key = job->origin;
    for (size_t t = 0; t < plan->trajectories; t++) {
        bool there                   = false;
        key.trajectory               = plan->trajectory[t];
        const enum dig_status status = dig_store_has(store, &key, &there, error);
        if (status != DIG_OK) {
            return status;
        }
        if (!there) {
            job->trajectory[job->digs++] = plan->trajectory[t];
        }
    }
    return DIG_OK;
}

static struct dig_job job_of(const struct dig_plan_point *const point, const size_t packing)
{
    struct dig_job job = { .origin = {
                               .gravel    = point->gravel,
                               .magnitude = point->magnitude,
                               .approach  = point->approach,
                               .packing   = packing,
                               .seed      = dig_bed_seed(&point->gravel, packing),
                           } };
    memcpy(job.origin.effect, point->effect, sizeof job.origin.effect);
    return job;
}

static size_t beds_of(const struct dig_plan *const plan, size_t *const most)
{
    size_t beds = 0;
    *most       = 0;
    for (size_t i = 0; i < plan->points; i++) {
        beds += plan->point[i].packings;
        *most = plan->point[i].packings > *most ? plan->point[i].packings : *most;
    }
    return beds;
}

// Packings outermost, so that every point has one bed before any has a second.
static enum dig_status fill(struct dig_store *const store, const struct dig_plan *const plan,
                            const size_t most, struct dig_queue *const queue,
                            struct dig_error *const error)
{
    const size_t shards = plan->shards > 0 ? plan->shards : 1;
    size_t       bed    = 0;
    for (size_t packing = 0; packing < most; packing++) {
        for (size_t i = 0; i < plan->points; i++) {
            if (packing >= plan->point[i].packings || bed++ % shards != plan->shard) {
                continue;
            }
            struct dig_job        job    = job_of(&plan->point[i], packing);
            const enum dig_status status = find_missing(store, plan, &job, error);
            if (status != DIG_OK) {
                return status;
            }
            queue->digs_total += plan->trajectories;
            queue->digs_done += plan->trajectories - job.digs;
            if (job.digs > 0) {
                queue->job[queue->jobs++] = job;
            }
        }
    }
    return DIG_OK;
}

enum dig_status dig_queue_make(struct dig_store *const store, const struct dig_plan *const plan,
                               struct dig_queue *const queue, struct dig_error *const error)
{
    assert(store != NULL && plan != NULL && queue != NULL);
    assert(plan->trajectories >= 1 && plan->trajectories <= DIG_TRAJECTORY_MAX);
    assert(plan->shards == 0 || plan->shard < plan->shards);

    size_t       most = 0;
    const size_t beds = beds_of(plan, &most);
    if (beds > JOBS_MAX) {
        return dig_error_set(error, DIG_EINVAL, "grid: %zu beds, expected at most %d", beds,
                             JOBS_MAX);
    }
    struct dig_queue made = { .job = malloc((beds + 1) * sizeof *made.job) };
    if (made.job == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "grid: no memory for %zu beds", beds);
    }
    const enum dig_status status = fill(store, plan, most, &made, error);
    if (status != DIG_OK) {
        free(made.job);
        return status;
    }
    *queue = made;
    return DIG_OK;
}

void dig_queue_finish(struct dig_queue *const queue)
{
    if (queue != NULL) {
        free(queue->job);
        *queue = (struct dig_queue){ 0 };
    }
}
