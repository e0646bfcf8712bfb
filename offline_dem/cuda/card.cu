// The device interface (offline_dem/world/device.h) on a graphics card. A step is two kernels: a
// thread a pair, and a thread a grain for its surfaces; then a thread a grain that moves it. With
// clumps a third stands between them. No sum is shared between threads, so the same steps give the
// same bits, and with -fmad=false those of tests/offline_dem/host_device.c, but for clumps.

#include "offline_dem/device/device_carry.h"
#include "offline_dem/device/device_grain.h"
#include "offline_dem/device/device_surfaces.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#define THREADS 64 // a block of the grid

namespace
{

// An array on the card.
struct array {
    void  *here;
    size_t room;
};

// Where the view's arrays stand; behind them that of a move.
enum {
#define ARRAY(name, count, how) AT_##name,
    DIG_DEVICE_ARRAYS(ARRAY, )
#undef ARRAY
    AT_WAS,
    ARRAYS
};

struct card {
    dig_device      device;
    dig_device_view host_view; // the processor's arrays
    dig_device_view view;   // the card's
    array           at[ARRAYS], before[ARRAYS]; // and of the lists before
    uint32_t       *margin_flag; // pinned
    cudaStream_t    stream;
};

__host__ __device__ uint32_t blocks(const uint32_t things)
{
    return (things + THREADS - 1) / THREADS;
}

// Pairs, and in the blocks behind them surfaces: neither waits for the other.
__global__ void __launch_bounds__(THREADS)
    add_loads(const dig_device_view view, const __grid_constant__ dig_device_step step)
{
    const uint32_t of_pairs = blocks(view.pairs);
    if (blockIdx.x < of_pairs) {
        const uint32_t pair = blockIdx.x * THREADS + threadIdx.x;
        if (pair < view.pairs) {
            dig_device_step_pair(&view, &step, pair);
        }
    } else {
        const uint32_t i = (blockIdx.x - of_pairs) * THREADS + threadIdx.x;
        if (i < view.n) {
            dig_device_step_surfaces(&view, &step, i);
        }
    }
}

__global__ void __launch_bounds__(THREADS)
    carry_grains(const dig_device_view from, const dig_device_move move, const dig_device_view to)
{
    const uint32_t i = blockIdx.x * THREADS + threadIdx.x;
    if (i < to.n) {
        dig_device_carry_grain(&from, &move, &to, i);
    }
}

__global__ void __launch_bounds__(THREADS)
    move_clumps(const dig_device_view view, const __grid_constant__ dig_device_step step)
{
    const uint32_t b = blockIdx.x * THREADS + threadIdx.x;
    if (b < view.clumps) {
        dig_device_step_clump(&view, &step, b);
    }
}

__global__ void __launch_bounds__(THREADS)
    move_grains(const dig_device_view view, const __grid_constant__ dig_device_step step)
{
    const uint32_t i = blockIdx.x * THREADS + threadIdx.x;
    if (i < view.n) {
        dig_device_step_grain(&view, &step, i);
    }
}

dig_status status_of(const cudaError_t error)
{
    return error == cudaSuccess                 ? DIG_OK
           : error == cudaErrorMemoryAllocation ? DIG_ENOMEM
                                                : DIG_EIO;
}

card *card_of(dig_device *const device)
{
    return static_cast<card *>(device->own);
}

// Allocates an array on the card and copies `from` to it; NULL: uninitialised. T is a pointer.
template <typename T>
cudaError_t place(card *const c, const int which, const size_t count, const T from, T *const to)
{
    array *const a     = &c->at[which];
    const size_t bytes = (count + 1) * sizeof *from;
    if (a->room < bytes) {
        (void)cudaFree(a->here);
        a->here                = nullptr;
        a->room                = 0;
        const size_t      more = bytes + bytes / 8;
        const cudaError_t e    = cudaMalloc(&a->here, more);
        if (e != cudaSuccess) {
            return e;
        }
        a->room = more;
    }
    *to = static_cast<T>(a->here);
    return from == nullptr || count == 0 ? cudaSuccess
                                         : cudaMemcpyAsync(a->here, from, count * sizeof *from,
                                                           cudaMemcpyHostToDevice, c->stream);
}

// Places a view's arrays on the card; where the state of grains and contacts is carried over, only
// room for it.
dig_status place_view(card *const c, const dig_device_view *const v, const bool carried)
{
    dig_device_view *const w = &c->view;
    cudaError_t            e = cudaSuccess;
    c->host_view             = *v;
    *w                       = *v;
#define ARRAY(name, count, how)                                                                    \
    if (e == cudaSuccess) {                                                                        \
        const bool given = (how) == DIG_DEVICE_GIVEN || ((how) == DIG_DEVICE_KEPT && !carried);    \
        e                = place(c, AT_##name, count, given ? v->name : nullptr, &w->name);        \
    }
    DIG_DEVICE_ARRAYS(ARRAY, v)
#undef ARRAY
    return status_of(e == cudaSuccess
                         ? cudaMemsetAsync(w->on_tool, 0, v->n * sizeof *w->on_tool, c->stream)
                         : e);
}

dig_status upload(dig_device *const device, const dig_device_view *const v)
{
    card *const      c      = card_of(device);
    const dig_status status = place_view(c, v, false);
    return status == DIG_OK ? status_of(cudaStreamSynchronize(c->stream)) : status;
}

dig_status relist(dig_device *const device, const dig_device_view *const v,
                  const dig_device_move *const move)
{
    card *const           c    = card_of(device);
    const dig_device_view from = c->view;
    std::swap(c->at, c->before);
    const dig_status status = place_view(c, v, true);
    dig_device_move  there  = *move;
    if (status != DIG_OK || v->n == 0) {
        return status;
    }
    const cudaError_t e = place(c, AT_WAS, v->n, move->was, &there.was);
    if (e != cudaSuccess) {
        return status_of(e);
    }
    carry_grains<<<blocks(v->n), THREADS, 0, c->stream>>>(from, there, c->view);
    const cudaError_t launched = cudaPeekAtLastError();
    return status_of(launched == cudaSuccess ? cudaStreamSynchronize(c->stream) : launched);
}

dig_status step(dig_device *const device, const dig_device_step *const s)
{
    card *const c = card_of(device);
    if (c->view.n == 0) {
        return DIG_OK;
    }
    add_loads<<<blocks(c->view.pairs) + blocks(c->view.n), THREADS, 0, c->stream>>>(c->view, *s);
    if (c->view.clumps > 0) {
        move_clumps<<<blocks(c->view.clumps), THREADS, 0, c->stream>>>(c->view, *s);
    }
    move_grains<<<blocks(c->view.n), THREADS, 0, c->stream>>>(c->view, *s);
    return status_of(cudaPeekAtLastError());
}

dig_status poll_margins(dig_device *const device, uint32_t margin_flag[DIG_MARGIN_FLAGS])
{
    card *const c = card_of(device);
    cudaError_t e =
        cudaMemcpyAsync(c->margin_flag, c->view.margin_flag, DIG_MARGIN_FLAGS * sizeof *margin_flag,
                        cudaMemcpyDeviceToHost, c->stream);
    e = e == cudaSuccess ? cudaStreamSynchronize(c->stream) : e;
    memcpy(margin_flag, c->margin_flag, DIG_MARGIN_FLAGS * sizeof *margin_flag);
    return status_of(e);
}

template <typename T>
cudaError_t fetch(card *const c, T *const to, const T *const from, const size_t count)
{
    return count == 0
               ? cudaSuccess
               : cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyDeviceToHost, c->stream);
}

dig_status download(dig_device *const device, const bool all)
{
    card *const                  c = card_of(device);
    const dig_device_view *const t = &c->host_view;
    const dig_device_view *const v = &c->view;
    const size_t                 n = v->n;
    // Without plates nothing is on the tool.
    const size_t on_tool = v->plates > 0 ? n : 0;
    cudaError_t  e       = fetch(c, t->motion, v->motion, n);
    e                    = e == cudaSuccess ? fetch(c, t->on_tool, v->on_tool, on_tool) : e;
    e                    = e == cudaSuccess ? fetch(c, t->clump, v->clump, v->clumps) : e;
    e                    = e == cudaSuccess
                               ? cudaMemsetAsync(v->on_tool, 0, n * sizeof *v->on_tool, c->stream)
                               : e;
    if (all) {
        e = e == cudaSuccess ? fetch(c, t->pair_history, v->pair_history, v->pairs) : e;
        e = e == cudaSuccess ? fetch(c, t->touching, v->touching, 2 * v->pairs) : e;
        e = e == cudaSuccess ? fetch(c, t->surface_history, v->surface_history, v->surfaces * n) : e;
        e = e == cudaSuccess ? fetch(c, t->surface_mask, v->surface_mask, n) : e;
    }
    e = e == cudaSuccess ? cudaStreamSynchronize(c->stream) : e;
    return status_of(e);
}

void destroy(dig_device *const device)
{
    card *const c = card_of(device);
    for (int a = 0; a < ARRAYS; a++) {
        (void)cudaFree(c->at[a].here);
        (void)cudaFree(c->before[a].here);
    }
    (void)cudaFreeHost(c->margin_flag);
    (void)cudaStreamDestroy(c->stream);
    free(c);
}

} // namespace

extern "C" int dig_cuda_version(void)
{
    return DIG_DEVICE_VERSION;
}

extern "C" dig_device *dig_cuda_create(char why[], const size_t size)
{
    card *const c = static_cast<card *>(calloc(1, sizeof(card)));
    if (c == nullptr) {
        snprintf(why, size, "out of memory");
        return nullptr;
    }
    cudaError_t e = cudaStreamCreate(&c->stream);
    e             = e == cudaSuccess ? cudaMallocHost(reinterpret_cast<void **>(&c->margin_flag),
                                                      DIG_MARGIN_FLAGS * sizeof *c->margin_flag)
                                     : e;
    if (e != cudaSuccess) {
        snprintf(why, size, "%s", cudaGetErrorString(e));
        free(c);
        return nullptr;
    }
    c->device.name     = "graphics card";
    c->device.own      = c;
    c->device.upload       = upload;
    c->device.relist       = relist;
    c->device.step         = step;
    c->device.poll_margins = poll_margins;
    c->device.download     = download;
    c->device.destroy      = destroy;
    return &c->device;
}
