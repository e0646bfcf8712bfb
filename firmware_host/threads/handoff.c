#include "firmware_host/threads/handoff.h"

#include <assert.h>
#include <string.h>

#define NEWS 4U

void dig_ring_init(struct dig_ring *const ring, const size_t size, const size_t capacity,
                   void *const memory)
{
    assert(ring != NULL && memory != NULL && size > 0);
    assert(capacity > 0 && (capacity & (capacity - 1)) == 0);
    *ring = (struct dig_ring){ .memory = memory, .size = size, .capacity = capacity };
    atomic_init(&ring->written, 0);
    atomic_init(&ring->read, 0);
}

static unsigned char *slot(const struct dig_ring *const ring, const size_t count)
{
    return ring->memory + ring->size * (count & (ring->capacity - 1));
}

bool dig_ring_push(struct dig_ring *const ring, const void *const record)
{
    assert(ring != NULL && record != NULL);
    const size_t written = atomic_load_explicit(&ring->written, memory_order_relaxed);
    const size_t read    = atomic_load_explicit(&ring->read, memory_order_acquire);
    if (written - read == ring->capacity) {
        return false;
    }
    memcpy(slot(ring, written), record, ring->size);
    atomic_store_explicit(&ring->written, written + 1, memory_order_release);
    return true;
}

bool dig_ring_pop(struct dig_ring *const ring, void *const record)
{
    assert(ring != NULL && record != NULL);
    const size_t read    = atomic_load_explicit(&ring->read, memory_order_relaxed);
    const size_t written = atomic_load_explicit(&ring->written, memory_order_acquire);
    if (written == read) {
        return false;
    }
    memcpy(record, slot(ring, read), ring->size);
    atomic_store_explicit(&ring->read, read + 1, memory_order_release);
    return true;
}

void dig_latest_init(struct dig_latest *const latest, const size_t size, void *const memory)
{
    assert(latest != NULL && memory != NULL && size > 0);
    *latest = (struct dig_latest){ .memory = memory, .size = size, .back = 0, .front = 2 };
    atomic_init(&latest->middle, 1U);
}

void dig_latest_put(struct dig_latest *const latest, const void *const record)
{
    assert(latest != NULL && record != NULL);
    memcpy(latest->memory + latest->size * latest->back, record, latest->size);
    const unsigned before =
        atomic_exchange_explicit(&latest->middle, latest->back | NEWS, memory_order_acq_rel);
    latest->back = before & ~NEWS;
}

const void *dig_latest_look(struct dig_latest *const latest)
{
    assert(latest != NULL);
    if ((atomic_load_explicit(&latest->middle, memory_order_relaxed) & NEWS) == 0) {
        return NULL;
    }
    const unsigned news =
        atomic_exchange_explicit(&latest->middle, latest->front, memory_order_acq_rel);
    latest->front = news & ~NEWS;
    return latest->memory + latest->size * latest->front;
}

bool dig_latest_take(struct dig_latest *const latest, void *const record)
{
    assert(latest != NULL && record != NULL);
    const void *const news = dig_latest_look(latest);
    if (news != NULL) {
        memcpy(record, news, latest->size);
    }
    return news != NULL;
}
