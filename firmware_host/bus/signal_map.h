// The signal map: decodes raw values of the bus to signals, SI, in the machine's frames. A YAML
// file (docs/formats.md) over a DBC's signals or over Modbus registers.
//
//   SI value = sign * (scale * physical + offset)
//
// where physical is the DBC's factor * raw + DBC offset, or the raw register. Raw values listed as
// not_available, and values outside min … max, are not decoded. With `j1939` neither are the values
// that SAE J1939-71 reserves: the topmost raw value ("not available") and the one below ("error");
// of 8 bits all from 0xFB on; of more bits the top bytes 0xFB to 0xFF.

#ifndef DIG_FIRMWARE_HOST_BUS_SIGNAL_MAP_H
#define DIG_FIRMWARE_HOST_BUS_SIGNAL_MAP_H

#include "core/error.h"
#include "firmware_host/bus/checksum.h"
#include "firmware_host/bus/dbc.h"
#include "firmware_host/bus/frame_watch.h"
#include "firmware_host/bus/reading.h"

#include <stddef.h>
#include <stdint.h>

#define DIG_NOT_AVAILABLE_MAX 4
#define DIG_REGISTERS_MAX     125 // of one Modbus request

enum dig_map_kind { DIG_MAP_CAN, DIG_MAP_MODBUS };

enum dig_register_type {
    DIG_REGISTER_UINT16,
    DIG_REGISTER_INT16,
    DIG_REGISTER_UINT32,
    DIG_REGISTER_INT32,
    DIG_REGISTER_FLOAT32,
};

struct dig_map_entry {
    bool                   used;
    unsigned               group; // index into dig_signal_map.group
    struct dig_dbc_signal  can;
    unsigned               reg; // Modbus: first register
    enum dig_register_type type;
    double                 sign, scale, offset, min, max;
    double                 max_rate;      // SI per second; 0: any
    size_t                 not_available; // raw values listed
    uint64_t               not_available_raw[DIG_NOT_AVAILABLE_MAX];
};

/// Signals that arrive together: a CAN message, or a block of Modbus registers.
struct dig_map_group {
    bool                      needed;      // carries a signal that force or moment need
    bool                      dispensable; // needed, but for the force alone
    struct dig_frame_settings frame;
    // CAN
    uint32_t              id;
    bool                  extended;
    unsigned              bytes;
    char                  name[DIG_DBC_NAME_SIZE];
    struct dig_dbc_signal counter; // where frame.counter_mod > 0
    enum dig_checksum     checksum;
    struct dig_dbc_signal checksum_at;
    // Modbus
    unsigned first_register, registers;
    unsigned function; // 4 input registers, 3 holding
    double   poll_s;   // between two requests; 0: as the input says
};

struct dig_signal_map {
    enum dig_map_kind    kind;
    struct dig_map_entry entry[DIG_SIGNALS];
    bool                 has_alive;
    struct dig_map_entry alive;
    double               frozen_s;   // the alive counter may be constant this long
    double               coherent_s; // signals of one sample may lie this far apart
    double               stuck_s;    // values may be constant this long; 0: for ever
    bool                 j1939;
    size_t               groups;
    struct dig_map_group group[DIG_GROUPS_MAX];
    bool                 low_word_first; // Modbus: of 32-bit values
};

/// Reads and checks. dbc is needed for kind: can and ignored otherwise; NULL refuses such a map.
/// DIG_EINVAL names file, line, key and what was expected: also a message or signal the DBC does
/// not have, a unit the scale cannot be right for, a needed signal without an entry, the same
/// signal twice.
DIG_MUST_CHECK enum dig_status dig_signal_map_read(const char *path, const struct dig_dbc *dbc,
                                                   struct dig_signal_map *map,
                                                   struct dig_error      *error);

/// The kind of machine the map's signals belong to.
enum dig_sensing dig_signal_map_sensing(const struct dig_signal_map *map);

/// The group (in map->group) of a CAN id, or -1.
int dig_signal_map_group(const struct dig_signal_map *map, uint32_t id, bool extended);

/// Decodes one frame of a group. DIG_EINVAL: shorter than the DBC says; DIG_ESTALE: its checksum is
/// wrong. Then *reading is untouched.
DIG_MUST_CHECK enum dig_status dig_signal_map_frame(const struct dig_signal_map *map,
                                                    unsigned group, size_t bytes,
                                                    const uint8_t data[], int64_t time_ns,
                                                    struct dig_reading *reading);

/// Decodes one block of a Modbus map from the registers of a reply.
void dig_signal_map_registers(const struct dig_signal_map *map, unsigned group,
                              const uint16_t registers[], int64_t time_ns,
                              struct dig_reading *reading);

#endif // DIG_FIRMWARE_HOST_BUS_SIGNAL_MAP_H
