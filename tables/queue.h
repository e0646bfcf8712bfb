// What is still to be dug: the plan less what the table holds.
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

/// Every combination of the axes' values, each in `packings` beds, each bed dug by these
/// trajectories (indices in the scene).
struct dig_plan {
    size_t        count[DIG_AXES];
    const double *value[DIG_AXES];
    size_t        packings;
    size_t        trajectories;
    size_t        trajectory[DIG_TRAJECTORY_MAX];
};

/// One bed and the digs it still lacks.
struct dig_job {
    struct dig_gravel gravel;
    size_t            packing;
    uint64_t          seed;
    size_t            digs;
    size_t            trajectory[DIG_TRAJECTORY_MAX]; // [digs]
};

struct dig_queue {
    size_t          jobs;
    struct dig_job *job;        // [jobs]: packings outermost, so that every point has one bed first
    size_t          digs_total; // of the plan
    size_t          digs_done;  // of these, in the table already
};

/// The seed of a gravel's k-th bed: the first 63 bits of the SHA-256 of
/// "bed friction=%.17g rolling=%.17g density_kgpm3=%.17g packing=%zu", so that the same gravel and
/// packing has the same bed in every table of the scene.
uint64_t dig_bed_seed(const struct dig_gravel *gravel, size_t packing);

/// Free with dig_queue_finish(). Writes on success only.
DIG_MUST_CHECK enum dig_status dig_queue_make(struct dig_store *store, const struct dig_plan *plan,
                                              struct dig_queue *queue, struct dig_error *error);

void dig_queue_finish(struct dig_queue *queue);

#endif // DIG_TABLES_QUEUE_H
