// Reads the part of a CAN database (.dbc) that decodes frames: messages (BO_), their signals (SG_)
// with start bit, length, byte order, sign, factor, offset and unit, and the cycle of a message
// (the attribute GenMsgCycleTime). Other sections are skipped. Multiplexed and floating-point
// signals (SIG_VALTYPE_) are marked; a map that names one is refused.
//
//   BO_ 2566879720 Pressure_1: 8 Machine         id (bit 31: extended frame), name, bytes, sender
//    SG_ name : 8|16@1+ (0.2,-10) [-10|40] "MPa" Receiver
//               ^ start bit | bits @ 1 Intel, 0 Motorola; + unsigned, - signed (factor,offset)
//
// An Intel start bit is the signal's lowest bit, bits counted up from bit 0 of byte 0. A Motorola
// start bit is its highest, and bits run down within a byte, then on to bit 7 of the next.

#ifndef DIG_FIRMWARE_HOST_BUS_DBC_H
#define DIG_FIRMWARE_HOST_BUS_DBC_H

#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DIG_DBC_NAME_SIZE 64

struct dig_dbc_signal {
    char     name[DIG_DBC_NAME_SIZE];
    unsigned start_bit, bits; // bits 1 … 64
    bool     intel, is_signed, multiplexed, is_float;
    double   factor, offset;
    char     unit[16];
};

struct dig_dbc_message {
    char     name[DIG_DBC_NAME_SIZE];
    uint32_t id; // without the flag
    bool     extended;
    unsigned bytes;
    size_t   first, signals; // in dig_dbc.signal
    double   cycle_s;        // 0: not given
};

struct dig_dbc {
    size_t                  messages, signals;
    struct dig_dbc_message *message; // malloc
    struct dig_dbc_signal  *signal;  // malloc
};

/// Reads a whole file. DIG_EINVAL names file, line, what was found and what was expected: also a
/// signal that reaches outside its message. Free with dig_dbc_finish(). Writes on success only.
DIG_MUST_CHECK enum dig_status dig_dbc_read(const char *path, struct dig_dbc *dbc,
                                            struct dig_error *error);

/// NULL and a zeroed struct are allowed.
void dig_dbc_finish(struct dig_dbc *dbc);

/// The message of that name, and a message's signal of that name; NULL when there is none.
const struct dig_dbc_message *dig_dbc_find(const struct dig_dbc *dbc, const char *name);
const struct dig_dbc_signal  *dig_dbc_find_signal(const struct dig_dbc         *dbc,
                                                  const struct dig_dbc_message *message,
                                                  const char                   *name);

/// The signal's bits in a frame of at least its message's length, before sign, factor and offset.
uint64_t dig_dbc_raw(const struct dig_dbc_signal *signal, const uint8_t data[]);

/// factor * raw + offset, in the DBC's unit.
double dig_dbc_value(const struct dig_dbc_signal *signal, uint64_t raw);

#endif // DIG_FIRMWARE_HOST_BUS_DBC_H
