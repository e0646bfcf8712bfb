#include "offline_dem/device/engine_cuda.h"

#include "offline_dem/device/device_cuda.h"
#include "offline_dem/dig/checked_pour.h"

// A card for this scene. NULL: *status and *error say why.
static struct dig_device *open_card(const struct dig_scene *const scene,
                                    enum dig_status *const status, struct dig_error *const error)
{
    for (size_t i = 0; i < scene->bed.obstacles; i++) {
        if (scene->bed.obstacle[i].movable) {
            *status =
                dig_error_set(error, DIG_EINVAL,
                              "obstacles[%zu].movable: expected false with the cuda engine", i);
            return NULL;
        }
    }
    struct dig_device *const card = dig_device_cuda_create(error);
    *status                       = card != NULL ? DIG_OK : DIG_EIO;
    return card;
}

static enum dig_status pour(const struct dig_stepper *const asked,
                            const struct dig_scene *const   scene,
                            const struct dig_gravel *const gravel, const uint64_t seed,
                            const struct dig_progress *const progress, struct dig_bed *const bed,
                            struct dig_error *const error)
{
    // A card for every bed, in the process that pours it.
    enum dig_status          status = DIG_OK;
    struct dig_device *const card   = open_card(scene, &status, error);
    if (card == NULL) {
        return status;
    }
    const struct dig_stepper stepper = { .device = card, .threads = asked->threads };
    status = dig_bed_pour_checked(&stepper, scene, gravel, seed, progress, bed, error);
    card->destroy(card);
    return status;
}

static enum dig_status dig(const struct dig_stepper *const asked,
                           const struct dig_scene *const   scene,
                           const struct dig_gravel *const gravel, const struct dig_bed *const bed,
                           const struct dig_trajectory *const trajectory, const char *const vtk_dir,
                           const struct dig_progress *const progress,
                           struct dig_recording *const recording, struct dig_error *const error)
{
    // A card for every bed, in the process that pours it.
    enum dig_status          status = DIG_OK;
    struct dig_device *const card   = open_card(scene, &status, error);
    if (card == NULL) {
        return status;
    }
    const struct dig_stepper stepper = { .device = card, .threads = asked->threads };
    status =
        dig_dig_run(&stepper, scene, gravel, bed, trajectory, vtk_dir, progress, recording, error);
    card->destroy(card);
    return status;
}

struct dig_engine dig_engine_cuda(void)
{
    struct dig_engine engine = dig_engine_kernel();
    engine.name              = "cuda";
    engine.pour              = pour;
    engine.dig               = dig;
    return engine;
}
