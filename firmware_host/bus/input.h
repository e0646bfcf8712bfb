// Source of readings: one struct and one thread for CAN, Modbus and replay. A source is opened,
// read until it fails, closed, and opened again after a pause that doubles up to 5 s. A source only
// listens: nothing but Modbus' read requests is ever sent.

#ifndef DIG_FIRMWARE_HOST_BUS_INPUT_H
#define DIG_FIRMWARE_HOST_BUS_INPUT_H

#include "core/error.h"
#include "firmware_host/bus/reading.h"
#include "firmware_host/threads/handoff.h"

#include <stdatomic.h>

struct dig_input;

/// Operations of a kind of source, called on the input thread only.
struct dig_input_ops {
    /// Tries once. On failure nothing stays open.
    enum dig_status (*open)(struct dig_input *input, struct dig_error *error);
    /// Waits at most about 100 ms for readings and puts them by dig_input_put(). DIG_OK also when
    /// none came. DIG_EIO: the source is gone; it will be closed and opened again.
    enum dig_status (*read)(struct dig_input *input, struct dig_error *error);
    /// Closes what open() opened; NULL: nothing.
    void (*close)(struct dig_input *input);
    /// Frees what the source holds; NULL: nothing.
    void (*finish)(struct dig_input *input);
};

/// A line for the log, from a thread to the publisher.
struct dig_log_line {
    char text[200];
};

/// The thread's common part. Counters are written by it and read by others.
struct dig_input {
    const struct dig_input_ops *ops;
    void                       *source; // of the ops, malloc'ed
    char                        name[160];
    struct dig_ring            *readings;
    struct dig_latest          *log; // out: struct dig_log_line, the last error; "" when it is over
    const atomic_bool          *stop;
    atomic_llong                frames;    // frames or polls that were received
    atomic_llong                malformed; // too short, refused by the other side
    atomic_llong                checksum;  // frames whose checksum was wrong
    atomic_llong                errors;    // error frames of a CAN controller
    atomic_llong                bus_offs;  // of them, those that said bus off
    atomic_llong                timeouts;  // requests without an answer in time
    atomic_llong overflow;   // readings for which the ring, frames for which the socket had no room
    atomic_llong reconnects; // times the source was opened again
    atomic_bool  connected;  // open
    atomic_bool  ended;      // a replay came to its end
};

/// Sources. strings are copied; the map must outlive the input. DIG_ENOMEM, DIG_EINVAL.
struct dig_signal_map;
struct dig_machine_recording;

DIG_MUST_CHECK enum dig_status dig_input_can_create(struct dig_input *input, const char *interface,
                                                    const struct dig_signal_map *map);

struct dig_modbus_address {
    char   host[128]; // TCP when not empty
    int    port;
    char   device[128]; // else RTU
    int    baud;
    char   parity; // 'N', 'E', 'O'
    int    unit;
    double poll_s; // between requests
};
DIG_MUST_CHECK enum dig_status dig_input_modbus_create(struct dig_input                *input,
                                                       const struct dig_modbus_address *address,
                                                       const struct dig_signal_map     *map);

/// Takes ownership of the recording. speed: seconds of the recording per
/// second.
DIG_MUST_CHECK enum dig_status dig_input_replay_create(struct dig_input             *input,
                                                       struct dig_machine_recording *recording,
                                                       const char *file, double speed);

/// Puts a reading into the ring, or counts it as lost.
void dig_input_put(struct dig_input *input, const struct dig_reading *reading);

/// Logs the last error; NULL: it is over.
void dig_input_log(struct dig_input *input, const struct dig_error *error);

/// The input thread: returns when *stop is set or a replay ended.
void dig_input_run(struct dig_input *input);

/// Frees the source; NULL and a zeroed struct are allowed.
void dig_input_destroy(struct dig_input *input);

/// CLOCK_MONOTONIC, ns.
int64_t dig_input_now_ns(void);

/// Sleeps, or until *stop, which is checked every 50 ms.
void dig_input_pause(const struct dig_input *input, int64_t pause_ns);

#endif // DIG_FIRMWARE_HOST_BUS_INPUT_H
