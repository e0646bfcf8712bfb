#include "tests/firmware_host/modbus_server.h"

#include "tests/testlib.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <stdbool.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

// The registers, byte by byte.
static void answer_slowly(struct modbus_server *const s, modbus_t *const bus, const uint8_t query[])
{
    uint8_t reply[9 + 24] = { query[0], query[1], 0, 0, 0, 27, query[6], query[7], 24 };
    for (size_t i = 0; i < 12; i++) {
        reply[9 + 2 * i]  = (uint8_t)(s->mapping->tab_input_registers[i] >> 8);
        reply[10 + 2 * i] = (uint8_t)s->mapping->tab_input_registers[i];
    }
    for (size_t i = 0; i < sizeof reply; i++) {
        const struct timespec pause = { .tv_nsec = atomic_load(&s->slow_ms) * 1000000LL };
        (void)nanosleep(&pause, NULL);
        (void)send(modbus_get_socket(bus), reply + i, 1, MSG_NOSIGNAL);
    }
}

static void answer(struct modbus_server *const s, modbus_t *const bus)
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
    struct modbus_server *const s = context;
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

void modbus_server_bind(struct modbus_server *const s)
{
    struct sockaddr_in address = { .sin_family      = AF_INET,
                                   .sin_addr.s_addr = htonl(INADDR_LOOPBACK) };
    socklen_t          size    = sizeof address;
    const int          fd = socket(AF_INET, SOCK_STREAM, 0), on = 1;
    assert_true(fd >= 0);
    assert_int_equal(setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on), 0);
    assert_int_equal(bind(fd, (struct sockaddr *)&address, sizeof address), 0);
    assert_int_equal(getsockname(fd, (struct sockaddr *)&address, &size), 0);
    s->listener = fd;
    s->port     = ntohs(address.sin_port);
}

void modbus_server_start(struct modbus_server *const s)
{
    static const uint16_t block[12] = { 0,    2856, 55076, 56552, 0,    8400,
                                        1000, 1000, 4200,  1000,  2000, 450 };
    s->mapping = modbus_mapping_new(0, 0, MODBUS_SERVER_FAR + 12, MODBUS_SERVER_FAR + 12);
    assert_non_null(s->mapping);
    memcpy(s->mapping->tab_input_registers, block, sizeof block);
    memcpy(s->mapping->tab_input_registers + MODBUS_SERVER_FAR, block, sizeof block);
    assert_int_equal(listen(s->listener, 4), 0);
    assert_int_equal(pthread_create(&s->thread, NULL, serve, s), 0);
}

void modbus_server_open(struct modbus_server *const s)
{
    modbus_server_bind(s);
    modbus_server_start(s);
}

void modbus_server_stop(struct modbus_server *const s)
{
    atomic_store(&s->stop, true);
    (void)shutdown(s->listener, SHUT_RDWR);
    assert_int_equal(pthread_join(s->thread, NULL), 0);
    (void)close(s->listener);
    modbus_mapping_free(s->mapping);
}
