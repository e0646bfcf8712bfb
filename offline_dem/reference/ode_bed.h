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

/// From now on ODE steps the grains of a world that has not been stepped, and its rocks. About a
/// microsecond a grain and step. No motion may be written, and no grain be taken away. DIG_ENOMEM;
/// DIG_EINVAL for clumps: ODE rotates bodies by another scheme, which agrees with rigid.h's to the
/// order of the step only.
DIG_MUST_CHECK enum dig_status dig_ode_bed_take_over(struct dig_world *world);

#endif // DIG_OFFLINE_DEM_REFERENCE_ODE_BED_H
