// Tests for tools/rig/bus/modbus_map.c: registers worked out by hand.

#include "tools/rig/bus/modbus_map.h"

#include "tests/testlib.h"

#include <stdio.h>

static void encode_example(uint16_t registers[const DIG_RIG_REGISTERS])
{
    struct dig_sample sample = {
        .value = { 0.5123, -1.25, -0.00012, 12.4e6, 1.0e6, 0.0, 34.3e6, 1.2346e6, 499.0, -0.05,
                   45.25, -0.083, 0.172, 1.25, -0.375, 0.0265 },
    };
    for (int s = 0; s < DIG_SIGNALS; s++) {
        sample.valid[s] = true;
    }
    dig_rig_modbus_encode(&sample, 65535, registers);
}

TEST(registers_are_those_worked_by_hand)
{
    uint16_t registers[DIG_RIG_REGISTERS];
    encode_example(registers);
    // -12500 is 0xCF2C, -1 is 0xFFFF, -500 is 0xFE0C; 452.5 tenths round away from zero. -4150 is
    // 0xEFCA, -38 (37.5 of them) 0xFFDA.
    const uint16_t expected[DIG_RIG_REGISTERS] = { 65535,  5123, 0xCF2C, 0xFFFF, 0xFE0C, 12400,
                                                   1000,   0,    34300,  1235,   0,      453,
                                                   0xEFCA, 8600, 125,    0xFFDA, 53 };
    assert_memory_equal(registers, expected, sizeof expected);
}

TEST(example_of_the_formats_is_what_is_read)
{
    uint16_t registers[DIG_RIG_REGISTERS];
    encode_example(registers);
    FILE *const file = fopen("tests/data/formats/rig_registers.csv", "r");
    assert_non_null(file);
    char header[200];
    assert_non_null(fgets(header, sizeof header, file));
    for (int i = 0; i < DIG_RIG_REGISTERS; i++) {
        int      number = -1;
        unsigned raw    = 0;
        assert_int_equal(fscanf(file, "%d,%u,%*[^\n]", &number, &raw), 2);
        assert_int_equal(number, i);
        assert_int_equal(raw, registers[i]);
    }
    (void)fclose(file);
}

TEST(what_is_not_known_has_its_own_number)
{
    const struct dig_sample none = { .time_ns = 0 };
    uint16_t                registers[DIG_RIG_REGISTERS];
    dig_rig_modbus_encode(&none, 7, registers);
    const uint16_t expected[DIG_RIG_REGISTERS] = { 7,      0x8000, 0x8000, 0x8000, 0x8000, 0xFFFF,
                                                   0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF, 0x8000,
                                                   0x8000, 0x8000, 0x8000, 0x8000, 0x8000 };
    assert_memory_equal(registers, expected, sizeof expected);
}

TEST(values_beyond_a_register_stand_at_its_end)
{
    struct dig_sample far = {
        .value = { 12.0, -12.0, NAN, 60e6, 90e6, -1e6, 1e6, 1e6, INFINITY, 0.0, 1e9, 1.0, -1.0,
                   400.0, -400.0, 20.0 },
    };
    for (int s = 0; s < DIG_SIGNALS; s++) {
        far.valid[s] = true;
    }
    uint16_t registers[DIG_RIG_REGISTERS];
    dig_rig_modbus_encode(&far, 0, registers);
    const uint16_t expected[DIG_RIG_REGISTERS] = { 0,     32767,  0x8001, 0x8000, 0,      60000,
                                                   65534, 0,      1000,   1000,   0xFFFF, 32767,
                                                   32767, 0x8001, 32767,  0x8001, 32767 };
    assert_memory_equal(registers, expected, sizeof expected);
}
