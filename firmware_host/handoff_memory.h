// The memory of all that the daemon's threads hand each other, and how much of each there is.

#ifndef DIG_FIRMWARE_HOST_HANDOFF_MEMORY_H
#define DIG_FIRMWARE_HOST_HANDOFF_MEMORY_H

#include "firmware_host/matching/fit.h"
#include "firmware_host/publish/publish.h"
#include "firmware_host/tick/loop.h"

/// Bytes behind the handoffs, in one block with everything else the threads touch.
struct dig_handoff_memory {
    struct dig_reading           readings[4096];
    struct dig_record            records[4096];
    struct dig_recorded_dig     *digs[4], *spares[4]; // recordings of digs on the way, at most
    struct dig_estimate          estimates[4096]; // seconds of them, for a matcher that is at work
    struct dig_fit_result        results[16];
    struct dig_prediction_basis  basis[3], table[3];
    struct dig_table_update      tables[3];
    struct dig_prediction_record predictions[3];
    struct dig_tick_status       tick_status[3];
    struct dig_log_line          input_log[3], fit_log[3];
};

/// All of them empty. memory outlives the handoffs, and neither moves.
void dig_handoffs_init(struct dig_handoffs *handoffs, struct dig_handoff_memory *memory);

#endif // DIG_FIRMWARE_HOST_HANDOFF_MEMORY_H
