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
    uint8_t           digest[32];
    dig_sha256_init(&hash);
    dig_sha256_add(&hash, text, (size_t)length);
    dig_sha256_finish(&hash, digest);
    uint64_t seed = 0;
    for (size_t i = 0; i < 8; i++) {
        seed = seed << 8 | digest[i];
    }
    return seed >> 1;
}

static struct dig_gravel gravel_at(const struct dig_plan *const plan, size_t point)
{
    struct dig_gravel gravel;
    for (int a = DIG_AXES - 1; a >= 0; a--) {
        gravel.value[a] = plan->value[a][point % plan->count[a]];
        point /= plan->count[a];
    }
    return gravel;
}

// Fills what the bed still lacks into job->trajectory.
static enum dig_status find_missing(struct dig_store *const      store,
                                    const struct dig_plan *const plan, struct dig_job *const job,
                                    struct dig_error *const error)
{
    for (size_t t = 0; t < plan->trajectories; t++) {
        bool                  there = false;
        const enum dig_status status =
            dig_store_has(store, &job->gravel, job->packing, plan->trajectory[t], &there, error);
        if (status != DIG_OK) {
            return status;
        }
        if (!there) {
            job->trajectory[job->digs++] = plan->trajectory[t];
        }
    }
    return DIG_OK;
}

enum dig_status dig_queue_make(struct dig_store *const store, const struct dig_plan *const plan,
                               struct dig_queue *const queue, struct dig_error *const error)
{
    assert(store != NULL && plan != NULL && queue != NULL);
    assert(plan->trajectories >= 1 && plan->trajectories <= DIG_TRAJECTORY_MAX);

    size_t points = 1;
    for (int a = 0; a < DIG_AXES; a++) {
        assert(plan->count[a] > 0);
        points *= plan->count[a];
    }
    if (points * plan->packings > JOBS_MAX) {
        return dig_error_set(error, DIG_EINVAL, "grid: %zu beds, expected at most %d",
                             points * plan->packings, JOBS_MAX);
    }
    struct dig_queue made = { .digs_total = points * plan->packings * plan->trajectories };
    made.job              = malloc(points * plan->packings * sizeof *made.job);
    if (made.job == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "grid: no memory for %zu beds",
                             points * plan->packings);
    }
    made.digs_done = made.digs_total;
    for (size_t i = 0; i < points * plan->packings; i++) {
        struct dig_job job = { .gravel = gravel_at(plan, i % points), .packing = i / points };
        job.seed           = dig_bed_seed(&job.gravel, job.packing);
        const enum dig_status status = find_missing(store, plan, &job, error);
        if (status != DIG_OK) {
            free(made.job);
            return status;
        }
        if (job.digs > 0) {
            made.job[made.jobs++] = job;
            made.digs_done -= job.digs;
        }
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
