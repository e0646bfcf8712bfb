// A sample as CAN frames in the public ZX200 layout, written by hand from its table:
//
//   Pressure_1        0x18FF79E8   8 x uint8        0.2 MPa/bit, -10 MPa   every 10 ms
//                     boom head, boom rod, arm head, arm rod, bucket head, bucket rod, swing a, b
//   Front_Angle       0x18FF7DE8   4 x uint16 LE    0.0004 rad/bit, -10 rad       10 ms
//                     boom, arm, bucket, swing
//   Roll_Pitch_Angle  0x18FF7EE8   14 bits at 0, 16 0.0005 rad/bit, -4 rad        20 ms
//                     roll, pitch
//   Machine_State     0x18FF84E8   byte 3: oil temperature, 1 degC/bit, -100;     50 ms
//                     byte 7: alive counter
//
// All ids have 29 bits. What a field cannot say, or is not known, is all ones: "not available".
// Angles are those of core/machine.h, counter-clockwise; a real machine may count otherwise, which
// is what a signal map is for.

#ifndef DIG_TOOLS_RIG_BUS_CAN_LAYOUT_H
#define DIG_TOOLS_RIG_BUS_CAN_LAYOUT_H

#include "core/sample.h"

#include <stdint.h>

struct dig_rig_can_frame {
    uint32_t id; // 29 bits, without flags
    uint8_t  data[8];
};

/// Values are rounded to the nearest bit. Beyond the field they stand at its end short of "not
/// available": pressures at 0xFE (40.8 MPa, beyond the layout's 40), angles at 0xFFFE.
struct dig_rig_can_frame dig_rig_can_pressures(const struct dig_sample *sample);
struct dig_rig_can_frame dig_rig_can_angles(const struct dig_sample *sample);
struct dig_rig_can_frame dig_rig_can_tilt(const struct dig_sample *sample);
struct dig_rig_can_frame dig_rig_can_state(const struct dig_sample *sample, uint8_t alive);

/// Puts a counter (0 … 15, upper half ones) into byte 6 and a checksum into byte 7, where the
/// layout's swing would be: CRC-8 SAE J1850 over bytes 0 to 6. For pressures and angles.
void dig_rig_can_seal(struct dig_rig_can_frame *frame, uint8_t counter);

#endif // DIG_TOOLS_RIG_BUS_CAN_LAYOUT_H
