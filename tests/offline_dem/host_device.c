#include "tests/offline_dem/host_device.h"

#include "offline_dem/device/device_grain.h"
#include "offline_dem/device/device_surfaces.h"
#include "offline_dem/world/offloaded.h"

#include <stdlib.h>

// Both the interface and what it owns.
struct host {
    struct dig_device      device;
    struct dig_device_view view;
};

static struct host *host_of(struct dig_device *const device)
{
    return device->own;
}

static enum dig_status upload(struct dig_device *const            device,
                              const struct dig_device_view *const view)
{
    host_of(device)->view = *view;
    return DIG_OK;
}

static enum dig_status step(struct dig_device *const device, const struct dig_device_step *const s)
{
    const struct dig_device_view *const view = &host_of(device)->view;
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
    for (int a = 0; a < DIG_MARGIN_FLAGS; a++) {
        margin_flag[a] = host_of(device)->view.margin_flag[a];
    }
    return DIG_OK;
}

// All is there. That on_tool begins anew is up to who adds it up: see offloaded.c.
static enum dig_status download(struct dig_device *const device, const bool all)
{
    (void)device;
    (void)all;
    return DIG_OK;
}

static void destroy(struct dig_device *const device)
{
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
