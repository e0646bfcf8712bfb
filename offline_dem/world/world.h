// A box of grains, its walls and perhaps a tool, stepped through time with neighbour list, contact
// lists and kernel. Leap-frog: forces at x(t) with v(t - dt/2), which is velocity Verlet whose half
// kicks between two steps are done as one.

#ifndef DIG_OFFLINE_DEM_WORLD_WORLD_H
#define DIG_OFFLINE_DEM_WORLD_WORLD_H

#include "core/status.h"
#include "offline_dem/kernel/contacts.h"
#include "offline_dem/kernel/grains.h"
#include "offline_dem/kernel/kernel.h"
#include "offline_dem/kernel/neighbour.h"
#include "offline_dem/law/law.h"
#include "offline_dem/law/wall.h"
#include "offline_dem/shapes/tool.h"

#include <stdbool.h>
#include <stdint.h>

struct dig_bodies;
struct dig_crew;
struct dig_ode_scene;
struct dig_world;

#define DIG_PAIR_LISTS ((size_t)DIG_GRAIN_TYPES_MAX * DIG_GRAIN_TYPES_MAX)

// Lists of grain types with surfaces: walls from 0 on, then plates of the tool, then rocks.
#define DIG_PLATE_LISTS   ((size_t)DIG_GRAIN_TYPES_MAX)
#define DIG_ROCK_LISTS    ((size_t)2 * DIG_GRAIN_TYPES_MAX)
#define DIG_SURFACE_LISTS ((size_t)3 * DIG_GRAIN_TYPES_MAX)

// Numbers of surfaces in these lists, which do not depend on what else is there.
#define DIG_FIRST_PLATE DIG_WALLS_MAX
#define DIG_FIRST_ROCK  (DIG_FIRST_PLATE + DIG_PLATES_MAX)

/// Work memory of contact_detection.c: the place of each pair and surface in the lists under
/// replacement (UINT32_MAX in between), and the new lists.
struct dig_contact_detection {
    uint32_t           *old_pair, *old_surface, *near_pairs;
    size_t              pair_room, surface_room, near_room; // allocated entries
    uint32_t           *near_count;                         // [grains] near pairs of each
    uint32_t           *count; // [slabs x DIG_PAIR_LISTS] contacts of a slab in each list
    size_t              near_count_room, count_room;
    struct dig_contacts pair[DIG_PAIR_LISTS];
    struct dig_contacts surface[DIG_SURFACE_LISTS];
};

/// What steps the grains of a world in the kernel's place. Status as dig_world_step() and
/// dig_world_sync().
struct dig_stand_in {
    enum dig_status (*step)(struct dig_world *world);
    /// Motions to the world; with `all` contacts, too, and what is written then counts.
    enum dig_status (*sync)(struct dig_world *world, bool all);
    void (*destroy)(struct dig_world *world);
};

struct dig_world {
    // Fixed at start.
    double dt_s;
    double gravity_mps2[3];
    // Laws of every pair of types [type_i * DIG_GRAIN_TYPES_MAX + type_j], type_i <= type_j, and of
    // every type with the walls and with the tool.
    struct dig_law  pair_law[DIG_PAIR_LISTS];
    struct dig_law  wall_law[DIG_GRAIN_TYPES_MAX];
    struct dig_law  tool_law[DIG_GRAIN_TYPES_MAX];
    size_t          walls;
    struct dig_wall wall[DIG_WALLS_MAX];
    enum dig_isa    isa;
    bool single; // velocities, loads and contacts in single precision (kernel.h); from the first
                 // step on false with other laws than the plain one and with clumps
    double period_y_m; // > 0: no sides, y repeats; more than 8 radii of the largest grain and the
                       // tool's width with as much beside it. Grains stay in [-P/2, P/2] nearly

    // Threads that share the slabs of a step, owned by the caller; NULL: none. They change no bit.
    struct dig_crew *crew;

    // May be moved between steps; NULL: no tool.
    struct dig_tool *tool;

    // Clumps and obstacles, owned by the caller; NULL: none.
    struct dig_bodies *bodies;

    // The scene in ODE, owned by the caller, which moves bucket and rocks; NULL: nothing does.
    struct dig_ode_scene *ode;

    // Steps the grains, and what it keeps for that; NULL: the kernel does.
    const struct dig_stand_in *stand_in;
    void                      *stand_in_own;

    // State.
    struct dig_grains grains;
    bool              started; // the first kick is half a step
    size_t            steps;
    struct dig_wrench on_tool;  // of the last step of the kernel
    struct dig_wrench sum_tool; // of the steps since dig_world_take_wrench()
    struct dig_wrench on_walls; // of the last step of the kernel

    // What the slabs of a step give besides motion: summed in their order.
    struct dig_slab_sums {
        struct dig_wrench on_tool, on_walls;
        bool              left; // a grain has left its margin
    } * slab_sums;              // [slabs]
    size_t slab_sums_room;

    // Lists and their margins.
    struct dig_neighbours neighbours;
    struct dig_contacts
        pair[DIG_GRAIN_TYPES_MAX * DIG_GRAIN_TYPES_MAX]; // type_i * TYPES_MAX + type_j
    struct dig_contacts          surface[DIG_SURFACE_LISTS];
    struct dig_contact_detection detection;
    double (*reference_m)[4]; // [n] position at the last contact detection, and margin
    size_t          reference_room;
    struct dig_pose tool_reference;
    double          tool_margin_m;
    bool            stale;
    size_t          list_rebuilds, contact_rebuilds; // counts, for tuning
};

/// Place of a surface, by its number, among those that are there: walls, plates, rocks. SIZE_MAX: a
/// wall or a tool that is gone.
static inline size_t dig_world_surface(const struct dig_world *const world, const uint32_t number)
{
    const size_t plates = world->tool != NULL ? world->tool->plates : 0;
    if (number < DIG_FIRST_PLATE) {
        return number < world->walls ? number : SIZE_MAX;
    }
    if (number < DIG_FIRST_ROCK) {
        const size_t plate = number - DIG_FIRST_PLATE;
        return plate < plates ? world->walls + plate : SIZE_MAX;
    }
    return world->walls + plates + number - DIG_FIRST_ROCK;
}

/// Takes over *grains. The caller fills the fixed fields of a zeroed *world; the laws before the
/// first step.
void dig_world_init(struct dig_world *world, struct dig_grains *grains);

/// Marks the lists stale: after grains were moved, or a tool was given or removed. They are remade
/// before the next step and keep all contacts.
void dig_world_mark_stale(struct dig_world *world);

/// Removes grains for which drop[i] is not 0; contacts between the others keep their history.
DIG_MUST_CHECK enum dig_status dig_world_drop(struct dig_world *world, const unsigned char drop[]);

/// One step. The tool, if any, stands at its pose of the present positions. DIG_ENOMEM; DIG_EINVAL
/// when a grain moves farther than its radius in a step or its position is not finite: the time
/// step is too long.
DIG_MUST_CHECK enum dig_status dig_world_step(struct dig_world *world);

/// Wrench on the tool, summed over the steps since the last call. Status as dig_world_step().
DIG_MUST_CHECK enum dig_status dig_world_take_wrench(struct dig_world  *world,
                                                     struct dig_wrench *wrench);

/// Before motions are read: copies them from single precision, or from what stands in for the
/// kernel. Fails with a device only.
DIG_MUST_CHECK enum dig_status dig_world_sync_motion(struct dig_world *world);

/// Before motions are written or grains removed: the same, and contacts from a device. What is
/// written then counts.
DIG_MUST_CHECK enum dig_status dig_world_sync(struct dig_world *world);

void dig_world_finish(struct dig_world *world);

#endif // DIG_OFFLINE_DEM_WORLD_WORLD_H
