// Tests for firmware_host/bus/dbc.c

#include "firmware_host/bus/dbc.h"

#include "tests/scratch.h"

#include <stdlib.h>

static struct dig_dbc read_good(const char *const text)
{
    struct dig_dbc   dbc;
    struct dig_error error = { "" };
    if (dig_dbc_read(scratch_write("good.dbc", text), &dbc, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    return dbc;
}

static double decode(const struct dig_dbc *const dbc, const char *const message,
                     const char *const signal, const uint8_t data[8])
{
    const struct dig_dbc_message *const m = dig_dbc_find(dbc, message);
    assert_non_null(m);
    const struct dig_dbc_signal *const s = dig_dbc_find_signal(dbc, m, signal);
    assert_non_null(s);
    return dig_dbc_value(s, dig_dbc_raw(s, data));
}

// Worked by hand: 0x69 = 105, 105 * 0.2 - 10 = 11; 0x37 = 55 is 1 MPa; 0x32 = 50 is none.
TEST(golden_pressure_frame_of_a_zx200)
{
    struct dig_dbc dbc;
    assert_int_equal(dig_dbc_read("config/can/zx200.dbc", &dbc, NULL), DIG_OK);
    const struct dig_dbc_message *const m = dig_dbc_find(&dbc, "Pressure_1");
    assert_int_equal(m->id, 0x18FF79E8);
    assert_true(m->extended);
    assert_int_equal(m->bytes, 8);
    const uint8_t data[8] = { 0x69, 0x37, 0x32, 0xFF, 0x00, 0xFE, 0xFF, 0xFF };
    assert_close(decode(&dbc, "Pressure_1", "boom_cylinder_bottom_pressure", data), 11.0, 1e-12);
    assert_close(decode(&dbc, "Pressure_1", "boom_cylinder_rod_pressure", data), 1.0, 1e-12);
    assert_close(decode(&dbc, "Pressure_1", "arm_cylinder_bottom_pressure", data), 0.0, 1e-12);
    assert_close(decode(&dbc, "Pressure_1", "arm_cylinder_rod_pressure", data), 41.0, 1e-12);
    assert_close(decode(&dbc, "Pressure_1", "bucket_cylinder_bottom_pressure", data), -10.0, 1e-12);
    assert_close(decode(&dbc, "Pressure_1", "bucket_cylinder_rod_pressure", data), 40.8, 1e-12);
    dig_dbc_finish(&dbc);
}

// Worked by hand: low byte first, 0x72 0x64 is 0x6472 = 25714, 25714 * 0.0004 - 10 = 0.2856.
// Swapped it would read 1.7136; with the precedence slip (factor * high * 256 + low) 116.9.
TEST(golden_angle_frames_of_a_zx200)
{
    struct dig_dbc dbc;
    assert_int_equal(dig_dbc_read("config/can/zx200.dbc", &dbc, NULL), DIG_OK);
    assert_int_equal(dig_dbc_find(&dbc, "Front_Angle")->id, 0x18FF7DE8);
    assert_int_equal(dig_dbc_find(&dbc, "Roll_Pitch_Angle")->id, 0x18FF7EE8);
    assert_int_equal(dig_dbc_find(&dbc, "Machine_State")->id, 0x18FF84E8);

    const uint8_t angles[8] = { 0x72, 0x64, 0x71, 0x57, 0xE2, 0x58, 0xFF, 0xFF };
    assert_close(decode(&dbc, "Front_Angle", "boom_relative_angle", angles), 0.2856, 1e-12);
    assert_close(decode(&dbc, "Front_Angle", "arm_relative_angle", angles), -1.0460, 1e-12);
    assert_close(decode(&dbc, "Front_Angle", "bucket_relative_angle", angles), -0.8984, 1e-12);

    // 14 bits from bit 16: 0x40 and the low six bits of 0xDF = 0x1F40 = 8000, 8000 * 0.0005 - 4 =
    // 0.
    const uint8_t tilt[8] = { 0xFF, 0xFF, 0x40, 0xDF, 0xFF, 0xFF, 0xFF, 0xFF };
    assert_close(decode(&dbc, "Roll_Pitch_Angle", "pitch_angle", tilt), 0.0, 1e-12);

    const uint8_t machine[8] = { 0, 0, 0, 0x91, 0, 0, 0, 0xC8 };
    assert_close(decode(&dbc, "Machine_State", "hydraulic_oil_temp", machine), 45.0, 1e-12);
    assert_close(decode(&dbc, "Machine_State", "alive_counter", machine), 200.0, 1e-12);
    dig_dbc_finish(&dbc);
}

TEST(motorola_and_signed_signals_are_decoded)
{
    struct dig_dbc                      dbc = read_good("BO_ 291 M: 8 X\n"
                                                                             " SG_ word : 7|16@0+ (1,0) [0|0] \"\" X\n"
                                                                             " SG_ twelve : 3|12@0+ (1,0) [0|0] \"\" X\n"
                                                                             " SG_ across : 18|5@0+ (1,0) [0|0] \"\" X\n"
                                                                             " SG_ minus : 36|12@1- (0.5,1) [0|0] \"\" X\n"
                                                                             " SG_ all : 0|64@1- (1,0) [0|0] \"\" X\n");
    const struct dig_dbc_message *const m   = dig_dbc_find(&dbc, "M");
    assert_false(m->extended);
    assert_int_equal(m->id, 0x123);

    // across: bits 2, 1, 0 of byte 2 and then 7, 6 of byte 3: 101 10 = 22.
    const uint8_t data[8] = { 0x1A, 0xBC, 0x05, 0x80, 0xF0, 0xFF, 0, 0 };
    assert_close(decode(&dbc, "M", "word", data), 0x1ABC, 0.0);
    assert_close(decode(&dbc, "M", "twelve", data), 0xABC, 0.0);
    assert_close(decode(&dbc, "M", "across", data), 22, 0.0);
    assert_close(decode(&dbc, "M", "minus", data), 0.5, 0.0); // all ones: -1 * 0.5 + 1

    const uint8_t least[8] = { 0, 0, 0, 0, 0x00, 0x80, 0, 0 }; // 0x800: -2048
    assert_close(decode(&dbc, "M", "minus", least), -1023.0, 0.0);
    const uint8_t minus_two[8] = { 0xFE, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF };
    assert_close(decode(&dbc, "M", "all", minus_two), -2.0, 0.0);
    dig_dbc_finish(&dbc);
}

// The decoder walks bit by bit; the oracle shifts the whole frame as one number of 64 bits.
TEST(every_signal_equals_a_shift_of_the_whole_frame)
{
    srand(7);
    for (int trial = 0; trial < 20000; trial++) {
        uint8_t  data[8];
        uint64_t little = 0, big = 0;
        for (unsigned i = 0; i < 8; i++) {
            data[i] = (uint8_t)(rand() >> 4);
            little |= (uint64_t)data[i] << (8 * i);
            big |= (uint64_t)data[i] << (8 * (7 - i));
        }
        const unsigned bits = 1 + (unsigned)rand() % 64;
        const unsigned from = (unsigned)rand() % (65 - bits);
        const uint64_t mask = bits == 64 ? UINT64_MAX : (UINT64_C(1) << bits) - 1;

        const struct dig_dbc_signal intel = { .start_bit = from, .bits = bits, .intel = true };
        assert_true(dig_dbc_raw(&intel, data) == ((little >> from) & mask));

        const struct dig_dbc_signal motorola = { .start_bit = from / 8 * 8 + 7 - from % 8,
                                                 .bits      = bits };
        assert_true(dig_dbc_raw(&motorola, data) == ((big >> (64 - from - bits)) & mask));
    }
}

TEST(what_is_no_message_is_passed_over)
{
    struct dig_dbc dbc = read_good("VERSION \"x\"\r\n"
                                   "NS_ :\n\tBA_\n"
                                   "BU_: A B\n"
                                   "BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX\n"
                                   " SG_ lost : 0|8@1+ (1,0) [0|0] \"\" Vector__XXX\n"
                                   "BO_ 2147483649 M: 2 A\n"
                                   " SG_ mux M : 0|4@1+ (1,0) [0|0] \"\" B\n"
                                   " SG_ one m1 : 4|4@1+ (1,0) [0|0] \"V\" B\n"
                                   " SG_ f : 8|8@1+ (1,0) [0|0] \"\" B\n"
                                   "CM_ BO_ 1 \"a comment\n"
                                   "BO_ 9 over: 8 lines\n"
                                   "\";\n"
                                   "SIG_VALTYPE_ 2147483649 f : 1;\n");
    assert_int_equal(dbc.messages, 2);
    const struct dig_dbc_message *const m = dig_dbc_find(&dbc, "M");
    assert_int_equal(m->id, 1);
    assert_true(m->extended);
    assert_false(dig_dbc_find_signal(&dbc, m, "mux")->multiplexed);
    assert_true(dig_dbc_find_signal(&dbc, m, "one")->multiplexed);
    assert_true(dig_dbc_find_signal(&dbc, m, "f")->is_float);
    assert_string_equal(dig_dbc_find_signal(&dbc, m, "one")->unit, "V");
    assert_null(dig_dbc_find_signal(&dbc, m, "lost"));
    assert_null(dig_dbc_find(&dbc, "over"));
    dig_dbc_finish(&dbc);
}

TEST(defects_are_refused_with_file_and_line_and_write_nothing)
{
    static const struct {
        const char *text, *expected;
    } cases[] = {
        { "", "bad.dbc:1: no BO_ line" },
        { "BO_ x M: 8 A\n", "bad.dbc:1: \"BO_ x M: 8 A\", expected BO_ ID NAME: BYTES SENDER" },
        { "BO_ 4096 M: 8 A\n", "expected an 11-bit id, or a 29-bit id with bit 31 set" },
        { "BO_ 1 M: 65 A\n", "expected at most 64 bytes" },
        { "BO_ 1 M: 8 A\nBO_ 2 M: 8 A\n", "bad.dbc:2: \"M\", expected every message once" },
        { " SG_ s : 0|8@1+ (1,0) [0|0] \"\" X\n", "expected a BO_ line before the first SG_" },
        { "BO_ 1 M: 1 A\n SG_ s : 1|8@1+ (1,0) [0|0] \"\" X\n", "bad.dbc:2: s: reaches bit 9" },
        { "BO_ 1 M: 1 A\n SG_ s : 6|8@0+ (1,0) [0|0] \"\" X\n", "bad.dbc:2: s: reaches bit 16" },
        { "BO_ 1 M: 8 A\n SG_ s : 0|0@1+ (1,0) [0|0] \"\" X\n", "expected 1 to 64 bits" },
        { "BO_ 1 M: 8 A\n SG_ s : 0|8@2+ (1,0) [0|0] \"\" X\n", "expected @1 (Intel) or @0" },
        { "BO_ 1 M: 8 A\n SG_ s : 0|8@1+ (0,0) [0|0] \"\" X\n", "a factor that is not 0" },
        { "BO_ 1 M: 8 A\n SG_ s : 0|8@1+ (nan,0) [0|0] \"\" X\n", "a factor that is not 0" },
        { "BO_ 1 M: 8 A\n SG_ s : 0|8@1+ 1,0 [0|0] \"\" X\n", "expected SG_ NAME" },
        { "BO_ 1 M: 8 A\n SG_ s : 0|8@1+ (1,0) [0|0]\n", "expected SG_ NAME" },
        { "BO_ 1 M: 8 A\n SG_ s 0|8\n", "expected SG_ NAME" },
        { "BO_ 1 M: 8 A\n SG_ s : 0|8@1+ (1,0) [0|0] \"\" X\n"
          " SG_ s : 8|8@1+ (1,0) [0|0] \"\" X\n",
          "bad.dbc:3: \"s\", expected every signal" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct dig_dbc   dbc   = { .messages = 42 };
        struct dig_error error = { "" };
        assert_int_equal(dig_dbc_read(scratch_write("bad.dbc", cases[i].text), &dbc, &error),
                         DIG_EINVAL);
        assert_contains(error.text, cases[i].expected);
        assert_int_equal(dbc.messages, 42);
    }
    struct dig_dbc dbc = { .messages = 42 };
    assert_int_equal(dig_dbc_read(scratch_path("none.dbc"), &dbc, NULL), DIG_EIO);
    assert_int_equal(dbc.messages, 42);
}

static void put_numbered(FILE *const to, const char *const line, const unsigned number)
{
    const char *const at = strstr(line, "%u");
    if (at == NULL) {
        (void)fputs(line, to);
    } else {
        (void)fprintf(to, "%.*s%u%s", (int)(at - line), line, number, at + 2);
    }
}

TEST(a_database_without_end_is_refused)
{
    static const struct {
        const char *head, *line, *says; // the line is written with a number in it
        unsigned    lines, every;       // before so many of them the head is
    } endless[] = {
        { "", "BO_ 1 M%u: 8 S\n", ":8193: \"M8192\", expected at most 8192 messages", 8200, 9000 },
        { "BO_ 1 M%u: 8 S\n", " SG_ s%u : 0|1@1+ (1,0) [0|1] \"\" S\n",
          "expected at most 1024 signals of a message", 1100, 2000 },
        { "BO_ 1 M%u: 8 S\n", " SG_ s%u : 0|1@1+ (1,0) [0|1] \"\" S\n",
          ":65603: \"s65536\", expected at most 65536 signals", 66000, 1000 },
        { "BO_ 1 M%u: 8 S\n", "SIG_VALTYPE_ 1 s%u : 1;\n", ":65538: ", 66000, 70000 },
        { "BO_ 1 M%u: 8 S\n", "BA_ \"GenMsgCycleTime\" BO_ 1 10;\n", ":65538: ", 66000, 70000 },
    };
    for (size_t i = 0; i < sizeof endless / sizeof endless[0]; i++) {
        FILE *const file = fopen(scratch_path("endless.dbc"), "w");
        assert_non_null(file);
        for (unsigned n = 0; n < endless[i].lines; n++) {
            if (n % endless[i].every == 0) {
                put_numbered(file, endless[i].head, n);
            }
            put_numbered(file, endless[i].line, n);
        }
        assert_int_equal(fclose(file), 0);
        struct dig_dbc   dbc   = { .messages = 42 };
        struct dig_error error = { "" };
        assert_int_equal(dig_dbc_read(scratch_path("endless.dbc"), &dbc, &error), DIG_EINVAL);
        assert_contains(error.text, endless[i].says);
        assert_int_equal(dbc.messages, 42);
    }
}

TESTS_WITH(scratch_setup, scratch_teardown)
