// A machine beside the processor that steps the grains of a world, a graphics card say: all grains
// at once, where the kernel takes their contacts in blocks.
//
//   processor                                device
//   neighbour list, walls, tool    upload    a thread a pair:  law -> pushes on both
//   (offloaded.h)                  ------>   a thread a grain: walls, plates, rocks -> push
//                                  <------   then a thread a clump: pushes -> its spheres' speeds
//                                 download   then a thread a grain: pushes -> motion
//                                            … step after step, until a grain wants new lists
//
// What a thread does stands in device_pair.h, device_surfaces.h and device_grain.h, in C for both
// sides: a device that rounds as the processor does gives the same bits as the loop of
// tests/offline_dem/host_device.c; but for clumps, whose sines are the device's own.

#ifndef DIG_OFFLINE_DEM_WORLD_DEVICE_H
#define DIG_OFFLINE_DEM_WORLD_DEVICE_H

#include "offline_dem/kernel/clump_body.h"
#include "offline_dem/kernel/grains.h"
#include "offline_dem/law/law.h"
#include "offline_dem/law/wall.h"
#include "offline_dem/shapes/rock_surface.h"
#include "offline_dem/shapes/tool.h"

#include <stdbool.h>
#include <stdint.h>

/// Of everything in this header: a device library of another number is refused.
#define DIG_DEVICE_VERSION 2

// Surfaces are numbered: walls, then plates, then rocks.
#define DIG_DEVICE_ROCKS    (DIG_WALLS_MAX + DIG_PLATES_MAX)
#define DIG_DEVICE_SURFACES (DIG_DEVICE_ROCKS + DIG_OBSTACLES_MAX)
#define DIG_DEVICE_LAWS     (DIG_GRAIN_TYPES_MAX * DIG_GRAIN_TYPES_MAX)

/// The grains and their contacts as arrays. A pair has a place as long as a neighbour list lives:
/// the place of the neighbour list, under its row grain.
struct dig_device_view {
    uint32_t n, pairs, clumps;
    uint32_t surface_rows; // numbers below it: as many rows of surface count

    // Fixed between two uploads.
    const uint8_t *type_of;         // [n] kinds
    const double (*reference_m)[4]; // [n] where the list was made, and the margin
    uint32_t       *pair_i;         // [pairs] the grain a pair stands under, and
    const uint32_t *pair_j;         // [pairs] the other one
    uint32_t       *load_start;     // [n + 1] a grain's pushes are first[i] … first[i + 1] - 1
    uint32_t (*load_index)[2];      // [pairs] places of the pushes on row and on other
    const struct dig_law *pair_law; // [DIG_DEVICE_LAWS] row's kind x DIG_GRAIN_TYPES_MAX + other's
    const struct dig_law *wall_law; // [DIG_GRAIN_TYPES_MAX]
    const struct dig_law *tool_law; // [DIG_GRAIN_TYPES_MAX]
    const struct dig_grain_type  *type;  // [DIG_GRAIN_TYPES_MAX]
    const struct dig_clump_shape *shape; // of all clumps

    // State.
    struct dig_motion          *motion;          // [n]
    struct dig_contact_history *pair_history;    // [pairs]
    uint8_t                    *touching;        // [2 pairs] of a push: whether its pair touches
    struct dig_load            *pair_load;       // [2 pairs] of those that do
    struct dig_contact_history *surface_history; // [surfaces_used][n]
    uint64_t                   *surface_mask;    // [n] bit s: touches surface s
    struct dig_load            *surface_load;    // [n] what walls, tool and rocks do to a grain
    struct dig_wrench          *on_tool; // [n] sum over steps of what each grain does to the tool
    struct dig_clump_body      *clump;   // [clumps]
    uint32_t                   *margin_flag; // [DIG_MARGIN_FLAGS] set when some grain …
};

enum dig_margin_flag {
    DIG_MARGIN_NEARLY_LEFT, // … will leave its margin within the steps announced
    DIG_MARGIN_LEFT,        // … has left it, or is nowhere: pairs may have been missed
    DIG_MARGIN_FLAGS
};

/// One step. The tool stands where it is at the time of the present positions.
struct dig_device_step {
    double                  kick_s, dt_s;
    double                  horizon_s; // how long until attention is asked for again
    double                  gravity_mps2[3];
    double                  period_y_m, inverse_period; // 0: sides; and the inverse
    uint32_t                walls;
    struct dig_wall         wall[DIG_WALLS_MAX];
    uint32_t                rocks;
    struct dig_rock_surface rock[DIG_OBSTACLES_MAX]; // fixed
    bool                    has_tool;                // whether there is a tool
    struct dig_tool         tool;
};

/// What a device can do. Every function returns DIG_ENOMEM when the device's memory is short and
/// DIG_EIO when the device fails; it is of no use afterwards.
struct dig_device {
    const char *name; // of the machine, for people
    void       *own;

    /// Takes over a copy of the whole view, whose arrays stay the caller's.
    enum dig_status (*upload)(struct dig_device *device, const struct dig_device_view *view);

    /// One step after the other; may return before it is done.
    enum dig_status (*step)(struct dig_device *device, const struct dig_device_step *step);

    /// Waits for all steps; then what they called for.
    enum dig_status (*poll_margins)(struct dig_device *device,
                                    uint32_t           margin_flag[DIG_MARGIN_FLAGS]);

    /// Waits for all steps; then fills motion, clump and on_tool of the view that was uploaded and
    /// clears the device's on_tool. With `all` the memories, touching, surface and surfaces, too.
    enum dig_status (*download)(struct dig_device *device, bool all);

    /// Gives everything back, the struct too.
    void (*destroy)(struct dig_device *device);
};

#endif // DIG_OFFLINE_DEM_WORLD_DEVICE_H
