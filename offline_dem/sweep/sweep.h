// A whole table: every bed of a plan poured and dug, one process a bed, on all cores.
//
//   parent: queue -> fork a worker for a bed -> read its curves -> store, one transaction each
//   worker: pour the bed, dig it with one trajectory after another, send each curve when it is done
//
// Only the parent touches the table. A worker that is killed costs its unfinished digs, which are
// tried once more; a parent that is killed takes its workers along, and the next sweep goes on with
// what the table lacks. Every curve is computed from its own seed alone, so it does not matter in
// which order, on how many cores, or in how many attempts a table was made.

#ifndef DIG_OFFLINE_DEM_SWEEP_SWEEP_H
#define DIG_OFFLINE_DEM_SWEEP_SWEEP_H

#include "core/error.h"
#include "offline_dem/dig/dig.h"
#include "tables/queue.h"
#include "tables/store.h"

#include <signal.h>

/// An engine as functions, called with its stepper; tests use one that takes no time. version
/// differs between two builds that may compute differently.
struct dig_engine {
    const char        *name;
    const char        *version;
    struct dig_stepper stepper;
    enum dig_status (*pour)(const struct dig_stepper *stepper, const struct dig_scene *scene,
                            const struct dig_gravel *gravel, uint64_t seed,
                            const struct dig_progress *progress, struct dig_bed *bed,
                            struct dig_error *error);
    enum dig_status (*dig)(const struct dig_stepper *stepper, const struct dig_scene *scene,
                           const struct dig_gravel *gravel, const struct dig_bed *bed,
                           const struct dig_trajectory *trajectory, const char *vtk_dir,
                           const struct dig_progress *progress, struct dig_recording *recording,
                           struct dig_error *error);
};

/// The grain kernel: offline_dem/dig/dig.h. Its version is the release and, behind a plus, a hash
/// of the sources and the compiler settings its numbers depend on.
struct dig_engine dig_engine_kernel(void);

/// The same in single precision, where the law allows (offline_dem/kernel/kernel.h): faster, and
/// other digs of the same gravel. stepper.threads step a large bed, with the same bits.
struct dig_engine dig_engine_single(void);

/// Progress of a sweep. digs_under_way counts fractions of running digs.
struct dig_sweep_state {
    size_t digs_total, digs_done; // of the whole plan, stored ones included
    double digs_under_way;
    size_t workers;
    size_t failed; // digs given up
    double elapsed_s;
    double left_s; // NaN: not yet known
};

struct dig_sweep_options {
    size_t workers;      // processes at a time, >= 1
    double time_limit_s; // no new dig is begun after it; INFINITY: none
    // Set to non-zero by a signal handler: workers are stopped and finished digs are kept.
    const volatile sig_atomic_t *stop;
    // Called about every second and after each dig stored; NULL: not at all.
    void (*report)(void *context, const struct dig_sweep_state *state);
    void *context;
};

/// Runs the plan into the store. DIG_OK when nothing failed, whether or not a limit or a stop cut
/// it short: state->digs_done < digs_total says so. DIG_EIO when digs failed (the first one's
/// reason in *error) or the table cannot be written. *state is always filled in.
///
/// Forks: call it from a process without threads.
DIG_MUST_CHECK enum dig_status
dig_sweep_run(const struct dig_scene *scene, const struct dig_plan *plan,
              const struct dig_engine *engine, const struct dig_sweep_options *options,
              struct dig_store *store, struct dig_sweep_state *state, struct dig_error *error);

/// Seconds on the monotonic clock.
double dig_sweep_now_s(void);

#endif // DIG_OFFLINE_DEM_SWEEP_SWEEP_H
