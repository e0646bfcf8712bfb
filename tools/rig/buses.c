#include "tools/rig/buses.h"

#include "core/text.h"
#include "tools/rig/bus/can_layout.h"
#include "tools/rig/bus/serve_can.h"

#include <stdio.h>

enum dig_status dig_rig_buses_open(const struct dig_rig_options *const options,
                                   struct dig_rig_buses *const buses, struct dig_error *const error)
{
    *buses = (struct dig_rig_buses){ .can    = -1,
                                     .sealed = options->can_sealed,
                                     .wire   = { .random = options->seed } };
    if (!dig_rig_board_init(&buses->board, &options->faults)) {
        return dig_error_set(error, DIG_ENOMEM, "no mutex");
    }
    char            where[300];
    enum dig_status status = DIG_OK;
    if (options->can != NULL) {
        status = dig_rig_can_open(options->can, &buses->can, error);
        if (status == DIG_OK) {
            dig_text_print(stderr, "digrig: serving CAN frames on %s\n", options->can);
        }
    }
    if (status == DIG_OK && options->tcp != NULL) {
        status = dig_rig_modbus_start_tcp(options->tcp, &buses->board, sizeof where, where,
                                          &buses->tcp, error);
        if (status == DIG_OK) {
            dig_text_print(stderr, "digrig: serving %s\n", where);
        }
    }
    if (status == DIG_OK && options->rtu != NULL) {
        status = dig_rig_modbus_start_rtu(options->rtu, &buses->board, sizeof where, where,
                                          &buses->rtu, error);
        if (status == DIG_OK) {
            dig_text_print(stderr, "digrig: serving %s\n", where);
        }
    }
    if (status != DIG_OK) {
        dig_rig_buses_close(buses);
    }
    return status;
}

static void send(void *const context, const struct dig_rig_can_frame *const frame)
{
    struct dig_rig_buses *const buses = context;
    if (dig_rig_can_send(buses->can, frame) == DIG_OK) {
        buses->frames_sent++;
    } else {
        buses->frames_lost++;
    }
}

static void put_frame(struct dig_rig_buses *const buses, const int64_t tick,
                      const struct dig_rig_can_frame frame)
{
    dig_rig_wire_put(&buses->wire, buses->board.faults, (double)tick / DIG_RIG_TICK_Hz, &frame,
                     send, buses);
}

// Each frame at the period its layout gives it, in ticks of 5 ms.
static void send_frames(struct dig_rig_buses *const buses, const int64_t tick,
                        const struct dig_sample *const sample, const bool moving)
{
    if (tick % 2 == 0) {
        struct dig_rig_can_frame angles    = dig_rig_can_angles(sample);
        struct dig_rig_can_frame pressures = dig_rig_can_pressures(sample);
        buses->can_counter                 = (uint8_t)(buses->can_counter + (moving ? 1U : 0U));
        if (buses->sealed) {
            dig_rig_can_seal(&angles, buses->can_counter);
            dig_rig_can_seal(&pressures, buses->can_counter);
        }
        put_frame(buses, tick, angles);
        put_frame(buses, tick, pressures);
    }
    if (tick % 4 == 0) {
        put_frame(buses, tick, dig_rig_can_tilt(sample));
    }
    if (tick % 10 == 0) {
        buses->can_alive = (uint8_t)(buses->can_alive + (moving ? 1U : 0U));
        put_frame(buses, tick, dig_rig_can_state(sample, buses->can_alive));
    }
}

void dig_rig_buses_send(struct dig_rig_buses *const buses, const int64_t tick,
                        const struct dig_sample *const sample, const bool moving)
{
    const double time_s = (double)tick / DIG_RIG_TICK_Hz;
    uint16_t     registers[DIG_RIG_REGISTERS];
    buses->modbus_alive = (uint16_t)(buses->modbus_alive + (moving ? 1U : 0U));
    dig_rig_modbus_encode(sample, buses->modbus_alive, registers);
    dig_rig_board_write(&buses->board, registers, time_s);
    if (buses->can >= 0 &&
        !(dig_rig_fault_amount(buses->board.faults, DIG_RIG_FAULT_MISSING, time_s) > 0.0)) {
        send_frames(buses, tick, sample, moving);
    }
}

void dig_rig_buses_close(struct dig_rig_buses *const buses)
{
    dig_rig_board_stop(&buses->board);
    dig_rig_modbus_join(buses->tcp, &buses->requests);
    dig_rig_modbus_join(buses->rtu, &buses->requests);
    dig_rig_can_close(buses->can);
    dig_rig_board_finish(&buses->board);
    buses->tcp = NULL;
    buses->rtu = NULL;
    buses->can = -1;
}
