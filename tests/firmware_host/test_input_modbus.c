// Tests for firmware_host/bus/input_modbus.c and the input thread, against libmodbus' own server on
// loopback.

#include "firmware_host/bus/input.h"
#include "firmware_host/bus/signal_map.h"

#include "tests/scratch.h"

#include <arpa/inet.h>
#include <errno.h>
#include <modbus/modbus.h>
#include <netinet/in.h>
#include <pthread.h>
#include <stdbool.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define MS 1000000LL

// Where the test's registers stand once more.
#define FAR 1000

// A server of twelve input registers, here and far off, that counts what it is asked for.
struct server {
    int               listener, port;
    modbus_mapping_t *mapping;
    atomic_bool       stop;
    atomic_bool       hang_up;          // end the connection instead of answering
    atomic_int        refuse;           // answer so many requests with an exception
    atomic_int        refused;          // requests for this register get an exception; 0: none
    atomic_int        muted;            // requests for this register get no answer; 0: none
    atomic_int        slow_ms;          // before each byte of an answer; 0: at once
    atomic_int        first, registers; // of the last request
    atomic_int        reads, writes, connections, unanswered;
    pthread_t         thread;
};

// The registers, byte by byte.
static void answer_slowly(struct server *const s, modbus_t *const bus, const uint8_t query[])
{
    uint8_t reply[9 + 24] = { query[0], query[1], 0, 0, 0, 27, query[6], query[7], 24 };
    for (size_t i = 0; i < 12; i++) {
        reply[9 + 2 * i]  = (uint8_t)(s->mapping->tab_input_registers[i] >> 8);
        reply[10 + 2 * i] = (uint8_t)s->mapping->tab_input_registers[i];
    }
    for (size_t i = 0; i < sizeof reply; i++) {
        const struct timespec pause = { .tv_nsec = atomic_load(&s->slow_ms) * MS };
        (void)nanosleep(&pause, NULL);
        (void)send(modbus_get_socket(bus), reply + i, 1, MSG_NOSIGNAL);
    }
}

static void answer(struct server *const s, modbus_t *const bus)
{
    uint8_t query[MODBUS_TCP_MAX_ADU_LENGTH];
    while (!atomic_load(&s->stop)) {
        const int size = modbus_receive(bus, query);
        if (size < 0) {
            return;
        }
        const int function = query[modbus_get_header_length(bus)];
        atomic_fetch_add(function == 3 || function == 4 ? &s->reads : &s->writes, 1);
        if (atomic_load(&s->hang_up)) {
            return;
        }
        const uint8_t *const asked = query + modbus_get_header_length(bus) + 1;
        const int            first = asked[0] << 8 | asked[1];
        atomic_store(&s->first, first);
        atomic_store(&s->registers, asked[2] << 8 | asked[3]);
        if (first > 0 && first == atomic_load(&s->muted)) {
            atomic_fetch_add(&s->unanswered, 1);
        } else if (first > 0 && first == atomic_load(&s->refused)) {
            (void)modbus_reply_exception(bus, query, MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS);
        } else if (atomic_load(&s->refuse) > 0) {
            atomic_fetch_sub(&s->refuse, 1);
            (void)modbus_reply_exception(bus, query, MODBUS_EXCEPTION_SLAVE_OR_SERVER_BUSY);
        } else {
            s->mapping->tab_input_registers[0]++;
            if (atomic_load(&s->slow_ms) > 0) {
                answer_slowly(s, bus, query);
                continue;
            }
            (void)modbus_reply(bus, query, size, s->mapping);
        }
    }
}

static void *serve(void *const context)
{
    struct server *const s = context;
    while (!atomic_load(&s->stop)) {
        const int fd = accept(s->listener, NULL, NULL);
        if (fd < 0) {
            break;
        }
        atomic_fetch_add(&s->connections, 1);
        modbus_t *const bus = modbus_new_tcp("127.0.0.1", s->port);
        (void)modbus_set_socket(bus, fd);
        (void)modbus_set_indication_timeout(bus, 0, 500000); // longer than a client waits
        answer(s, bus);
        modbus_close(bus);
        modbus_free(bus);
    }
    return NULL;
}

static int listen_on(const int port, int *const bound)
{
    struct sockaddr_in address = { .sin_family      = AF_INET,
                                   .sin_port        = htons((uint16_t)port),
                                   .sin_addr.s_addr = htonl(INADDR_LOOPBACK) };
    socklen_t          size    = sizeof address;
    const int          fd = socket(AF_INET, SOCK_STREAM, 0), on = 1;
    assert_true(fd >= 0);
    assert_int_equal(setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on), 0);
    assert_int_equal(bind(fd, (struct sockaddr *)&address, sizeof address), 0);
    assert_int_equal(getsockname(fd, (struct sockaddr *)&address, &size), 0);
    *bound = ntohs(address.sin_port);
    return fd;
}

static void server_start(struct server *const s)
{
    static const uint16_t block[12] = { 0,    2856, 55076, 56552, 0,    8400,
                                        1000, 1000, 4200,  1000,  2000, 450 };
    s->mapping                      = modbus_mapping_new(0, 0, FAR + 12, FAR + 12);
    assert_non_null(s->mapping);
    memcpy(s->mapping->tab_input_registers, block, sizeof block);
    memcpy(s->mapping->tab_input_registers + FAR, block, sizeof block);
    assert_int_equal(listen(s->listener, 4), 0);
    assert_int_equal(pthread_create(&s->thread, NULL, serve, s), 0);
}

static void server_open(struct server *const s)
{
    s->listener = listen_on(0, &s->port);
    server_start(s);
}

static void server_stop(struct server *const s)
{
    atomic_store(&s->stop, true);
    (void)shutdown(s->listener, SHUT_RDWR);
    assert_int_equal(pthread_join(s->thread, NULL), 0);
    (void)close(s->listener);
    modbus_mapping_free(s->mapping);
}

struct client {
    struct dig_signal_map map;
    struct dig_input      input;
    struct dig_ring       readings;
    struct dig_latest     log;
    struct dig_reading    reading_memory[256];
    struct dig_log_line   log_memory[3];
    atomic_bool           stop;
    pthread_t             thread;
};

static void *client_main(void *const context)
{
    dig_input_run(&((struct client *)context)->input);
    return NULL;
}

static void client_start_with(struct client *const c, const int port, const char *const map,
                              const double poll_s)
{
    const struct dig_modbus_address address = {
        .host = "127.0.0.1", .port = port, .unit = 1, .poll_s = poll_s
    };
    *c = (struct client){ 0 };
    assert_int_equal(dig_signal_map_read(map, NULL, &c->map, NULL), DIG_OK);
    assert_int_equal(dig_input_modbus_create(&c->input, &address, &c->map), DIG_OK);
    dig_ring_init(&c->readings, sizeof c->reading_memory[0], 256, c->reading_memory);
    dig_latest_init(&c->log, sizeof c->log_memory[0], c->log_memory);
    c->input.readings = &c->readings;
    c->input.log      = &c->log;
    c->input.stop     = &c->stop;
    assert_int_equal(pthread_create(&c->thread, NULL, client_main, c), 0);
}

static void client_start(struct client *const c, const int port)
{
    client_start_with(c, port, "config/signals/modbus_default.yaml", 0.005);
}

static void client_stop(struct client *const c)
{
    atomic_store(&c->stop, true);
    assert_int_equal(pthread_join(c->thread, NULL), 0);
    dig_input_destroy(&c->input);
}

static void pause_ms(void)
{
    const struct timespec pause = { .tv_nsec = MS };
    (void)nanosleep(&pause, NULL);
}

// Until the next reading, or for ten seconds.
static bool next_reading(struct client *const c, struct dig_reading *const reading)
{
    for (int i = 0; i < 10000; i++) {
        if (dig_ring_pop(&c->readings, reading)) {
            return true;
        }
        pause_ms();
    }
    return false;
}

// What waits is older.
static bool fresh_reading(struct client *const c, struct dig_reading *const reading)
{
    while (dig_ring_pop(&c->readings, reading)) {
    }
    return next_reading(c, reading);
}

static bool next_note(struct client *const c, struct dig_log_line *const note)
{
    for (int i = 0; i < 10000; i++) {
        if (dig_latest_take(&c->log, note)) {
            return true;
        }
        pause_ms();
    }
    return false;
}

static void the_block_is_polled_and_decoded_with_reads_only(void **state)
{
    (void)state;
    struct server s = { 0 };
    server_open(&s);
    static struct client c;
    client_start(&c, s.port);
    struct dig_reading reading;
    for (int i = 0; i < 20; i++) {
        assert_true(next_reading(&c, &reading));
    }
    assert_true(reading.has_alive);
    assert_close(reading.value[DIG_SIGNAL_BOOM_rad], 0.2856, 1e-12);
    assert_close(reading.value[DIG_SIGNAL_ARM_rad], -1.0460, 1e-12);
    assert_close(reading.value[DIG_SIGNAL_BOOM_HEAD_Pa], 8.4e6, 1e-6);
    assert_true(reading.time_ns <= dig_input_now_ns());
    client_stop(&c);
    server_stop(&s);
    assert_true(atomic_load(&s.reads) >= 20);
    assert_int_equal(atomic_load(&s.writes), 0);
    assert_int_equal(atomic_load(&s.connections), 1);
    assert_int_equal(atomic_load(&c.input.reconnects), 0);
}

static void a_server_that_comes_late_is_found_and_said(void **state)
{
    (void)state;
    struct server s = { 0 };
    s.listener      = listen_on(0, &s.port); // bound, not listening: refused
    static struct client c;
    client_start(&c, s.port);
    struct dig_log_line note;
    assert_true(next_note(&c, &note));
    assert_non_null(strstr(note.text, "Connection refused"));
    assert_false(atomic_load(&c.input.connected));
    server_start(&s);
    struct dig_reading reading;
    assert_true(next_reading(&c, &reading));
    assert_true(next_note(&c, &note));
    assert_string_equal(note.text, ""); // the trouble is over
    client_stop(&c);
    server_stop(&s);
}

static void a_connection_that_breaks_is_made_anew(void **state)
{
    (void)state;
    struct server s = { 0 };
    server_open(&s);
    static struct client c;
    client_start(&c, s.port);
    struct dig_reading reading;
    assert_true(next_reading(&c, &reading));
    atomic_store(&s.hang_up, true);
    while (atomic_load(&s.connections) < 2) {
        pause_ms();
    }
    atomic_store(&s.hang_up, false);
    assert_true(fresh_reading(&c, &reading));
    client_stop(&c);
    server_stop(&s);
    assert_true(atomic_load(&c.input.reconnects) >= 1);
}

// Each byte comes in time, the last of them when the first registers are long past.
static void an_answer_that_dawdles_is_not_taken_for_the_present(void **state)
{
    (void)state;
    struct server s = { .slow_ms = 10 }; // a third of a second in all
    server_open(&s);
    static struct client c;
    client_start(&c, s.port);
    while (atomic_load(&c.input.timeouts) == 0 && atomic_load(&c.input.frames) == 0) {
        pause_ms();
    }
    client_stop(&c);
    assert_true(atomic_load(&c.input.timeouts) > 0);
    assert_int_equal(atomic_load(&c.input.frames), 0);
    server_stop(&s);
}

static void a_refusal_is_counted_and_borne(void **state)
{
    (void)state;
    struct server s = { 0 };
    server_open(&s);
    static struct client c;
    client_start(&c, s.port);
    struct dig_reading reading;
    assert_true(next_reading(&c, &reading));
    atomic_store(&s.refuse, 3);
    while (atomic_load(&c.input.malformed) < 3) {
        pause_ms();
    }
    assert_true(fresh_reading(&c, &reading));
    assert_int_equal(atomic_load(&c.input.malformed), 3);
    assert_int_equal(atomic_load(&s.connections), 1);
    client_stop(&c);
    server_stop(&s);
}

// Angles here, pressures far off at a fifth of the rate, the oil's temperature once in a while.
static const char far_map[] =
    "kind: modbus\n"
    "blocks:\n"
    "  - {register: 0, registers: 4}\n"
    "  - {register: 1009, registers: 2, poll_Hz: 10}\n"
    "  - {register: 1011, registers: 1, poll_Hz: 2}\n"
    "alive: {register: 0}\n"
    "signals:\n"
    "  - {name: boom_rad, register: 1, type: int16, scale: 1e-4, min: -4, max: 4}\n"
    "  - {name: arm_rad, register: 2, type: int16, scale: 1e-4, min: -4, max: 4}\n"
    "  - {name: bucket_rad, register: 3, type: int16, scale: 1e-4, min: -4, max: 4}\n"
    "  - {name: bucket_head_Pa, register: 1009, scale: 1e3, min: -1, max: 4.0e7}\n"
    "  - {name: bucket_rod_Pa, register: 1010, scale: 1e3, min: -1, max: 4.0e7}\n"
    "  - {name: temperature_degC, register: 1011, scale: 0.1, min: -60, max: 150}\n";

// Takes readings until so many of a block came; how many of each came meanwhile.
static void count_blocks(struct client *const c, const unsigned block, const int until,
                         int came[const 3])
{
    struct dig_reading reading;
    while (came[block] < until) {
        assert_true(next_reading(c, &reading));
        assert_in_range(reading.group, 0, 2);
        assert_true(came[reading.group]++ < 2000);
        if (reading.group == 1) {
            assert_close(reading.value[DIG_SIGNAL_BUCKET_HEAD_Pa], 1e6, 1e-6);
            assert_int_equal(reading.state[DIG_SIGNAL_BOOM_rad], DIG_READING_ABSENT);
        }
        assert_int_equal(reading.has_alive, reading.group == 0);
    }
}

static void blocks_that_lie_apart_are_asked_for_each_at_its_rate(void **state)
{
    (void)state;
    struct server s = { 0 };
    server_open(&s);
    static struct client c;
    client_start_with(&c, s.port, scratch_write("far.yaml", far_map), 0.02);
    int came[3] = { 0 };
    count_blocks(&c, 1, 10, came);
    print_message("blocks at 50, 10, 2 Hz: %d, %d, %d readings\n", came[0], came[1], came[2]);
    assert_true(came[0] > 2 * came[1]); // five times as many, were it not for a busy machine
    assert_in_range(came[2], 1, came[1] / 2);
    client_stop(&c);
    server_stop(&s);
    const int first = atomic_load(&s.first);
    const int last  = atomic_load(&s.registers);
    assert_true((first == 0 && last == 4) || (first == 1009 && last == 2) ||
                (first == 1011 && last == 1));
    assert_int_equal(atomic_load(&s.writes), 0);
    assert_int_equal(atomic_load(&s.connections), 1);
}

static void a_block_that_is_refused_is_done_without_or_ends_the_connection(void **state)
{
    (void)state;
    struct server s = { 0 };
    server_open(&s);
    static struct client c;
    atomic_store(&s.refused, 1011); // the temperature
    client_start_with(&c, s.port, scratch_write("far.yaml", far_map), 0.02);
    int came[3] = { 0 };
    while (atomic_load(&c.input.malformed) < 6) {
        count_blocks(&c, 1, came[1] + 1, came);
    }
    assert_int_equal(came[2], 0);
    assert_int_equal(atomic_load(&s.connections), 1);

    struct dig_log_line note;
    (void)dig_latest_take(&c.log, &note);
    atomic_store(&s.refused, 1009); // the pressures
    assert_true(next_note(&c, &note));
    assert_non_null(
        strstr(note.text, "registers 1009 … 1010: no good answer: Illegal data address"));
    atomic_store(&s.refused, 0);
    count_blocks(&c, 2, 1, came); // all is well again
    client_stop(&c);
    server_stop(&s);
    assert_true(atomic_load(&c.input.reconnects) >= 1);
}

// The boom's pressures tell only the force: while they are refused the rest comes, and they come
// again when they are not.
static void a_block_of_force_alone_is_done_without_until_it_is_back(void **state)
{
    (void)state;
    static const char map[] =
        "kind: modbus\n"
        "blocks:\n"
        "  - {register: 0, registers: 6}\n"
        "  - {register: 1009, registers: 2}\n"
        "signals:\n"
        "  - {name: boom_rad, register: 1, type: int16, scale: 1e-4, min: -4, max: 4}\n"
        "  - {name: arm_rad, register: 2, type: int16, scale: 1e-4, min: -4, max: 4}\n"
        "  - {name: bucket_rad, register: 3, type: int16, scale: 1e-4, min: -4, max: 4}\n"
        "  - {name: bucket_head_Pa, register: 4, scale: 1e3, min: -1, max: 4.0e7}\n"
        "  - {name: bucket_rod_Pa, register: 5, scale: 1e3, min: -1, max: 4.0e7}\n"
        "  - {name: boom_head_Pa, register: 1009, scale: 1e3, min: -1, max: 4.0e7}\n"
        "  - {name: boom_rod_Pa, register: 1010, scale: 1e3, min: -1, max: 4.0e7}\n";
    struct server s = { 0 };
    server_open(&s);
    static struct client c;
    atomic_store(&s.refused, 1009);
    client_start_with(&c, s.port, scratch_write("force.yaml", map), 0.01);
    struct dig_reading reading;
    while (atomic_load(&c.input.malformed) < 7) {
        assert_true(next_reading(&c, &reading));
        assert_int_equal(reading.group, 0);
    }
    assert_int_equal(atomic_load(&s.connections), 1);
    atomic_store(&s.refused, 0);
    do {
        assert_true(next_reading(&c, &reading));
    } while (reading.group != 1);
    assert_close(reading.value[DIG_SIGNAL_BOOM_HEAD_Pa], 1e6, 1e-6);
    client_stop(&c);
    server_stop(&s);
    assert_int_equal(atomic_load(&c.input.reconnects), 0);
}

static double now_s(void)
{
    return 1e-9 * (double)dig_input_now_ns();
}

// A block without an answer costs the others 200 ms each time: after three times it is asked once
// in five seconds, and said to be silent; the others go on. Then it is back.
static void a_silent_block_is_asked_less_and_less_while_others_answer(void **state)
{
    (void)state;
    struct server s = { 0 };
    server_open(&s);
    static struct client c;
    atomic_store(&s.muted, 1011); // the temperature, due twice a second
    client_start_with(&c, s.port, scratch_write("far.yaml", far_map), 0.02);
    int                 came[3] = { 0 };
    struct dig_log_line note    = { "" };
    bool                said    = false;
    while (!said) {
        count_blocks(&c, 0, came[0] + 1, came);
        said = dig_latest_take(&c.log, &note) && strstr(note.text, "silent") != NULL;
    }
    assert_contains(note.text, "registers 1011 … 1011: silent while others answer");
    assert_true(atomic_load(&c.input.timeouts) >= 3);

    const double begin_s = now_s();
    const int    before  = atomic_load(&s.unanswered);
    while (now_s() - begin_s < 2.5) {
        count_blocks(&c, 0, came[0] + 1, came);
        count_blocks(&c, 1, came[1] + 1, came);
    }
    assert_true(atomic_load(&s.unanswered) - before <= (now_s() - begin_s) / 5.0);
    assert_int_equal(came[2], 0);
    atomic_store(&s.muted, 0);
    count_blocks(&c, 2, 1, came);
    while (note.text[0] != '\0') {
        assert_true(next_note(&c, &note));
    }
    client_stop(&c);
    server_stop(&s);
    assert_int_equal(atomic_load(&s.connections), 1);
    assert_int_equal(atomic_load(&c.input.reconnects), 0);
}

static void what_cannot_be_polled_is_refused(void **state)
{
    (void)state;
    struct dig_signal_map           can     = { .kind = DIG_MAP_CAN };
    const struct dig_modbus_address address = { .host = "127.0.0.1", .port = 1, .poll_s = 0.01 };
    struct dig_input                input   = { 0 };
    assert_int_equal(dig_input_modbus_create(&input, &address, &can), DIG_EINVAL);
    const struct dig_modbus_address never = { .host = "127.0.0.1", .port = 1 };
    can.kind                              = DIG_MAP_MODBUS;
    assert_int_equal(dig_input_modbus_create(&input, &never, &can), DIG_EINVAL);
    assert_null(input.ops);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_block_is_polled_and_decoded_with_reads_only),
        cmocka_unit_test(a_server_that_comes_late_is_found_and_said),
        cmocka_unit_test(a_connection_that_breaks_is_made_anew),
        cmocka_unit_test(an_answer_that_dawdles_is_not_taken_for_the_present),
        cmocka_unit_test(a_refusal_is_counted_and_borne),
        cmocka_unit_test(blocks_that_lie_apart_are_asked_for_each_at_its_rate),
        cmocka_unit_test(a_block_that_is_refused_is_done_without_or_ends_the_connection),
        cmocka_unit_test(a_block_of_force_alone_is_done_without_until_it_is_back),
        cmocka_unit_test(a_silent_block_is_asked_less_and_less_while_others_answer),
        cmocka_unit_test(what_cannot_be_polled_is_refused),
    };
    return cmocka_run_group_tests_name("input_modbus", tests, NULL, NULL);
}
