// Groups the registers of a Modbus map into blocks, one request each.
//
//   registers   |0 1 2 3 4|     . . . .     |1000 … 1005|          each block is a group of the map
//   requests     every poll                  100 a second
//
// A map may name its blocks. Otherwise registers within reach of one request form a block, whatever
// lies between them.

#ifndef DIG_FIRMWARE_HOST_BUS_REGISTER_PLAN_H
#define DIG_FIRMWARE_HOST_BUS_REGISTER_PLAN_H

#include "firmware_host/bus/signal_map.h"

/// Number of registers of one value.
unsigned dig_register_words(enum dig_register_type type);

/// Makes the blocks of a map without any, as few as possible, in ascending order, all of one
/// function and at the input's rate. Sets every entry's group.
void dig_register_plan(struct dig_signal_map *map, unsigned function);

/// Sets an entry's group to the first block that holds it whole. False when none does.
bool dig_register_assign(const struct dig_signal_map *map, struct dig_map_entry *entry);

#endif // DIG_FIRMWARE_HOST_BUS_REGISTER_PLAN_H
