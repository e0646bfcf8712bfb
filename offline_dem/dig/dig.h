// One dig, from an empty box to a curve: pour, level, drive the bucket, record.
// The same inputs give the same bits, on any number of threads.

#ifndef DIG_OFFLINE_DEM_DIG_DIG_H
#define DIG_OFFLINE_DEM_DIG_DIG_H

#include "core/bed.h"
#include "core/curve.h"
#include "core/error.h"
#include "core/recording.h"
#include "core/scene.h"
#include "core/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct dig_world;

/// Who steps the grains; NULL: the kernel, in double precision.
struct dig_stepper {
    // Makes something else step a world: sets its stand_in (offline_dem/world/world.h). DIG_ENOMEM,
    // or another status and *error. NULL: the kernel steps.
    enum dig_status (*take_over)(struct dig_world *world, struct dig_error *error);
    bool single_precision; // of the kernel, where it can (kernel.h)
    size_t
        threads; // in a large bed; 0, 1: none beside the caller. With a device they make its lists
};

/// Called from the computing thread every hundred steps or so with the simulated time done and in
/// total, packing included. Return false to stop; the call then returns DIG_ESTALE and writes
/// nothing.
struct dig_progress {
    int (*report)(void *context, double done_s, double total_s);
    void *context;
};

/// Pours and levels a bed of this gravel. A device (offline_dem/world/device.h) moves no rocks. The
/// kernel takes 4 s of one core with AVX-512 for
/// 7000 grains, half a minute without. *bed is written on success only; error may be NULL.
/// DIG_EINVAL when the scene or the gravel cannot be computed or the scene's time step is too long
/// for it, DIG_EUNREACHABLE when the grains do not fit, DIG_ESTALE when stopped, DIG_EIO when the
/// device fails, DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_bed_pour(const struct dig_stepper *stepper,
                                            const struct dig_scene   *scene,
                                            const struct dig_gravel *gravel, uint64_t seed,
                                            const struct dig_progress *progress,
                                            struct dig_bed *bed, struct dig_error *error);

/// Moves the bucket along the trajectory in a copy of the bed. 12 s of one core with AVX-512 for 3
/// s of digging in 7000 grains. Pictures go into vtk_dir, 10 a second of digging
/// (offline_dem/dig/vtk.h); NULL: none. Fails as dig_bed_pour(), for an impossible bed or
/// trajectory, and with DIG_EIO when a picture cannot be written.
DIG_MUST_CHECK enum dig_status
dig_dig_run(const struct dig_stepper *stepper, const struct dig_scene *scene,
            const struct dig_gravel *gravel, const struct dig_bed *bed,
            const struct dig_trajectory *trajectory, const char *vtk_dir,
            const struct dig_progress *progress, struct dig_recording *recording,
            struct dig_error *error);

#endif // DIG_OFFLINE_DEM_DIG_DIG_H
