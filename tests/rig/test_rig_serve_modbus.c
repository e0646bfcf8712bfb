// Tests for tools/rig/bus/serve_modbus.c and board.c with libmodbus clients: TCP on a free port of
// the loopback.

#include "tools/rig/bus/serve_modbus.h"

#include "tests/rig/modbus_rig.h"

#include <errno.h>
#include <modbus/modbus.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static void start_tcp(struct rig *const rig)
{
    char             where[100];
    struct dig_error error = { "" };
    memset(rig, 0, sizeof *rig);
    assert_true(dig_rig_board_init(&rig->board, &rig->faults));
    dig_rig_board_write(&rig->board, registers, 0.0);
    assert_ok(dig_rig_modbus_start_tcp("127.0.0.1:0", &rig->board, sizeof where, where,
                                       &rig->server, &error),
              error);
    assert_int_equal(sscanf(where, "Modbus TCP on 127.0.0.1:%d", &rig->port), 1);
}

static modbus_t *join(const struct rig *const rig)
{
    modbus_t *const client = modbus_new_tcp("127.0.0.1", rig->port);
    assert_non_null(client);
    assert_int_equal(modbus_connect(client), 0);
    return client;
}

TEST(input_and_holding_registers_read_the_same_board)
{
    struct rig rig;
    start_tcp(&rig);
    modbus_t *const client                   = join(&rig);
    uint16_t        found[DIG_RIG_REGISTERS] = { 0 };
    assert_int_equal(modbus_read_input_registers(client, 0, DIG_RIG_REGISTERS, found),
                     DIG_RIG_REGISTERS);
    assert_memory_equal(found, registers, sizeof registers);
    memset(found, 0, sizeof found);
    assert_int_equal(modbus_read_registers(client, 0, DIG_RIG_REGISTERS, found), DIG_RIG_REGISTERS);
    assert_memory_equal(found, registers, sizeof registers);

    // What is written on the board is read at once, and from the middle too.
    uint16_t newer[DIG_RIG_REGISTERS];
    memcpy(newer, registers, sizeof newer);
    newer[5] = 777;
    dig_rig_board_write(&rig.board, newer, 0.0);
    assert_int_equal(modbus_read_input_registers(client, 5, 1, found), 1);
    assert_int_equal(found[0], 777);

    // They stand once more far off, and nothing between.
    assert_int_equal(modbus_read_input_registers(client, DIG_RIG_FAR + 4, 8, found), 8);
    assert_memory_equal(found, newer + 4, 8 * sizeof newer[0]);
    assert_int_equal(modbus_read_input_registers(client, DIG_RIG_FAR - 1, 2, found), -1);
    assert_int_equal(errno, EMBXILADD);
    assert_int_equal(
        modbus_read_input_registers(client, DIG_RIG_FAR + DIG_RIG_REGISTERS - 1, 2, found), -1);
    assert_int_equal(errno, EMBXILADD);
    leave(client);
    stop(&rig);
    assert_int_equal(rig.requests.served[3], 1);
    assert_int_equal(rig.requests.served[4], 3);
    assert_int_equal(rig.requests.refused[4], 2);
}

TEST(every_write_is_refused_with_exception_1_and_counted)
{
    struct rig rig;
    start_tcp(&rig);
    modbus_t *const client   = join(&rig);
    uint16_t        found[2] = { 0 };
    uint8_t         bits[8]  = { 0 };

    assert_int_equal(modbus_write_register(client, 0, 9), -1);
    assert_int_equal(errno, EMBXILFUN);
    assert_int_equal(modbus_write_registers(client, 0, 2, registers), -1);
    assert_int_equal(errno, EMBXILFUN);
    assert_int_equal(modbus_write_bit(client, 0, 1), -1);
    assert_int_equal(errno, EMBXILFUN);
    assert_int_equal(modbus_write_bits(client, 0, 8, bits), -1);
    assert_int_equal(errno, EMBXILFUN);
    assert_int_equal(modbus_mask_write_register(client, 0, 1, 1), -1);
    assert_int_equal(errno, EMBXILFUN);
    assert_int_equal(modbus_write_and_read_registers(client, 0, 1, registers, 0, 1, found), -1);
    assert_int_equal(errno, EMBXILFUN);
    assert_int_equal(modbus_read_bits(client, 0, 8, bits), -1);
    assert_int_equal(errno, EMBXILFUN);

    // And none of them touched the board or broke the connection.
    assert_int_equal(modbus_read_registers(client, 0, 2, found), 2);
    assert_memory_equal(found, registers, sizeof found);
    leave(client);
    stop(&rig);
    const int functions[] = { 1, 5, 6, 15, 16, 22, 23 };
    for (size_t i = 0; i < sizeof functions / sizeof functions[0]; i++) {
        assert_int_equal(rig.requests.refused[functions[i]], 1);
        assert_int_equal(rig.requests.served[functions[i]], 0);
    }
}

TEST(reads_outside_the_map_are_refused)
{
    struct rig rig;
    start_tcp(&rig);
    modbus_t *const client   = join(&rig);
    uint16_t        found[2] = { 42, 42 };
    assert_int_equal(modbus_read_input_registers(client, DIG_RIG_REGISTERS - 1, 2, found), -1);
    assert_int_equal(errno, EMBXILADD);
    assert_int_equal(modbus_read_input_registers(client, 40000, 1, found), -1);
    assert_int_equal(errno, EMBXILADD);
    assert_int_equal(found[0], 42);
    leave(client);
    stop(&rig);
    assert_int_equal(rig.requests.refused[4], 2);
    assert_int_equal(rig.requests.served[4], 0);
}

TEST(several_clients_come_and_go_and_one_that_drops_stops_nobody)
{
    struct rig rig;
    start_tcp(&rig);
    uint16_t found[DIG_RIG_REGISTERS];
    for (int round = 0; round < 12; round++) {
        modbus_t *const a = join(&rig);
        modbus_t *const b = join(&rig);
        assert_int_equal(modbus_read_registers(a, 0, 12, found), 12);
        assert_int_equal(modbus_read_registers(b, 0, 12, found), 12);
        // One leaves in the middle of a request.
        const uint8_t half[] = { 0x00, 0x01, 0x00, 0x00, 0x00 };
        assert_int_equal(write(modbus_get_socket(a), half, sizeof half), (int)sizeof half);
        leave(a);
        assert_int_equal(modbus_read_registers(b, 0, 12, found), 12);
        leave(b);
    }
    modbus_t *const last = join(&rig);
    assert_int_equal(modbus_read_registers(last, 0, 12, found), 12);
    leave(last);
    stop(&rig);
    assert_int_equal(rig.requests.served[3], 37);
    assert_int_equal(rig.requests.clients, 25);
}

TEST(silent_board_answers_nothing_and_speaks_again_later)
{
    struct rig rig;
    start_tcp(&rig);
    modbus_t *const client = join(&rig);
    uint16_t        found[12];
    modbus_set_response_timeout(client, 0, 100000);
    assert_int_equal(dig_rig_fault_add("missing@1:1", &rig.faults, NULL), DIG_OK);
    dig_rig_board_write(&rig.board, registers, 1.0);
    assert_int_equal(modbus_read_registers(client, 0, 12, found), -1);
    assert_int_equal(errno, ETIMEDOUT);
    dig_rig_board_write(&rig.board, registers, 2.0);
    modbus_set_response_timeout(client, 2, 0);
    assert_int_equal(modbus_read_registers(client, 0, 12, found), 12);
    leave(client);
    stop(&rig);
    assert_int_equal(rig.requests.unanswered, 1);
}

TEST(damaged_answers_are_refused_by_the_client_and_counted)
{
    struct rig rig;
    uint16_t   read[12];
    start_tcp(&rig);
    modbus_t *const client = join(&rig);
    assert_int_equal(dig_rig_fault_add("corrupt=1@1:1", &rig.faults, NULL), DIG_OK);
    dig_rig_board_write(&rig.board, registers, 1.0);
    for (int i = 0; i < 9; i++) {
        assert_int_equal(modbus_read_input_registers(client, 0, 12, read), -1);
        assert_int_equal(errno, EMBBADDATA);
        (void)modbus_flush(client);
    }
    dig_rig_board_write(&rig.board, registers, 2.0);
    assert_int_equal(modbus_read_input_registers(client, 0, 12, read), 12);
    assert_memory_equal(read, registers, sizeof read);
    leave(client);
    stop(&rig);
    assert_int_equal(rig.requests.damaged, 9);
    assert_int_equal(rig.requests.served[4], 1);
}

TEST(port_that_is_taken_and_addresses_that_are_none_are_refused)
{
    struct rig rig;
    start_tcp(&rig);
    char                   where[100];
    char                   taken[64];
    struct dig_rig_modbus *server = NULL;
    struct dig_error       error  = { "" };
    (void)snprintf(taken, sizeof taken, "127.0.0.1:%d", rig.port);
    assert_int_equal(
        dig_rig_modbus_start_tcp(taken, &rig.board, sizeof where, where, &server, &error), DIG_EIO);
    static const char *const bad[] = { "",
                                       "1502",
                                       "127.0.0.1",
                                       "127.0.0.1:",
                                       "127.0.0.1:x",
                                       "127.0.0.1:70000",
                                       "localhost:1502",
                                       ":1502" };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(
            dig_rig_modbus_start_tcp(bad[i], &rig.board, sizeof where, where, &server, &error),
            DIG_EINVAL);
    }
    assert_int_equal(dig_rig_modbus_start_rtu("/nowhere/tty:9600", &rig.board, sizeof where, where,
                                              &server, &error),
                     DIG_EIO);
    assert_null(server);
    stop(&rig);
}

static void *read_board(void *const board)
{
    static uint16_t found[DIG_RIG_REGISTERS];
    (void)dig_rig_board_read(board, found);
    return found;
}

// A client that came before the first values read zeros: the front jumped there, and back.
TEST(request_before_the_first_values_is_answered_with_them)
{
    struct dig_rig_board board;
    assert_true(dig_rig_board_init(&board, NULL));
    pthread_t reader;
    assert_int_equal(pthread_create(&reader, NULL, read_board, &board), 0);
    const struct timespec moment = { .tv_nsec = 20000000 };
    (void)nanosleep(&moment, NULL);
    dig_rig_board_write(&board, registers, 0.0);
    void *found = NULL;
    assert_int_equal(pthread_join(reader, &found), 0);
    assert_memory_equal(found, registers, sizeof registers);
    dig_rig_board_finish(&board);
}
