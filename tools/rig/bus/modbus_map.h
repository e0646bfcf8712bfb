// A sample as Modbus registers, the same for FC 3 (holding) and FC 4 (input):
//
//    0      alive counter, uint16, one more at every update of the map
//    1..3   boom, arm, bucket angle     int16   1e-4 rad/bit   0x8000: not available
//    4      pitch                       int16   1e-4 rad/bit   0x8000
//    5..10  boom head, boom rod, arm head, arm rod, bucket head, bucket rod
//                                       uint16  1e3 Pa/bit     0xFFFF
//   11      oil temperature             int16   0.1 degC/bit   0x8000
//   12..13  of a bucket on a force sensor, whose angle stands in 3: pin X, pin Z
//                                       int16   2e-5 m/bit     0x8000
//   14..15  what the sensor reads: Fx, Fz
//                                       int16   0.01 N/bit     0x8000
//   16      My                          int16   5e-4 Nm/bit    0x8000
//
// The same stand once more from register 1000 on, as on a gateway whose blocks lie apart.

#ifndef DIG_TOOLS_RIG_BUS_MODBUS_MAP_H
#define DIG_TOOLS_RIG_BUS_MODBUS_MAP_H

#include "core/sample.h"

#include <stdint.h>

#define DIG_RIG_REGISTERS 17
#define DIG_RIG_FAR       1000

/// Values are rounded to the nearest bit; beyond the register they stand at its end short of "not
/// available".
void dig_rig_modbus_encode(const struct dig_sample *sample, uint16_t alive,
                           uint16_t registers[DIG_RIG_REGISTERS]);

#endif // DIG_TOOLS_RIG_BUS_MODBUS_MAP_H
