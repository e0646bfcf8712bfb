// The queue of digs to compute: the plan less what the table holds.
//
// The queue lives in the memory of the one process that writes the table. A job is claimed by being
// given out and finished by its runs being stored; a job of a process that died is therefore simply
// not in the table, and the next queue made from the table holds it again.

#ifndef DIG_TABLES_QUEUE_H
#define DIG_TABLES_QUEUE_H

#include "core/curve.h"
#include "core/error.h"
#include "tables/store.h"

#include <stdbool.h>
#include <stdint.h>

/// What is dug in and how: a gravel, perhaps with an effect, in `packings` beds.
struct dig_plan_point {
    struct dig_gravel   gravel;
    char                effect[DIG_NAME_SIZE]; // "": none
    double              magnitude;             // 0 without an effect
    struct dig_approach approach;              // of every trajectory
    size_t              packings;
};

/// Points, all different, each bed of which is dug by these trajectories (indices in the scene).
/// The beds of the plan, packings outermost, are dealt out in turn to `shards` slices (0: one), of
/// which this is the one numbered `shard`, from 0.
struct dig_plan {
    size_t                       points;
    const struct dig_plan_point *point; // [points]
    size_t                       trajectories;
    size_t                       trajectory[DIG_TRAJECTORY_MAX];
    size_t                       shard, shards;
};

/// One bed and the digs it still lacks.
struct dig_job {
    struct dig_run_origin origin; // what all its digs have in common
    size_t                digs;
    size_t                trajectory[DIG_TRAJECTORY_MAX]; // [digs]
};

struct dig_queue {
    size_t          jobs;
    struct dig_job *job;        // [jobs]: packings outermost, so that every point has one bed first
    size_t          digs_total; // of the plan
    size_t          digs_done;  // of these, in the table already
};

/// The seed of a gravel's k-th bed: the first 63 bits of the SHA-256 of
/// "bed friction=%.17g rolling=%.17g density_kgpm3=%.17g packing=%zu", so that the same gravel and
/// packing has the same bed in every table of the scene, and a bed with an effect, or for another
/// approach, is poured from the same seed as the plain one.
uint64_t dig_bed_seed(const struct dig_gravel *gravel, size_t packing);

/// Free with dig_queue_finish(). Writes on success only.
DIG_MUST_CHECK enum dig_status dig_queue_make(struct dig_store *store, const struct dig_plan *plan,
                                              struct dig_queue *queue, struct dig_error *error);

void dig_queue_finish(struct dig_queue *queue);

#endif // DIG_TABLES_QUEUE_H
