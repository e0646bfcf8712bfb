// The slow reference of the grain kernel: every grain an ODE body with a sphere for its geometry,
// found by ODE's spaces, collided by dCollide, moved by dWorldQuickStep. Only the law is ours,
// applied by dBodyAddForce; ODE's contact joints are not used
// (docs/adr/0001-explicit-contact-law.md).
//
// ODE decides which grains come near the bucket; the contact points are those of tool.c
// (docs/adr/0002-tool-narrow-phase.md).
//
// ODE steps v += dt (F/m + g), x += dt v, which is the leap-frog of world.h; the first kick is half
// of one. The kernel's lists, blocks and sorting are not used here: both give the same motion until
// rounding has grown.

#ifndef DIG_OFFLINE_DEM_REFERENCE_ODE_BED_H
#define DIG_OFFLINE_DEM_REFERENCE_ODE_BED_H

#include "offline_dem/world/world.h"

struct dig_ode_bed; // one ODE world; not to be shared between threads

/// ODE bodies for the grains, laws, walls, rocks and time step of a world that has not been
/// stepped. The world is only read. Movable rocks stand in one ODE scene, so that only one of the
/// two may be stepped. NULL when memory is short, or the world has clumps: ODE rotates bodies by
/// another scheme, which agrees with rigid.h's to the order of the step only.
struct dig_ode_bed *dig_ode_bed_create(const struct dig_world *world);

/// NULL is allowed.
void dig_ode_bed_destroy(struct dig_ode_bed *bed);

/// One step; tool and *on_tool as in struct dig_world. About a microsecond a grain. DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status
dig_ode_bed_step(struct dig_ode_bed *bed, const struct dig_tool *tool, struct dig_wrench *on_tool);

/// Grains keep the indices of the world the bed was made from.
struct dig_motion dig_ode_bed_motion(const struct dig_ode_bed *bed, size_t grain);

#endif // DIG_OFFLINE_DEM_REFERENCE_ODE_BED_H
