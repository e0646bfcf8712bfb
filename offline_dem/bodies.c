#include "offline_dem/bodies.h"

enum dig_status dig_bodies_pick(struct dig_world *const world)
{
    (void)world;
    return DIG_OK;
}

void dig_bodies_push(struct dig_world *const world)
{
    (void)world;
}

void dig_bodies_advance(struct dig_world *const world)
{
    (void)world;
}

void dig_bodies_move(struct dig_bodies *const bodies, const uint32_t place[])
{
    (void)bodies;
    (void)place;
}
