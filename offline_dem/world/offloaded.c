#include "offline_dem/world/offloaded.h"

#include "offline_dem/law/period.h"
#include "offline_dem/world/bodies.h"
#include "offline_dem/world/device_arrays.h"
#include "offline_dem/world/lists.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Wider than the kernel's: a pair costs a device little, a rebuild as much as hundreds of steps.
static const struct dig_skin wide_skin = { 0.5, 500.0, 1.5 };
#define POLL_STEPS       16  // between two polls of the margin flags
#define ROCKS_POLL_STEPS 2   // where bucket and rock may squeeze a grain out
#define SPEED_RESERVE    2.0 // factor by which a grain may speed up meanwhile

struct dig_offloaded {
    struct dig_device       *device;
    struct dig_device_arrays arrays;
    bool                     is_synced; // the host has the state, contacts in the world's lists
    bool                     is_motion_synced;   // the host has the motions of the last step
    bool                     has_outdated_lists; // but all else is on the device
    size_t                   unpolled_steps;
};

static struct dig_offloaded *own_of(const struct dig_world *const w)
{
    return w->stand_in_own;
}

static void destroy(struct dig_world *const w)
{
    struct dig_offloaded *const o = own_of(w);
    o->device->destroy(o->device);
    dig_device_arrays_finish(&o->arrays);
    free(o);
}

// Adds the grains' wrenches to the world's and clears them.
static void sum_wrenches(struct dig_world *const w)
{
    struct dig_device_view *const v = &own_of(w)->arrays.view;
    for (uint32_t i = 0; i < v->n; i++) {
        dig_wrench_add(&v->on_tool[i], &w->sum_tool);
    }
    memset(v->on_tool, 0, v->n * sizeof *v->on_tool);
}

static enum dig_status sync(struct dig_world *const w, const bool all)
{
    struct dig_offloaded *const o = own_of(w);
    if (o->is_synced || (o->is_motion_synced && !all)) {
        return DIG_OK;
    }
    enum dig_status status = o->device->download(o->device, all);
    if (status != DIG_OK) {
        return status;
    }
    sum_wrenches(w);
    o->is_motion_synced = true;
    if (all) {
        status       = dig_device_arrays_read(&o->arrays, w);
        o->is_synced = status == DIG_OK;
    }
    return status;
}

// Rebuilds the lists from the state on the host and uploads all of it.
static enum dig_status upload(struct dig_world *const w)
{
    struct dig_offloaded *const o      = own_of(w);
    enum dig_status             status = dig_lists_rebuild(w, wide_skin);
    status = status == DIG_OK ? dig_device_arrays_write(w, &o->arrays) : status;
    if (status != DIG_OK) {
        return status;
    }
    o->unpolled_steps     = 0;
    o->has_outdated_lists = false;
    return o->device->upload(o->device, &o->arrays.view);
}

// Rebuilds the lists from the motions on the host; the device keeps the state.
static enum dig_status relist(struct dig_world *const w)
{
    struct dig_offloaded *const o      = own_of(w);
    uint32_t *const             was    = malloc((w->grains.n + 1) * sizeof *was);
    enum dig_status             status = was != NULL ? DIG_OK : DIG_ENOMEM;
    status = status == DIG_OK ? dig_lists_sort(w, wide_skin, was) : status;
    status = status == DIG_OK ? dig_device_arrays_write_lists(w, &o->arrays) : status;
    if (status == DIG_OK) {
        const struct dig_device_move move = { was, w->period_y_m,
                                              dig_period_inverse(w->period_y_m) };
        o->unpolled_steps                 = 0;
        o->has_outdated_lists             = false;
        status                            = o->device->relist(o->device, &o->arrays.view, &move);
    }
    free(was);
    return status;
}

// Where the host has changed the world all of it goes to the device; else new lists do.
static enum dig_status renew(struct dig_world *const w)
{
    enum dig_status status = sync(w, w->stale);
    if (status == DIG_OK && !dig_grains_are_sound(&w->grains, w->dt_s, w->crew)) {
        status = DIG_EINVAL;
    }
    if (status == DIG_OK) {
        status = w->stale ? upload(w) : relist(w);
    }
    w->stale = w->stale && status != DIG_OK;
    return status;
}

static size_t poll_interval(const struct dig_world *const w)
{
    return w->bodies != NULL && w->bodies->obstacles.rocks > 0 ? ROCKS_POLL_STEPS : POLL_STEPS;
}

static struct dig_device_step make_step(const struct dig_world *const w)
{
    struct dig_device_step step = {
        .kick_s         = w->started ? w->dt_s : 0.5 * w->dt_s,
        .dt_s           = w->dt_s,
        .horizon_s      = SPEED_RESERVE * (double)poll_interval(w) * w->dt_s,
        .gravity_mps2   = { w->gravity_mps2[0], w->gravity_mps2[1], w->gravity_mps2[2] },
        .period_y_m     = w->period_y_m,
        .inverse_period = dig_period_inverse(w->period_y_m),
        .walls          = (uint32_t)w->walls,
        .has_tool       = w->tool != NULL,
    };
    memcpy(step.wall, w->wall, sizeof step.wall);
    if (w->tool != NULL) {
        step.tool = *w->tool;
    }
    step.rocks = w->bodies == NULL ? 0 : (uint32_t)w->bodies->obstacles.rocks;
    for (uint32_t r = 0; r < step.rocks; r++) {
        step.rock[r] = w->bodies->obstacles.rock[r].surface;
    }
    return step;
}

// Every poll_interval() steps: whether the lists have to be rebuilt.
static enum dig_status poll_margins(struct dig_world *const w)
{
    struct dig_offloaded *const o = own_of(w);
    if (++o->unpolled_steps < poll_interval(w)) {
        return DIG_OK;
    }
    uint32_t margin_flag[DIG_MARGIN_FLAGS] = { 0 };
    o->unpolled_steps                      = 0;
    const enum dig_status status           = o->device->poll_margins(o->device, margin_flag);
    if (status == DIG_OK && margin_flag[DIG_MARGIN_LEFT] != 0) {
        return DIG_EINVAL;
    }
    o->has_outdated_lists = margin_flag[DIG_MARGIN_NEARLY_LEFT] != 0;
    return status;
}

static enum dig_status step(struct dig_world *const w)
{
    struct dig_offloaded *const o      = own_of(w);
    enum dig_status             status = DIG_OK;
    if (w->stale || o->has_outdated_lists) {
        status = renew(w);
        if (status != DIG_OK) {
            return status;
        }
    }
    const struct dig_device_step next = make_step(w);
    status                            = o->device->step(o->device, &next);
    o->is_synced                      = false;
    o->is_motion_synced               = false;
    status                            = status == DIG_OK ? poll_margins(w) : status;
    w->started                        = true;
    w->steps++;
    return status;
}

enum dig_status dig_offload(struct dig_world *const w, struct dig_device *const device)
{
    static const struct dig_stand_in stand_in = { step, sync, destroy };
    assert(w != NULL && device != NULL && w->stand_in == NULL);
    assert(w->bodies == NULL || w->bodies->ode == NULL);
    struct dig_offloaded *const o = calloc(1, sizeof *o);
    if (o == NULL || dig_device_arrays_init(&o->arrays) != DIG_OK) {
        free(o);
        device->destroy(device);
        return DIG_ENOMEM;
    }
    o->device           = device;
    o->is_synced        = true;
    o->is_motion_synced = true;
    w->stand_in         = &stand_in;
    w->stand_in_own     = o;
    w->single           = false;
    w->stale            = true;
    return DIG_OK;
}
