// Lock-free queues between two threads: a ring of records where none may be lost, a slot where only
// the newest matters. One producer and one consumer each; wait-free on both sides, no system call,
// no allocation. Both hold bytes by value in memory the caller gives.

#ifndef DIG_FIRMWARE_HOST_THREADS_HANDOFF_H
#define DIG_FIRMWARE_HOST_THREADS_HANDOFF_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

/// Keeps the producer's and the consumer's counters on cache lines of their own.
#define DIG_CACHE_LINE 64

struct dig_ring {
    unsigned char *memory;
    size_t         size;     // of one record
    size_t         capacity; // records, a power of two
    char           apart0[DIG_CACHE_LINE];
    atomic_size_t  written; // ever
    char           apart1[DIG_CACHE_LINE];
    atomic_size_t  read; // ever
};

/// memory holds size * capacity bytes and outlives the ring; capacity is a power of two.
void dig_ring_init(struct dig_ring *ring, size_t size, size_t capacity, void *memory);

/// False when the ring is full; nothing is written then. Producer only.
bool dig_ring_push(struct dig_ring *ring, const void *record);

/// False when the ring is empty; *record is untouched then. Consumer only.
bool dig_ring_pop(struct dig_ring *ring, void *record);

/// A triple buffer: the producer's copy, the consumer's, and the one exchanged.
struct dig_latest {
    unsigned char *memory;
    size_t         size;
    unsigned       back; // producer's copy
    char           apart0[DIG_CACHE_LINE];
    atomic_uint    middle; // index, and a bit: not read yet
    char           apart1[DIG_CACHE_LINE];
    unsigned       front; // consumer's copy
};

/// memory holds 3 * size bytes and outlives the slot.
void dig_latest_init(struct dig_latest *latest, size_t size, void *memory);

/// Replaces what was put before, taken or not. Producer only.
void dig_latest_put(struct dig_latest *latest, const void *record);

/// True when something was put since the last take; *record is untouched otherwise. Consumer only.
bool dig_latest_take(struct dig_latest *latest, void *record);

/// The same without a copy: what was put last, unchanged until the next look or take; NULL when
/// nothing was put since. Consumer only.
const void *dig_latest_look(struct dig_latest *latest);

/// All that the daemon's threads hand each other, each queue with its two ends.
struct dig_handoffs {
    struct dig_ring readings;      // input -> tick: struct dig_reading
    struct dig_ring records;       // tick -> publisher: struct dig_record
    struct dig_ring digs;          // tick -> matcher: struct dig_recorded_dig *, finished digs
    struct dig_ring spares;        // matcher -> tick: the same memory, for further digs
    struct dig_ring estimates;     // tick -> matcher: struct dig_estimate, of the dig in progress.
                                   // What does not fit is dropped: less is seen, nothing wrong
    struct dig_ring   results;     // matcher -> publisher: struct dig_fit_result
    struct dig_latest basis;       // matcher -> tick: struct dig_prediction_basis of its table
    struct dig_latest table;       // matcher -> tick: struct dig_prediction_basis of another table
    struct dig_latest tables;      // matcher -> publisher: struct dig_table_update
    struct dig_latest predictions; // tick -> publisher: struct dig_prediction_record
    struct dig_latest tick_status; // tick -> publisher: struct dig_tick_status
    struct dig_latest input_log;   // input -> publisher: struct dig_log_line
    struct dig_latest fit_log;     // matcher -> publisher: struct dig_log_line
};

#endif // DIG_FIRMWARE_HOST_THREADS_HANDOFF_H
