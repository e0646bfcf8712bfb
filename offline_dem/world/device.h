// A device that steps the grains of a world in the kernel's place, such as a graphics card: all
// grains at once, where the kernel takes contacts in blocks.
//
//   host                                     device
//   neighbour list, walls, tool    upload    a thread a pair:  law -> load on both grains
//   (offloaded.h)                  ------>   a thread a grain: walls, plates, rocks -> load
//                                  <------   then a thread a clump: loads -> its spheres'
//                                  velocities
//                                 download   then a thread a grain: loads -> motion
//                                            … step after step, until a grain nears its margin
//                                  relist    a thread a grain: contacts go on in new lists
//
// The work of a thread stands in device_pair.h, device_surfaces.h and device_grain.h, in C for both
// sides. A device that rounds as the processor does gives the bits of
// tests/offline_dem/host_device.c, but for clumps, whose sines are the device's own.

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

/// Version of this header: a device library of another version is refused.
#define DIG_DEVICE_VERSION 4

#define DIG_DEVICE_LAWS (DIG_GRAIN_TYPES_MAX * DIG_GRAIN_TYPES_MAX)

/// The grains and their contacts as arrays. A pair keeps its place in the neighbour list as long as
/// that list lives. Surfaces are numbered walls first, then plates of the tool, then rocks.
struct dig_device_view {
    uint32_t n, pairs, clumps;
    uint32_t walls, plates; // 0 plates: no tool
    uint32_t surfaces;      // walls, plates and rocks

    // Fixed between two uploads.
    const uint8_t *type_of;         // [n] grain types
    const double (*reference_m)[4]; // [n] position when the list was made, and the margin
    uint32_t       *pair_i;         // [pairs] the grain that lists the pair
    const uint32_t *pair_j;         // [pairs] its partner
    const uint32_t *pair_start; // [n + 1] grain i lists pairs pair_start[i] … pair_start[i + 1] - 1
    uint32_t       *load_start; // [n + 1] loads of grain i: load_start[i] … load_start[i + 1] - 1
    uint32_t (*load_index)[2];  // [pairs] places of the loads on i and on j
    const struct dig_law *pair_law; // [DIG_DEVICE_LAWS] type of i x DIG_GRAIN_TYPES_MAX + type of j
    const struct dig_law *wall_law; // [DIG_GRAIN_TYPES_MAX]
    const struct dig_law *tool_law; // [DIG_GRAIN_TYPES_MAX]
    const struct dig_grain_type  *type;  // [DIG_GRAIN_TYPES_MAX]
    const struct dig_clump_shape *shape; // of all clumps

    // State.
    struct dig_motion          *motion;          // [n]
    struct dig_contact_history *pair_history;    // [pairs]
    uint8_t                    *touching;        // [2 pairs] of a load: whether its pair touches
    struct dig_load            *pair_load;       // [2 pairs] valid where touching
    struct dig_contact_history *surface_history; // [surfaces][n]
    uint64_t                   *surface_mask;    // [n] bit s: touches surface s
    struct dig_load            *surface_load;    // [n] from walls, tool and rocks
    struct dig_wrench          *on_tool; // [n] wrench of each grain on the tool, summed over steps;
                                         // zero at first
    struct dig_clump_body *clump;        // [clumps]
    uint32_t              *margin_flag;  // [DIG_MARGIN_FLAGS] set when some grain …
};

/// What a device's array holds at first: what the view's does; the same, but at a relist() what the
/// device carries over; what the device makes.
enum dig_device_array { DIG_DEVICE_GIVEN, DIG_DEVICE_KEPT, DIG_DEVICE_MADE };

/// The arrays of a view v and their lengths, for those who copy them.
#define DIG_DEVICE_ARRAYS(array, v)                                                                \
    array(type_of, (v)->n, DIG_DEVICE_GIVEN) array(reference_m, (v)->n, DIG_DEVICE_GIVEN)          \
        array(pair_i, (v)->pairs, DIG_DEVICE_KEPT) array(pair_j, (v)->pairs, DIG_DEVICE_GIVEN)     \
            array(pair_start, (v)->n + 1, DIG_DEVICE_GIVEN) array(load_start, (v)->n + 1,          \
                                                                  DIG_DEVICE_GIVEN)                \
                array(load_index, (v)->pairs, DIG_DEVICE_GIVEN) array(pair_law, DIG_DEVICE_LAWS,   \
                                                                      DIG_DEVICE_GIVEN)            \
                    array(wall_law, DIG_GRAIN_TYPES_MAX,                                           \
                          DIG_DEVICE_GIVEN) array(tool_law, DIG_GRAIN_TYPES_MAX, DIG_DEVICE_GIVEN) \
                        array(type, DIG_GRAIN_TYPES_MAX, DIG_DEVICE_GIVEN)                         \
                            array(shape, (v)->shape == NULL ? 0 : 1,                               \
                                  DIG_DEVICE_GIVEN) array(motion, (v)->n, DIG_DEVICE_KEPT)         \
                                array(pair_history, (v)->pairs, DIG_DEVICE_KEPT)                   \
                                    array(touching, (size_t)2 * (v)->pairs, DIG_DEVICE_KEPT)       \
                                        array(pair_load, (size_t)2 * (v)->pairs, DIG_DEVICE_MADE)  \
                                            array(surface_history, (size_t)(v)->surfaces *(v)->n,  \
                                                  DIG_DEVICE_KEPT) array(surface_mask, (v)->n,     \
                                                                         DIG_DEVICE_KEPT)          \
                                                array(surface_load, (v)->n, DIG_DEVICE_MADE)       \
                                                    array(on_tool, (v)->n, DIG_DEVICE_MADE) array( \
                                                        clump, (v)->clumps, DIG_DEVICE_GIVEN)      \
                                                        array(margin_flag, DIG_MARGIN_FLAGS,       \
                                                              DIG_DEVICE_GIVEN)

/// From old lists to new ones.
struct dig_device_move {
    const uint32_t *was;                        // [n] the index that grain i had
    double          period_y_m, inverse_period; // 0: walls; and the inverse
};

enum dig_margin_flag {
    DIG_MARGIN_NEARLY_LEFT, // … may leave its margin within horizon_s
    DIG_MARGIN_LEFT,        // … has left it, or is not finite: pairs may be missing
    DIG_MARGIN_FLAGS
};

/// One step. The tool stands at its pose of the present positions.
struct dig_device_step {
    double                  kick_s, dt_s;
    double                  horizon_s; // time until the flags are polled again
    double                  gravity_mps2[3];
    double                  period_y_m, inverse_period; // 0: walls; and the inverse
    uint32_t                walls;
    struct dig_wall         wall[DIG_WALLS_MAX];
    uint32_t                rocks;
    struct dig_rock_surface rock[DIG_OBSTACLES_MAX]; // fixed
    bool                    has_tool;                // whether there is a tool
    struct dig_tool         tool;
};

/// Operations of a device. Every function returns DIG_ENOMEM when the device is short of memory and
/// DIG_EIO when it fails; the device is useless afterwards.
struct dig_device {
    const char *name; // for messages
    void       *own;

    /// Copies the whole view, whose arrays stay the caller's.
    enum dig_status (*upload)(struct dig_device *device, const struct dig_device_view *view);

    /// Takes the view's lists and clumps, of the same grains and surfaces in another order, and
    /// carries the device's own state over to them (device_carry.h). After download() and no step.
    enum dig_status (*relist)(struct dig_device *device, const struct dig_device_view *view,
                              const struct dig_device_move *move);

    /// Queues one step; may return before it is done.
    enum dig_status (*step)(struct dig_device *device, const struct dig_device_step *step);

    /// Waits for all steps and reads the margin flags.
    enum dig_status (*poll_margins)(struct dig_device *device,
                                    uint32_t           margin_flag[DIG_MARGIN_FLAGS]);

    /// Waits for all steps, fills motion, clump and on_tool of the uploaded view, and clears the
    /// device's on_tool. With `all` the histories, touching and surface_mask, too.
    enum dig_status (*download)(struct dig_device *device, bool all);

    /// Frees the device and this struct.
    void (*destroy)(struct dig_device *device);
};

#endif // DIG_OFFLINE_DEM_WORLD_DEVICE_H
