// Readings of a bus for the tests of the assembler.

#ifndef DIG_TESTS_FIRMWARE_HOST_READINGS_H
#define DIG_TESTS_FIRMWARE_HOST_READINGS_H

#include "firmware_host/tick/assemble.h"

#include "tests/testlib.h"

#define MS 1000000LL

// As CAN has it: pressures in group 0, angles in group 1, the optional pitch and the alive counter
// in group 2.
static const struct dig_assembler_settings can = {
    .time_scale = 1.0,
    .coherent_s = 0.006,
    .frozen_s   = 0.5,
    .optional_s = 1.0,
    .has_alive  = true,
    .groups     = 3,
    .needed     = { true, true, false },
};

// As Modbus has it: all in one poll.
static const struct dig_assembler_settings poll_settings = {
    .time_scale = 1.0,
    .coherent_s = 1.0,
    .frozen_s   = 0.5,
    .optional_s = 1.0,
    .has_alive  = true,
    .repeats    = true,
    .groups     = 1,
    .needed     = { true },
};

static inline struct dig_reading pressures(const int64_t time_ns, const double level)
{
    struct dig_reading r = { .time_ns = time_ns, .group = 0 };
    for (int i = DIG_SIGNAL_BOOM_HEAD_Pa; i <= DIG_SIGNAL_BUCKET_ROD_Pa; i++) {
        r.state[i] = DIG_READING_OK;
        r.value[i] = level;
    }
    return r;
}

static inline struct dig_reading angles(const int64_t time_ns, const double level)
{
    struct dig_reading r = { .time_ns = time_ns, .group = 1 };
    for (int i = DIG_SIGNAL_BOOM_rad; i <= DIG_SIGNAL_BUCKET_rad; i++) {
        r.state[i] = DIG_READING_OK;
        r.value[i] = level;
    }
    return r;
}

static inline struct dig_reading alive(const int64_t time_ns, const uint64_t counter)
{
    struct dig_reading r          = { .time_ns = time_ns, .group = 2 };
    r.has_alive                   = true;
    r.alive                       = counter;
    r.state[DIG_SIGNAL_PITCH_rad] = DIG_READING_OK;
    r.value[DIG_SIGNAL_PITCH_rad] = 0.1;
    return r;
}

static inline struct dig_reading poll(const int64_t time_ns, const uint64_t counter)
{
    struct dig_reading       r = pressures(time_ns, 1.0);
    const struct dig_reading a = angles(time_ns, 2.0);
    for (int i = DIG_SIGNAL_BOOM_rad; i <= DIG_SIGNAL_BUCKET_rad; i++) {
        r.state[i] = a.state[i];
        r.value[i] = a.value[i];
    }
    r.has_alive = true;
    r.alive     = counter;
    return r;
}

#endif // DIG_TESTS_FIRMWARE_HOST_READINGS_H
