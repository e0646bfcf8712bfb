#include "firmware_host/handoff_memory.h"

#include <assert.h>

// The record's size is that of the memory's entry, and there are as many.
#define RING(name)                                                                                 \
    dig_ring_init(&h->name, sizeof m->name[0], sizeof m->name / sizeof m->name[0], m->name)
#define LATEST(name) dig_latest_init(&h->name, sizeof m->name[0], m->name)

void dig_handoffs_init(struct dig_handoffs *const h, struct dig_handoff_memory *const m)
{
    assert(h != NULL && m != NULL);
    RING(readings);
    RING(records);
    // NOLINTNEXTLINE(bugprone-sizeof-expression): the memory itself is handed over, by pointer
    RING(digs);
    // NOLINTNEXTLINE(bugprone-sizeof-expression): as above
    RING(spares);
    RING(estimates);
    RING(results);
    LATEST(basis);
    LATEST(table);
    LATEST(tables);
    LATEST(predictions);
    LATEST(tick_status);
    LATEST(input_log);
    LATEST(fit_log);
}
