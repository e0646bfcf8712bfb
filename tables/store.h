// The table as a store: runs go in, each with the entry it changes, in one transaction.
//
// One process writes; it holds an advisory lock on the file from opening to closing, so that a
// second writer is refused and a dead one's lock is gone with it. Any number may read meanwhile.
// A transaction that a crash cut short is rolled back by the next opening.

#ifndef DIG_TABLES_STORE_H
#define DIG_TABLES_STORE_H

#include "core/approach.h"
#include "core/curve.h"
#include "core/error.h"
#include "core/recording.h"
#include "core/scene.h"

#include <stdbool.h>
#include <stdint.h>

struct dig_store;

#define DIG_STORE_TEXT_SIZE 40

/// Where a run came from. Gravel, effect, magnitude, approach, packing and trajectory are its key.
struct dig_run_origin {
    struct dig_gravel   gravel;
    char                effect[DIG_NAME_SIZE]; // put into the scene at this magnitude; "": none
    double              magnitude;             // 0 without an effect
    struct dig_approach approach;              // of the trajectory
    size_t              packing;               // 0 … ; which of the gravel's beds
    size_t              trajectory;            // index in the scene
    uint64_t            seed;                  // below 2^63
    char                engine[DIG_STORE_TEXT_SIZE];
    char                version[DIG_STORE_TEXT_SIZE];
    size_t              grains;
    double              wall_s;
    char                made_utc[DIG_STORE_TEXT_SIZE]; // ISO 8601
};

/// A run as stored: DIG_CHANNELS arrays of `windows` samples, the i-th at first_s + i step_s. The
/// carried mass is NaN throughout where it is not known, all else is finite.
struct dig_run {
    struct dig_run_origin origin;
    size_t                windows;
    double                first_s, step_s;
    const float          *value;
};

/// Opens path for writing, and makes it first where there is none. DIG_EINVAL when it holds another
/// scene (both named) or is no table; DIG_ESCHEMA when it is of another version; DIG_EIO when
/// another process writes to it or the disk refuses. Nothing is left behind when a new table fails.
DIG_MUST_CHECK enum dig_status dig_store_create(const char *path, const struct dig_scene *scene,
                                                struct dig_store **store, struct dig_error *error);

/// Opens an existing table to read its runs.
DIG_MUST_CHECK enum dig_status dig_store_open(const char *path, struct dig_store **store,
                                              struct dig_error *error);

/// NULL is allowed.
void dig_store_close(struct dig_store *store);

/// In a forked child, which must not touch the store: lets go of the lock, so that a child that
/// outlives its parent does not hold it.
void dig_store_forget(struct dig_store *store);

/// All trajectories of the scene, in its order.
const struct dig_trajectory *dig_store_trajectories(const struct dig_store *store, size_t *count);

/// Stores one dig and refreshes its entry, both or neither. The recording's samples must be evenly
/// spaced (within 1 % of the spacing). DIG_EINVAL for a recording that is not finite, not even, or
/// for a run that is there already; for an effect core/effect.h does not name; for an approach out
/// of range. A carried mass that is missing in one row is stored as not known in any.
DIG_MUST_CHECK enum dig_status dig_store_put(struct dig_store            *store,
                                             const struct dig_run_origin *origin,
                                             const struct dig_recording  *recording,
                                             struct dig_error            *error);

/// What is put from here on is stored by dig_store_commit(), all or nothing: dig_store_close()
/// without it, or a crash, takes it back. Once, not within another.
DIG_MUST_CHECK enum dig_status dig_store_begin(struct dig_store *store, struct dig_error *error);
DIG_MUST_CHECK enum dig_status dig_store_commit(struct dig_store *store, struct dig_error *error);

/// Writes true to *there when the run with the key of *origin is stored.
DIG_MUST_CHECK enum dig_status dig_store_has(struct dig_store            *store,
                                             const struct dig_run_origin *origin, bool *there,
                                             struct dig_error *error);

/// Called for each run, ordered by gravel, effect (none first), magnitude, depth, attack,
/// trajectory, packing.
/// Anything but DIG_OK ends the walk and is returned.
struct dig_run_visitor {
    enum dig_status (*visit)(void *context, const struct dig_run *run, struct dig_error *error);
    void *context;
};

DIG_MUST_CHECK enum dig_status dig_store_walk(struct dig_store             *store,
                                              const struct dig_run_visitor *visitor,
                                              struct dig_error             *error);

/// What dig_store_check() counted.
struct dig_store_report {
    size_t entries; // (gravel, effect, magnitude) x trajectory
    size_t runs;
    size_t builds;     // engines and versions of them that made the runs
    size_t points;     // gravels dug plainly: without an effect, as the trajectory stands
    size_t effects;    // gravels with an effect
    size_t approaches; // gravels without one, at another depth or attack
    size_t holes;      // grid points between the axes' values that hold no gravel
    size_t incomplete; // entries with fewer packings than most others of their kind have

    struct dig_table_step step; // core/table_step.h
};

/// Recomputes every entry from its runs and refuses the first that differs (DIG_EINVAL, named).
DIG_MUST_CHECK enum dig_status
dig_store_check(struct dig_store *store, struct dig_store_report *report, struct dig_error *error);

#endif // DIG_TABLES_STORE_H
