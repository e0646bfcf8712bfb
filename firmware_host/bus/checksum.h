// Checksums that makers put into their frames beside CAN's own CRC: they detect damage by a gateway
// or in the sender's memory.
//
//   sum8              the other bytes added, the low 8 bits
//   xor8              the other bytes exclusive-or'ed
//   crc8_sae_j1850    polynomial 0x1D, first 0xFF, last inverted, over the other bytes in order
//                     ("123456789" gives 0x4B); as in AUTOSAR's E2E profile 1, without its data id
//   j1939_tsc1        3 bits: bytes 1 to 7, the frame's counter and the four bytes of its id added,
//                     then folded (SAE J1939-71, SPN 4207)

#ifndef DIG_FIRMWARE_HOST_BUS_CHECKSUM_H
#define DIG_FIRMWARE_HOST_BUS_CHECKSUM_H

#include <stddef.h>
#include <stdint.h>

enum dig_checksum {
    DIG_CHECKSUM_NONE,
    DIG_CHECKSUM_SUM8,
    DIG_CHECKSUM_XOR8,
    DIG_CHECKSUM_CRC8_SAE_J1850,
    DIG_CHECKSUM_J1939_TSC1,
};

/// The expected checksum of a frame. at: the byte that holds it, which is left out. id:
/// 29 bits; counter: the frame's own.
uint8_t dig_checksum_of(enum dig_checksum kind, size_t bytes, const uint8_t data[], size_t at,
                        uint32_t id, uint64_t counter);

#endif // DIG_FIRMWARE_HOST_BUS_CHECKSUM_H
