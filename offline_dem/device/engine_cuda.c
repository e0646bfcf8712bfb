#include "offline_dem/device/engine_cuda.h"

#include "offline_dem/device/device_cuda.h"
#include "offline_dem/world/bodies.h"
#include "offline_dem/world/offloaded.h"

// A card for every bed, in the process that pours it.
static enum dig_status take_over(struct dig_world *const world, struct dig_error *const error)
{
    for (size_t i = 0; world->bodies != NULL && i < world->bodies->obstacles.rocks; i++) {
        if (world->bodies->obstacles.rock[i].movable) {
            return dig_error_set(error, DIG_EINVAL,
                                 "obstacles[%zu].movable: expected false with the cuda engine", i);
        }
    }
    struct dig_device *const card = dig_device_cuda_create(error);
    return card != NULL ? dig_offload(world, card) : DIG_EIO;
}

struct dig_engine dig_engine_cuda(void)
{
    struct dig_engine engine = dig_engine_kernel();
    engine.name              = "cuda";
    engine.stepper.take_over = take_over;
    return engine;
}
