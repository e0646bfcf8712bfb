// One dig, from an empty box to a curve: pour, level, drive the bucket, record.
// One process a dig: nothing here uses threads, and the same inputs give the same bits.

#ifndef DIG_OFFLINE_DEM_DIG_H
#define DIG_OFFLINE_DEM_DIG_H

#include "core/curve.h"
#include "core/error.h"
#include "core/recording.h"
#include "core/scene.h"
#include "core/status.h"

#include <stdint.h>

/// A settled bed, one grain an index; owned by the caller, freed with dig_bed_finish().
struct dig_bed {
    size_t  grains;
    double *x_m, *y_m, *z_m, *radius_m; // [grains]
};

/// Called now and then from the computing thread: done of total seconds of simulated time (packing
/// counted in). Return false to stop; the call then returns DIG_ESTALE and writes nothing.
struct dig_progress {
    int (*tell)(void *context, double done_s, double total_s);
    void *context;
};

/// Pours and levels a bed of this gravel. Minutes of one core for 7000 grains are normal; seconds
/// with a fast machine. DIG_EINVAL when the scene or the gravel cannot be computed.
DIG_MUST_CHECK enum dig_status dig_bed_pour(const struct dig_scene  *scene,
                                            const struct dig_gravel *gravel, uint64_t seed,
                                            const struct dig_progress *progress,
                                            struct dig_bed *bed, struct dig_error *error);

void dig_bed_finish(struct dig_bed *bed);

/// Drives the bucket through the trajectory in a copy of the bed. vtk_dir NULL: no pictures.
DIG_MUST_CHECK enum dig_status
dig_dig_run(const struct dig_scene *scene, const struct dig_gravel *gravel,
            const struct dig_bed *bed, const struct dig_trajectory *trajectory, const char *vtk_dir,
            const struct dig_progress *progress, struct dig_recording *recording,
            struct dig_error *error);

/// The step a dig is computed with, s: the scene's, or derived from the Rayleigh and contact times.
double dig_time_step_s(const struct dig_scene *scene, double density_kgpm3);

#endif // DIG_OFFLINE_DEM_DIG_H
