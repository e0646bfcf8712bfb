#include "tests/offline_dem/host_device.h"

#include "offline_dem/device/device_carry.h"
#include "offline_dem/device/device_grain.h"
#include "offline_dem/device/device_surfaces.h"
#include "offline_dem/world/offloaded.h"

#include <stdlib.h>
#include <string.h>

#define ARRAYS 24

// A view's arrays, of the device's own: what is not uploaded or downloaded must not be missed.
struct memory {
    struct dig_device_view view;
    size_t                 arrays;
    void                  *array[ARRAYS];
    bool                   is_short;
};

// Both the interface and what it owns.
struct host {
    struct dig_device      device;
    struct dig_device_view caller;
    struct memory          memory;
};

static struct host *host_of(struct dig_device *const device)
{
    return device->own;
}

static void forget(struct memory *const m)
{
    for (size_t a = 0; a < m->arrays; a++) {
        free(m->array[a]);
    }
    *m = (struct memory){ 0 };
}

// What has no values yet is filled with ones, which are none that a step may read.
static void *place(struct memory *const m, const void *const from, const size_t bytes)
{
    unsigned char *const to = malloc(bytes + 1);
    m->is_short             = m->is_short || to == NULL;
    if (to != NULL && from != NULL) {
        memcpy(to, from, bytes);
    } else if (to != NULL) {
        memset(to, 0xff, bytes);
    }
    m->array[m->arrays++] = to;
    return to;
}

// The view's arrays; the state of grains and contacts where it is not carried over.
static struct memory copy_of(const struct dig_device_view *const v, const bool carried)
{
    struct memory m        = { .view = *v };
    const bool    given[3] = { [DIG_DEVICE_GIVEN] = true, [DIG_DEVICE_KEPT] = !carried };
#define ARRAY(name, count, how)                                                                    \
    m.view.name = place(&m, given[how] ? v->name : NULL, (count) * sizeof *v->name);
    DIG_DEVICE_ARRAYS(ARRAY, v)
#undef ARRAY
    if (m.view.on_tool != NULL) {
        memset(m.view.on_tool, 0, v->n * sizeof *v->on_tool);
    }
    return m;
}

static enum dig_status upload(struct dig_device *const            device,
                              const struct dig_device_view *const view)
{
    struct host *const host = host_of(device);
    forget(&host->memory);
    host->caller = *view;
    host->memory = copy_of(view, false);
    return host->memory.is_short ? DIG_ENOMEM : DIG_OK;
}

static enum dig_status relist(struct dig_device *const            device,
                              const struct dig_device_view *const view,
                              const struct dig_device_move *const move)
{
    struct host *const host = host_of(device);
    struct memory      from = host->memory;
    host->caller            = *view;
    host->memory            = copy_of(view, true);
    for (uint32_t i = 0; i < view->n && !host->memory.is_short; i++) {
        dig_device_carry_grain(&from.view, move, &host->memory.view, i);
    }
    forget(&from);
    return host->memory.is_short ? DIG_ENOMEM : DIG_OK;
}

static enum dig_status step(struct dig_device *const device, const struct dig_device_step *const s)
{
    const struct dig_device_view *const view = &host_of(device)->memory.view;
    for (uint32_t p = 0; p < view->pairs; p++) {
        dig_device_step_pair(view, s, p);
    }
    for (uint32_t i = 0; i < view->n; i++) {
        dig_device_step_surfaces(view, s, i);
    }
    for (uint32_t b = 0; b < view->clumps; b++) {
        dig_device_step_clump(view, s, b);
    }
    for (uint32_t i = 0; i < view->n; i++) {
        dig_device_step_grain(view, s, i);
    }
    return DIG_OK;
}

static enum dig_status poll_margins(struct dig_device *const device,
                                    uint32_t                 margin_flag[DIG_MARGIN_FLAGS])
{
    memcpy(margin_flag, host_of(device)->memory.view.margin_flag,
           DIG_MARGIN_FLAGS * sizeof *margin_flag);
    return DIG_OK;
}

static enum dig_status download(struct dig_device *const device, const bool all)
{
    const struct dig_device_view *const to   = &host_of(device)->caller;
    const struct dig_device_view *const from = &host_of(device)->memory.view;
    const size_t                        n    = from->n;
    memcpy(to->motion, from->motion, n * sizeof *to->motion);
    memcpy(to->on_tool, from->on_tool, n * sizeof *to->on_tool);
    memset(from->on_tool, 0, n * sizeof *from->on_tool);
    if (from->clumps > 0) {
        memcpy(to->clump, from->clump, from->clumps * sizeof *to->clump);
    }
    if (all) {
        memcpy(to->pair_history, from->pair_history, from->pairs * sizeof *to->pair_history);
        memcpy(to->touching, from->touching, 2 * (size_t)from->pairs * sizeof *to->touching);
        memcpy(to->surface_history, from->surface_history,
               from->surfaces * n * sizeof *to->surface_history);
        memcpy(to->surface_mask, from->surface_mask, n * sizeof *to->surface_mask);
    }
    return DIG_OK;
}

static void destroy(struct dig_device *const device)
{
    forget(&host_of(device)->memory);
    free(device->own);
}

struct dig_device *dem_host_device_create(void)
{
    struct host *const host = calloc(1, sizeof *host);
    if (host == NULL) {
        return NULL;
    }
    host->device = (struct dig_device){
        .name         = "processor",
        .own          = host,
        .upload       = upload,
        .relist       = relist,
        .step         = step,
        .poll_margins = poll_margins,
        .download     = download,
        .destroy      = destroy,
    };
    return &host->device;
}

enum dig_status dem_host_take_over(struct dig_world *const world, struct dig_error *const error)
{
    struct dig_device *const host = dem_host_device_create();
    (void)error;
    return host != NULL ? dig_offload(world, host) : DIG_ENOMEM;
}
