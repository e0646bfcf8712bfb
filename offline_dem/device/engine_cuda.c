#include "offline_dem/device/engine_cuda.h"

#include "offline_dem/device/device_cuda.h"
#include "offline_dem/dig/checked_pour.h"

static enum dig_status check(const struct dig_scene *const scene, struct dig_error *const error)
{
    for (size_t i = 0; i < scene->bed.obstacles; i++) {
        if (scene->bed.obstacle[i].movable) {
            return dig_error_set(error, DIG_EINVAL,
                                 "obstacles[%zu].movable: expected false with the cuda engine", i);
        }
    }
    return DIG_OK;
}

static enum dig_status pour(const struct dig_scene *const  scene,
                            const struct dig_gravel *const gravel, const uint64_t seed,
                            const struct dig_progress *const progress, struct dig_bed *const bed,
                            struct dig_error *const error)
{
    enum dig_status status = check(scene, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_device *const card = dig_device_cuda_create(error);
    if (card == NULL) {
        return DIG_EIO;
    }
    status = dig_bed_pour_checked(card, scene, gravel, seed, progress, bed, error);
    card->destroy(card);
    return status;
}

static enum dig_status dig(const struct dig_scene *const  scene,
                           const struct dig_gravel *const gravel, const struct dig_bed *const bed,
                           const struct dig_trajectory *const trajectory, const char *const vtk_dir,
                           const struct dig_progress *const progress,
                           struct dig_recording *const recording, struct dig_error *const error)
{
    enum dig_status status = check(scene, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_device *const card = dig_device_cuda_create(error);
    if (card == NULL) {
        return DIG_EIO;
    }
    status = dig_dig_run(card, scene, gravel, bed, trajectory, vtk_dir, progress, recording, error);
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
